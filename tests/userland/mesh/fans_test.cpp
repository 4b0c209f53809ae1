// SPDX-License-Identifier: GPL-2.0-or-later
// Fans close what creases leave open: every side of a face or a fan, from one (vertex, normal) to another, is
// the side of exactly one other, run through the other way.
#include <gtest/gtest.h>

#include "mesh/fans.hpp"
#include "meshes.hpp"

namespace phantom::mesh {
namespace {

using namespace test;

Mesh prepared(Soup soup, double crease_deg = 30)
{
    PrepareOptions options;
    options.crease_deg = crease_deg;
    auto result = prepare(std::move(soup), options, "test");
    EXPECT_TRUE(result.ok());
    return std::move(result->mesh);
}

using End = std::pair<std::uint32_t, Vec3>; ///< a vertex with one of its normals

/// Sides without their opposite. Points (the same end twice) do not count.
int open_sides(const Mesh& mesh, const Fans& fans)
{
    std::map<std::pair<End, End>, int> balance;
    const auto add_side = [&balance](const End& from, const End& to) {
        if (from == to)
            return;
        ++balance[{from, to}];
        --balance[{to, from}];
    };
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            add_side({mesh.faces[f][i], mesh.normals[mesh.face_normals[f][i]]},
                     {mesh.faces[f][j], mesh.normals[mesh.face_normals[f][j]]});
        }
    for (const Fan& fan : fans.fans)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            add_side({fan.corners[i], fan.normals[i]}, {fan.corners[j], fan.normals[j]});
        }
    int open = 0;
    for (const auto& [side, count] : balance)
        open += std::abs(count);
    return open / 2;
}

/// A cone of `sides` triangles with a base: creases round the base, and along its sides where they are steep.
Soup cone(std::uint32_t sides, double radius, double height)
{
    Soup soup;
    soup.vertices = {{0, 0, height}, {0, 0, 0}};
    for (std::uint32_t i = 0; i < sides; ++i) {
        const double turn = 2 * std::numbers::pi * i / sides;
        soup.vertices.push_back({radius * std::cos(turn), radius * std::sin(turn), 0});
    }
    for (std::uint32_t i = 0; i < sides; ++i) {
        const std::uint32_t a = 2 + i, b = 2 + (i + 1) % sides;
        soup.faces.push_back({0, a, b});
        soup.faces.push_back({1, b, a});
    }
    return soup;
}

/// A step: an L-shaped prism with one concave edge.
Soup step()
{
    Soup soup;
    const std::vector<std::array<double, 2>> outline{{0, 0}, {30, 0}, {30, 10}, {10, 10}, {10, 30}, {0, 30}};
    for (const double z : {0.0, 20.0})
        for (const auto& [x, y] : outline)
            soup.vertices.push_back({x, y, z});
    for (std::uint32_t i = 0; i < 6; ++i) {
        const std::uint32_t j = (i + 1) % 6;
        soup.faces.push_back({i, j, 6 + j});
        soup.faces.push_back({i, 6 + j, 6 + i});
    }
    for (const Triple& t : {Triple{0, 1, 2}, Triple{0, 2, 3}, Triple{0, 3, 4}, Triple{0, 4, 5}}) {
        soup.faces.push_back({t[2], t[1], t[0]});
        soup.faces.push_back({6 + t[0], 6 + t[1], 6 + t[2]});
    }
    return soup;
}

/// A globe with bumps, so coarse that some of its edges are creases and others are not.
Soup rough_globe()
{
    Soup soup = globe(20, 14, 9);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> part(0.8, 1.2);
    for (Vec3& v : soup.vertices)
        v = scaled(v, part(random));
    return soup;
}

TEST(Fans, ACubeHasTwoOverEachEdgeAndOneOverEachCorner)
{
    const Mesh mesh = prepared(cube());
    const Fans fans = make_fans(mesh);
    EXPECT_EQ(std::count_if(fans.fans.begin(), fans.fans.end(), [](const Fan& f) { return f.over_vertex(); }),
              8);
    EXPECT_EQ(fans.fans.size(), 24U + 8U);
    for (const Fan& fan : fans.fans) {
        // Outward: the normals of a fan lean away from the middle of the cube.
        Vec3 sum{0, 0, 0};
        for (const Vec3& n : fan.normals)
            sum = add(sum, n);
        EXPECT_GT(dot(sum, mesh.vertices[fan.corners[0]]), 0);
    }
}

TEST(Fans, OfASmoothMeshAreNone)
{
    const Mesh mesh = prepared(globe(20, 40, 20), 60);
    const Fans fans = make_fans(mesh);
    EXPECT_TRUE(fans.fans.empty());
    EXPECT_TRUE(fans.of(3).empty());
}

TEST(Fans, CloseEveryClosedMesh)
{
    const std::map<std::string, Soup> meshes{{"cube", cube()},
                                             {"step", step()},
                                             {"blunt cone", cone(12, 20, 10)},
                                             {"needle", cone(5, 1, 50)},
                                             {"tetrahedron", cone(3, 10, 10)},
                                             {"rough globe", rough_globe()},
                                             {"blade", cone(3, 20, 0.01)}};
    for (const auto& [name, soup] : meshes) {
        for (const double crease_deg : {5.0, 20.0, 45.0, 80.0}) {
            SCOPED_TRACE(name + ", crease " + std::to_string(crease_deg));
            const Mesh mesh = prepared(soup, crease_deg);
            const Fans fans = make_fans(mesh);
            EXPECT_EQ(open_sides(mesh, fans), 0);
            if (fans.fans.empty())
                continue;
            EXPECT_GT(open_sides(mesh, Fans{}), 0);
        }
    }
}

TEST(Fans, AreNeverTooWideToHaveAShell)
{
    for (const Soup& soup : {cube(), cone(3, 20, 0.01), cone(3, 1, 60), step()}) {
        const Fans fans = make_fans(prepared(soup));
        ASSERT_FALSE(fans.fans.empty());
        for (const Fan& fan : fans.fans)
            for (std::size_t i = 0; i < 3; ++i)
                EXPECT_LE(angle_between(fan.normals[i], fan.normals[(i + 1) % 3]), 2.0);
    }
}

TEST(Fans, EachLiesAtItsFace)
{
    const Mesh mesh = prepared(rough_globe(), 20);
    const Fans fans = make_fans(mesh);
    ASSERT_EQ(fans.first.size(), mesh.faces.size() + 1);
    std::size_t seen = 0;
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
        for (const Fan& fan : fans.of(f)) {
            ++seen;
            for (const std::uint32_t corner : fan.corners)
                EXPECT_EQ(std::count(mesh.faces[f].begin(), mesh.faces[f].end(), corner), 1);
        }
    }
    EXPECT_EQ(seen, fans.fans.size());
    EXPECT_GT(seen, 50U);
}

TEST(Fans, CloseASheetThatIsTwoSided)
{
    Soup cap = globe(20, 16, 9); // without its southern half: a rim that bends
    std::erase_if(cap.faces, [&cap](const Triple& t) {
        return cap.vertices[t[0]][2] + cap.vertices[t[1]][2] + cap.vertices[t[2]][2] < 0;
    });
    Soup square;
    square.vertices = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}};
    square.faces = {{0, 1, 2}, {0, 2, 3}};
    for (const Soup& soup : {cap, square}) {
        PrepareOptions options;
        options.two_sided = true;
        const auto sheet = prepare(soup, options, "sheet");
        ASSERT_TRUE(sheet.ok());
        EXPECT_EQ(sheet->mesh.faces.size(), 2 * sheet->report.faces);
        EXPECT_TRUE(sheet->report.warnings.empty() ||
                    sheet->report.warnings[0].find("boundary") == std::string::npos);
        for (std::uint32_t f = 0; f < sheet->mesh.faces.size(); ++f) {
            for (const std::uint32_t neighbour : sheet->mesh.neighbours[f]) {
                ASSERT_NE(neighbour, no_neighbour);
                const Triple& back = sheet->mesh.neighbours[neighbour];
                EXPECT_GE(std::count(back.begin(), back.end(), f), 1);
            }
        }
        EXPECT_EQ(open_sides(sheet->mesh, make_fans(sheet->mesh)), 0);
        EXPECT_GT(open_sides(sheet->mesh, Fans{}), 0);
    }
}

TEST(Fans, ABoundaryStaysOpenAndHarmsNothing)
{
    Soup open = cube();
    open.faces.resize(open.faces.size() - 2); // without a side
    const Mesh mesh = prepared(std::move(open));
    const Fans fans = make_fans(mesh);
    // 8 of 12 edges, and the four corners away from the hole
    EXPECT_EQ(fans.fans.size(), 16U + 4U);
}

} // namespace
} // namespace phantom::mesh
