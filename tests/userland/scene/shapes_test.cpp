// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>

#include <gtest/gtest.h>

#include "mesh/prepare.hpp"
#include "mesh/vector.hpp"
#include "scene/shapes.hpp"

namespace phantom::scene::test {
namespace {

TEST(SceneShapes, SphereIsClosedOutwardAndFine)
{
    for (const double radius : {0.5, 50.0}) {
        const auto prepared = mesh::prepare(sphere_soup(radius), {}, "sphere");
        ASSERT_TRUE(prepared.ok());
        const mesh::Mesh& sphere = prepared->mesh;
        EXPECT_TRUE(prepared->report.watertight);
        EXPECT_EQ(prepared->report.components_turned, 0U);
        EXPECT_EQ(prepared->report.normals_repaired, 0U);
        EXPECT_EQ(sphere.faces.size(), 5120U);
        for (std::size_t f = 0; f < sphere.faces.size(); ++f) {
            mesh::Vec3 middle{};
            for (std::size_t i = 0; i < 3; ++i) {
                const mesh::Vec3& v = sphere.vertices[sphere.faces[f][i]];
                EXPECT_NEAR(mesh::length(v), radius, 1e-14 * radius);
                EXPECT_LT(mesh::distance(sphere.normals[sphere.face_normals[f][i]], mesh::normalized(v)),
                          1e-15);
                middle = mesh::add(middle, mesh::scaled(v, 1.0 / 3));
            }
            // No point of a face is nearer to the centre than its plane.
            const auto& [a, b, c] = sphere.faces[f];
            const mesh::Vec3 normal =
                mesh::normalized(mesh::cross(mesh::subtract(sphere.vertices[b], sphere.vertices[a]),
                                             mesh::subtract(sphere.vertices[c], sphere.vertices[a])));
            EXPECT_GT(mesh::dot(normal, middle), (1 - 0.0012) * radius);
        }
    }
}

TEST(SceneShapes, BoxIsClosedSharpAndOfItsSize)
{
    const auto prepared = mesh::prepare(box_soup({80, 60, 40}), {}, "box");
    ASSERT_TRUE(prepared.ok());
    EXPECT_TRUE(prepared->report.watertight);
    EXPECT_EQ(prepared->report.components_turned, 0U);
    EXPECT_EQ(prepared->report.crease_edges, 12U);
    EXPECT_EQ(prepared->report.size_mm[0], 80);
    EXPECT_EQ(prepared->report.size_mm[1], 60);
    EXPECT_EQ(prepared->report.size_mm[2], 40);
    for (const mesh::Vec3& normal : prepared->mesh.normals)
        EXPECT_NEAR(std::max({std::abs(normal[0]), std::abs(normal[1]), std::abs(normal[2])}), 1, 1e-15);
}

} // namespace
} // namespace phantom::scene::test
