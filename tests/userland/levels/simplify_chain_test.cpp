// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/simplify_chain.hpp"

#include <set>

#include <gtest/gtest.h>

#include "mesh/two_sided.hpp"
#include "study/bumpy_sphere.hpp"
#include "surfaces.hpp"

namespace phantom::test {
namespace {

using mesh::ChainLevel;
using mesh::Mesh;
using mesh::Vec3;

std::vector<ChainLevel> chain_of(const Mesh& mesh, std::size_t faces_last, unsigned threads = 0)
{
    mesh::ChainOptions options;
    options.threads = threads;
    options.enough = [faces_last](const ChainLevel& level) { return level.mesh.faces.size() <= faces_last; };
    return mesh::simplify_chain(mesh, fdh::TriangleTree<14>::build({mesh.vertices, mesh.faces}), options);
}

/// What every level of a chain promises.
void expect_sound(const Mesh& mesh, const std::vector<ChainLevel>& chain)
{
    const std::set<Vec3> vertices(mesh.vertices.begin(), mesh.vertices.end());
    std::size_t faces = mesh.faces.size();
    double error_mm = 0;
    ASSERT_FALSE(chain.empty());
    for (const ChainLevel& level : chain) {
        const Mesh& m = level.mesh;
        SCOPED_TRACE(testing::Message() << m.faces.size() << " faces");
        EXPECT_LE(m.faces.size(), 3 * faces / 4);
        EXPECT_GE(4 * m.faces.size() + 8, faces);
        EXPECT_GE(level.error_mm, error_mm);
        EXPECT_EQ(level.tree.triangles(), m.faces.size());
        for (const Vec3& vertex : m.vertices)
            EXPECT_TRUE(vertices.contains(vertex));
        for (std::size_t f = 0; f < m.faces.size(); ++f) {
            const auto x = corners(m, f);
            const Vec3 normal = mesh::cross(mesh::subtract(x[1], x[0]), mesh::subtract(x[2], x[0]));
            for (std::size_t i = 0; i < 3; ++i) {
                const Vec3& n = m.normals[m.face_normals[f][i]];
                EXPECT_NEAR(mesh::length(n), 1, 1e-12);
                EXPECT_GT(mesh::dot(n, normal), 0);
                const std::uint32_t other = m.neighbours[f][i];
                if (other != mesh::no_neighbour) {
                    const mesh::Triple& back = m.neighbours[other];
                    EXPECT_TRUE(back[0] == f || back[1] == f || back[2] == f);
                }
            }
        }
        faces = m.faces.size();
        error_mm = level.error_mm;
    }
}

TEST(SimplifyChain, OfASmoothClosedMeshStaysClosedAndItsErrorsAboutDouble)
{
    const Mesh mesh = *study::bumpy_sphere(30);
    const auto chain = chain_of(mesh, 1000);
    expect_sound(mesh, chain);
    ASSERT_GE(chain.size(), 4U);
    for (std::size_t i = 0; i < chain.size(); ++i) {
        const Mesh& level = chain[i].mesh;
        EXPECT_EQ(open_edges(level), 0U);
        EXPECT_EQ(level.faces.size(), 2 * (level.vertices.size() - 2)) << "a sphere still: Euler";
        EXPECT_EQ(level.normals.size(), level.vertices.size()) << "no crease where there was none";
        if (i > 0) {
            EXPECT_GT(chain[i].error_mm, 1.2 * chain[i - 1].error_mm);
            EXPECT_LT(chain[i].error_mm, 4 * chain[i - 1].error_mm);
        }
    }
    // Half of the triangles cost about what twice the triangles' size does: its square over 8 radii of
    // curvature.
    EXPECT_LT(chain[0].error_mm, 0.15);
}

/// A ring as thin as a rod of four sides: rings of edges that are no face's. Collapsing one would pinch it
/// off.
TEST(SimplifyChain, OfAThinRingIsARing)
{
    constexpr std::uint32_t along = 200, round = 4;
    mesh::Soup soup;
    for (std::uint32_t i = 0; i < along; ++i)
        for (std::uint32_t j = 0; j < round; ++j) {
            const double u = 2 * std::numbers::pi * i / along, v = 2 * std::numbers::pi * j / round;
            const Vec3 normal{std::cos(u) * std::cos(v), std::sin(u) * std::cos(v), std::sin(v)};
            soup.normals.push_back(normal);
            soup.vertices.push_back(mesh::add({50 * std::cos(u), 50 * std::sin(u), 0}, normal));
            const std::uint32_t a = i * round + j, b = i * round + (j + 1) % round;
            const std::uint32_t c = (a + round) % (along * round), d = (b + round) % (along * round);
            soup.faces.insert(soup.faces.end(), {{a, c, d}, {a, d, b}});
        }
    soup.face_normals = soup.faces;
    const Mesh mesh = prepared(soup, {.crease_deg = 180});
    mesh::ChainOptions options;
    options.crease_deg = 180; // nothing but the topology keeps it
    options.enough = [](const ChainLevel& level) { return level.mesh.faces.size() < 30; };
    const auto chain =
        mesh::simplify_chain(mesh, fdh::TriangleTree<14>::build({mesh.vertices, mesh.faces}), options);
    ASSERT_FALSE(chain.empty());
    for (const ChainLevel& level : chain) {
        EXPECT_EQ(open_edges(level.mesh), 0U);
        EXPECT_EQ(level.mesh.faces.size(), 2 * level.mesh.vertices.size()) << "a torus still: Euler";
    }
}

TEST(SimplifyChain, ErrorIsTheDistanceThatBruteForceFinds)
{
    const Mesh mesh = prepared(waves(40));
    const auto chain = chain_of(mesh, 400);
    expect_sound(mesh, chain);
    for (const ChainLevel& level : chain) {
        double farthest = 0;
        for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
            farthest = std::max(farthest, distance_to(level.mesh, mesh.vertices[v]));
        EXPECT_LE(farthest, level.error_mm + 1e-9);
        EXPECT_GT(farthest, 0.5 * level.error_mm);
    }
}

TEST(SimplifyChain, KeepsTheBorderOfASheet)
{
    const Mesh mesh = prepared(waves(40));
    for (const ChainLevel& level : chain_of(mesh, 400)) {
        double length_mm = 0; // of the border, seen from above: its corners are far from collinear
        for (std::size_t f = 0; f < level.mesh.faces.size(); ++f)
            for (std::size_t i = 0; i < 3; ++i) {
                if (level.mesh.neighbours[f][i] != mesh::no_neighbour)
                    continue;
                const Vec3 &a = level.mesh.vertices[level.mesh.faces[f][i]],
                           &b = level.mesh.vertices[level.mesh.faces[f][(i + 1) % 3]];
                EXPECT_TRUE((a[0] == b[0] && std::abs(a[0]) == 50) ||
                            (a[1] == b[1] && std::abs(a[1]) == 50) || level.error_mm > 1)
                    << "a border edge on no side of the square";
                length_mm += std::hypot(a[0] - b[0], a[1] - b[1]);
            }
        EXPECT_NEAR(length_mm, 400, 4 * level.error_mm + 1e-9);
    }
}

TEST(SimplifyChain, KeepsTheOutlineOfAFlatSheet)
{
    const Mesh mesh = prepared(sheet(24, [](double, double) { return 0.0; }));
    const auto chain = chain_of(mesh, 32);
    ASSERT_FALSE(chain.empty());
    EXPECT_LE(chain.back().mesh.faces.size(), 32U);
    for (const ChainLevel& level : chain)
        EXPECT_NEAR(area_mm2(level.mesh), 10000, 1e-6);
}

TEST(SimplifyChain, KeepsTheCreasesOfACube)
{
    const Mesh mesh = prepared(cut_cube(12));
    const auto chain = chain_of(mesh, 64);
    expect_sound(mesh, chain);
    const ChainLevel& last = chain.back();
    EXPECT_LE(last.mesh.faces.size(), 64U);
    EXPECT_EQ(open_edges(last.mesh), 0U);
    EXPECT_NEAR(last.error_mm, 0, 1e-6) << "flat sides lose nothing";
    std::size_t corners_kept = 0;
    for (const Vec3& v : last.mesh.vertices)
        corners_kept += std::abs(v[0]) == 20 && std::abs(v[1]) == 20 && std::abs(v[2]) == 20;
    EXPECT_EQ(corners_kept, 8U);
    for (const Vec3& n : last.mesh.normals) // each side has its own
        EXPECT_NEAR(std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]), 1, 1e-9);
}

TEST(SimplifyChain, OfAMeshWithBacksHasBacks)
{
    Mesh mesh = prepared(waves(20));
    ASSERT_TRUE(mesh::make_two_sided(mesh));
    const auto chain = chain_of(mesh, 200);
    ASSERT_FALSE(chain.empty());
    for (const ChainLevel& level : chain) {
        const std::size_t fronts = level.mesh.faces.size() / 2;
        ASSERT_EQ(level.mesh.faces.size(), 2 * fronts);
        EXPECT_EQ(open_edges(level.mesh), 0U);
        for (std::size_t f = 0; f < fronts; ++f) {
            const mesh::Triple &front = level.mesh.faces[f], &back = level.mesh.faces[fronts + f];
            EXPECT_EQ(back, (mesh::Triple{front[0], front[2], front[1]}));
        }
    }
}

TEST(SimplifyChain, IsTheSameForAnyThreadsAndFarFromTheOrigin)
{
    const Mesh mesh = *study::bumpy_sphere(20);
    const auto one = chain_of(mesh, 1000, 1), two = chain_of(mesh, 1000, 2);
    ASSERT_EQ(one.size(), two.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one[i].mesh.faces, two[i].mesh.faces);
        EXPECT_EQ(one[i].error_mm, two[i].error_mm);
    }
    Mesh far = mesh;
    std::vector<Vec3> moved = mesh.vertices.to_vector();
    for (Vec3& vertex : moved)
        vertex = mesh::add(vertex, {5e6, -5e6, 5e6});
    far.vertices = std::move(moved);
    const auto there = chain_of(far, 1000);
    expect_sound(far, there);
    ASSERT_EQ(there.size(), one.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_NEAR(static_cast<double>(there[i].mesh.faces.size()),
                    static_cast<double>(one[i].mesh.faces.size()),
                    0.02 * static_cast<double>(mesh.faces.size()));
        EXPECT_NEAR(there[i].error_mm, one[i].error_mm, 0.3 * one[i].error_mm);
    }
}

TEST(SimplifyChain, OfWhatCannotBeSimplifiedIsEmpty)
{
    EXPECT_TRUE(chain_of(prepared(cut_cube(1)), 0).empty());
    EXPECT_TRUE(chain_of(Mesh{}, 0).empty());
}

TEST(SimplifyChain, EndsBeforeALongEdgeAndWhenItIsCancelled)
{
    const Mesh mesh = prepared(waves(40));
    const auto tree = fdh::TriangleTree<14>::build({mesh.vertices, mesh.faces});
    mesh::ChainOptions options;
    options.enough = [](const ChainLevel&) { return false; };
    const auto longest_edge = [](const Mesh& level) {
        double longest = 0;
        for (std::size_t f = 0; f < level.faces.size(); ++f) {
            const auto x = corners(level, f);
            for (std::size_t i = 0; i < 3; ++i)
                longest = std::max(longest, mesh::distance(x[i], x[(i + 1) % 3]));
        }
        return longest;
    };
    const auto whole = mesh::simplify_chain(mesh, tree, options);
    ASSERT_GE(whole.size(), 3U);
    options.edge_max_mm = 0.999 * longest_edge(whole.back().mesh);
    const auto chain = mesh::simplify_chain(mesh, tree, options);
    EXPECT_LT(chain.size(), whole.size());
    for (const ChainLevel& level : chain)
        EXPECT_LE(longest_edge(level.mesh), options.edge_max_mm);
    int asked = 0;
    options.cancelled = [&asked] { return ++asked > 1; };
    EXPECT_LT(mesh::simplify_chain(mesh, tree, options).size(), 2U);
}

} // namespace
} // namespace phantom::test
