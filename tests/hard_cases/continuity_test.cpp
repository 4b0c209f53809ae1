// SPDX-License-Identifier: GPL-2.0-or-later
// `projected` is continuous: walls, vertex lines, folds, ridges and grooves. A jump is a step of the
// force that stays when the path is sampled finer; near a fold the force is steep (it grows with the
// square root of the way), so a bound on the slope alone would not tell.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <numbers>

#include "contact.hpp"
#include "shapes_of_interest.hpp"

namespace {

using namespace phantom;
using namespace phantom::hard;

/// Steps of that part of kR at 1 um are looked at; what is left of them at some nm is the jump.
constexpr double suspicious = 2e-3;
/// sqrt(3 nm / 1 mm) = 0.2%: what a fold may do on 3 nm, and the slope of a soft wall.
constexpr double smooth = 1e-2;
/// float32, where an edge has folded over: the two roots that cancel there differ by rounding, for some nm.
constexpr double folded_edge = 0.1;

/// The shell at one place, without a path that led there.
Vec3 shell_force(Contact& contact, const Vec3& tip)
{
    contact.restart();
    return contact.tick(tip).force;
}

/// The step of the force that is left on the finest grid, by bisection of a-b.
double step_on_the_grid(Contact& contact, Vec3 a, Vec3 b)
{
    Vec3 fa = shell_force(contact, a), fb = shell_force(contact, b);
    while (length(subtract(a, b)) > 3e-6) {
        const Vec3 middle = on_grid(scale(0.5, add(a, b)));
        const Vec3 fm = shell_force(contact, middle);
        if (length(subtract(fa, fm)) > length(subtract(fm, fb))) {
            b = middle;
            fb = fm;
        } else {
            a = middle;
            fa = fm;
        }
    }
    return length(subtract(fa, fb));
}

/// Goes along from-to in steps of 1 um until the path enters the surface. Returns the steps made.
unsigned expect_continuous(const std::vector<reference::Triangle>& triangles, const Vec3& from,
                           const Vec3& to, Settings settings = with_proxy(), double jump = smooth,
                           const phantom_float_ops& ops = phantom_float_sse2)
{
    Contact path(ops, triangles, settings), shell(ops, triangles, settings);
    const double k_r = triangles[0].stiffness * triangles[0].radius;
    const auto count = static_cast<unsigned>(length(subtract(to, from)) / 1e-3);
    Vec3 before = on_grid(from), force = path.tick(before).force;
    for (unsigned i = 1; i <= count; ++i) {
        const Vec3 p = on_grid(add(from, scale(static_cast<double>(i) / count, subtract(to, from))));
        const Touch now = path.tick(p);
        if (now.inside)
            return i;
        if (length(subtract(now.force, force)) > suspicious * k_r) {
            const double left = step_on_the_grid(shell, before, p);
            EXPECT_LE(left, jump * k_r)
                << fmt::format("jump between {} and {}", fmt::join(before, " "), fmt::join(p, " "));
            if (left > jump * k_r)
                return i;
        }
        before = p;
        force = now.force;
    }
    return count;
}

TEST(Projected, IsContinuousAlongStraightPathsPastSmoothAndFoldedShells)
{
    for (const Named& shape : shapes_of_interest()) {
        if (shape.name == "soup" || shape.name == "saddle")
            continue; // open: the shell ends at its rim
        SCOPED_TRACE(shape.name);
        std::mt19937 random(23);
        unsigned steps = 0;
        for (int path = 0; path < 8; ++path) {
            const Vec3 a = point_near(shape.triangles, random, 0.3, 0.6 * shape.radius);
            const Vec3 aside = scale(1.5, unit(cross(a, {0.3, -0.5, 0.8})));
            steps += expect_continuous(shape.triangles, a, add(a, aside));
        }
        EXPECT_GT(steps, 5000U);
    }
}

/// A ridge or groove along y: z = slope |x|.
TEST(Projected, IsContinuousOverRidgesAndInGroovesOfAnyAngle)
{
    for (const double degrees : {5.0, 20.0, 45.0, 90.0, 135.0, 175.0}) {
        const double slope = 1 / std::tan(degrees / 2 * std::numbers::pi / 180);
        for (const double sign : {-1.0, 1.0}) {
            SCOPED_TRACE(fmt::format("{} of {} degrees", sign < 0 ? "ridge" : "groove", degrees));
            const auto triangles =
                field(12, 6, [&](double x, double) { return sign * slope * std::abs(x); }).triangles(1, 1.5);
            const double x = sign < 0 ? -1 : 0; // over the whole ridge; from the groove's middle to its wall
            for (const double z : {0.2, 0.9})
                expect_continuous(triangles, {x, 0.31, z}, {1, -0.22, z});
            expect_continuous(triangles, {0, 0.1, 0.01}, {0.001, 0.12, 2});
        }
    }
}

TEST(Projected, IsContinuousOverTheApexOfACone)
{
    for (const double height : {0.5, 3.0, 20.0}) {
        SCOPED_TRACE(height);
        const auto cone = fan(7, 4, height).triangles(1, 1.5);
        expect_continuous(cone, {-0.5, 0, height + 0.4}, {0.5, 0.1, height + 0.4});
        expect_continuous(cone, {0, 0, height}, {0, 0, height + 1.6});
    }
}

/// Tip on the line of a vertex normal, on the wall over an edge, and some nm beside them.
TEST(Projected, CountsATipOnAWallOnce)
{
    const double radius = 20, reach = 3;
    for (const unsigned subdivisions : {0U, 1U, 3U}) {
        const Shape shape = sphere(subdivisions, radius);
        const auto triangles = shape.triangles(1, reach);
        for (const phantom_float_ops* ops : sections()) {
            Contact contact(*ops, triangles, {});
            for (std::size_t f = 0; f < triangles.size(); f += 3) {
                const auto& t = triangles[f];
                for (const Vec3& foot : {t.normal[0], scale(0.5, add(t.normal[0], t.normal[1])),
                                         add(scale(0.25, t.normal[1]), scale(0.75, t.normal[2]))}) {
                    for (const double beside_mm : {0.0, 1e-6, -3e-6, 2e-5, -7e-5, 1e-4}) {
                        // x + h m of a point with x = radius n, m = n: (radius + h) foot
                        const double h = 1;
                        const Vec3 p =
                            on_grid(add(scale(radius + h, foot), {beside_mm, -beside_mm / 2, beside_mm / 3}));
                        const Vec3 expected = scale(reach - h * length(foot), unit(foot));
                        const double error = length(subtract(contact.tick(p).force, expected));
                        // rounding over a patch of 28 mm, in a soft wall of some 100 nm
                        ASSERT_LE(error, reach * 5e-3) << ops->name << " beside " << beside_mm;
                    }
                }
            }
        }
    }
}

/// On a closed mesh the roots of either sign differ by one everywhere outside.
TEST(Projected, ValidLessFoldedIsOneRoundAConcaveMesh)
{
    const auto dented = [](const Vec3& d) { return 10 - 4 * std::exp(-15 * (1 - d[2])); };
    const double reach = 12; // beyond the dent's radius of curvature
    const auto triangles = star(3, dented).triangles(1, reach);
    reference::Options options;
    options.all_roots = true;
    const reference::Reference reference(triangles, options);
    Contact contact(phantom_float_sse2, triangles, {});
    std::mt19937 random(31);
    std::uniform_real_distribution<double> side(-3, 3), height(6.5, 15);
    unsigned folds = 0, all_in_range = 0;
    for (int i = 0; i < 80; ++i) {
        const Vec3 p = on_grid({side(random), side(random), height(random)});
        const auto expected = reference.shell(p);
        if (expected.margin < 2e-4 || dented(unit(p)) + 0.2 > length(p))
            continue;
        EXPECT_EQ(expected.degree, 1);
        const Touch touch = contact.tick(p);
        EXPECT_EQ(touch.contacts, expected.contacts);
        EXPECT_EQ(touch.folded, expected.folded);
        folds += touch.folded > 0;
        if (static_cast<int>(expected.contacts - 2 * expected.folded) != expected.degree)
            continue; // a partner is beyond R
        ++all_in_range;
        EXPECT_EQ(touch.contacts - 2 * touch.folded, 1U);
    }
    EXPECT_GT(folds, 3U);
    EXPECT_GT(all_in_range, 10U);
}

TEST(Bounded, IsContinuousThroughASlotNarrowerThanTwoR)
{
    // two plates that face each other, 1 mm apart, R = 2 mm
    auto triangles = field(2, 5, [](double, double) { return 0.0; }).triangles(1, 2);
    auto lid = triangles;
    for (auto& t : lid) {
        std::swap(t.corner[1], t.corner[2]);
        std::swap(t.vertex[1], t.vertex[2]);
        for (std::size_t i = 0; i < 3; ++i) {
            t.corner[i][2] = 1;
            t.normal[i] = {0, 0, -1};
            t.vertex[i] += 100;
        }
    }
    triangles.insert(triangles.end(), lid.begin(), lid.end());
    for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED}) {
        Contact contact(phantom_float_sse2, triangles, with_proxy(model));
        expect_continuous(triangles, {1.1, 0.7, 0.01}, {1.1, 0.7, 0.99}, with_proxy(model));
        EXPECT_NEAR(length(contact.tick({1.1, 0.7, 0.5}).force), 0, 2e-6);
        // k (R - z) - k (R - (1 - z))
        EXPECT_NEAR(contact.tick({1.1, 0.7, 0.3}).force[2], 0.4, 3e-6);
    }
}

TEST(Bounded, IsContinuousInABoxSmallerThanR)
{
    Shape inward = box({0.6, 0.5, 0.4}); // seen from inside
    for (auto& face : inward.faces)
        std::swap(face[1], face[2]);
    smooth_normals(inward);
    const auto triangles = inward.triangles(1, 2);
    const std::array<std::pair<Vec3, Vec3>, 2> paths{
        {{{-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}}, {{-0.5, 0.1, 0.05}, {0.5, -0.02, 0.03}}}};
    for (const auto& [from, to] : paths) {
        EXPECT_GT(expect_continuous(triangles, from, to, with_proxy(), smooth, phantom_float_double), 900U);
        EXPECT_GT(expect_continuous(triangles, from, to, with_proxy(), folded_edge), 900U);
    }
}

} // namespace
