// SPDX-License-Identifier: GPL-2.0-or-later
// Corner normals: analytic answers on the cube, the sphere and the cone; what a file gave is kept where it
// fits.
#include <limits>

#include <gtest/gtest.h>

#include "meshes.hpp"

namespace phantom::mesh::test {
namespace {

const Vec3& corner_normal(const Mesh& mesh, std::size_t face, std::size_t corner)
{
    return mesh.normals[mesh.face_normals[face][corner]];
}

TEST(MeshNormals, CubeHasFaceNormals)
{
    const Mesh mesh = prepared(cube(50), {.crease_deg = 60}).mesh;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_LT(distance(corner_normal(mesh, f, i), normal_of(mesh, f)), 1e-15);
    }
    EXPECT_EQ(mesh.normals.size(), 24U); // three at each corner
}

TEST(MeshNormals, CubeWithoutCreaseHasDiagonals)
{
    const Prepared out = prepared(cube(50), {.crease_deg = 120});
    EXPECT_EQ(out.report.crease_edges, 0U);
    EXPECT_EQ(out.mesh.normals.size(), 8U);
    for (std::size_t f = 0; f < out.mesh.faces.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 diagonal = normalized(out.mesh.vertices[out.mesh.faces[f][i]]);
            EXPECT_LT(distance(corner_normal(out.mesh, f, i), diagonal), 1e-15);
        }
    }
}

TEST(MeshNormals, SphereIsSmoothAndRadial)
{
    const Prepared out = prepared(globe(50, 40, 24));
    EXPECT_EQ(out.report.crease_edges, 0U);
    EXPECT_EQ(out.mesh.normals.size(), out.mesh.vertices.size());
    for (std::size_t f = 0; f < out.mesh.faces.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 radial = normalized(out.mesh.vertices[out.mesh.faces[f][i]]);
            EXPECT_LT(angle_between(corner_normal(out.mesh, f, i), radial), 0.01);
        }
    }
}

/// Cutting a flat side into more triangles must not tilt the normals: the point of weighting by angle.
TEST(MeshNormals, DoNotDependOnTheCutOfAFlatSide)
{
    Soup soup = cube(50);
    const Vec3 before = prepared(soup, {.crease_deg = 120}).mesh.normals[0];
    // The first side's corner at vertex 0 lies in two triangles; make it five.
    soup.faces.erase(soup.faces.begin());
    soup.vertices.push_back({-50, 30, -50});
    soup.vertices.push_back({-50 + 1e-3, 50, -50});
    soup.faces.push_back({0, 8, 9});
    soup.faces.push_back({8, 2, 9});
    soup.faces.push_back({0, 9, 3});
    Soup none = soup;
    const Mesh mesh = prepared(none, {.full = false}).mesh;
    EXPECT_LT(angle_between(mesh.normals[0], before), 1e-4);
}

TEST(MeshNormals, ConeApexIsOneGroupAndItsRimIsSharp)
{
    Soup soup;
    constexpr std::uint32_t sides = 36;
    soup.vertices = {{0, 0, 50}, {0, 0, 0}};
    for (std::uint32_t i = 0; i < sides; ++i) {
        const double t = 2 * std::numbers::pi * i / sides;
        soup.vertices.push_back({30 * std::cos(t), 30 * std::sin(t), 0});
    }
    for (std::uint32_t i = 0; i < sides; ++i) {
        const std::uint32_t a = 2 + i, b = 2 + (i + 1) % sides;
        soup.faces.push_back({a, b, 0});
        soup.faces.push_back({b, a, 1});
    }
    const Prepared out = prepared(soup);
    EXPECT_EQ(out.report.crease_edges, sides);
    for (std::uint32_t f = 0; f < 2 * sides; f += 2) {
        EXPECT_LT(distance(corner_normal(out.mesh, f, 2), {0, 0, 1}), 1e-12);
        EXPECT_LT(distance(corner_normal(out.mesh, f + 1, 0), {0, 0, -1}), 1e-12);
    }
}

TEST(MeshNormals, NeighboursShareTheNormalsOfTheirEdge)
{
    const Mesh mesh = prepared(globe(50, 12, 8)).mesh;
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t other = mesh.neighbours[f][i];
            ASSERT_NE(other, no_neighbour);
            for (std::size_t j = 0; j < 3; ++j) {
                if (mesh.faces[other][j] == mesh.faces[f][i]) {
                    EXPECT_EQ(mesh.face_normals[other][j], mesh.face_normals[f][i]);
                }
            }
        }
    }
}

/// A closed fan folded flat: the normals round the middle cancel exactly.
TEST(MeshNormals, CancelledNormalsBecomeTheFacesOwn)
{
    Soup soup;
    soup.vertices = {{0, 0, 0}, {30, 0, 0}, {0, 30, 0}};
    soup.faces = {{0, 1, 2}, {0, 2, 1}};
    const Prepared out = prepared(soup, {.crease_deg = 180});
    EXPECT_EQ(out.report.normals_repaired, 6U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(corner_normal(out.mesh, 0, i), (Vec3{0, 0, 1}));
        EXPECT_EQ(corner_normal(out.mesh, 1, i), (Vec3{0, 0, -1}));
    }
}

TEST(MeshNormals, FileNormalsAreKeptWhereTheyFitTheFace)
{
    Soup soup = globe(50, 12, 8);
    for (const Vec3& v : soup.vertices)
        soup.normals.push_back(normalized(v));
    soup.face_normals = soup.faces;
    const Prepared out = prepared(soup);
    EXPECT_EQ(out.report.normals_repaired, 0U);
    for (std::size_t f = 0; f < out.mesh.faces.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_EQ(corner_normal(out.mesh, f, i), soup.normals[soup.faces[f][i]]);
    }
}

TEST(MeshNormals, BadFileNormalsAreRepairedAndCounted)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Vec3& bad : {Vec3{0, 0, 0}, Vec3{nan, 0, 0}, Vec3{0, 0, -1}}) {
        Soup soup = sheet(4, 4);
        soup.normals.assign(soup.vertices.size(), Vec3{0, 0, 1});
        soup.normals[12] = bad; // the middle one, of six corners
        soup.face_normals = soup.faces;
        const Prepared out = prepared(soup);
        EXPECT_EQ(out.report.normals_repaired, 6U);
        for (const Vec3& normal : out.mesh.normals)
            EXPECT_LT(distance(normal, {0, 0, 1}), 1e-15);
    }
}

/// Solid and normals inside out together: the formula's normals survive, turned over.
TEST(MeshNormals, FileNormalsOfASolidInsideOutAreTurnedWithIt)
{
    Soup soup = globe(50, 12, 8);
    for (const Vec3& v : soup.vertices)
        soup.normals.push_back(scaled(normalized(v), -1));
    for (std::size_t f = 0; f < soup.faces.size(); ++f)
        turn(soup, f);
    soup.face_normals = soup.faces;
    const Prepared out = prepared(soup);
    EXPECT_EQ(out.report.normals_repaired, 3 * soup.faces.size());
    for (std::size_t f = 0; f < out.mesh.faces.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_EQ(corner_normal(out.mesh, f, i), normalized(out.mesh.vertices[out.mesh.faces[f][i]]));
    }
}

TEST(MeshNormals, SmoothingGroupsDecideWhereBothFacesHaveOne)
{
    Soup soup = cube(50);
    soup.smoothing.assign(12, 7);
    EXPECT_EQ(prepared(soup).report.crease_edges, 0U); // however sharp
    soup.smoothing[0] = soup.smoothing[1] = 8;         // one side
    EXPECT_EQ(prepared(soup).report.crease_edges, 4U);
    soup.smoothing.assign(12, 0); // none: by the angle
    EXPECT_EQ(prepared(soup).report.crease_edges, 12U);
    EXPECT_EQ(prepared(soup, {.crease_deg = 180}).report.crease_edges, 0U);
    soup.smoothing.assign(12, 1);
    soup.smoothing[0] = 2; // across its own side's diagonal too
    EXPECT_EQ(prepared(soup, {.crease_deg = 180}).report.crease_edges, 3U);
    // and they go with their faces through every step
    soup = cube(50);
    soup.smoothing.assign(12, 7);
    soup.faces.insert(soup.faces.begin(), {0, 0, 1});
    soup.smoothing.insert(soup.smoothing.begin(), 3);
    EXPECT_EQ(prepared(soup, {.split_mm = 40}).report.crease_edges, 0U);
}

TEST(MeshNormals, NothingPassesOverANonManifoldEdge)
{
    // Three half-planes that meet in the y axis, 120 degrees apart.
    Soup soup;
    soup.vertices = {{0, 0, 0}, {0, 50, 0}};
    for (int k = 0; k < 3; ++k) {
        const double t = 2 * std::numbers::pi * k / 3;
        soup.vertices.push_back({50 * std::cos(t), 0, 50 * std::sin(t)});
        soup.faces.push_back({0, 1, static_cast<std::uint32_t>(k + 2)});
    }
    const Prepared out = prepared(soup, {.crease_deg = 180});
    EXPECT_EQ(out.report.nonmanifold_edges, 1U);
    for (std::size_t f = 0; f < 3; ++f) {
        EXPECT_EQ(out.mesh.neighbours[f], (Triple{no_neighbour, no_neighbour, no_neighbour}));
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_LT(distance(corner_normal(out.mesh, f, i), normal_of(out.mesh, f)), 1e-15);
    }
}

} // namespace
} // namespace phantom::mesh::test
