// SPDX-License-Identifier: GPL-2.0-or-later
// No path slips through a surface: not through an edge, a vertex, between two ticks, nor in one tick.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

#include "contact.hpp"
#include "shapes_of_interest.hpp"

namespace {

using namespace phantom;
using namespace phantom::hard;

/// One tick from a to b, from outside.
Touch stroke(Contact& contact, const Vec3& a, const Vec3& b)
{
    contact.restart();
    contact.tick(a);
    return contact.tick(b);
}

TEST(Path, ExactlyThroughTheVertexOfAFanIsNeverMissed)
{
    for (const unsigned valence : {3U, 4U, 5U, 6U, 7U, 12U, 40U}) {
        for (const double height : {-2.0, 0.0, 0.7, 5.0}) {
            Contact contact(phantom_float_sse2, fan(valence, 3, height).triangles(1, 1), with_proxy());
            std::mt19937 random(valence);
            std::normal_distribution<double> any;
            for (int i = 0; i < 200; ++i) {
                // down through the vertex (0, 0, height), to the same distance below; steep enough
                // to come from the front of every face
                const Vec3 way = on_grid({0.02 * any(random), 0.02 * any(random), 0.3});
                const Vec3 vertex = on_grid({0, 0, height});
                const Touch touch = stroke(contact, add(vertex, way), subtract(vertex, way));
                ASSERT_TRUE(touch.inside) << "valence " << valence << " height " << height << " path " << i;
                ASSERT_LE(length(subtract(touch.proxy, vertex)), 5e-6);
            }
        }
    }
}

TEST(Path, ExactlyThroughEdgesIsNeverMissed)
{
    const Shape shape = sphere(2, 10);
    const auto triangles = shape.triangles(1, 1);
    for (const phantom_float_ops* ops : sections()) {
        Contact contact(*ops, triangles, with_proxy());
        std::mt19937 random(3);
        std::normal_distribution<double> any;
        for (const auto& t : triangles) {
            const Vec3 middle = on_grid(scale(0.5, add(t.corner[1], t.corner[2])));
            const Vec3 way = on_grid(
                add(scale(0.4, unit(middle)), {0.05 * any(random), 0.05 * any(random), 0.05 * any(random)}));
            ASSERT_TRUE(stroke(contact, add(middle, way), subtract(middle, way)).inside) << ops->name;
        }
    }
}

/// A plate that lies anyhow, with a sliver (vertices 0, 1, 2) some nm high along its middle: a cap, whose
/// third vertex lies over the edge between the other two, or a needle, whose third lies beside the second.
Shape slit_plate(std::mt19937& random, double height_mm, bool cap)
{
    std::normal_distribution<double> any;
    const Vec3 normal = unit({any(random), any(random), any(random)});
    const Vec3 along = unit(cross(normal, {any(random), any(random), any(random)}));
    const Vec3 across = cross(normal, along);
    const auto at = [&](double x, double y) { return on_grid(add(scale(x, along), scale(y, across))); };
    Shape plate;
    plate.vertices = {at(-3, 0), at(3, 0), at(cap ? 0.7 : 3, height_mm), at(0.5, 3), at(-0.5, -3)};
    plate.faces = {{0, 1, 2}, {0, 2, 3}, {1, 0, 4}};
    if (cap)
        plate.faces.push_back({2, 1, 3});
    plate.normals.assign(plate.vertices.size(), on_unit_grid(normal));
    return plate;
}

TEST(Path, ThroughASliverTooLowForAPlaneIsHeld)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> part(0, 1), low(1e-6, 15e-6);
    unsigned refused = 0, strokes = 0;
    for (int i = 0; i < 120; ++i) {
        const Shape plate = slit_plate(random, low(random), i % 2 == 0);
        const auto triangles = plate.triangles(1, 1);
        for (const phantom_float_ops* ops : sections()) {
            for (const std::uint32_t proxy : {PHANTOM_PROXY_PAPER, PHANTOM_PROXY_CONSTRAINED}) {
                Settings settings = with_proxy();
                settings.proxy = proxy;
                Contact contact(*ops, triangles, settings);
                refused += contact.refused();
                for (int k = 0; k < 20; ++k) {
                    const double u = part(random), v = part(random) * (1 - u);
                    const Vec3 in =
                        on_grid(add(scale(1 - u - v, plate.vertices[0]),
                                    add(scale(u, plate.vertices[1]), scale(v, plate.vertices[2]))));
                    const Vec3 way = on_grid(scale(0.3, plate.normals[0]));
                    const Touch touch = stroke(contact, add(in, way), subtract(in, way));
                    ASSERT_TRUE(touch.inside) << ops->name << " sliver " << i << " stroke " << k;
                    // V where the path went in, and the force of a plate
                    ASSERT_LE(length(subtract(touch.proxy, in)), 2e-5) << ops->name;
                    ASSERT_NEAR(length(touch.force), 1.3, 1e-4) << ops->name;
                    ++strokes;
                }
            }
        }
    }
    EXPECT_GT(refused, strokes / 20 / 2) << "slivers must be among them that are refused";
}

TEST(Path, InManyTicksThroughAnyPlaceOfASphereIsNeverMissed)
{
    const auto triangles = sphere(3, 10).triangles(1, 1);
    std::mt19937 random(9);
    std::normal_distribution<double> any;
    std::uniform_real_distribution<double> tick_mm(1e-6, 0.4);
    for (const phantom_float_ops* ops : sections()) {
        Contact contact(*ops, triangles, with_proxy());
        for (int path = 0; path < 300; ++path) {
            const Vec3 from = scale(10.2, unit({any(random), any(random), any(random)}));
            const Vec3 to = scale(8, unit(add(from, {any(random), any(random), any(random)})));
            contact.restart();
            Touch touch;
            for (double s = 0; s < length(subtract(to, from)); s += 0.05 + tick_mm(random))
                touch = contact.tick(on_grid(add(from, scale(s, unit(subtract(to, from))))));
            ASSERT_TRUE(contact.tick(on_grid(to)).inside) << ops->name << " path " << path;
        }
    }
}

/// 1 nm of descent on 1 um of way: no single tick shows a clear crossing.
TEST(Path, ThatGrazesAPlateDoesNotFallThrough)
{
    const auto triangles =
        field(20, 5, [](double x, double y) { return 0.01 * x - 0.02 * y; }).triangles(1, 1);
    for (const phantom_float_ops* ops : sections()) {
        for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED}) {
            Contact contact(*ops, triangles, with_proxy(model));
            for (int i = 0; i < 4000; ++i) {
                const double x = -2 + i * 1e-3, y = 0.3 + i * 2e-4;
                const Touch touch = contact.tick(on_grid({x, y, 0.01 * x - 0.02 * y + 5e-7 - i * 1e-9}));
                ASSERT_NEAR(length(touch.force), 1, 2e-3) << ops->name << " model " << model << " tick " << i;
            }
        }
    }
}

TEST(Path, ThatEndsExactlyOnAFaceGoesOnBothWays)
{
    Contact contact(phantom_float_sse2, field(2, 5, [](double, double) { return 0.0; }).triangles(1, 1),
                    with_proxy());
    contact.tick({1, 1, 0.5});
    EXPECT_FALSE(contact.tick({1, 1, 0}).inside); // on the face is outside
    EXPECT_FALSE(contact.tick({1, 1, 0.1}).inside);
    EXPECT_FALSE(contact.tick({1, 1, 0}).inside);
    EXPECT_TRUE(contact.tick({1, 1, -0.1}).inside);
    EXPECT_FALSE(contact.tick({1, 1, 0}).inside);
    EXPECT_TRUE(contact.tick({1, 1, -1e-6}).inside);
    EXPECT_FALSE(contact.tick({1, 1, 1e-6}).inside);
}

TEST(Path, ThroughAThinPlateInOneTickIsHeldAndLetOutAgain)
{
    Contact contact(phantom_float_sse2, box({5, 5, 0.05}).triangles(1, 1), with_proxy());
    contact.tick({1, 2, 0.5});
    const Touch below = contact.tick({1, 2, -0.8});
    EXPECT_TRUE(below.inside);
    EXPECT_NEAR(below.proxy[2], 0.05, 1e-6);
    EXPECT_GT(below.force[2], 1.5);
    const Touch aside = contact.tick({1.2, 2.1, -0.79}); // slides along the front, still held
    EXPECT_TRUE(aside.inside);
    EXPECT_NEAR(aside.proxy[2], 0.05, 1e-5);
    EXPECT_NEAR(aside.proxy[0], 1.2, 1e-5);
    EXPECT_FALSE(contact.tick({1.2, 2.1, 0.4}).inside);
}

TEST(Path, ThatClipsARidgeInOneTickStaysOutside)
{
    Contact contact(phantom_float_sse2, box({5, 5, 5}).triangles(1, 1), with_proxy());
    EXPECT_FALSE(stroke(contact, {4.5, 1, 5.2}, {5.3, 1.1, 4.7}).inside);
    const auto round = sphere(3, 10).triangles(1, 1);
    Contact ball(phantom_float_sse2, round, with_proxy());
    EXPECT_FALSE(stroke(ball, {-1.5, 0.2, 9.9}, {1.5, 0.3, 9.9}).inside);
}

TEST(Path, FasterThanTheMeshIsBigIsHeldAtTheFirstCrossing)
{
    Contact contact(phantom_float_sse2, box({5, 5, 0.5}).triangles(1, 1), with_proxy());
    const Touch touch = stroke(contact, {1, 1, 300}, {1, 1, -300});
    EXPECT_TRUE(touch.inside);
    EXPECT_NEAR(touch.proxy[2], 0.5, 1e-4);
    EXPECT_FALSE(touch.invalid);
}

TEST(Proxy, OfAFaceThatTheSetLostIsFoundAgainOrGivesNoForce)
{
    const auto triangles = field(4, 5, [](double, double) { return 0.0; }).triangles(1, 1);
    Contact contact(phantom_float_sse2, triangles, with_proxy());
    contact.tick({1, 1.2, 0.3});
    ASSERT_TRUE(contact.tick({1, 1.2, -0.5}).inside);
    contact.job().proxy_face = 12345; // no such face, but V still lies on one of the set
    const Touch found = contact.tick({1.1, 1.2, -0.5});
    EXPECT_TRUE(found.inside);
    EXPECT_NEAR(found.force[2], 1.5, 1e-5);
    EXPECT_NE(found.job.proxy_face, 12345U);
    contact.job().proxy_face = 12345;
    contact.job().proxy_nm[2] = 2000000; // 2 mm off every face
    const Touch lost = contact.tick({1.2, 1.2, -0.5});
    EXPECT_TRUE(lost.inside);
    EXPECT_EQ(length(lost.force), 0);
    EXPECT_EQ(lost.job.proxy_nm[2], 2000000);
}

TEST(Proxy, DoesNotCreepUnderATipThatRests)
{
    Contact contact(phantom_float_sse2, sphere(3, 10).triangles(1, 1), with_proxy());
    contact.tick({3, 4, 9});
    const Touch first = contact.tick({2.2, 3.3, 8});
    ASSERT_TRUE(first.inside);
    Touch last;
    for (int i = 0; i < 20000; ++i)
        last = contact.tick({2.2, 3.3, 8});
    EXPECT_LE(length(subtract(first.proxy, last.proxy)), 2e-5);
}

TEST(Proxy, OffLetsTheTipFallThrough)
{
    Settings settings;
    Contact contact(phantom_float_sse2, sphere(3, 10).triangles(1, 1), settings);
    const Touch touch = stroke(contact, {0, 0, 10.5}, {0, 0, 9});
    EXPECT_FALSE(touch.inside);
    EXPECT_EQ(length(touch.force), 0);
}

} // namespace
