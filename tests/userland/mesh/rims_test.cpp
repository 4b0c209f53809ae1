// SPDX-License-Identifier: GPL-2.0-or-later
// Where a surface ends, and which faces that concerns: against a search through all edges.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "mesh/rims.hpp"
#include "meshes.hpp"

namespace phantom::mesh {
namespace {

using namespace test;

Mesh prepared(Soup soup, bool full = true, bool two_sided = false)
{
    PrepareOptions options;
    options.full = full;
    options.two_sided = two_sided;
    auto out = prepare(std::move(soup), options, "test");
    EXPECT_TRUE(out.ok());
    return std::move(out->mesh);
}

/// Faces of which some edge is run along by no other face the other way round, by points.
std::size_t open_edges(const Mesh& mesh)
{
    std::size_t open = 0;
    for (const Triple& f : mesh.faces) {
        for (int i = 0; i < 3; ++i) {
            const Vec3 &a = mesh.vertices[f[i]], &b = mesh.vertices[f[(i + 1) % 3]];
            bool closed = false;
            for (const Triple& g : mesh.faces)
                for (int k = 0; k < 3; ++k)
                    closed |= mesh.vertices[g[k]] == b && mesh.vertices[g[(k + 1) % 3]] == a;
            open += !closed;
        }
    }
    return open;
}

double away(const Mesh& mesh, const Rim& rim, const Vec3& p)
{
    double least = 1e9;
    for (int i = 0; i <= 1000; ++i)
        least = std::min(least, distance(p, add(scaled(mesh.vertices[rim.from], 1 - i * 1e-3),
                                                scaled(mesh.vertices[rim.to], i * 1e-3))));
    return least;
}

TEST(Rims, AClosedMeshHasNone)
{
    for (const bool full : {false, true}) {
        const Rims rims = make_rims(prepared(cube(), full), 10);
        EXPECT_TRUE(rims.edges.empty());
        EXPECT_TRUE(rims.surface.empty());
        EXPECT_EQ(rims.surface_of(3), 0U);
        EXPECT_EQ(rims.loops, 0U);
    }
    // every face with vertices of its own: closed all the same
    EXPECT_TRUE(make_rims(prepared(unwelded(cube()), false), 10).edges.empty());
    // both sides of a sheet, and of an open surface that bends
    EXPECT_TRUE(make_rims(prepared(sheet(3, 2), true, true), 10).edges.empty());
    EXPECT_TRUE(make_rims(prepared(globe(20, 16, 9), true, true), 10).edges.empty());
}

TEST(Rims, AreTheEdgesThatNoOtherFaceGoesOnFrom)
{
    Soup holes = cube();
    holes.faces.erase(holes.faces.begin() + 1);
    holes.faces.pop_back();
    for (const Soup& soup : {sheet(4, 3), holes, unwelded(holes), unwelded(sheet(4, 3)), moebius(9)}) {
        for (const bool full : {false, true}) {
            const Mesh mesh = prepared(soup, full);
            const Rims rims = make_rims(mesh, 10);
            EXPECT_EQ(rims.edges.size(), open_edges(mesh));
            for (const Rim& rim : rims.edges) {
                const Triple& face = mesh.faces[rim.face];
                bool own = false;
                for (int i = 0; i < 3; ++i)
                    own |= face[i] == rim.from && face[(i + 1) % 3] == rim.to;
                EXPECT_TRUE(own) << "as its face runs";
                EXPECT_EQ(rims.surface_of(rim.face), rim.surface);
                EXPECT_GT(rim.surface, 0U);
            }
        }
    }
    EXPECT_EQ(make_rims(prepared(sheet(4, 3)), 10).loops, 1U);
    Soup frame = sheet(5, 5);
    frame.faces.erase(frame.faces.begin() + 24, frame.faces.begin() + 26); // the cell in the middle
    EXPECT_EQ(make_rims(prepared(frame), 10).loops, 2U);
}

/// Doubled faces end where single ones do; back to back they do not end at all.
TEST(Rims, OfDoubledFaces)
{
    Soup twice = sheet(2, 2);
    const auto faces = twice.faces;
    twice.faces.insert(twice.faces.end(), faces.begin(), faces.end());
    EXPECT_EQ(make_rims(prepared(twice, false), 10).edges.size(), 2U * 8U);
    Soup backed = sheet(2, 2);
    for (const Triple& f : faces)
        backed.faces.push_back({f[0], f[2], f[1]});
    EXPECT_TRUE(make_rims(prepared(backed, false), 10).edges.empty());
}

TEST(Rims, OtherSurfacesHaveOtherNumbersAndClosedOnesNone)
{
    Soup soup = sheet(2, 2); // z = 0, cells of 10 mm
    const Soup ball = cube(5, {0, 0, 200});
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    soup.vertices.insert(soup.vertices.end(), ball.vertices.begin(), ball.vertices.end());
    for (const Triple& f : ball.faces)
        soup.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
    const std::size_t closed = soup.faces.size();
    // a triangle that shares one vertex with the sheet
    soup.vertices.push_back({-30, -40, 0});
    soup.vertices.push_back({-40, -30, 0});
    const auto last = static_cast<std::uint32_t>(soup.vertices.size());
    soup.faces.push_back({0, last - 1, last - 2});
    const Mesh mesh = prepared(soup, false);
    const Rims rims = make_rims(mesh, 1000);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const std::uint32_t surface = rims.surface_of(static_cast<std::uint32_t>(f));
        if (f < 8) {
            EXPECT_EQ(surface, rims.surface_of(0));
        } else if (f < closed) {
            EXPECT_EQ(surface, 0U) << "though a rim of another surface is near";
        } else {
            EXPECT_NE(surface, rims.surface_of(0));
        }
    }
    EXPECT_GT(rims.surface_of(0), 0U);
    EXPECT_GT(rims.surface_of(static_cast<std::uint32_t>(closed)), 0U);
}

TEST(Rims, ConcernEveryFaceThatOneCanBeInReachOf)
{
    std::mt19937 random(2);
    std::uniform_real_distribution<double> part(0, 1);
    const Mesh mesh = prepared(sheet(9, 7));
    for (const double reach : {0.5, 8.0, 40.0}) {
        const Rims rims = make_rims(mesh, reach);
        unsigned none = 0;
        for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
            none += rims.surface_of(f) == 0;
            for (int i = 0; i < 20 && rims.surface_of(f) == 0; ++i) {
                const double a = part(random), b = (1 - a) * part(random);
                Vec3 p = scaled(mesh.vertices[mesh.faces[f][0]], a);
                p = add(p, scaled(mesh.vertices[mesh.faces[f][1]], b));
                p = add(p, scaled(mesh.vertices[mesh.faces[f][2]], 1 - a - b));
                for (const Rim& rim : rims.edges)
                    EXPECT_GT(away(mesh, rim, p), reach) << "face " << f;
            }
        }
        EXPECT_EQ(none > 0, reach < 20) << "faces far from every rim cost nothing";
    }
}

TEST(Rims, WithinADistanceAreAllThatAre)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-60, 60), how_far(0, 60);
    const Mesh mesh = prepared(sheet(9, 7));
    const Rims rims = make_rims(mesh, 1);
    ASSERT_EQ(rims.edges.size(), 32U);
    std::vector<Rims::Near> near;
    for (int i = 0; i < 300; ++i) {
        const Vec3 p{place(random), place(random), place(random)};
        const double distance = how_far(random);
        near.clear();
        rims.within(mesh, p, distance, near);
        std::vector<bool> found(rims.edges.size(), false);
        for (const auto& n : near) {
            EXPECT_FALSE(found[n.rim]) << "twice";
            found[n.rim] = true;
            EXPECT_NEAR(n.distance, away(mesh, rims.edges[n.rim], p), 0.02);
        }
        for (std::size_t r = 0; r < rims.edges.size(); ++r) {
            const double d = away(mesh, rims.edges[r], p);
            if (std::abs(d - distance) > 0.02) {
                EXPECT_EQ(found[r], d < distance);
            }
        }
    }
}

} // namespace
} // namespace phantom::mesh
