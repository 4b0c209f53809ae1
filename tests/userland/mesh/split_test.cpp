// SPDX-License-Identifier: GPL-2.0-or-later
// Bisection: no edge too long, no T-junction, the same surface.
#include <gtest/gtest.h>

#include "meshes.hpp"

namespace phantom::mesh::test {
namespace {

/// A vertex in the inside of an edge that does not end there.
bool has_t_junction(const Mesh& mesh)
{
    for (const auto& [edge, faces] : edges_of(mesh.faces)) {
        const Vec3 &a = mesh.vertices[edge.first], &b = mesh.vertices[edge.second];
        for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
            if (mesh.vertices[v] == a || mesh.vertices[v] == b)
                continue;
            const double around = distance(a, mesh.vertices[v]) + distance(mesh.vertices[v], b);
            if (around - distance(a, b) < 1e-9)
                return true;
        }
    }
    return false;
}

TEST(MeshSplit, NoEdgeIsTooLong)
{
    for (const double split_mm : {90.0, 40.0, 17.0}) {
        const Prepared out = prepared(cube(50), {.split_mm = split_mm});
        EXPECT_LE(out.report.edge_max_mm, split_mm);
        EXPECT_EQ(out.report.faces, 12 + out.report.faces_split);
        EXPECT_GT(out.report.faces_split, 0U);
    }
}

TEST(MeshSplit, NoTJunctions)
{
    const Soup half = sheet(3, 2);
    Soup uneven = cube(50); // one finely cut side beside coarse ones
    const Prepared fine = prepared(uneven, {.split_mm = 30});
    EXPECT_FALSE(has_t_junction(fine.mesh));
    EXPECT_TRUE(fine.report.watertight);
    EXPECT_FALSE(has_t_junction(prepared(half, {.split_mm = 6}).mesh));
    EXPECT_FALSE(has_t_junction(prepared(globe(50, 9, 6), {.split_mm = 12}).mesh));
}

TEST(MeshSplit, KeepsAreaVolumeAndSense)
{
    const Prepared out = prepared(cube(50), {.split_mm = 13});
    EXPECT_NEAR(area(out.mesh.vertices, out.mesh.faces), 60000, 1e-6);
    EXPECT_NEAR(signed_volume(out.mesh.vertices, out.mesh.faces), 1e6, 1e-4);
}

TEST(MeshSplit, SplitsEveryFaceOfANonManifoldEdge)
{
    Soup soup;
    soup.vertices = {{0, 0, 0}, {0, 50, 0}};
    for (int k = 0; k < 3; ++k) {
        const double t = 2 * std::numbers::pi * k / 3;
        soup.vertices.push_back({20 * std::cos(t), 25, 20 * std::sin(t)});
        soup.faces.push_back({0, 1, static_cast<std::uint32_t>(k + 2)});
    }
    const Prepared out = prepared(soup, {.split_mm = 40});
    EXPECT_EQ(out.report.faces, 6U);
    EXPECT_EQ(out.report.nonmanifold_edges, 2U);
    EXPECT_FALSE(has_t_junction(out.mesh));
}

TEST(MeshSplit, ChildrenTakeTheirParentsPlace)
{
    const Mesh mesh = prepared(cube(50), {.split_mm = 50}).mesh;
    // Sides come in pairs of faces in cube(): the normals must come in the same order.
    std::vector<Vec3> sides;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        if (sides.empty() || distance(sides.back(), normal_of(mesh, f)) > 1e-9)
            sides.push_back(normal_of(mesh, f));
    }
    EXPECT_EQ(sides.size(), 6U);
}

TEST(MeshSplit, InterpolatesTheNormalsOfTheFile)
{
    Soup soup = globe(50, 12, 8);
    for (const Vec3& v : soup.vertices)
        soup.normals.push_back(normalized(v));
    soup.face_normals = soup.faces;
    const Prepared out = prepared(soup, {.split_mm = 10});
    EXPECT_EQ(out.report.normals_repaired, 0U);
    for (std::size_t f = 0; f < out.mesh.faces.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 radial = normalized(out.mesh.vertices[out.mesh.faces[f][i]]);
            EXPECT_LT(angle_between(out.mesh.normals[out.mesh.face_normals[f][i]], radial), 0.02);
        }
    }
}

TEST(MeshSplit, TooManyFacesAreRefusedBeforeTheyAreMade)
{
    const auto out = prepare(cube(500), {.split_mm = 1e-3}, "cube.ply");
    ASSERT_FALSE(out.ok());
    EXPECT_EQ(out.error().where, "cube.ply");
    EXPECT_NE(out.error().text().find("--split"), std::string::npos);
}

} // namespace
} // namespace phantom::mesh::test
