// SPDX-License-Identifier: GPL-2.0-or-later
// `fdhctl prepare --simplify`: within its bounds.
#include "mesh/simplify.hpp"

#include <set>

#include <gtest/gtest.h>

#include "surfaces.hpp"

namespace phantom::test {
namespace {

using mesh::Vec3;

mesh::Prepared simplified(mesh::Soup soup, const mesh::SimplifyOptions& wanted)
{
    mesh::PrepareOptions options;
    options.simplify = wanted;
    auto result = mesh::prepare(std::move(soup), options, "test");
    EXPECT_TRUE(result) << result.error().text();
    return std::move(*result);
}

TEST(Simplify, StopsAtSoManyFacesAndAccountsForAll)
{
    const auto result = simplified(waves(40), {.faces = 1000});
    EXPECT_LE(result.report.faces, 1000U);
    EXPECT_GE(result.report.faces, 990U);
    EXPECT_EQ(result.report.faces_read, result.report.faces + result.report.faces_simplified);
    EXPECT_EQ(result.report.faults, 0U);
}

TEST(Simplify, KeepsBothSurfacesWithinTheError)
{
    const mesh::Mesh before = prepared(waves(40));
    const auto result = simplified(waves(40), {.error_mm = 0.2});
    EXPECT_LT(result.report.faces, before.faces.size() / 2);
    EXPECT_GT(result.report.simplify_error_mm, 0);
    EXPECT_LE(result.report.simplify_error_mm, 0.2);
    for (const Vec3& vertex : before.vertices)
        EXPECT_LE(distance_to(result.mesh, vertex), 0.2 + 1e-9);
    for (std::size_t f = 0; f < result.mesh.faces.size(); ++f) {
        const auto x = corners(result.mesh, f);
        EXPECT_LE(distance_to(before, mesh::scaled(mesh::add(mesh::add(x[0], x[1]), x[2]), 1.0 / 3)),
                  0.2 + 1e-9);
    }
    EXPECT_NEAR(mesh::bounds_of(result.mesh.vertices).extent(), 100, 1e-12) << "the border's corners";
}

TEST(Simplify, KeepsCreasesAndNormals)
{
    mesh::Soup soup = cut_cube(8);
    const auto result = simplified(soup, {.error_mm = 0.01});
    EXPECT_LT(result.report.faces, 200U);
    EXPECT_TRUE(result.report.watertight);
    EXPECT_EQ(result.report.normals_repaired, 0U);
    for (const Vec3& n : result.mesh.normals)
        EXPECT_NEAR(std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]), 1, 1e-12);
    EXPECT_NEAR(area_mm2(result.mesh), 6 * 1600, 1e-6);
}

TEST(Simplify, KeepsTheOutlineOfAFlatSheet)
{
    const auto result = simplified(sheet(24, [](double, double) { return 0.0; }), {.faces = 100});
    EXPECT_LE(result.report.faces, 120U);
    EXPECT_NEAR(area_mm2(result.mesh), 10000, 1e-6);
}

TEST(Simplify, TurnsNoFaceOverAndMakesNoSlivers)
{
    const auto result = simplified(waves(40), {.faces = 600, .normal_deg = 20, .aspect = 5});
    for (std::size_t f = 0; f < result.mesh.faces.size(); ++f) {
        const auto x = corners(result.mesh, f);
        const Vec3 normal = mesh::cross(mesh::subtract(x[1], x[0]), mesh::subtract(x[2], x[0]));
        EXPECT_GT(normal[2], 0);
        double longest = 0;
        for (std::size_t i = 0; i < 3; ++i)
            longest = std::max(longest, mesh::distance(x[i], x[(i + 1) % 3]));
        EXPECT_LE(longest * longest / mesh::length(normal), 5 * 1.01);
    }
}

TEST(Simplify, OfFileNormalsKeepsThemWhereVerticesStay)
{
    mesh::Soup soup = waves(30);
    for (const Vec3& v : soup.vertices) // not what the faces would give
        soup.normals.push_back(mesh::normalized({v[0] * 1e-3, v[1] * 1e-3, 1}));
    soup.face_normals = soup.faces;
    const auto result = simplified(soup, {.faces = 500});
    EXPECT_EQ(result.report.normals_repaired, 0U);
    for (std::size_t f = 0; f < result.mesh.faces.size(); ++f)
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3& v = result.mesh.vertices[result.mesh.faces[f][i]];
            const Vec3 given = mesh::normalized({v[0] * 1e-3, v[1] * 1e-3, 1});
            EXPECT_LT(mesh::distance(result.mesh.normals[result.mesh.face_normals[f][i]], given), 1e-12);
        }
}

TEST(Simplify, WithBoundsThatNothingMeetsChangesNothing)
{
    const auto result = simplified(waves(10), {.error_mm = 1e-9});
    EXPECT_EQ(result.report.faces, 200U);
    EXPECT_EQ(result.report.faces_simplified, 0U);
    EXPECT_NE(testing::PrintToString(result.report.warnings).find("--simplify-error"), std::string::npos);
}

TEST(Simplify, NeedsARepairedMesh)
{
    mesh::PrepareOptions options;
    options.full = false;
    options.simplify.emplace();
    const auto result = mesh::prepare(waves(3), options, "test");
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().text().find("--simplify"), std::string::npos);
}

} // namespace
} // namespace phantom::test
