// SPDX-License-Identifier: GPL-2.0-or-later
#include "shape_checks.hpp"

#include <gtest/gtest.h>

#include "fdh/scene_tree.hpp"
#include "mesh/prepare.hpp"
#include "mesh/vector.hpp"

namespace phantom::scene::test {

using mesh::Vec3;

namespace {

/// Barycentric coordinates of a face's inside: corners, edges and middle.
std::vector<Vec3> inside_of_face()
{
    constexpr int parts = 6;
    std::vector<Vec3> points;
    for (int i = 0; i <= parts; ++i)
        for (int j = 0; i + j <= parts; ++j)
            points.push_back({static_cast<double>(i) / parts, static_cast<double>(j) / parts,
                              static_cast<double>(parts - i - j) / parts});
    return points;
}

Vec3 face_normal(const mesh::Soup& soup, const mesh::Triple& face)
{
    return mesh::normalized(mesh::cross(mesh::subtract(soup.vertices[face[1]], soup.vertices[face[0]]),
                                        mesh::subtract(soup.vertices[face[2]], soup.vertices[face[0]])));
}

} // namespace

mesh::Soup soup_of(const Shape& shape, std::optional<double> chord_mm)
{
    auto soup = triangulate(shape, chord_mm);
    EXPECT_TRUE(soup.ok()) << soup.error().text();
    return soup.ok() ? *std::move(soup) : mesh::Soup{};
}

double expect_within_chord(const mesh::Soup& soup, const Formula& formula, double chord_mm)
{
    const std::vector<Vec3> inside = inside_of_face();
    const std::size_t stride = 1 + soup.faces.size() / 1200;
    const double allowed = chord_mm * (1 + 1e-9) + 1e-12;
    double farthest = 0;
    for (std::size_t f = 0; f < soup.faces.size(); f += stride) {
        for (const Vec3& b : inside) {
            Vec3 at{};
            for (std::size_t i = 0; i < 3; ++i)
                at = mesh::add(at, mesh::scaled(soup.vertices[soup.faces[f][i]], b[i]));
            farthest = std::max(farthest, formula.distance(at));
        }
    }
    EXPECT_LE(farthest, allowed) << "a face leaves the surface";

    fdh::SceneTree<14> tree;
    tree.add(fdh::TriangleTree<14>::build({soup.vertices, soup.faces}, {.threads = 1}), {});
    tree.update();
    constexpr int samples = 90;
    fdh::Nearest nearest;
    double from_faces = 0;
    for (int i = 0; i <= samples; ++i) {
        for (int j = 0; j <= samples; ++j) {
            const Vec3 at = formula.point(static_cast<double>(i) / samples, static_cast<double>(j) / samples);
            tree.nearest(at, 1, 100 * chord_mm, nearest);
            from_faces = std::max(from_faces, nearest.hits.empty() ? 1e300 : nearest.hits[0].distance);
        }
    }
    EXPECT_LE(from_faces, allowed) << "the surface has a part without faces";
    return std::max(farthest, from_faces);
}

void expect_exact_corners(const mesh::Soup& soup, const Formula& formula, double size_mm)
{
    double off = 0, askew = 0;
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        const Vec3 plane = face_normal(soup, soup.faces[f]);
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3& at = soup.vertices[soup.faces[f][i]];
            off = std::max(off, formula.distance(at));
            askew = std::max(
                askew, mesh::distance(soup.normals[soup.face_normals[f][i]], formula.normal(at, plane)));
        }
    }
    EXPECT_LE(off, 1e-12 * size_mm) << "a corner is not on the surface";
    EXPECT_LE(askew, 1e-12) << "a corner's normal is not the formula's";

    const auto prepared = mesh::prepare(soup, {}, "shape");
    ASSERT_TRUE(prepared.ok()) << prepared.error().text();
    const mesh::Mesh& mesh = prepared->mesh;
    ASSERT_EQ(mesh.faces.size(), soup.faces.size());
    std::size_t changed = 0;
    for (std::size_t f = 0; f < soup.faces.size(); ++f)
        for (std::size_t i = 0; i < 3; ++i)
            changed += mesh.normals[mesh.face_normals[f][i]] != soup.normals[soup.face_normals[f][i]] ||
                       mesh.vertices[mesh.faces[f][i]] != soup.vertices[soup.faces[f][i]];
    EXPECT_EQ(changed, 0U) << "preparation changed corners";
}

void expect_sound(const mesh::Soup& soup, bool closed, std::uint64_t normals_repaired)
{
    const auto prepared = mesh::prepare(soup, {}, "shape");
    ASSERT_TRUE(prepared.ok()) << prepared.error().text();
    const mesh::Report& report = prepared->report;
    EXPECT_EQ(report.watertight, closed);
    EXPECT_EQ(report.rims, closed ? 0U : 1U);
    EXPECT_EQ(report.components, 1U);
    EXPECT_EQ(report.components_turned, 0U);
    EXPECT_EQ(report.faces_flipped, 0U);
    EXPECT_EQ(report.faces_zero_area, 0U);
    EXPECT_EQ(report.faces_duplicate, 0U);
    EXPECT_EQ(report.vertices_welded, 0U);
    EXPECT_EQ(report.vertices, soup.vertices.size()) << "a vertex that no face has";
    EXPECT_EQ(report.normals_repaired, normals_repaired);
    EXPECT_EQ(report.nonmanifold_edges, 0U);
}

} // namespace phantom::scene::test
