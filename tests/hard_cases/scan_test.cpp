// SPDX-License-Identifier: GPL-2.0-or-later
// Real scans, prepared as a user's: sets of the patches within reach, against the __float128 reference over
// the whole mesh.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "creased.hpp"
#include "distance.hpp"
#include "mesh/read.hpp"
#include "shapes_of_interest.hpp"
#include "suite.hpp"

namespace {

using namespace phantom;
using namespace phantom::hard;
using reference::margin_mm;
using reference::Reference;

constexpr double size_mm = 120, radius_mm = 1, crease_deg = 60;
/// float32 over some mm, k = 1 N/mm; near a fold a root moves by many times what moved it.
constexpr double tolerance_n = 1e-4;

constexpr const char* bunny_file = "/usr/share/glmark2/models/bunny.obj";
/// Debian's libcgal-demo: everything in one archive.
constexpr const char* cgal_archive = "/usr/share/doc/libcgal-dev/data.tar.gz";

Triangles scan(const std::filesystem::path& file)
{
    auto soup = mesh::read(file);
    EXPECT_TRUE(soup) << soup.error().text();
    return soup ? prepared(std::move(*soup), size_mm, crease_deg, 1, radius_mm) : Triangles{};
}

/// Out of the archive; empty where that cannot be done.
Triangles from_cgal(const std::string& name)
{
    const std::filesystem::path file = testing::TempDir() + "hard-cases-" + name;
    const std::string command =
        fmt::format("tar -xzOf {} data/meshes/{} >'{}' 2>/dev/null", cgal_archive, name, file.string());
    Triangles out;
    if (std::system(command.c_str()) == 0) // NOLINT: nothing of it comes from outside
        out = scan(file);
    std::filesystem::remove(file);
    return out;
}

/// What a feeder would put into a set: every patch that has a point within `reach` of the tip, and the rims
/// that may be within R of those points.
Triangles within(const Triangles& mesh, const Vec3& tip, double reach)
{
    Triangles out;
    for (const auto& t : mesh) {
        double extent = 0;
        for (const Vec3& x : t.corner)
            extent = std::max(extent, length(subtract(x, t.corner[0])));
        if (length(subtract(tip, t.corner[0])) <= reach + extent + (t.rim ? t.radius : 0))
            out.push_back(t);
    }
    return out;
}

/// Valid less folded roots; where a fold's partner lies farther away than the patches near the tip, with
/// more.
int degree_at(const Triangles& mesh, const Vec3& tip)
{
    reference::Options options;
    options.penetration = false;
    options.all_roots = true;
    int degree = 0;
    for (const double reach : {2.0, 6.0, 20.0}) {
        degree = Reference(within(mesh, tip, reach * radius_mm), options).shell(tip).degree;
        if (degree == 1)
            break;
    }
    return degree;
}

void expect_exact(const std::string& name, const Triangles& mesh, unsigned points)
{
    ASSERT_FALSE(mesh.empty()) << name;
    const std::array<reference::Model, 2> models{reference::Model::projected, reference::Model::paper};
    Triangles surface = mesh;
    std::erase_if(surface, [](const auto& t) { return t.rim; });
    std::mt19937 random(47);
    unsigned judged = 0, counted = 0;
    for (unsigned i = 0; i < points; ++i) {
        const Vec3 p = point_near(surface, random, 0.02, 0.95 * radius_mm);
        const Triangles set = within(mesh, p, radius_mm);
        const Nearest near = nearest(set, p);
        ASSERT_LE(set.size(), PHANTOM_PATCHES_MAX) << "a smaller R would do";
        for (const auto model : models) {
            reference::Options options;
            options.model = model;
            options.penetration = false;
            const auto expected = Reference(mesh, options).shell(p);
            SCOPED_TRACE(fmt::format("{}, {} at {}", name,
                                     model == reference::Model::paper ? "paper" : "projected",
                                     fmt::join(p, " ")));
            Settings settings;
            settings.model = model == reference::Model::paper ? PHANTOM_MODEL_PAPER : PHANTOM_MODEL_PROJECTED;
            for (const phantom_float_ops* ops : sections()) {
                const Touch got = Contact(*ops, set, settings).tick(p);
                EXPECT_FALSE(got.invalid);
                EXPECT_LE(length(got.force), radius_mm * (1 + rounding_of(*ops, Case{})));
                // no position near the front of the mesh is without contact
                if (near.in_front && near.distance < 0.3 * radius_mm) {
                    EXPECT_GT(got.contacts, 0U) << ops->name;
                }
                if (expected.margin < margin_mm)
                    continue;
                ++judged;
                EXPECT_EQ(got.contacts, expected.contacts) << ops->name;
                EXPECT_EQ(got.folded, expected.folded) << ops->name;
                EXPECT_LE(length(subtract(got.force, expected.force)), tolerance_n) << ops->name;
            }
            if (model == reference::Model::projected && near.in_front && expected.margin >= margin_mm &&
                i % 4 == 0) {
                ++counted;
                EXPECT_EQ(degree_at(mesh, p), 1);
            }
        }
    }
    EXPECT_GT(judged, points);
    EXPECT_GT(counted, points / 8);
}

TEST(Scan, TheBunnyAgreesWithTheReference)
{
    if (!std::filesystem::exists(bunny_file))
        GTEST_SKIP() << "glmark2-data is not installed";
    expect_exact("bunny", scan(bunny_file), 30);
}

TEST(Scan, MeshesOfCgalAgreeWithTheReference)
{
    if (!std::filesystem::exists(cgal_archive))
        GTEST_SKIP() << "libcgal-demo is not installed";
    for (const char* name : {"elephant.off", "fandisk.off", "ChineseDragon-10kv.off", "armadillo.off"})
        expect_exact(name, from_cgal(name), 15);
}

} // namespace
