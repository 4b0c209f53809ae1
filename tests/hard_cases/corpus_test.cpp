// SPDX-License-Identifier: GPL-2.0-or-later
// The shell's force in every hard case: against the __float128 reference, and turned, scaled and in another
// order. (suite_test.cpp walks the paths.)
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "distance.hpp"
#include "suite.hpp"

namespace {

using namespace phantom;
using namespace phantom::hard;
using reference::Reference;

Settings shell_of(const Variant& variant)
{
    Settings settings;
    settings.model = variant.model;
    settings.combine = variant.combine;
    settings.newton_steps = variant.newton_steps;
    return settings;
}

/// Every variant that is as exact as its arithmetic. (reference_test.cpp has combine=paper.)
std::vector<Variant> exact_variants()
{
    std::vector<Variant> out;
    std::copy_if(variants.begin(), variants.end(), std::back_inserter(out), [](const Variant& v) {
        if (v.combine == PHANTOM_COMBINE_PAPER)
            return false; // where contacts oppose each other rounding turns the force over: combine.h
        return v.model == PHANTOM_MODEL_PAPER || v.newton_steps >= exact_steps;
    });
    return out;
}

Reference reference_of(const Case& hard, const Variant& variant, bool all_roots = false)
{
    reference::Options options;
    options.penetration = false;
    options.all_roots = all_roots;
    options.model =
        variant.model == PHANTOM_MODEL_PAPER ? reference::Model::paper : reference::Model::projected;
    options.combine =
        variant.combine == PHANTOM_COMBINE_PAPER ? reference::Combine::paper : reference::Combine::bounded;
    return {hard.sets[0], options};
}

struct Point {
    Vec3 tip;
    reference::Result expected;
};

/// Samples of the case's paths where there is a shell contact, drawn at random, with what the reference says
/// of them. A tip very near to a wall, a face or the shell's end may be decided either way, and is left out.
std::vector<Point> touched(const Case& hard, const Reference& reference, unsigned count)
{
    const Course course(hard, 1);
    std::vector<Vec3> all;
    for (const auto& path : course.samples())
        all.insert(all.end(), path.begin(), path.end());
    const double margin = std::min(5e-4, 0.05 * hard.radius);
    std::mt19937 random(41);
    Contact contact(phantom_float_double, hard.sets[0], shell_of(variants[0]));
    std::vector<Point> out;
    for (unsigned tries = 0; tries < 6 * count && out.size() < count; ++tries) {
        const Vec3& p = all[random() % all.size()];
        if (contact.tick(p).contacts == 0)
            continue;
        const auto expected = reference.shell(p);
        if (expected.margin >= margin)
            out.push_back({p, expected});
    }
    return out;
}

/// Float32 knows a distance to some 1e-6 of the largest one involved (mm); near a fold a root moves by many
/// times what moved it.
double tolerance_n(const Case& hard, const phantom_float_ops& ops)
{
    double extent = 0;
    for (const auto& t : hard.sets[0])
        extent = std::max(
            {extent, length(subtract(t.corner[1], t.corner[0])), length(subtract(t.corner[2], t.corner[0]))});
    const double amplified = hard.projected_step > smooth_step ? 100 : 10;
    return hard.stiffness * amplified * 1e-6 * (1 + extent + hard.radius) * rounding_of(ops, hard) / 2e-5 +
           2e-6;
}

TEST(Corpus, AgreesWithTheReference)
{
    unsigned compared = 0;
    for (const Case& hard : corpus()) {
        if (hard.saturates)
            continue;
        for (const Variant& variant : exact_variants()) {
            const Reference reference = reference_of(hard, variant);
            for (const auto& [p, expected] : touched(hard, reference, 6)) {
                for (const phantom_float_ops* ops : sections()) {
                    if (!hard.fault.empty())
                        continue;
                    const Touch got = Contact(*ops, hard.sets[0], shell_of(variant)).tick(p);
                    SCOPED_TRACE(fmt::format("{}, {}, {} at {}", hard.name, variant.name, ops->name,
                                             fmt::join(p, " ")));
                    EXPECT_EQ(got.contacts, expected.contacts);
                    EXPECT_EQ(got.folded, expected.folded);
                    EXPECT_LE(length(subtract(got.force, expected.force)), tolerance_n(hard, *ops));
                    ++compared;
                }
            }
        }
    }
    EXPECT_GT(compared, 2000U);
}

TEST(Corpus, ValidLessFoldedCountsTheClosedSurfaces)
{
    unsigned judged = 0;
    for (const Case& hard : corpus()) {
        if (!hard.closed || hard.kind == Kind::speed)
            continue;
        for (const auto& [p, at] : touched(hard, reference_of(hard, variants[0], true), 8)) {
            if (!nearest(hard.sets[0], p).in_front)
                continue;
            EXPECT_EQ(at.degree, hard.surfaces) << fmt::format("{} at {}", hard.name, fmt::join(p, " "));
            ++judged;
        }
    }
    EXPECT_GT(judged, 40U);
}

/// What must not matter: how the mesh lies, how large it is, in which order its triangles come.
struct Change {
    const char* name;
    bool turned;
    double factor;
    bool shuffled;
    [[nodiscard]] Vec3 apply(const Vec3& v) const
    {
        if (!turned)
            return v;
        const double c = std::cos(0.7), s = std::sin(0.7);
        return {c * v[1] + s * v[0], v[2], c * v[0] - s * v[1]}; // about z, then the axes exchanged
    }
};

Triangles changed(Triangles triangles, const Change& change, std::mt19937& random)
{
    for (auto& t : triangles) {
        t.radius *= change.factor;
        for (std::size_t i = 0; i < 3; ++i) {
            t.corner[i] = on_grid(scale(change.factor, change.apply(t.corner[i])));
            t.normal[i] = on_unit_grid(change.apply(t.normal[i]));
        }
    }
    if (change.shuffled) {
        const auto rims =
            std::find_if(triangles.begin(), triangles.end(), [](const auto& t) { return t.rim; });
        const auto fans = std::find_if(triangles.begin(), rims, [](const auto& t) { return t.fan; });
        std::shuffle(triangles.begin(), fans, random);
        std::shuffle(fans, rims, random);
        std::shuffle(rims, triangles.end(), random);
    }
    return triangles;
}

TEST(Corpus, TurnedScaledAndShuffledGivesTheSameForce)
{
    const std::array<Change, 4> changes{{{"turned", true, 1, false},
                                         {"at a quarter", false, 0.25, false},
                                         {"at twice the size", false, 2, false},
                                         {"shuffled", false, 1, true}}};
    std::mt19937 random(43);
    unsigned compared = 0, on_walls = 0;
    for (const Case& hard : corpus()) {
        if (!hard.rigid || hard.saturates || hard.kind == Kind::limits)
            continue;
        for (const Variant& variant : exact_variants()) {
            const auto points = touched(hard, reference_of(hard, variant), 4);
            for (const Change& change : changes) {
                const Triangles other = changed(hard.sets[0], change, random);
                for (const phantom_float_ops* ops : sections()) {
                    if (!hard.fault.empty())
                        continue;
                    Contact a(*ops, hard.sets[0], shell_of(variant)), b(*ops, other, shell_of(variant));
                    for (const Point& point : points) {
                        const Vec3& p = point.tip;
                        const Touch before = a.tick(p);
                        const Touch after = b.tick(on_grid(scale(change.factor, change.apply(p))));
                        if (before.contacts != after.contacts) {
                            ++on_walls;
                            continue;
                        }
                        ++compared;
                        const Vec3 expected = scale(change.factor, change.apply(before.force));
                        EXPECT_LE(length(subtract(expected, after.force)),
                                  2 * std::max(1.0, change.factor) * tolerance_n(hard, *ops))
                            << fmt::format("{}, {}, {}, {} at {}", hard.name, change.name, variant.name,
                                           ops->name, fmt::join(p, " "));
                    }
                }
            }
        }
    }
    EXPECT_LT(on_walls, compared / 10);
}

} // namespace
