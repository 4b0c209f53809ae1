// SPDX-License-Identifier: GPL-2.0-or-later
// Edges and corners whose faces keep normals of their own: fans fill the gap between their shells.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "contact.hpp"
#include "creased.hpp"
#include "shapes_of_interest.hpp"

namespace {

using namespace phantom;
using namespace phantom::hard;

constexpr Vec3 half{5, 4, 3};

/// From the nearest point of the box to p: the gradient of its distance, times that.
Vec3 away_from_box(const Vec3& p)
{
    Vec3 away{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        away[axis] = std::copysign(std::max(std::abs(p[axis]) - half[axis], 0.0), p[axis]);
    return away;
}

Settings settings_of(std::uint32_t model, std::uint32_t combine = PHANTOM_COMBINE_BOUNDED)
{
    Settings settings;
    settings.model = model;
    settings.combine = combine;
    return settings;
}

/// What the direction may be off by, N for kR = radius: next to a wall of the shells as much as a soft
/// wall is wide, seen from the surface.
double tolerance_n(const Vec3& p, const Vec3& corner, double radius, double distance)
{
    constexpr double soft_wall_mm = 2e-4;
    bool beside = false;
    for (std::size_t axis = 0; axis < 3; ++axis)
        beside = beside || std::abs(std::abs(p[axis]) - corner[axis]) < soft_wall_mm;
    return 1e-4 + (beside ? radius * soft_wall_mm / distance : 0);
}

TEST(Fan, ABoxFeelsLikeItsExactDistance)
{
    const double radius = 2;
    const auto triangles = creased(box(half), 30, 1, radius);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-1.3, 1.3);
    for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED}) {
        for (const phantom_float_ops* ops : sections()) {
            Contact contact(*ops, triangles, settings_of(model));
            unsigned over_edges = 0;
            for (int i = 0; i < 4000; ++i) {
                const Vec3 p =
                    on_grid({place(random) * half[0], place(random) * half[1], place(random) * half[2]});
                const Vec3 away = away_from_box(p);
                const double distance = length(away);
                if (distance < 0.02 || distance > radius)
                    continue;
                over_edges += (away[0] != 0) + (away[1] != 0) + (away[2] != 0) > 1;
                const Vec3 expected = scale(radius - distance, unit(away));
                ASSERT_LE(length(subtract(contact.tick(p).force, expected)),
                          tolerance_n(p, half, radius, distance))
                    << fmt::format("{} model {} at {}", ops->name, model, fmt::join(p, " "));
            }
            EXPECT_GT(over_edges, 500U);
        }
    }
}

/// On a wall, on two at once, on the line of a corner's normal, and some nm beside: one full force.
TEST(Fan, ATipOnItsWallsIsHeldOnce)
{
    const double radius = 2;
    const auto triangles = creased(box(half), 30, 1, radius);
    for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED}) {
        for (const phantom_float_ops* ops : sections()) {
            Contact contact(*ops, triangles, settings_of(model));
            for (const double beside_mm : {0.0, 1e-6, -3e-6, 2e-5, -7e-5, 3e-4}) {
                for (const Vec3& over : {Vec3{1, 0, 0}, Vec3{0, 0.7, 0}, Vec3{0.5, 0.5, 0}, Vec3{0.3, 0, 0.9},
                                         Vec3{0.4, 0.4, 0.4}, Vec3{0, 0, 0.05}}) {
                    const Vec3 p = on_grid(add(add(half, over), {beside_mm, -beside_mm / 2, beside_mm / 3}));
                    const Vec3 away = away_from_box(p);
                    const Vec3 expected = scale(radius - length(away), unit(away));
                    // a soft wall of 0.1 um, seen from 50 um
                    ASSERT_LE(length(subtract(contact.tick(p).force, expected)), radius * 5e-3)
                        << fmt::format("{} model {} at {}", ops->name, model, fmt::join(p, " "));
                }
            }
        }
    }
}

/// A sheet without thickness, touched from both sides: all round it, the exact distance.
TEST(Fan, ATwoSidedSheetFeelsLikeItsExactDistance)
{
    const double radius = 2;
    Shape sheet;
    sheet.vertices = {{-5, -4, 0}, {5, -4, 0}, {5, 4, 0}, {-5, 4, 0}};
    sheet.faces = {{0, 1, 2}, {0, 2, 3}};
    const auto triangles = creased(sheet, 30, 1, radius, true);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(-1.3, 1.3), height(-1.9, 1.9);
    for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED}) {
        for (const phantom_float_ops* ops : sections()) {
            Contact contact(*ops, triangles, settings_of(model));
            unsigned round_the_rim = 0;
            for (int i = 0; i < 4000; ++i) {
                const Vec3 p = on_grid({place(random) * 5, place(random) * 4, height(random)});
                const Vec3 away{std::copysign(std::max(std::abs(p[0]) - 5, 0.0), p[0]),
                                std::copysign(std::max(std::abs(p[1]) - 4, 0.0), p[1]), p[2]};
                const double distance = length(away);
                if (distance < 0.02 || distance > radius)
                    continue;
                round_the_rim += away[0] != 0 || away[1] != 0;
                const Vec3 expected = scale(radius - distance, unit(away));
                ASSERT_LE(length(subtract(contact.tick(p).force, expected)),
                          tolerance_n(p, {5, 4, 0}, radius, distance))
                    << fmt::format("{} model {} at {}", ops->name, model, fmt::join(p, " "));
            }
            EXPECT_GT(round_the_rim, 300U);
        }
    }
}

/// A bumpy ball whose sharper edges are creases: convex and concave ones, ends, corners of any kind.
Named rough()
{
    Shape ball = star(2, [](const Vec3& d) { return 10 + 1.5 * std::sin(7 * d[0]) * std::cos(6 * d[1]); });
    return {"rough", creased(ball, 25, 1, 1.2), 1.2};
}

Named step()
{
    Shape shape;
    const std::vector<std::array<double, 2>> outline{{0, 0}, {9, 0}, {9, 4}, {3, 4}, {3, 9}, {0, 9}};
    for (const double z : {0.0, 6.0})
        for (const auto& [x, y] : outline)
            shape.vertices.push_back({x, y, z});
    for (std::uint32_t i = 0; i < 6; ++i) {
        const std::uint32_t j = (i + 1) % 6;
        shape.faces.push_back({i, j, 6 + j});
        shape.faces.push_back({i, 6 + j, 6 + i});
    }
    for (std::uint32_t i = 1; i < 5; ++i) {
        shape.faces.push_back({i + 1, i, 0});
        shape.faces.push_back({6, 6 + i, 7 + i});
    }
    return {"step", creased(shape, 30, 1, 1.5), 1.5};
}

std::vector<Named> creased_shapes()
{
    return {{"box", creased(box(half), 30, 1, 2), 2}, step(), rough()};
}

TEST(Fan, AgreesWithTheReference)
{
    for (const Named& shape : creased_shapes()) {
        for (const auto model : {reference::Model::paper, reference::Model::projected}) {
            reference::Options options;
            options.model = model;
            options.penetration = false;
            const reference::Reference reference(shape.triangles, options);
            std::vector<Contact> contacts;
            for (const phantom_float_ops* ops : sections())
                contacts.emplace_back(*ops, shape.triangles,
                                      settings_of(model == reference::Model::paper
                                                      ? PHANTOM_MODEL_PAPER
                                                      : PHANTOM_MODEL_PROJECTED));
            std::mt19937 random(13);
            unsigned judged = 0;
            for (int i = 0; i < 300; ++i) {
                const Vec3 p = point_near(shape.triangles, random, 0.05, shape.radius);
                const auto expected = reference.shell(p);
                if (expected.margin < 5e-4)
                    continue;
                ++judged;
                for (Contact& contact : contacts) {
                    const Touch got = contact.tick(p);
                    SCOPED_TRACE(fmt::format("{} {} model {} at {}", shape.name, contact.name(),
                                             static_cast<int>(model), fmt::join(p, " ")));
                    ASSERT_EQ(got.contacts, expected.contacts);
                    ASSERT_EQ(got.folded, expected.folded);
                    ASSERT_LE(length(subtract(got.force, expected.force)), 5e-5);
                }
            }
            EXPECT_GT(judged, 100U) << shape.name;
        }
    }
}

/// With its fans a creased mesh is as closed as a smooth one: roots of either sign differ by one, concave
/// edges too.
TEST(Fan, ValidLessFoldedIsOneRoundCreases)
{
    for (const Named& shape : creased_shapes()) {
        SCOPED_TRACE(shape.name);
        reference::Options options;
        options.all_roots = true;
        const reference::Reference reference(shape.triangles, options);
        std::mt19937 random(17);
        unsigned judged = 0, folds = 0;
        for (int i = 0; i < 150; ++i) {
            const Vec3 p = point_near(shape.triangles, random, 0.05, shape.radius);
            const auto at = reference.shell(p);
            if (at.margin < 1e-4)
                continue;
            ++judged;
            folds += at.folded > 0;
            EXPECT_EQ(at.degree, 1) << fmt::format("{}", fmt::join(p, " "));
        }
        EXPECT_GT(judged, 60U);
        EXPECT_TRUE(shape.name == "box" || folds > 5U);
    }
}

TEST(Fan, TheSameBitsFromEveryWidth)
{
    const std::vector<const phantom_float_ops*> widths = wide_sections();
    if (widths.empty())
        GTEST_SKIP() << "this CPU has no AVX2";
    std::size_t turn = 0;
    for (const Named& shape : creased_shapes()) {
        for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED}) {
            Contact narrow(phantom_float_sse2, shape.triangles, settings_of(model));
            Contact wide(*widths[turn++ % widths.size()], shape.triangles, settings_of(model));
            std::mt19937 random(19);
            unsigned touched = 0;
            for (int i = 0; i < 3000; ++i) {
                const Vec3 p = point_near(shape.triangles, random, 0, shape.radius);
                const Touch a = narrow.tick(p), b = wide.tick(p);
                ASSERT_EQ(a.force, b.force);
                ASSERT_EQ(a.normal, b.normal);
                ASSERT_EQ(a.contacts, b.contacts);
                touched += a.contacts > 0;
            }
            EXPECT_GT(touched, 1000U);
        }
    }
}

/// Normals that hardly differ, edges of some nm, fans as wide as they get: bounded, and never no number.
TEST(Fan, IsBoundedWhereItHardlyExists)
{
    std::mt19937 random(23);
    std::uniform_real_distribution<double> side(-1, 1), exponent(-9, 0.2);
    for (int i = 0; i < 3000; ++i) {
        reference::Triangle t;
        t.fan = true;
        const Vec3 a = on_grid({side(random), side(random), side(random)});
        const Vec3 b =
            on_grid(add(a, scale(std::pow(10, exponent(random)), {side(random), 1, side(random)})));
        const bool corner = i % 2 == 0 || a == b;
        t.corner = {a, corner ? a : b, a};
        const Vec3 n = unit({side(random), side(random), side(random)});
        const double spread = std::pow(10, exponent(random));
        for (Vec3& m : t.normal)
            m = on_unit_grid(unit(add(n, scale(spread, {side(random), side(random), side(random)}))));
        t.radius = 1.5;
        for (const phantom_float_ops* ops : sections()) {
            for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED}) {
                Contact contact(*ops, {t}, settings_of(model));
                for (const double height : {0.0, 1e-6, 1e-3, 0.5, 1.5}) {
                    const Touch touch = contact.tick(on_grid(add(a, scale(height, n))));
                    ASSERT_FALSE(touch.invalid);
                    ASSERT_LE(length(touch.force), 1.5 * (1 + 1e-5));
                }
            }
        }
    }
}

} // namespace
