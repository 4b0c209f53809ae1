// SPDX-License-Identifier: GPL-2.0-or-later
// Polygons into triangles: their outline once each way, their area, nothing turned over.
#include <set>

#include <gtest/gtest.h>

#include "corpus.hpp"
#include "mesh/polygon.hpp"
#include "mesh/read.hpp"

namespace phantom::mesh::test {
namespace {

Vec3 area_vector(const std::vector<Vec3>& outline)
{
    Vec3 sum{0, 0, 0};
    for (std::size_t i = 0; i < outline.size(); ++i)
        sum = add(sum, scaled(cross(outline[i], outline[(i + 1) % outline.size()]), 0.5));
    return sum;
}

/// Every edge of the outline in one triangle, every other edge in two, one each way; all triangles lie as the
/// polygon does and have its area together: then they cover it once.
void expect_covered(const std::vector<Vec3>& outline)
{
    std::vector<Triple> triangles;
    ASSERT_TRUE(PolygonCutter().cut(outline, triangles));
    const auto count = static_cast<std::uint32_t>(outline.size());
    ASSERT_EQ(triangles.size(), outline.size() - 2);
    std::multiset<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const Triple& t : triangles)
        for (std::size_t i = 0; i < 3; ++i)
            edges.insert({t[i], t[(i + 1) % 3]});
    for (const auto& [a, b] : edges) {
        ASSERT_EQ(edges.count({a, b}), 1U);
        ASSERT_EQ(edges.count({b, a}), b == (a + 1) % count ? 0U : 1U);
    }
    const Vec3 whole = area_vector(outline), normal = normalized(whole);
    double sum = 0;
    for (const Triple& t : triangles) {
        const double part = dot(normal, area_vector({outline[t[0]], outline[t[1]], outline[t[2]]}));
        ASSERT_GE(part, -1e-12 * length(whole));
        sum += part;
    }
    EXPECT_NEAR(sum, length(whole), 1e-9 * length(whole));
}

/// In some plane of space, begun at every corner if there are few.
void expect_covered_anywhere(const std::vector<Vec3>& flat)
{
    Noise noise(3);
    const std::size_t starts = flat.size() <= 16 ? flat.size() : 1;
    for (std::size_t start = 0; start < starts; ++start) {
        const Vec3 u = normalized(noise.vector(1)), v = normalized(cross(u, noise.vector(1)));
        const Vec3 at = noise.vector(100);
        for (const bool mirrored : {false, true}) {
            std::vector<Vec3> outline;
            for (const Vec3& p : flat)
                outline.push_back(add(at, add(scaled(u, p[0]), scaled(v, mirrored ? -p[1] : p[1]))));
            std::rotate(outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(start), outline.end());
            expect_covered(outline);
        }
    }
}

TEST(MeshPolygon, ConcaveShapes)
{
    expect_covered_anywhere({{0, 0, 0}, {10, 0, 0}, {2, 2, 0}, {0, 10, 0}});                         // arrow
    expect_covered_anywhere({{0, 0, 0}, {10, 0, 0}, {10, 2, 0}, {2, 2, 0}, {2, 10, 0}, {0, 10, 0}}); // L
    std::vector<Vec3> star;
    for (int i = 0; i < 10; ++i) {
        const double t = std::numbers::pi * i / 5, r = i % 2 ? 4 : 10;
        star.push_back({r * std::cos(t), r * std::sin(t), 0});
    }
    expect_covered_anywhere(star);
}

TEST(MeshPolygon, RandomOutlines)
{
    Noise noise(9);
    for (int round = 0; round < 60; ++round) {
        std::vector<Vec3> outline;
        const int count = 5 + round * 3;
        for (int i = 0; i < count; ++i) {
            const double t = 2 * std::numbers::pi * i / count, r = 10 + 9 * noise();
            outline.push_back({r * std::cos(t), r * std::sin(t), 0});
        }
        expect_covered_anywhere(outline);
    }
}

TEST(MeshPolygon, CombsAndSpiralsOfThousands)
{
    std::vector<Vec3> comb;
    for (int i = 0; i < 2000; ++i) {
        comb.push_back({i * 1.0, 0, 0});
        comb.push_back({i + 0.4, 50, 0});
    }
    comb.push_back({2000, -10, 0});
    comb.push_back({0, -10, 0});
    std::reverse(comb.begin(), comb.end());
    expect_covered_anywhere(comb);
    std::vector<Vec3> spiral, back;
    for (int i = 0; i < 3000; ++i) {
        const double t = 0.02 * i, r = 10 + t;
        spiral.push_back({r * std::cos(t), r * std::sin(t), 0});
        back.push_back({(r + 2) * std::cos(t), (r + 2) * std::sin(t), 0});
    }
    spiral.insert(spiral.end(), back.rbegin(), back.rend());
    expect_covered_anywhere(spiral);
}

TEST(MeshPolygon, CornersInARow)
{
    std::vector<Vec3> square;
    for (int side = 0; side < 4; ++side) {
        for (int i = 0; i < 5; ++i) {
            const double s = 2.0 * i;
            square.push_back(side == 0   ? Vec3{s, 0, 0}
                             : side == 1 ? Vec3{10, s, 0}
                             : side == 2 ? Vec3{10 - s, 10, 0}
                                         : Vec3{0, 10 - s, 0});
        }
    }
    std::vector<Triple> triangles;
    ASSERT_TRUE(PolygonCutter().cut(square, triangles));
    for (const Triple& t : triangles)
        EXPECT_GT(length(area_vector({square[t[0]], square[t[1]], square[t[2]]})), 1e-3);
    expect_covered_anywhere(square);
}

TEST(MeshPolygon, AHoleReachedOverABridge)
{
    // a square of 10 with a hole of 4, the corners of the bridge twice
    const std::vector<Vec3> outline = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}, {0, 0, 0},
                                       {3, 3, 0}, {3, 7, 0},  {7, 7, 0},   {7, 3, 0},  {3, 3, 0}};
    std::vector<Triple> triangles;
    EXPECT_TRUE(PolygonCutter().cut(outline, triangles));
    ASSERT_EQ(triangles.size(), 8U);
    double sum = 0;
    for (const Triple& t : triangles) {
        const Vec3 part = area_vector({outline[t[0]], outline[t[1]], outline[t[2]]});
        EXPECT_GE(part[2], 0);
        sum += part[2];
        const Vec3 centre = scaled(add(add(outline[t[0]], outline[t[1]]), outline[t[2]]), 1.0 / 3);
        EXPECT_FALSE(part[2] > 1e-9 && std::abs(centre[0] - 5) < 2 && std::abs(centre[1] - 5) < 2);
    }
    EXPECT_NEAR(sum, 84, 1e-9);
}

TEST(MeshPolygon, ABentQuadrilateralIsCutWhereItBendsLess)
{
    // a roof: the ridge is the diagonal from 0 to 2, or from 1 to 3
    const std::vector<Vec3> first = {{0, 0, 2}, {10, 0, 0}, {10, 10, 2}, {0, 10, 0}};
    for (const bool other : {false, true}) {
        std::vector<Vec3> outline = first;
        if (other)
            std::rotate(outline.begin(), outline.begin() + 1, outline.end());
        outline[0][0] += 1; // so that the two bends differ
        std::vector<Triple> triangles;
        PolygonCutter().cut(outline, triangles);
        const auto bend = [&](const Triple& a, const Triple& b) {
            return angle_between(area_vector({outline[a[0]], outline[a[1]], outline[a[2]]}),
                                 area_vector({outline[b[0]], outline[b[1]], outline[b[2]]}));
        };
        EXPECT_LE(bend(triangles[0], triangles[1]), bend({0, 1, 2}, {0, 2, 3}) + 1e-12);
        EXPECT_LE(bend(triangles[0], triangles[1]), bend({1, 2, 3}, {1, 3, 0}) + 1e-12);
    }
}

TEST(MeshPolygon, FlatConvexOnesStayFans)
{
    std::vector<Triple> triangles;
    EXPECT_TRUE(PolygonCutter().cut(std::vector<Vec3>{{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {1, 2, 0}, {0, 1, 0}},
                                    triangles));
    EXPECT_EQ(triangles, (std::vector<Triple>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(MeshPolygon, OneThatCrossesItselfIsToldAndEnds)
{
    // the star drawn in one stroke
    std::vector<Vec3> outline;
    for (int i = 0; i < 5; ++i) {
        const double t = 4 * std::numbers::pi * i / 5;
        outline.push_back({std::cos(t), std::sin(t), 0});
    }
    std::vector<Triple> triangles;
    EXPECT_FALSE(PolygonCutter().cut(outline, triangles));
    EXPECT_EQ(triangles.size(), 3U);
    triangles.clear();
    EXPECT_FALSE(
        PolygonCutter().cut(std::vector<Vec3>{{0, 0, 0}, {10, 10, 0}, {10, 0, 0}, {0, 10, 0}}, triangles));
    EXPECT_EQ(triangles.size(), 2U);
    Noise noise(2);
    std::vector<Vec3> tangle;
    for (int i = 0; i < 3000; ++i)
        tangle.push_back(noise.vector(10));
    triangles.clear();
    EXPECT_FALSE(PolygonCutter().cut(tangle, triangles));
    EXPECT_EQ(triangles.size(), 2998U);
}

TEST(MeshPolygon, WithoutAnAreaItIsAFanThatPreparationDrops)
{
    std::vector<Triple> triangles;
    EXPECT_TRUE(
        PolygonCutter().cut(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, triangles));
    EXPECT_EQ(triangles.size(), 2U);
}

TEST(MeshPolygon, FilesOfConcavePolygonsKeepTheirArea)
{
    // a prism over an L: two concave sides and six rectangles
    const std::string obj = "v 0 0 0\nv 10 0 0\nv 10 2 0\nv 2 2 0\nv 2 10 0\nv 0 10 0\n"
                            "v 0 0 5\nv 10 0 5\nv 10 2 5\nv 2 2 5\nv 2 10 5\nv 0 10 5\n"
                            "f 3 2 1 6 5 4\nf 9 10 11 12 7 8\nf 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\n"
                            "f 5 6 12 11\nf 6 1 7 12\n";
    const Folder folder;
    const auto soup = read(folder.write("l.obj", obj));
    ASSERT_TRUE(soup.ok()) << soup.error().text();
    const auto out = prepare(*soup, {}, "l.obj");
    ASSERT_TRUE(out.ok());
    EXPECT_TRUE(out->report.watertight);
    EXPECT_NEAR(signed_volume(out->mesh.vertices.to_vector(), out->mesh.faces.to_vector()), 36 * 5, 1e-9);
    EXPECT_NEAR(area(out->mesh.vertices.to_vector(), out->mesh.faces.to_vector()), 2 * 36 + 40 * 5, 1e-9);
}

} // namespace
} // namespace phantom::mesh::test
