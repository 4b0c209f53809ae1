// SPDX-License-Identifier: GPL-2.0-or-later
// Cracks and T-junctions: what looks closed is closed, and nothing else.
#include <gtest/gtest.h>

#include "meshes.hpp"

namespace phantom::mesh::test {
namespace {

/// Two rectangles side by side in the plane z = 0: the left one's side at x = 0 is cut into `left` edges, the
/// right one's into `right`; `crooked` moves the left one's inner vertices by that much along x.
Soup seam(std::uint32_t left, std::uint32_t right, double crooked = 0)
{
    Soup soup;
    for (const auto& [count, far] : {std::pair{left, -40.0}, std::pair{right, 40.0}}) {
        const auto base = static_cast<std::uint32_t>(soup.vertices.size());
        soup.vertices.push_back({far, 0, 0});
        soup.vertices.push_back({far, 60, 0});
        for (std::uint32_t i = 0; i <= count; ++i)
            soup.vertices.push_back({i > 0 && i < count && far < 0 ? crooked : 0.0, 60.0 * i / count, 0});
        const auto add_face = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            if (far < 0)
                soup.faces.push_back({base + a, base + b, base + c});
            else
                soup.faces.push_back({base + a, base + c, base + b});
        };
        for (std::uint32_t i = 0; i < count; ++i)
            add_face(0, 2 + i, 3 + i);
        add_face(0, 2 + count, 1);
    }
    return soup;
}

/// Edges of the whole outline: four sides, of which the two short ends of the seam are not on it.
constexpr std::uint64_t outline = 6;

TEST(MeshStitch, AJunctionIsCutIntoTheLongerEdge)
{
    const Prepared out = prepared(seam(1, 2));
    EXPECT_EQ(out.report.t_junctions, 1U);
    EXPECT_EQ(out.report.faces_cut, 1U);
    EXPECT_EQ(out.report.boundary_edges, outline);
    EXPECT_EQ(out.report.components, 1U);
    EXPECT_EQ(out.report.faces, 6U);
    EXPECT_EQ(out.report.moved_max_mm, 0);
    EXPECT_NEAR(area(out.mesh.vertices.to_vector(), out.mesh.faces.to_vector()), 4800, 1e-9);
}

TEST(MeshStitch, EdgesThatOverlapInPartAreCutOnBothSides)
{
    for (std::uint32_t left = 1; left <= 7; ++left) {
        for (std::uint32_t right = 1; right <= 7; ++right) {
            const Prepared out = prepared(seam(left, right));
            EXPECT_EQ(out.report.boundary_edges, outline) << left << " " << right;
            EXPECT_EQ(out.report.components, 1U);
            EXPECT_EQ(out.report.rims, 1U);
        }
    }
}

TEST(MeshStitch, WithinTheToleranceOnly)
{
    // The mesh is 100 mm across its diagonal: a millionth of it is 0.1 um.
    const Prepared near = prepared(seam(3, 1, 0.9e-4));
    EXPECT_EQ(near.report.boundary_edges, outline);
    EXPECT_NEAR(near.report.moved_max_mm, 0.9e-4, 1e-12);
    const Prepared far = prepared(seam(3, 1, 1.1e-4));
    EXPECT_EQ(far.report.t_junctions, 0U);
    EXPECT_EQ(far.report.boundary_edges, outline + 4);
    const Prepared welded = prepared(seam(3, 1, 0.09), {.weld_mm = 0.1});
    EXPECT_EQ(welded.report.boundary_edges, outline);
    EXPECT_NEAR(welded.report.moved_max_mm, 0.09, 1e-12);
}

TEST(MeshStitch, CracksAreSewn)
{
    for (const double gap : {1e-5, 0.9e-4, 1.1e-4}) {
        Soup soup = seam(4, 4);
        for (Vec3& v : soup.vertices) {
            if (v[0] > 0) // all of the right half is its far side and what comes after it
                break;
        }
        for (std::size_t v = 7; v < soup.vertices.size(); ++v)
            soup.vertices[v][2] += gap;
        const Prepared out = prepared(soup);
        const bool near = gap < 1e-4;
        EXPECT_EQ(out.report.boundary_edges, near ? outline : outline + 8) << gap;
        EXPECT_EQ(out.report.vertices_sewn, near ? 5U : 0U);
        EXPECT_NEAR(out.report.moved_max_mm, near ? gap : 0, 1e-12);
    }
}

TEST(MeshStitch, ABoxOfUnevenSidesBecomesWatertightAndOutward)
{
    // Every side on its own, cut into cells of its own number: junctions on all twelve edges.
    for (const bool inside_out : {false, true}) {
        Soup soup;
        for (std::uint32_t side = 0; side < 6; ++side) {
            const std::uint32_t axis = side / 2, cells = 2 + side;
            const double at = side % 2 ? 50 : -50;
            Soup part;
            for (std::uint32_t j = 0; j <= cells; ++j) {
                for (std::uint32_t i = 0; i <= cells; ++i) {
                    Vec3 v{};
                    v[axis] = at;
                    v[(axis + 1) % 3] = -50 + 100.0 * i / cells;
                    v[(axis + 2) % 3] = -50 + 100.0 * j / cells;
                    part.vertices.push_back(v);
                }
            }
            for (std::uint32_t j = 0; j < cells; ++j) {
                for (std::uint32_t i = 0; i < cells; ++i) {
                    const std::uint32_t a = j * (cells + 1) + i, c = a + cells + 1;
                    part.faces.push_back({a, a + 1, c + 1});
                    part.faces.push_back({a, c + 1, c});
                }
            }
            for (std::size_t f = 0; f < part.faces.size(); ++f) {
                if ((side % 2 == 0) != inside_out)
                    turn(part, f);
            }
            append(soup, part);
        }
        const Prepared out = prepared(soup);
        EXPECT_TRUE(out.report.watertight);
        EXPECT_EQ(out.report.components, 1U);
        EXPECT_EQ(out.report.components_turned, inside_out ? 1U : 0U);
        EXPECT_NEAR(signed_volume(out.mesh.vertices.to_vector(), out.mesh.faces.to_vector()), 1e6, 1e-3);
        const Prepared again = prepared(soup_of(out.mesh));
        EXPECT_EQ(again.mesh.faces, out.mesh.faces);
        EXPECT_EQ(again.mesh.vertices, out.mesh.vertices);
        EXPECT_EQ(again.mesh.normals, out.mesh.normals);
    }
}

TEST(MeshStitch, NormalsOfTheFileAreInterpolated)
{
    Soup soup = seam(1, 3);
    for (const Vec3& v : soup.vertices)
        soup.normals.push_back(normalized({v[0], v[1] - 30, 100}));
    soup.face_normals = soup.faces;
    const Prepared out = prepared(soup);
    EXPECT_EQ(out.report.normals_repaired, 0U);
    for (std::size_t f = 0; f < out.mesh.faces.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3& v = out.mesh.vertices[out.mesh.faces[f][i]];
            EXPECT_LT(
                distance(out.mesh.normals[out.mesh.face_normals[f][i]], normalized({v[0], v[1] - 30, 100})),
                1e-12);
        }
    }
}

TEST(MeshStitch, ACornerThatOnlyTouchesAnEdgeCutsNothing)
{
    Soup soup;
    soup.vertices = {{0, 0, 0}, {40, 0, 0}, {20, -30, 0}, {20, 0, 0}, {30, 0, 30}, {10, 0, 30}};
    soup.faces = {{0, 1, 2}, {3, 4, 5}};
    const Prepared out = prepared(soup);
    EXPECT_EQ(out.report.t_junctions, 0U);
    EXPECT_EQ(out.report.faces, 2U);
}

TEST(MeshStitch, SmallDetailIsNotSewnTogether)
{
    // A sheet of 0.01 um beside one of 100 mm: finer than a millionth of the whole.
    Soup soup = sheet(10, 10);
    Soup tiny = sheet(2, 2);
    for (Vec3& v : tiny.vertices)
        v = add(scaled(v, 5e-7), {200, 0, 0});
    append(soup, tiny);
    const Prepared out = prepared(soup);
    EXPECT_EQ(out.report.vertices_sewn, 0U);
    EXPECT_EQ(out.report.faces, 208U);
    // nor with a large one right beside it, whichever comes first
    for (Vec3& v : tiny.vertices)
        v[0] -= 200 - 100 - 2e-5;
    for (const auto& [first, second] : {std::pair{sheet(10, 10), tiny}, std::pair{tiny, sheet(10, 10)}}) {
        Soup both = first;
        append(both, second);
        EXPECT_EQ(prepared(both).report.vertices_sewn, 0U);
    }
}

/// Each is near the next, the last is far from the first.
TEST(MeshStitch, AChainOfVerticesIsNotDrawnTogether)
{
    Soup soup;
    for (int i = 0; i < 3; ++i) {
        const Vec3 at = {0.6e-4 * i, 0, 0};
        for (const Vec3& v : {Vec3{0, 0, 0}, Vec3{40.0 * i - 50, 40, 0}, Vec3{40.0 * i - 20, 40, 10}})
            soup.vertices.push_back(add(at, v));
        const auto base = static_cast<std::uint32_t>(3 * i);
        soup.faces.push_back({base, base + 1, base + 2});
    }
    const Prepared out = prepared(soup);
    EXPECT_EQ(out.report.vertices_sewn, 1U);
    EXPECT_NEAR(out.report.moved_max_mm, 0.6e-4, 1e-12);
}

} // namespace
} // namespace phantom::mesh::test
