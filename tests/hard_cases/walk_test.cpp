// SPDX-License-Identifier: GPL-2.0-or-later
// proxy=constrained: V is the point of the surface nearest to the tip, on the sheet that the tip went in
// through, held by whatever else stands there.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "contact.hpp"
#include "shapes_of_interest.hpp"

namespace {

using namespace phantom;
using namespace phantom::hard;

/// V is put on whole nm, and its face's plane is known to a few.
constexpr double on_the_spot_mm = 1e-5;

Settings constrained(std::uint32_t model = PHANTOM_MODEL_PROJECTED)
{
    Settings s;
    s.model = model;
    s.proxy = PHANTOM_PROXY_CONSTRAINED;
    return s;
}

/// Every corner with its face's own normal: each edge is a crease.
std::vector<reference::Triangle> flat(std::vector<reference::Triangle> triangles)
{
    for (auto& t : triangles)
        t.normal.fill(on_unit_grid(
            unit(cross(subtract(t.corner[1], t.corner[0]), subtract(t.corner[2], t.corner[0])))));
    return triangles;
}

std::vector<reference::Triangle> moved(std::vector<reference::Triangle> triangles, const Vec3& by)
{
    for (auto& t : triangles)
        for (Vec3& x : t.corner)
            x = on_grid(add(x, by));
    return triangles;
}

/// As another object: with vertices of its own.
void join(std::vector<reference::Triangle>& all, std::vector<reference::Triangle> more)
{
    for (auto& t : more) {
        for (std::uint32_t& v : t.vertex)
            v += 1000 + static_cast<std::uint32_t>(3 * all.size());
    }
    all.insert(all.end(), more.begin(), more.end());
}

double distance_to(const reference::Triangle& t, const Vec3& p)
{
    const auto& x = t.corner;
    const Vec3 area = cross(subtract(x[1], x[0]), subtract(x[2], x[0]));
    double least = 1e300;
    bool over = true;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 e = subtract(x[(i + 1) % 3], x[i]), q = subtract(p, x[i]);
        over = over && dot(cross(area, e), q) >= 0;
        least = std::min(least, length(subtract(q, scale(std::clamp(dot(e, q) / dot(e, e), 0.0, 1.0), e))));
    }
    return over ? std::abs(dot(unit(area), subtract(p, x[0]))) : least;
}

double distance_to(const std::vector<reference::Triangle>& all, const Vec3& p)
{
    double least = 1e300;
    for (const auto& t : all)
        least = std::min(least, distance_to(t, p));
    return least;
}

/// From a to b in steps of `step_mm`, both ends included.
Touch go(Contact& contact, const Vec3& a, const Vec3& b, double step_mm)
{
    const auto steps = std::max(1, static_cast<int>(length(subtract(b, a)) / step_mm));
    Touch touch;
    for (int i = 0; i <= steps; ++i)
        touch = contact.tick(on_grid(add(a, scale(static_cast<double>(i) / steps, subtract(b, a)))));
    return touch;
}

void expect_at(const Touch& touch, const Vec3& v, double tolerance = on_the_spot_mm)
{
    ASSERT_TRUE(touch.inside);
    EXPECT_LE(length(subtract(touch.proxy, v)), tolerance)
        << touch.proxy[0] << " " << touch.proxy[1] << " " << touch.proxy[2];
}

/// Going down only, one finds the nearest of all: at a speed of 0.2 mm a tick, on a tenth of the way.
TEST(Walk, EndsAtTheNearestPointOfABumpySurface)
{
    const auto triangles = star(4, bumpy).triangles(1, 1);
    for (const phantom_float_ops* ops : sections()) {
        Contact contact(*ops, triangles, constrained());
        std::mt19937 random(11);
        std::normal_distribution<double> any;
        unsigned compared = 0, behind = 0;
        for (int path = 0; path < 4; ++path) {
            const Vec3 from = unit({any(random), any(random), any(random)});
            const Vec3 to = unit(add(from, {any(random), any(random), any(random)}));
            contact.restart();
            go(contact, scale(12, from), scale(8.5, from), 0.05);
            for (int i = 0; i <= 60; ++i) {
                const Vec3 p = on_grid(scale(8.5, unit(add(scale(60 - i, from), scale(i, to)))));
                const Touch touch = contact.tick(p);
                ASSERT_TRUE(touch.inside) << ops->name;
                ASSERT_LE(distance_to(triangles, touch.proxy), on_the_spot_mm);
                const double off = length(subtract(touch.proxy, p)) - distance_to(triangles, p);
                ASSERT_GE(off, -on_the_spot_mm);
                ++compared;
                behind += off > on_the_spot_mm;
            }
        }
        EXPECT_LE(behind, compared / 50) << ops->name; // faces 20 degrees apart and more hold it a while
    }
}

TEST(Walk, LeavesVWhereItIsUnderATipThatRests)
{
    auto room = box({5, 4, 3}).triangles(1, 1);
    for (auto& t : room) {
        std::swap(t.corner[1], t.corner[2]);
        std::swap(t.vertex[1], t.vertex[2]);
    }
    auto crossed = flat(box({10, 10, 2}).triangles(1, 1));
    join(crossed, moved(flat(box({1, 1, 6}).triangles(1, 1)), {0, 0, 3}));
    const std::array<std::pair<std::vector<reference::Triangle>, std::pair<Vec3, Vec3>>, 4> cases{
        {{star(3, bumpy).triangles(1, 1), {{3, 5, 12}, {2, 3, 7}}},
         {flat(room), {{4.5, 3.5, 2.5}, {5.7, 4.6, 3.3}}},
         {field(12, 6, [](double x, double) { return 20 * std::abs(x); }).triangles(1, 1),
          {{0.01, 0.3, 3}, {0.012, 0.2, -1.5}}},
         {crossed, {{5, 0.3, 2.5}, {0.4, 0.35, 1.1}}}}};
    for (const phantom_float_ops* ops : sections()) {
        for (const auto& [triangles, way] : cases) {
            Contact contact(*ops, triangles, constrained());
            Touch first = go(contact, way.first, way.second, 0.02);
            for (int i = 0; i < 40; ++i) // a walk that was not done goes on
                first = contact.tick(on_grid(way.second));
            ASSERT_TRUE(first.inside);
            for (int i = 0; i < 500; ++i) {
                const Touch touch = contact.tick(on_grid(way.second));
                ASSERT_EQ(touch.proxy, first.proxy) << ops->name << " tick " << i;
                ASSERT_EQ(touch.force, first.force) << ops->name << " tick " << i;
            }
        }
    }
}

TEST(Plate, OfAFifthOfAMillimetreHoldsTheTipFarBelowItsBackAtAnySpeed)
{
    for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED}) {
        for (const double speed_m_s : {0.001, 0.1, 1.0, 3.0, 10.0}) {
            for (const bool creases : {false, true}) {
                auto triangles = box({5, 5, 0.1}).triangles(1, 1);
                if (creases)
                    triangles = flat(triangles);
                Contact contact(phantom_float_sse2, triangles, constrained(model));
                const double step_mm = std::min(speed_m_s, 4.0); // at 1 kHz
                contact.tick({1, 1.5, 1.9});
                const Touch below = go(contact, {1, 1.5, 1.5}, {1, 1.5, -3}, step_mm);
                expect_at(below, {1, 1.5, 0.1});
                EXPECT_GE(below.force[2], 3.1);
                EXPECT_LE(length(below.force), 1 + 3.1 + 1e-3);
                expect_at(go(contact, {1, 1.5, -3}, {-2, 3.3, -2.5}, step_mm), {-2, 3.3, 0.1});
                EXPECT_FALSE(go(contact, {-2, 3.3, -2.5}, {-2, 3.3, 0.5}, step_mm).inside);
            }
        }
    }
}

TEST(Plate, LetsGoOverItsRim)
{
    Contact contact(phantom_float_sse2, flat(box({5, 5, 0.1}).triangles(1, 1)), constrained());
    ASSERT_TRUE(go(contact, {4, 1, 1}, {4, 1, -1}, 0.05).inside);
    const Touch beyond = go(contact, {4, 1, -1}, {5.4, 1, -1}, 0.05);
    EXPECT_FALSE(beyond.inside);
    EXPECT_FALSE(go(contact, {5.4, 1, -1}, {5.4, 1, 1}, 0.05).inside);
}

TEST(Box, SmallerThanRHoldsTheTipOnTheSideItCameIn)
{
    const auto triangles = box({0.6, 0.5, 0.4}).triangles(1, 2);
    Contact contact(phantom_float_sse2, triangles, constrained());
    std::mt19937 random(3);
    std::uniform_real_distribution<double> part(-0.9, 0.9);
    expect_at(go(contact, {0.1, 0.1, 2.5}, {0.1, 0.1, -0.3}, 0.05), {0.1, 0.1, 0.4});
    Vec3 at{0.1, 0.1, -0.3};
    for (int i = 0; i < 300; ++i) {
        const Vec3 next{0.6 * part(random), 0.5 * part(random), 0.4 * part(random)};
        const Touch touch = go(contact, at, next, 0.05);
        expect_at(touch, {next[0], next[1], 0.4});
        EXPECT_LE(length(touch.force), 2 + (0.4 - next[2]) + 1e-5);
        at = next;
    }
}

/// The bottom of a groove holds V over a whole wedge of tips; there the normal turns with the tip.
TEST(Groove, OfAnyAngleTurnsTheForceFromWallToWallWithoutAStep)
{
    for (const double degrees : {5.0, 30.0, 90.0, 150.0}) {
        const double slope = 1 / std::tan(degrees / 2 * std::numbers::pi / 180);
        for (const bool creases : {false, true}) {
            auto triangles =
                field(12, 6, [&](double x, double) { return slope * std::abs(x); }).triangles(1, 1);
            if (creases)
                triangles = flat(triangles);
            for (const phantom_float_ops* ops : sections()) {
                SCOPED_TRACE(std::to_string(degrees) + (creases ? " creases " : " ") + ops->name);
                Contact contact(*ops, triangles, constrained());
                const double depth = 1, reach = 1.5 * slope * depth; // beyond both ends of the wedge
                ASSERT_TRUE(go(contact, {0.001, 0.3, 1}, {0.0, 0.3, -depth}, 0.01).inside);
                go(contact, {0, 0.3, -depth}, {-reach, 0.3, -depth}, 0.01);
                const int steps = 4000;
                const double step_mm = 2 * reach / steps;
                Vec3 before{};
                for (int i = 0; i <= steps; ++i) {
                    const Touch touch = contact.tick(on_grid({-reach + i * step_mm, 0.3, -depth}));
                    ASSERT_TRUE(touch.inside);
                    // V goes no faster than the tip; the normal turns with 1 / depth, R = 1. Between two
                    // vertices 1 mm apart smooth normals turn by twice the slope's angle at most.
                    if (i > 0) {
                        ASSERT_LE(length(subtract(touch.force, before)),
                                  (creases ? 2.5 : 6.0) * step_mm + 1e-5)
                            << "step " << i;
                    }
                    before = touch.force;
                }
            }
        }
    }
}

/// Seen from the material, a room's edges and corners are where V is caught.
TEST(Corner, OfARoomCatchesVInItsEdgesAndInItself)
{
    auto room = flat(box({5, 4, 3}).triangles(1, 1));
    for (auto& t : room) {
        std::swap(t.corner[1], t.corner[2]);
        std::swap(t.vertex[1], t.vertex[2]);
    }
    room = flat(room);
    for (const phantom_float_ops* ops : sections()) {
        Contact contact(*ops, room, constrained());
        expect_at(go(contact, {4, 2, 1}, {5.5, 2, 1}, 0.03), {5, 2, 1});
        expect_at(go(contact, {5.5, 2, 1}, {5.5, 4.5, 1.2}, 0.03), {5, 4, 1.2});
        expect_at(go(contact, {5.5, 4.5, 1.2}, {5.4, 4.3, -2}, 0.03), {5, 4, -2});
        expect_at(go(contact, {5.4, 4.3, -2}, {5.4, 4.3, -3.3}, 0.03), {5, 4, -3});
        expect_at(go(contact, {5.4, 4.3, -3.3}, {4, 4.3, -3.2}, 0.03), {4, 4, -3});
        EXPECT_FALSE(go(contact, {4, 4.3, -3.2}, {4, 3, -2}, 0.03).inside);
    }
}

TEST(Cube, HoldsOnTheFaceThatWasEnteredUntilTheTipIsOutAgain)
{
    Contact contact(phantom_float_sse2, flat(box({5, 5, 5}).triangles(1, 1)), constrained());
    expect_at(go(contact, {1, 1, 6}, {1, 1, 2}, 0.05), {1, 1, 5});
    expect_at(go(contact, {1, 1, 2}, {4.9, 1, 2}, 0.05), {4.9, 1, 5}); // 0.1 mm from the side, 3 from the top
    expect_at(go(contact, {4.9, 1, 2}, {4.9, 4.9, 2}, 0.05), {4.9, 4.9, 5});
    EXPECT_FALSE(go(contact, {4.9, 4.9, 2}, {5.2, 4.9, 2}, 0.05).inside);
}

/// A plate with a post through it, two objects: V on the plate stops at the post.
TEST(TwoObjects, HoldVAtTheirIntersectionAndLetItSlideAlong)
{
    auto both = flat(box({10, 10, 2}).triangles(1, 1));
    join(both, moved(flat(box({1, 1, 6}).triangles(1, 1)), {0, 0, 3}));
    for (const phantom_float_ops* ops : sections()) {
        SCOPED_TRACE(ops->name);
        Contact contact(*ops, both, constrained());
        const double near = 1e-4; // V stays some nm off a face that holds it
        expect_at(go(contact, {5, 0.3, 3}, {5, 0.3, 1}, 0.05), {5, 0.3, 2});
        const Touch held = go(contact, {5, 0.3, 1}, {0.2, 0.3, 1}, 0.05);
        expect_at(held, {1, 0.3, 2}, near);
        EXPECT_GT(held.force[0], 0.5); // by the post
        EXPECT_GT(held.force[2], 0.5); // and by the plate
        expect_at(go(contact, {0.2, 0.3, 1}, {0.2, -0.7, 1.2}, 0.05), {1, -0.7, 2}, near);
        // past the post's edge V is free
        expect_at(go(contact, {0.2, -0.7, 1.2}, {0.2, -3, 1}, 0.05), {0.2, -3, 2}, near);
        // and from there it comes to the post's other side
        expect_at(go(contact, {0.2, -3, 1}, {0.2, 0, 1}, 0.05), {0.2, -1, 2}, near);
        // up inside the post: the tip is over the plate, and still under the post's wall
        expect_at(go(contact, {0.2, 0, 1}, {0.2, -0.4, 4}, 0.05), {0.2, -1, 4}, near);
        EXPECT_FALSE(go(contact, {0.2, -0.4, 4}, {0.2, -1.3, 4}, 0.05).inside);
    }
}

/// Two blocks side by side, their tops one plane: no crack to fall into.
TEST(TwoObjects, SideBySideAreOnePlaneToV)
{
    auto both = flat(box({3, 3, 3}).triangles(1, 1));
    join(both, moved(flat(box({3, 3, 3}).triangles(1, 1)), {6, 0, 0}));
    for (const phantom_float_ops* ops : sections()) {
        Contact contact(*ops, both, constrained());
        ASSERT_TRUE(go(contact, {1, 0.4, 4}, {1, 0.4, 2}, 0.05).inside);
        for (int i = 0; i <= 200; ++i) {
            const Vec3 p{1 + 0.02 * i, 0.4, 2};
            expect_at(contact.tick(on_grid(p)), {p[0], p[1], 3}, 2e-5);
        }
    }
}

TEST(Crease, IsSlidAlongWithoutChatter)
{
    const auto triangles = flat(field(12, 6, [](double x, double) { return std::abs(x); }).triangles(1, 1));
    Contact contact(phantom_float_sse2, triangles, constrained());
    ASSERT_TRUE(go(contact, {0.001, -4, 0.5}, {0, -4, -1}, 0.01).inside);
    for (int i = 0; i <= 4000; ++i) {
        const Vec3 p{1e-5 * (i % 7), -4 + 0.002 * i, -1};
        const Touch touch = contact.tick(on_grid(p));
        expect_at(touch, {0, p[1], 0});
        ASSERT_NEAR(touch.force[2], 2, 1e-3);
        ASSERT_NEAR(touch.force[0], 0, 1e-3);
    }
}

TEST(Walk, OfAFaceThatTheSetLostEndsOutside)
{
    const auto triangles = field(4, 5, [](double, double) { return 0.0; }).triangles(1, 1);
    Contact contact(phantom_float_sse2, triangles, constrained());
    ASSERT_TRUE(go(contact, {1, 1.2, 0.3}, {1, 1.2, -0.5}, 0.1).inside);
    contact.job().proxy_face = 12345; // no such face, but V still lies on one of the set
    expect_at(contact.tick({1.1, 1.2, -0.5}), {1.1, 1.2, 0});
    contact.job().proxy_face = 12345;
    contact.job().proxy_nm[2] = 2000000; // 2 mm off every face
    const Touch lost = contact.tick({1.2, 1.2, -0.5});
    EXPECT_FALSE(lost.inside);
    EXPECT_EQ(length(lost.force), 0);
}

/// Where the set's promise ends no side can be told: V waits for the next set.
TEST(Walk, DoesNotLetGoWhereTheSetEnds)
{
    const auto triangles = field(4, 5, [](double, double) { return 0.0; }).triangles(1, 1);
    Contact contact(phantom_float_sse2, triangles, constrained());
    ASSERT_TRUE(go(contact, {1, 1.2, 0.3}, {1, 1.2, -0.5}, 0.1).inside);
    contact.job().radius_nm = 100000;
    EXPECT_TRUE(contact.tick({1, 1.2, 0.5}).inside);
    contact.job().radius_nm = 2000000000;
    EXPECT_FALSE(contact.tick({1, 1.2, 0.5}).inside);
}

TEST(Walk, InFloat32AndFloat64EndsAtTheSameDistance)
{
    for (const Named& shape : shapes_of_interest()) {
        if (shape.name == "soup")
            continue; // nothing fits anything
        Contact a(phantom_float_sse2, shape.triangles, constrained()),
            b(phantom_float_double, shape.triangles, constrained());
        std::mt19937 random(2);
        unsigned inside = 0, differ = 0;
        Vec3 p = point_near(shape.triangles, random, 0.5, 0.6), target = p;
        for (int i = 0; i < 4000; ++i) {
            if (length(subtract(target, p)) < 0.1)
                target = point_near(shape.triangles, random, -1.5, 0.2);
            p = on_grid(add(p, scale(0.05, unit(subtract(target, p)))));
            const Touch x = a.tick(p), y = b.tick(p);
            inside += x.inside && y.inside;
            differ += x.inside != y.inside ||
                      std::abs(length(subtract(x.proxy, p)) - length(subtract(y.proxy, p))) > on_the_spot_mm;
        }
        EXPECT_GT(inside, 1000U) << shape.name;
        EXPECT_LE(differ, 40U) << shape.name; // on a lip either side is as near
    }
}

} // namespace
