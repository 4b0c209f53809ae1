// SPDX-License-Identifier: GPL-2.0-or-later
// Preparation: nothing is lost silently, orientation and adjacency are what brute force says.
#include <limits>

#include <gtest/gtest.h>

#include "meshes.hpp"

namespace phantom::mesh::test {
namespace {

/// Every input face is in the result or in one dropped count; all normals are unit; neighbours are right.
void expect_sound(const Prepared& out)
{
    const Report& report = out.report;
    EXPECT_EQ(report.faces_read, report.faces - report.faces_split - report.faces_cut +
                                     report.faces_zero_area + report.faces_duplicate +
                                     report.faces_nonfinite);
    const Mesh& mesh = out.mesh;
    EXPECT_EQ(report.faces, mesh.faces.size());
    EXPECT_EQ(report.vertices, mesh.vertices.size());
    ASSERT_EQ(mesh.face_normals.size(), mesh.faces.size());
    ASSERT_EQ(mesh.neighbours.size(), mesh.faces.size());
    for (const Vec3& normal : mesh.normals)
        ASSERT_NEAR(length(normal), 1, 1e-12);
    const auto edges = edges_of(mesh.faces);
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i) {
            ASSERT_GT(dot(mesh.normals[mesh.face_normals[f][i]], normal_of(mesh, f)), 0) << "face " << f;
            const std::uint32_t a = mesh.faces[f][i], b = mesh.faces[f][(i + 1) % 3];
            const auto& on_edge = edges.at({std::min(a, b), std::max(a, b)});
            std::uint32_t expected = no_neighbour;
            if (on_edge.size() == 2) {
                const std::uint32_t other = on_edge[0] == f ? on_edge[1] : on_edge[0];
                for (std::size_t j = 0; j < 3; ++j) {
                    if (mesh.faces[other][j] == b && mesh.faces[other][(j + 1) % 3] == a)
                        expected = other;
                }
            }
            ASSERT_EQ(mesh.neighbours[f][i], expected) << "face " << f << " edge " << i;
        }
    }
}

/// All the defects at once: two unwelded solids, flipped and duplicated faces, slivers, a fin, a loose sheet.
Soup messy()
{
    Soup soup = unwelded(globe(40, 10, 7));
    for (const Soup& part : {unwelded(cube(10, {100, 0, 0})), sheet(3, 2)})
        append(soup, part);
    turn(soup, 3);
    turn(soup, 50);
    soup.faces.push_back(soup.faces[7]);                                          // duplicate
    soup.faces.push_back({soup.faces[7][1], soup.faces[7][2], soup.faces[7][0]}); // the same, rotated
    soup.faces.push_back({soup.faces[9][0], soup.faces[9][0], soup.faces[9][1]}); // two corners equal
    const auto base = static_cast<std::uint32_t>(soup.vertices.size());
    soup.vertices.insert(soup.vertices.end(), {{0, 0, 200}, {1, 1, 200}, {3, 3, 200}}); // collinear
    soup.faces.push_back({base, base + 1, base + 2});
    soup.vertices.push_back({0, 0, 90});
    soup.faces.push_back({soup.faces[20][0], soup.faces[20][1], base + 3}); // a fin: three faces on an edge
    return soup;
}

TEST(MeshPrepare, EveryFaceIsKeptOrCounted)
{
    const Prepared out = prepared(messy());
    expect_sound(out);
    EXPECT_EQ(out.report.faces_zero_area, 2U);
    EXPECT_EQ(out.report.faces_duplicate, 2U);
    EXPECT_EQ(out.report.faces_flipped, 2U);
    EXPECT_EQ(out.report.nonmanifold_edges, 1U);
    EXPECT_FALSE(out.report.watertight);
    EXPECT_EQ(out.report.warnings.size(), 4U); // open, non-manifold, zero area, duplicates
}

TEST(MeshPrepare, Idempotent)
{
    for (const double weld_mm : {0.0, 0.5}) {
        for (const double split_mm : {0.0, 15.0}) {
            const PrepareOptions options{.fit_mm = 120, .weld_mm = weld_mm, .split_mm = split_mm};
            const Prepared once = prepared(messy(), options);
            expect_sound(once);
            const Prepared twice = prepared(soup_of(once.mesh), options);
            EXPECT_EQ(twice.mesh.vertices, once.mesh.vertices);
            EXPECT_EQ(twice.mesh.faces, once.mesh.faces);
            EXPECT_EQ(twice.mesh.neighbours, once.mesh.neighbours);
            EXPECT_EQ(twice.mesh.normals, once.mesh.normals);
            EXPECT_EQ(twice.mesh.face_normals, once.mesh.face_normals);
            // what was separated is welded, and separated again
            EXPECT_EQ(twice.report.vertices_welded, once.report.vertices_separated);
            EXPECT_EQ(twice.report.faces_zero_area + twice.report.faces_duplicate +
                          twice.report.faces_flipped + twice.report.components_turned +
                          twice.report.faces_split,
                      0U);
        }
    }
}

/// Welding can leave a face without area, and its corners without a face.
TEST(MeshPrepare, VerticesOfFacesDroppedAfterWeldingAreDroppedToo)
{
    Soup soup = cube(50);
    soup.vertices.insert(soup.vertices.begin(), {{200, 0, 0}, {200.1, 0, 0}, {200, 0.1, 0}});
    for (Triple& face : soup.faces) {
        for (std::uint32_t& v : face)
            v += 3;
    }
    soup.faces.push_back({0, 1, 2});
    const Prepared out = prepared(soup, {.weld_mm = 0.5});
    expect_sound(out);
    EXPECT_EQ(out.report.faces_zero_area, 1U);
    EXPECT_EQ(out.report.vertices, 8U);
    EXPECT_NEAR(out.report.size_mm[0], 100, 1e-12);
}

TEST(MeshPrepare, UnweldedSolidBecomesWatertight)
{
    const Prepared out = prepared(unwelded(globe(50, 16, 9)));
    expect_sound(out);
    EXPECT_TRUE(out.report.watertight);
    EXPECT_EQ(out.report.boundary_edges, 0U);
    EXPECT_EQ(out.report.components, 1U);
    // Euler: V - E + F = 2, with E = 3 F / 2.
    EXPECT_EQ(2 * out.report.vertices, out.report.faces + 4);
}

TEST(MeshPrepare, WatertightStaysWatertight)
{
    for (const double split_mm : {0.0, 7.0}) {
        const Prepared out = prepared(globe(50, 16, 9), {.split_mm = split_mm});
        expect_sound(out);
        EXPECT_TRUE(out.report.watertight);
    }
}

TEST(MeshPrepare, OrderOfFacesAndVerticesIsKept)
{
    const Soup given = globe(50, 16, 9);
    const Prepared out = prepared(given);
    EXPECT_EQ(out.mesh.faces, given.faces);
    EXPECT_EQ(out.mesh.vertices, given.vertices);
    Soup flawed = given;
    flawed.faces.insert(flawed.faces.begin() + 5, {4, 4, 9});
    flawed.faces.insert(flawed.faces.begin() + 30, flawed.faces[2]);
    EXPECT_EQ(prepared(flawed).mesh.faces, given.faces);
}

TEST(MeshPrepare, FlippedFacesAreTurnedBack)
{
    const Soup given = globe(50, 16, 9);
    std::mt19937 random(3);
    for (int round = 0; round < 10; ++round) {
        Soup soup = given;
        std::uint64_t turned = 0;
        for (std::size_t f = 0; f < soup.faces.size(); ++f) {
            if (random() % 3 == 0) {
                turn(soup, f);
                ++turned;
            }
        }
        const Prepared out = prepared(soup);
        EXPECT_EQ(out.report.faces_flipped, turned);
        EXPECT_GT(signed_volume(out.mesh.vertices, out.mesh.faces), 0);
        EXPECT_TRUE(out.report.watertight);
    }
}

TEST(MeshPrepare, InsideOutSolidsAreTurnedOutward)
{
    // Two solids, one inside out, far from the origin so that the sign must not drown in rounding.
    Soup soup = cube(1, {1e6, 1e6, 1e6});
    const Soup second = cube(1, {1e6 + 10, 1e6, 1e6});
    for (const Triple& f : second.faces)
        soup.faces.push_back({f[0] + 8, f[2] + 8, f[1] + 8});
    soup.vertices.insert(soup.vertices.end(), second.vertices.begin(), second.vertices.end());
    const Prepared out = prepared(soup);
    expect_sound(out);
    EXPECT_EQ(out.report.components, 2U);
    EXPECT_EQ(out.report.components_turned, 1U);
    for (std::uint32_t f = 0; f < out.mesh.faces.size(); ++f) {
        const Vec3 centre = {1e6 + (f < 12 ? 0 : 10), 1e6, 1e6};
        EXPECT_GT(dot(normal_of(out.mesh, f), subtract(out.mesh.vertices[out.mesh.faces[f][0]], centre)), 0);
    }
}

TEST(MeshPrepare, SolidsThatShareAnEdgeAreBothOutward)
{
    // Two cubes, one inside out, with one edge in common: four faces on it, so no neighbours across.
    Soup soup = cube(10);
    const Soup second = cube(10, {20, 20, 0});
    for (const Triple& f : second.faces)
        soup.faces.push_back({f[0] + 8, f[2] + 8, f[1] + 8});
    soup.vertices.insert(soup.vertices.end(), second.vertices.begin(), second.vertices.end());
    const Prepared out = prepared(soup);
    expect_sound(out);
    EXPECT_EQ(out.report.nonmanifold_edges, 1U);
    EXPECT_EQ(out.report.components, 2U);
    EXPECT_EQ(out.report.components_turned, 1U);
    EXPECT_NEAR(signed_volume(out.mesh.vertices, out.mesh.faces), 2 * 8000, 1e-6);
}

TEST(MeshPrepare, OpenSheetKeepsItsSide)
{
    Soup up = sheet(4, 3);
    const Prepared out = prepared(up);
    EXPECT_EQ(out.report.faces_flipped, 0U);
    EXPECT_EQ(out.report.boundary_edges, 14U);
    EXPECT_EQ(normal_of(out.mesh, 0), (Vec3{0, 0, 1}));
    for (std::size_t f = 0; f < up.faces.size(); ++f)
        turn(up, f);
    EXPECT_EQ(normal_of(prepared(up).mesh, 0), (Vec3{0, 0, -1}));
}

TEST(MeshPrepare, MoebiusStripEndsAndIsReported)
{
    const Prepared out = prepared(moebius(40));
    expect_sound(out);
    EXPECT_EQ(out.report.components, 1U);
    EXPECT_EQ(out.report.unorientable_edges, 1U);
    EXPECT_FALSE(out.report.watertight);
}

TEST(MeshPrepare, UnorientableStripsAreIdempotentToo)
{
    std::mt19937 random(5);
    for (int round = 0; round < 20; ++round) {
        Soup soup = moebius(40);
        for (std::size_t f = 0; f < soup.faces.size(); ++f) {
            if (random() % 2)
                turn(soup, f);
        }
        const Prepared once = prepared(soup);
        EXPECT_EQ(once.report.unorientable_edges, 1U);
        const Prepared twice = prepared(soup_of(once.mesh));
        EXPECT_EQ(twice.mesh.faces, once.mesh.faces);
        EXPECT_EQ(twice.report.faces_flipped, 0U);
    }
}

TEST(MeshPrepare, OppositeCoincidentFacesAreBothKept)
{
    Soup soup;
    soup.vertices = {{0, 0, 0}, {30, 0, 0}, {0, 30, 0}};
    soup.faces = {{0, 1, 2}, {0, 2, 1}};
    const Prepared out = prepared(soup);
    expect_sound(out);
    EXPECT_EQ(out.mesh.faces.size(), 2U);
    EXPECT_EQ(out.report.components_turned, 0U);
}

TEST(MeshPrepare, WeldJoinsWithinTheDistanceOnly)
{
    Soup soup = unwelded(cube(50));
    std::mt19937 random(4);
    std::uniform_real_distribution<double> jitter(-0.02, 0.02);
    for (Vec3& v : soup.vertices)
        v = add(v, {jitter(random), jitter(random), jitter(random)});
    EXPECT_EQ(prepared(soup, {.weld_mm = 0}).report.vertices, 36U);
    const Prepared welded = prepared(soup, {.weld_mm = 0.1});
    expect_sound(welded);
    EXPECT_EQ(welded.report.vertices, 8U);
    EXPECT_EQ(welded.report.vertices_welded, 28U);
    EXPECT_TRUE(welded.report.watertight);
}

TEST(MeshPrepare, WeldTakesNegativeZeroForZero)
{
    Soup soup;
    soup.vertices = {{0, 0, 0}, {30, 0, 0}, {0, 30, 0}, {-0.0, 0, -0.0}, {30, -0.0, 0}, {0, -30, 0}};
    soup.faces = {{0, 1, 2}, {3, 5, 4}};
    EXPECT_EQ(prepared(soup).report.vertices_welded, 2U);
}

TEST(MeshPrepare, SliversWithAreaAreKept)
{
    for (const double height : {1e-1, 1e-4, 1e-7}) {
        Soup soup;
        soup.vertices = {{0, 0, 0}, {100, 0, 0}, {50, height, 0}, {50, -50, 0}};
        soup.faces = {{0, 1, 2}, {1, 0, 3}};
        const Prepared out = prepared(soup);
        expect_sound(out);
        EXPECT_EQ(out.report.faces, 2U) << height;
    }
}

TEST(MeshPrepare, FacesWithoutFiniteCornersAreDroppedAndCounted)
{
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        Soup soup = cube(50);
        soup.vertices[7][0] = bad;
        const Prepared out = prepared(soup, {.fit_mm = 50});
        expect_sound(out);
        EXPECT_GT(out.report.faces_nonfinite, 0U);
    }
}

TEST(MeshPrepare, NoUsableFaceIsAnError)
{
    Soup soup;
    soup.vertices = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
    soup.faces = {{0, 1, 2}, {0, 0, 1}};
    const auto out = prepare(soup, {}, "flat.ply");
    ASSERT_FALSE(out.ok());
    EXPECT_EQ(out.error().text(), "flat.ply: has no usable face: 2 without area, 0 not finite, of 2");
}

TEST(MeshPrepare, ScaleComesBeforeFit)
{
    const Prepared scaled = prepared(cube(0.05), {.scale = 1000});
    EXPECT_NEAR(scaled.report.size_mm[0], 100, 1e-12);
    const Prepared fitted = prepared(cube(0.05, {7, 8, 9}), {.scale = 1000, .fit_mm = 60, .weld_mm = 1});
    expect_sound(fitted);
    const Bounds bounds = bounds_of(fitted.mesh.vertices);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(bounds.low[axis], -30, 1e-9);
        EXPECT_NEAR(bounds.high[axis], 30, 1e-9);
    }
}

TEST(MeshPrepare, FitIgnoresVerticesThatNoFaceUses)
{
    Soup soup = cube(1);
    soup.vertices.push_back({1e8, 0, 0});
    EXPECT_NEAR(prepared(soup, {.fit_mm = 100}).report.size_mm[0], 100, 1e-9);
}

TEST(MeshPrepare, SizeWarningsNameTheOptions)
{
    const auto small = prepared(cube(0.075)).report.warnings;
    ASSERT_EQ(small.size(), 1U);
    EXPECT_NE(small[0].find("--unit"), std::string::npos);
    EXPECT_NE(small[0].find("--fit"), std::string::npos);
    const auto large = prepared(cube(600)).report.warnings;
    ASSERT_EQ(large.size(), 1U);
    EXPECT_NE(large[0].find("--unit"), std::string::npos);
    EXPECT_TRUE(prepared(cube(50)).report.warnings.empty());
}

TEST(MeshPrepare, BadOptionsAreRefused)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const PrepareOptions& options :
         {PrepareOptions{.scale = 0}, PrepareOptions{.scale = nan}, PrepareOptions{.fit_mm = -1},
          PrepareOptions{.weld_mm = nan}, PrepareOptions{.crease_deg = 181}, PrepareOptions{.split_mm = -2}})
        EXPECT_FALSE(prepare(cube(), options, "test").ok());
}

TEST(MeshPrepare, EdgeLengthsOfACube)
{
    const Report report = prepared(cube(50)).report;
    EXPECT_NEAR(report.edge_min_mm, 100, 1e-12);
    EXPECT_NEAR(report.edge_max_mm, 100 * std::sqrt(2), 1e-12);
    EXPECT_EQ(report.crease_edges, 12U);
}

TEST(MeshPrepare, NoneKeepsEverythingAsItIs)
{
    Soup soup = messy();
    const Soup given = soup;
    const Prepared out = prepared(soup, {.full = false, .weld_mm = 1, .split_mm = 1});
    EXPECT_EQ(out.mesh.vertices, given.vertices);
    EXPECT_EQ(out.mesh.faces, given.faces);
    EXPECT_EQ(out.mesh.face_normals, given.faces);
    EXPECT_EQ(out.mesh.neighbours.size(), given.faces.size());
}

TEST(MeshPrepare, NoneKeepsTheFilesNormals)
{
    Soup soup = cube(50);
    soup.normals = {{0, 0, 1}, {0, 1, 0}};
    soup.face_normals.assign(soup.faces.size(), Triple{0, 1, 0});
    const Prepared out = prepared(soup, {.full = false});
    EXPECT_EQ(out.mesh.normals, soup.normals);
    EXPECT_EQ(out.mesh.face_normals, soup.face_normals);
}

TEST(MeshPrepare, NoneMakesAngleWeightedNormalsWithoutCrease)
{
    const Prepared out = prepared(cube(50), {.full = false});
    // Each of the three sides has a right angle at a corner of the cube, however it is cut.
    for (std::size_t v = 0; v < 8; ++v)
        EXPECT_LT(distance(out.mesh.normals[v], normalized(out.mesh.vertices[v])), 1e-15);
    EXPECT_EQ(out.mesh.neighbours[0][1], 6U + 1U);
}

TEST(MeshPrepare, ProgressRisesToOne)
{
    std::vector<double> seen;
    prepared(cube(), {.progress = [&seen](double part) { seen.push_back(part); }});
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    EXPECT_EQ(seen.back(), 1.0);
}

} // namespace
} // namespace phantom::mesh::test
