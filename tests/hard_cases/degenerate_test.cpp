// SPDX-License-Identifier: GPL-2.0-or-later
// Triangles that scans really have: slivers, points, doubles, opposites; and tips exactly on things.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "contact.hpp"
#include "shapes_of_interest.hpp"

namespace {

using namespace phantom;
using namespace phantom::hard;

const std::array<std::uint32_t, 2> models{PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED};

Settings with_model(std::uint32_t model)
{
    Settings s;
    s.model = model;
    s.proxy = PHANTOM_PROXY_PAPER;
    return s;
}

void expect_bounded(const Touch& touch, const Vec3& tip, double k, double radius)
{
    ASSERT_FALSE(touch.invalid);
    ASSERT_EQ(touch.saturated, 0U);
    const double depth = touch.inside ? length(subtract(touch.proxy, tip)) : 0;
    ASSERT_LE(length(touch.force), k * (radius + depth) * (1 + 1e-5) + 1e-5);
}

reference::Triangle triangle(const Vec3& a, const Vec3& b, const Vec3& c)
{
    reference::Triangle t;
    t.corner = {on_grid(a), on_grid(b), on_grid(c)};
    t.normal = {Vec3{0, 0, 1}, Vec3{0, 0, 1}, Vec3{0, 0, 1}};
    t.vertex = {900, 901, 902};
    return t;
}

TEST(Slivers, NeedlesAndCapsStayBounded)
{
    for (const double aspect : {1e3, 1e4, 1e5, 1e6, 1e7}) {
        const double height = 10 / aspect;
        for (const auto& t : {triangle({-5, 0, 0}, {5, 0, 0}, {5, height, 0}),    // needle
                              triangle({-5, 0, 0}, {5, 0, 0}, {0, height, 0})}) { // cap
            for (const std::uint32_t model : models) {
                for (const phantom_float_ops* ops : sections()) {
                    Contact contact(*ops, {t}, with_model(model));
                    EXPECT_EQ(contact.refused(), height < 16e-6 ? 1U : 0U) << aspect;
                    std::mt19937 random(1);
                    std::uniform_real_distribution<double> x(-6, 6), y(-0.01, 0.01), z(-0.5, 1.2);
                    for (int i = 0; i < 300; ++i) {
                        const Vec3 p{x(random), y(random), z(random)};
                        expect_bounded(contact.tick(p), p, 1, 1);
                    }
                }
            }
        }
    }
}

TEST(Slivers, StillCarryTheTipWhereTheyCanBeComputed)
{
    for (const double aspect : {1e2, 1e3, 1e4}) {
        const double height = 10 / aspect;
        for (const std::uint32_t model : models) {
            Contact contact(phantom_float_sse2, {triangle({-5, 0, 0}, {5, 0, 0}, {5, height, 0})},
                            with_model(model));
            EXPECT_NEAR(contact.tick({2, height / 4, 0.5}).force[2], 0.5, 2e-4) << aspect;
        }
    }
}

TEST(FacesThatCannotBeComputed, ContributeNothingAndAreCounted)
{
    const auto good = sphere(2, 10).triangles(1, 2);
    auto mixed = good;
    mixed.push_back(triangle({0, 0, 10}, {0, 0, 10}, {0, 0, 10}));    // one point
    mixed.push_back(triangle({0, 0, 10}, {1, 0, 10}, {1, 0, 10}));    // an edge
    mixed.push_back(triangle({-1, -1, 10}, {0, 0, 10}, {3, 3, 10}));  // collinear
    mixed.push_back(triangle({0, 0, 10}, {9, 0, 10}, {5, 1e-6, 10})); // 1 nm high
    for (const phantom_float_ops* ops : sections()) {
        for (const std::uint32_t model : models) {
            Contact a(*ops, good, with_model(model)), b(*ops, mixed, with_model(model));
            EXPECT_EQ(a.refused(), 0U);
            EXPECT_EQ(b.refused(), 4U);
            std::mt19937 random(2);
            for (int i = 0; i < 300; ++i) {
                const Vec3 p = point_near(good, random, -0.5, 2.1);
                a.restart();
                b.restart();
                EXPECT_EQ(a.tick(p).force, b.tick(p).force);
            }
        }
    }
}

TEST(TipExactlyOn, VertexEdgeAndFaceGetsTheFullForceAndNoMore)
{
    const Shape shape = sphere(2, 10);
    const auto triangles = shape.triangles(1, 2);
    for (const phantom_float_ops* ops : sections()) {
        for (const std::uint32_t model : models) {
            Contact contact(*ops, triangles, with_model(model));
            for (const auto& t : triangles) {
                const Vec3 edge = scale(0.5, add(t.corner[0], t.corner[1]));
                const Vec3 face =
                    scale(1.0 / 3, add(edge, add(scale(0.5, add(t.corner[0], t.corner[1])), t.corner[2])));
                for (const Vec3& p : {t.corner[0], on_grid(edge), on_grid(face)}) {
                    contact.restart(); // no path: the shell alone must know
                    ASSERT_NEAR(length(contact.tick(p).force), 2, 2e-5) << ops->name << " model " << model;
                }
            }
        }
    }
}

TEST(TipExactlyOn, TheShellsEndGetsNoForceAndNoStep)
{
    for (const std::uint32_t model : models) {
        Contact contact(phantom_float_sse2, sphere(2, 10).triangles(1, 2), with_model(model));
        for (int nm = -40; nm <= 40; ++nm)
            EXPECT_LE(length(contact.tick({0, 0, 12 + nm * 1e-6}).force), 5e-5);
    }
}

TEST(Doubles, OppositesAndFlippedFacesStayBounded)
{
    const auto good = sphere(2, 10).triangles(1, 2);
    auto twice = good, both = good, some_flipped = good;
    twice.insert(twice.end(), good.begin(), good.end());
    for (std::size_t f = 0; f < good.size(); ++f) {
        auto t = good[f];
        std::swap(t.corner[1], t.corner[2]);
        std::swap(t.normal[1], t.normal[2]);
        std::swap(t.vertex[1], t.vertex[2]);
        if (f % 5 == 0)
            some_flipped[f] = t;
        for (Vec3& n : t.normal)
            n = scale(-1, n);
        both.push_back(t);
    }
    for (const auto* mesh : {&twice, &both, &some_flipped}) {
        for (const std::uint32_t model : models) {
            Contact contact(phantom_float_sse2, *mesh, with_model(model));
            std::mt19937 random(4);
            for (int i = 0; i < 2000; ++i) {
                const Vec3 p = point_near(good, random, -1.5, 2.1);
                if (i % 3 == 0)
                    contact.restart();
                expect_bounded(contact.tick(p), p, 1, 2);
            }
        }
    }
}

TEST(Doubles, ADuplicatedFaceDoesNotDoubleTheForce)
{
    auto triangles = sphere(2, 10).triangles(1, 2);
    Contact once(phantom_float_sse2, triangles, with_model(PHANTOM_MODEL_PAPER));
    const auto copy = triangles;
    triangles.insert(triangles.end(), copy.begin(), copy.end());
    Contact twice(phantom_float_sse2, triangles, with_model(PHANTOM_MODEL_PAPER));
    EXPECT_NEAR(length(subtract(once.tick({1, 2, 10.1}).force, twice.tick({1, 2, 10.1}).force)), 0, 1e-5);
}

TEST(VertexNormals, ThatPointAnywhereStayBounded)
{
    std::mt19937 random(6);
    std::normal_distribution<double> any;
    auto triangles = soup(random, 64, 1.5);
    for (auto& t : triangles)
        for (Vec3& n : t.normal)
            n = on_unit_grid(unit({any(random), any(random), any(random)}));
    for (const phantom_float_ops* ops : sections()) {
        for (const std::uint32_t model : models) {
            Contact contact(*ops, triangles, with_model(model));
            for (int i = 0; i < 3000; ++i) {
                const Vec3 p = on_grid({2 * any(random), 2 * any(random), 2 * any(random)});
                expect_bounded(contact.tick(p), p, 1, 1.5);
            }
        }
    }
}

TEST(Scale, AMeshTenMicrometresAcrossFeelsLikeALargeOne)
{
    const auto large = sphere(2, 5).triangles(1, 1), small = sphere(2, 0.005).triangles(1, 0.001);
    for (const std::uint32_t model : models) {
        Contact a(phantom_float_sse2, large, with_model(model)),
            b(phantom_float_sse2, small, with_model(model));
        std::mt19937 random(8);
        for (int i = 0; i < 300; ++i) {
            const Vec3 p = point_near(large, random, 0.05, 0.9);
            a.restart();
            b.restart();
            const Vec3 f = a.tick(p).force, g = b.tick(on_grid(scale(1e-3, p))).force;
            // 1 nm of 10 um is 1e-4; R is 1 um
            ASSERT_NEAR(length(subtract(f, scale(1000, g))), 0, 1e-2);
        }
    }
}

} // namespace
