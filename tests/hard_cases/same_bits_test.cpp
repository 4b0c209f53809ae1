// SPDX-License-Identifier: GPL-2.0-or-later
// The same inputs give the same bits with SSE2 and AVX2; what must not matter does not.
#include <gtest/gtest.h>

#include <cstring>
#include <numbers>

#include "contact.hpp"
#include "shapes_of_interest.hpp"

namespace {

using namespace phantom;
using namespace phantom::hard;

Settings random_settings(std::mt19937& random)
{
    Settings s;
    s.model = random() % 2 ? PHANTOM_MODEL_PAPER : PHANTOM_MODEL_PROJECTED;
    s.newton_steps = random() % 4;
    s.combine = random() % 2 ? PHANTOM_COMBINE_PAPER : PHANTOM_COMBINE_BOUNDED;
    s.proxy = random() % 3; // off, paper, constrained
    s.effects = random() % 2 ? PHANTOM_EFFECT_DAMPING : 0;
    s.damping = 1;
    return s;
}

TEST(SameBits, FromEveryWidthOnAHundredThousandJobs)
{
    const std::vector<const phantom_float_ops*> wide = wide_sections();
    if (wide.empty())
        GTEST_SKIP() << "this CPU has no AVX2";
    std::mt19937 random(77);
    std::normal_distribution<double> speed(0, 100);
    unsigned contacts = 0, inside = 0;
    for (int set = 0; set < 200; ++set) {
        // stacked soups, and pieces of meshes whose size is no multiple of the block
        auto triangles = set % 2 ? soup(random, 1 + random() % 90, 2) : star(3, bumpy).triangles(1, 2);
        triangles.resize(std::min<std::size_t>(triangles.size(), 1 + random() % 300));
        const Settings settings = random_settings(random);
        const phantom_float_ops& ops = *wide[static_cast<std::size_t>(set) / 2 % wide.size()];
        Contact a(phantom_float_sse2, triangles, settings), b(ops, triangles, settings);
        for (int i = 0; i < 500; ++i) {
            const Vec3 p = point_near(triangles, random, -1, 2.2);
            const Vec3 v{speed(random), speed(random), speed(random)};
            phantom_float_job x = a.tick(p, v).job, y = b.tick(p, v).job;
            x.set = y.set = nullptr;
            ASSERT_EQ(std::memcmp(&x, &y, sizeof(x)), 0) << ops.name << ", set " << set << " job " << i;
            contacts += x.contacts;
            inside += x.inside;
        }
    }
    EXPECT_GT(contacts, 50000U);
    EXPECT_GT(inside, 5000U);
}

/// Sums in another order differ by rounding.
constexpr double order_tolerance_n = 2e-6;

TEST(Invariance, TheOrderOfTheTrianglesChangesNothingBeyondRounding)
{
    std::mt19937 random(5);
    for (const Named& shape : shapes_of_interest()) {
        auto shuffled = shape.triangles;
        std::shuffle(shuffled.begin(), shuffled.end(), random);
        for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED}) {
            Settings settings;
            settings.model = model;
            Contact a(phantom_float_sse2, shape.triangles, settings),
                b(phantom_float_sse2, shuffled, settings);
            for (int i = 0; i < 500; ++i) {
                const Vec3 p = point_near(shape.triangles, random, 0, shape.radius);
                ASSERT_LE(length(subtract(a.tick(p).force, b.tick(p).force)), order_tolerance_n)
                    << shape.name;
            }
        }
    }
}

/// Positions are formed as exact differences, so the place of the mesh is not even in the bits.
TEST(Invariance, ATranslationOfAlmostAMetreChangesNoBit)
{
    const Vec3 far{0.9e3, -0.95e3, 0.8e3};
    std::mt19937 random(6);
    for (const Named& shape : shapes_of_interest()) {
        auto moved = shape.triangles;
        for (auto& t : moved)
            for (Vec3& x : t.corner)
                x = on_grid(add(x, far));
        for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED}) {
            Settings settings;
            settings.model = model;
            settings.proxy = PHANTOM_PROXY_PAPER;
            Contact a(phantom_float_sse2, shape.triangles, settings), b(phantom_float_sse2, moved, settings);
            for (int i = 0; i < 500; ++i) {
                const Vec3 p = point_near(shape.triangles, random, -0.5, shape.radius);
                ASSERT_EQ(a.tick(p).force, b.tick(on_grid(add(p, far))).force) << shape.name;
            }
        }
    }
}

TEST(Invariance, ARotationTurnsTheForceAndNothingElse)
{
    const double c = std::cos(0.7), s = std::sin(0.7);
    const auto turn = [&](const Vec3& v) { // about z, then the axes exchanged
        return Vec3{c * v[1] + s * v[0], v[2], c * v[0] - s * v[1]};
    };
    std::mt19937 random(8);
    for (const Named& shape : shapes_of_interest()) {
        if (shape.name == "soup")
            continue; // its folds multiply the nm grid that the turned corners are put on
        auto turned = shape.triangles;
        for (auto& t : turned) {
            for (std::size_t i = 0; i < 3; ++i) {
                t.corner[i] = on_grid(turn(t.corner[i]));
                t.normal[i] = on_unit_grid(turn(t.normal[i]));
            }
        }
        Contact a(phantom_float_sse2, shape.triangles, {}), b(phantom_float_sse2, turned, {});
        unsigned touched = 0;
        for (int i = 0; i < 500; ++i) {
            const Vec3 p = point_near(shape.triangles, random, 0.01, 0.95 * shape.radius);
            const Touch before = a.tick(p), after = b.tick(on_grid(turn(p)));
            if (before.contacts != after.contacts)
                continue; // on a wall
            ++touched;
            ASSERT_LE(length(subtract(turn(before.force), after.force)), 2e-5) << shape.name;
        }
        EXPECT_GT(touched, 480U) << shape.name;
    }
}

} // namespace
