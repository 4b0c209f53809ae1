// SPDX-License-Identifier: GPL-2.0-or-later
// Edges of more than two faces and vertices of several fans: who goes on in whom.
#include <set>

#include <gtest/gtest.h>

#include "meshes.hpp"

namespace phantom::mesh::test {
namespace {

/// Of every edge by its vertices at most two faces, and of every vertex one fan: counted the plain way.
void expect_manifold(const Mesh& mesh)
{
    std::map<std::uint32_t, std::set<std::uint32_t>> faces_of;
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
        for (const std::uint32_t v : mesh.faces[f])
            faces_of[v].insert(f);
    for (const auto& [edge, faces] : edges_of(mesh.faces.to_vector()))
        EXPECT_LE(faces.size(), 2U);
    for (auto& [vertex, faces] : faces_of) {
        std::vector<std::uint32_t> stack = {*faces.begin()};
        std::set<std::uint32_t> reached = {*faces.begin()};
        while (!stack.empty()) {
            const std::uint32_t at = stack.back();
            stack.pop_back();
            for (const std::uint32_t next : mesh.neighbours[at])
                if (next != no_neighbour && faces.count(next) && reached.insert(next).second)
                    stack.push_back(next);
        }
        EXPECT_EQ(reached.size(), faces.size()) << "vertex " << vertex;
    }
}

/// Which part of the soup a face came from, by the number of faces of each.
std::vector<std::uint32_t> parts(std::initializer_list<std::size_t> counts)
{
    std::vector<std::uint32_t> part;
    std::uint32_t number = 0;
    for (const std::size_t count : counts)
        part.insert(part.end(), count, number++);
    return part;
}

void expect_apart(const Mesh& mesh, const std::vector<std::uint32_t>& part)
{
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
        for (const std::uint32_t other : mesh.neighbours[f])
            EXPECT_TRUE(other != no_neighbour && part[other] == part[f]) << "face " << f;
}

TEST(MeshManifold, SolidsThatShareAnEdgeAreClosedEachForItself)
{
    for (const double side : {20.0, -20.0}) {
        Soup soup = cube(10);
        append(soup, cube(10, {side, 20, 0}));
        const Prepared out = prepared(soup);
        EXPECT_EQ(out.report.nonmanifold_edges, 1U);
        EXPECT_EQ(out.report.nonmanifold_vertices, 2U);
        EXPECT_EQ(out.report.vertices_separated, 2U);
        EXPECT_EQ(out.report.boundary_edges, 0U);
        EXPECT_TRUE(out.report.watertight);
        expect_apart(out.mesh, parts({12, 12}));
        expect_manifold(out.mesh);
    }
}

TEST(MeshManifold, SolidsThatShareASideAreClosedEachForItself)
{
    Soup soup = cube(10);
    append(soup, cube(10, {20, 0, 0}));
    const Prepared out = prepared(soup);
    EXPECT_TRUE(out.report.watertight);
    expect_apart(out.mesh, parts({12, 12}));
    expect_manifold(out.mesh);
}

/// One surface that meets itself along an edge: eight cubes but two opposite ones, cut out of a block.
TEST(MeshManifold, AClosedSurfaceThatTouchesItselfHasItsInsideBetweenPairs)
{
    // Two cubes share an edge, and a third joins them behind: all one component.
    std::map<Vec3, int> corners;
    Soup all;
    const std::vector<Vec3> centres = {{0, 0, 0}, {20, 20, 0}, {0, 0, 20}, {20, 0, 20}, {20, 20, 20}};
    for (const Vec3& c : centres)
        append(all, cube(10, c));
    // Faces that two cubes share lie on one another: both go.
    const auto middle = [&](const Triple& f) {
        std::array<Vec3, 3> x = {all.vertices[f[0]], all.vertices[f[1]], all.vertices[f[2]]};
        std::sort(x.begin(), x.end());
        return x;
    };
    std::map<std::array<Vec3, 3>, int> count;
    for (const Triple& f : all.faces)
        ++count[middle(f)];
    // sides are cut along the same diagonal from either side, or along the other one: drop by the plane
    Soup soup = all;
    soup.faces.clear();
    for (std::size_t f = 0; f < all.faces.size(); ++f) {
        const Vec3 centre = centres[f / 12];
        Vec3 normal = cross(subtract(all.vertices[all.faces[f][1]], all.vertices[all.faces[f][0]]),
                            subtract(all.vertices[all.faces[f][2]], all.vertices[all.faces[f][0]]));
        const Vec3 beyond = add(centre, scaled(normalized(normal), 20));
        bool shared = false;
        for (const Vec3& other : centres)
            shared = shared || distance(other, beyond) < 1e-9;
        if (!shared)
            soup.faces.push_back(all.faces[f]);
    }
    const Prepared out = prepared(soup);
    EXPECT_EQ(out.report.nonmanifold_edges, 1U);
    EXPECT_TRUE(out.report.watertight);
    expect_manifold(out.mesh);
    EXPECT_NEAR(signed_volume(out.mesh.vertices.to_vector(), out.mesh.faces.to_vector()), 5 * 8000, 1e-6);
    // Across the shared edge the inside lies between neighbours: a convex edge, the normals turn away.
    for (std::uint32_t f = 0; f < out.mesh.faces.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 &a = out.mesh.vertices[out.mesh.faces[f][i]],
                       &b = out.mesh.vertices[out.mesh.faces[f][(i + 1) % 3]];
            if (a[0] == 10 && a[1] == 10 && b[0] == 10 && b[1] == 10 && std::max(a[2], b[2]) < 11) {
                const std::uint32_t other = out.mesh.neighbours[f][i];
                ASSERT_NE(other, no_neighbour);
                Vec3 third{};
                for (const std::uint32_t v : out.mesh.faces[other])
                    if (out.mesh.vertices[v] != a && out.mesh.vertices[v] != b)
                        third = out.mesh.vertices[v];
                EXPECT_LT(dot(normal_of(out.mesh, f), subtract(third, a)), 0);
            }
        }
    }
}

TEST(MeshManifold, AFinDoesNotPartTheSurfaceThatItStandsOn)
{
    Soup soup = sheet(4, 4);
    soup.vertices.push_back({20, 15, 10});
    soup.faces.push_back({7, 12, 25}); // on the edge from (20, 10) to (20, 20)
    const Prepared plain = prepared(sheet(4, 4)), out = prepared(soup);
    EXPECT_EQ(out.report.nonmanifold_edges, 1U);
    EXPECT_EQ(out.report.boundary_edges, plain.report.boundary_edges + 3);
    for (std::size_t f = 0; f < plain.mesh.faces.size(); ++f)
        EXPECT_EQ(out.mesh.neighbours[f], plain.mesh.neighbours[f]);
    EXPECT_EQ(out.mesh.neighbours.back(), (Triple{no_neighbour, no_neighbour, no_neighbour}));
    expect_manifold(out.mesh);
}

TEST(MeshManifold, AWallInsideASolidDoesNotPartIt)
{
    // Two halves of a box with one wall between them: each half alone is open.
    Soup soup = cube(10);
    append(soup, cube(10, {20, 0, 0}));
    std::size_t walls = 0;
    std::erase_if(soup.faces, [&](const Triple& f) {
        const bool wall =
            std::all_of(f.begin(), f.end(), [&](std::uint32_t v) { return soup.vertices[v][0] == 10; });
        walls += wall;
        return wall && walls <= 2;
    });
    ASSERT_EQ(walls, 4U);
    const Prepared out = prepared(soup);
    EXPECT_EQ(out.report.nonmanifold_edges, 4U);
    EXPECT_EQ(out.report.boundary_edges, 4U); // the wall's
    expect_manifold(out.mesh);
    for (std::uint32_t f = 0; f < out.mesh.faces.size(); ++f) {
        const bool wall = std::abs(normal_of(out.mesh, f)[0]) > 0.5 &&
                          std::abs(out.mesh.vertices[out.mesh.faces[f][0]][0] - 10) < 1e-9;
        for (const std::uint32_t other : out.mesh.neighbours[f])
            if (!wall) {
                EXPECT_NE(other, no_neighbour) << f;
            }
    }
}

TEST(MeshManifold, SheetsThatCrossGoStraightOn)
{
    Soup soup;
    soup.vertices = {{0, 0, 0}, {0, 50, 0}, {50, 25, 0}, {-50, 25, 0}, {0, 25, 50}, {0, 25, -50}};
    soup.faces = {{1, 0, 2}, {0, 1, 3}, {1, 0, 4}, {0, 1, 5}};
    const Prepared out = prepared(soup);
    EXPECT_EQ(out.report.nonmanifold_edges, 1U);
    EXPECT_EQ(out.mesh.neighbours[0][0], 1U);
    EXPECT_EQ(out.mesh.neighbours[2][0], 3U);
    EXPECT_EQ(out.report.components, 2U);
    expect_manifold(out.mesh);
}

TEST(MeshManifold, ConesTipToTipGetATipEach)
{
    Soup soup = globe(20, 8, 2);
    Soup upper = soup;
    for (Vec3& v : upper.vertices)
        v[2] += 40;
    append(soup, upper);
    const Prepared out = prepared(soup);
    EXPECT_EQ(out.report.nonmanifold_edges, 0U);
    EXPECT_EQ(out.report.nonmanifold_vertices, 1U);
    EXPECT_EQ(out.report.vertices_separated, 1U);
    EXPECT_EQ(out.report.vertices, soup.vertices.size());
    EXPECT_TRUE(out.report.watertight);
    expect_manifold(out.mesh);
}

TEST(MeshManifold, DoesNotDependOnTheOrderOfTheFaces)
{
    std::mt19937 random(11);
    Soup soup = cube(10);
    append(soup, cube(10, {20, 20, 0}));
    append(soup, cube(10, {20, -20, 0}));
    for (int round = 0; round < 10; ++round) {
        std::vector<std::uint32_t> order(soup.faces.size());
        for (std::uint32_t i = 0; i < order.size(); ++i)
            order[i] = i;
        std::shuffle(order.begin(), order.end(), random);
        Soup shuffled = soup;
        std::vector<std::uint32_t> part;
        for (std::size_t i = 0; i < order.size(); ++i) {
            shuffled.faces[i] = soup.faces[order[i]];
            part.push_back(order[i] / 12);
        }
        expect_apart(prepared(shuffled).mesh, part);
    }
}

} // namespace
} // namespace phantom::mesh::test
