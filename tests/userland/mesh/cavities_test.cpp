// SPDX-License-Identifier: GPL-2.0-or-later
// Closed parts inside one another: which bound a solid and which a hollow in it.
#include <gtest/gtest.h>

#include "meshes.hpp"

namespace phantom::mesh::test {
namespace {

/// Volume of faces first ... last - 1 of the result, about a point of theirs.
double volume_of(const Mesh& mesh, std::size_t first, std::size_t last)
{
    const Vec3 origin = mesh.vertices[mesh.faces[first][0]];
    double sum = 0;
    for (std::size_t f = first; f < last; ++f) {
        std::array<Vec3, 3> x;
        for (std::size_t i = 0; i < 3; ++i)
            x[i] = subtract(mesh.vertices[mesh.faces[f][i]], origin);
        sum += dot(x[0], cross(x[1], x[2]));
    }
    return sum / 6;
}

TEST(MeshCavities, SpheresInsideOneAnotherTakeTurns)
{
    // Whatever their order in the file and the sense that they come in.
    std::vector<double> radii = {50, 40, 30, 20, 10};
    std::mt19937 random(7);
    for (int round = 0; round < 12; ++round) {
        std::shuffle(radii.begin(), radii.end(), random);
        Soup soup;
        const std::size_t faces = globe(1, 12, 8).faces.size();
        for (const double radius : radii)
            append(soup, globe(radius, 12, 8));
        for (std::size_t f = 0; f < soup.faces.size(); ++f) {
            if (random() % 2)
                turn(soup, f);
        }
        const Prepared out = prepared(soup);
        EXPECT_EQ(out.report.cavities, 2U);
        EXPECT_TRUE(out.report.watertight);
        for (std::size_t i = 0; i < radii.size(); ++i) {
            const bool hollow = radii[i] == 40 || radii[i] == 20;
            EXPECT_EQ(volume_of(out.mesh, i * faces, (i + 1) * faces) < 0, hollow) << radii[i];
        }
        EXPECT_EQ(prepared(soup_of(out.mesh)).report.components_turned, 0U);
    }
}

TEST(MeshCavities, ManyBubblesInOneSolid)
{
    Soup soup = cube(100);
    for (int x = 0; x < 6; ++x)
        for (int y = 0; y < 6; ++y)
            for (int z = 0; z < 6; ++z)
                append(soup, cube(5, {30.0 * x - 75, 30.0 * y - 75, 30.0 * z - 75}));
    const Prepared out = prepared(soup);
    EXPECT_EQ(out.report.cavities, 216U);
    EXPECT_EQ(out.report.components_turned, 216U);
    EXPECT_NEAR(signed_volume(out.mesh.vertices, out.mesh.faces), 8e6 - 216 * 1000, 1e-3);
}

/// The box of one lies in the box of the other, and still it is outside.
TEST(MeshCavities, InTheHoleOfARingIsOutside)
{
    Soup ring;
    constexpr std::uint32_t sides = 24, round = 12;
    for (std::uint32_t i = 0; i < sides; ++i) {
        const double t = 2 * std::numbers::pi * i / sides;
        for (std::uint32_t j = 0; j < round; ++j) {
            const double s = 2 * std::numbers::pi * j / round, r = 50 + 15 * std::cos(s);
            ring.vertices.push_back({r * std::cos(t), r * std::sin(t), 15 * std::sin(s)});
        }
    }
    const auto number = [](std::uint32_t i, std::uint32_t j) { return i % sides * round + j % round; };
    for (std::uint32_t i = 0; i < sides; ++i) {
        for (std::uint32_t j = 0; j < round; ++j) {
            ring.faces.push_back({number(i, j), number(i + 1, j), number(i + 1, j + 1)});
            ring.faces.push_back({number(i, j), number(i + 1, j + 1), number(i, j + 1)});
        }
    }
    for (const Vec3& centre : {Vec3{0, 0, 0}, Vec3{50, 0, 0}, Vec3{0, -50, 0}}) {
        Soup soup = ring;
        append(soup, cube(3, centre));
        EXPECT_EQ(prepared(soup).report.cavities, centre[0] == centre[1] ? 0U : 1U);
        for (Vec3& v : soup.vertices) // upright: the ray out of the hole crosses the ring twice
            v = {v[2], v[0], v[1]};
        EXPECT_EQ(prepared(soup).report.cavities, centre[0] == centre[1] ? 0U : 1U);
    }
}

/// Bubbles close to slanted faces on either side, and straight below edges: where a ray is decided by
/// rounding.
TEST(MeshCavities, BubblesNextToTheWall)
{
    Soup outer = globe(50, 9, 7);
    for (Vec3& v : outer.vertices) // so that no edge is parallel to anything
        v = {0.8 * v[0] - 0.6 * v[2], v[1] + 0.1 * v[0], 0.6 * v[0] + 0.8 * v[2]};
    Soup bubble = cube(1e-4);
    bubble.faces = {{0, 2, 1}, {0, 1, 4}, {0, 4, 2}, {1, 2, 4}};
    bubble.vertices = {{-1e-4, 0, 0}, {1e-4, 0, 0}, {0, 1e-4, 0}, {}, {0, 0, 1e-4}};
    Soup soup = outer;
    std::uint64_t inside = 0;
    const std::size_t last = outer.faces.size();
    // The outer one is convex: a point is inside it when it is behind all of its faces.
    const auto add_bubble = [&](const Vec3& at) {
        double out = -1e9;
        for (std::size_t f = 0; f < last; ++f) {
            const Vec3 &a = outer.vertices[outer.faces[f][0]], &b = outer.vertices[outer.faces[f][1]],
                       &c = outer.vertices[outer.faces[f][2]];
            out = std::max(out, dot(normalized(cross(subtract(b, a), subtract(c, a))), subtract(at, a)));
        }
        if (std::abs(out) < 1e-3)
            return;
        Soup part = bubble;
        for (Vec3& v : part.vertices)
            v = add(v, at);
        append(soup, part);
        inside += out < 0;
    };
    for (std::size_t f = 0; f < last; ++f) {
        const Triple& face = outer.faces[f];
        const Vec3 &a = outer.vertices[face[0]], &b = outer.vertices[face[1]], &c = outer.vertices[face[2]];
        const Vec3 centre = scaled(add(add(a, b), c), 1.0 / 3);
        const Vec3 normal = normalized(cross(subtract(b, a), subtract(c, a)));
        add_bubble(add(centre, scaled(normal, -1e-2)));
        add_bubble(add(centre, scaled(normal, 1e-2)));
        for (std::size_t i = 0; i < 3; ++i) {
            if (face[i] > face[(i + 1) % 3])
                continue; // each edge once
            const Vec3 &from = outer.vertices[face[i]], &to = outer.vertices[face[(i + 1) % 3]];
            for (int k = 1; k < 16; ++k) {
                const Vec3 on_edge = add(from, scaled(subtract(to, from), k / 16.0));
                add_bubble(add(on_edge, {0, 0, on_edge[2] > 0 ? -0.1 * k : 0.1 * k}));
            }
        }
    }
    EXPECT_GT(inside, 1000U);
    EXPECT_EQ(prepared(soup).report.cavities, inside);
}

/// Rays that meet vertices and edges exactly: axis-parallel boxes on a common grid.
TEST(MeshCavities, RaysThroughEdgesAndVerticesCountOnce)
{
    for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
            Soup soup = cube(50);
            // A tetrahedron pair as inner body: centroids of faces lie on the cube's diagonals and middles.
            append(soup, cube(1, {10.0 * x, 10.0 * y, 0}));
            Soup fine = soup;
            EXPECT_EQ(prepared(soup).report.cavities, 1U);
            EXPECT_EQ(prepared(soup, {.split_mm = 7}).report.cavities, 1U);
        }
    }
    Soup soup = globe(50, 8, 6);
    // an octahedron whose faces' centres lie above the globe's meridians
    append(soup, globe(6, 8, 2));
    EXPECT_EQ(prepared(soup).report.cavities, 1U);
}

TEST(MeshCavities, SolidsThatCutOneAnotherAreBothOutward)
{
    Soup soup = globe(50, 24, 16);
    append(soup, cube(10, {42, 0, 0})); // its box is inside the globe's, its corners are not
    const Prepared out = prepared(soup);
    EXPECT_EQ(out.report.cavities, 0U);
    EXPECT_EQ(out.report.components_turned, 0U);
}

TEST(MeshCavities, OpenPartsNeitherHoldNorAreHeld)
{
    Soup soup = cube(50);
    soup.faces.pop_back();
    append(soup, cube(10));
    EXPECT_EQ(prepared(soup).report.cavities, 0U);
    Soup other = cube(50);
    Soup open = cube(10);
    open.faces.pop_back();
    append(other, open);
    EXPECT_EQ(prepared(other).report.cavities, 0U);
}

} // namespace
} // namespace phantom::mesh::test
