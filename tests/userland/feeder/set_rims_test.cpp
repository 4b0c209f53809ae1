// SPDX-License-Identifier: GPL-2.0-or-later
// The rims in a set: wherever it promises a surface, the distance to that surface's rim is known as well, up
// to the contact radius, whatever the budget. Against a search through all rims of the scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "feeder/feeder.hpp"
#include "scenes.hpp"

namespace phantom::test {
namespace {

Vector minus(const Vector& a, const Vector& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double dot(const Vector& a, const Vector& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double to_segment(const Vector& p, const Vector& a, const Vector& b)
{
    const Vector e = minus(b, a), q = minus(p, a);
    const double t = std::clamp(dot(e, q) / dot(e, e), 0.0, 1.0);
    const Vector away = {q[0] - t * e[0], q[1] - t * e[1], q[2] - t * e[2]};
    return std::sqrt(dot(away, away));
}

/// A sheet of cells of 1 mm over waves of 1 mm, with a hole.
mesh::Mesh waves(std::uint32_t cells)
{
    mesh::Soup soup;
    for (std::uint32_t j = 0; j <= cells; ++j)
        for (std::uint32_t i = 0; i <= cells; ++i)
            soup.vertices.push_back({1.0 * i, 1.0 * j, std::sin(0.7 * i) * std::cos(0.5 * j)});
    for (std::uint32_t j = 0; j < cells; ++j) {
        for (std::uint32_t i = 0; i < cells; ++i) {
            if (i / 2 == cells / 4 && j / 2 == cells / 4)
                continue;
            const std::uint32_t a = j * (cells + 1) + i, c = a + cells + 1;
            soup.faces.push_back({a, a + 1, c + 1});
            soup.faces.push_back({a, c + 1, c});
        }
    }
    auto prepared = mesh::prepare(std::move(soup), {}, "waves");
    return std::move(prepared->mesh);
}

/// Two of them, one turned, close to one another, and a closed ball that touches both.
scene::Scene open_scene()
{
    scene::Scene scene;
    scene.materials.push_back({"soft", 0.5, 2.5, {}});
    scene.materials.push_back({"hard", 1.0, 1.0, {}});
    add_object(scene, waves(20), {}, 0);
    add_object(scene, waves(20), quarter_turn({20.3, 0.4, 1.0}), 1);
    add_object(scene, sphere(6.0, 12, 24), quarter_turn({10.0, -4.0, 5.0}), 0);
    for (scene::Object& object : scene.objects)
        object.rims = mesh::make_rims(object.mesh, scene.materials[object.material].radius_mm);
    return scene;
}

Vector to_world(const fdh::Pose& pose, const Vector& v)
{
    Vector out = pose.translation;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            out[row] += pose.rotation[3 * row + column] * v[column];
    return out;
}

/// In mm of the world.
Vector corner_of(const device::PatchSet& set, const phantom_patch& patch, int corner)
{
    Vector out;
    for (int axis = 0; axis < 3; ++axis)
        out[axis] = 1e-6 * static_cast<double>(patch.vertex_nm[corner][axis] + set.header.origin_nm[axis]);
    return out;
}

/// To the nearest rim of the object that the scene has, and of the surface that the set has.
double in_scene(const scene::Object& object, const Vector& p)
{
    double least = 1e9;
    for (const mesh::Rim& rim : object.rims.edges)
        least = std::min(least, to_segment(p, to_world(object.pose, object.mesh.vertices[rim.from]),
                                           to_world(object.pose, object.mesh.vertices[rim.to])));
    return least;
}

double in_set(const device::PatchSet& set, std::uint32_t surface, const Vector& p)
{
    double least = 1e9;
    for (const phantom_patch& patch : set.patches)
        if (patch.kind == PHANTOM_PATCH_RIM && patch.surface == surface)
            least = std::min(least, to_segment(p, corner_of(set, patch, 0), corner_of(set, patch, 1)));
    return least;
}

const scene::Object& owner_of(const scene::Scene& scene, const device::PatchSet& set,
                              const phantom_patch& patch)
{
    return scene.objects[set.objects[patch.object].object];
}

/// Points of the set's faces within its coverage.
unsigned expect_known(const scene::Scene& scene, const device::PatchSet& set, const Vector& centre,
                      std::mt19937& random)
{
    std::uniform_real_distribution<double> part(0, 1);
    unsigned faded = 0;
    for (const phantom_patch& patch : set.patches) {
        if (patch.kind != PHANTOM_PATCH_FACE)
            continue;
        const scene::Object& object = owner_of(scene, set, patch);
        const double radius = scene.materials[object.material].radius_mm;
        for (int i = 0; i < 4; ++i) {
            const double a = part(random), b = (1 - a) * part(random);
            Vector p;
            for (int axis = 0; axis < 3; ++axis)
                p[axis] = a * corner_of(set, patch, 0)[axis] + b * corner_of(set, patch, 1)[axis] +
                          (1 - a - b) * corner_of(set, patch, 2)[axis];
            if (std::sqrt(dot(minus(p, centre), minus(p, centre))) > 1e-6 * set.header.radius_nm)
                continue;
            const double expected = std::min(radius, in_scene(object, p));
            const double known = patch.surface ? std::min(radius, in_set(set, patch.surface, p)) : radius;
            EXPECT_NEAR(known, expected, 3e-6) << "face " << patch.face;
            faded += expected < radius;
        }
    }
    return faded;
}

TEST(SetRims, AreInEverySetThatHasASurfaceNearThem)
{
    const scene::Scene scene = open_scene();
    const fdh::SceneTree<14> tree = scene::build_tree<14>(scene);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-3, 24), height(-2, 4);
    device::PatchSet set;
    fdh::Nearest near;
    unsigned faded = 0, cut = 0;
    for (const std::uint32_t patches_max : {512U, 60U, 13U}) {
        feeder::SetBuilder builder(scene, patches_max);
        for (const std::size_t budget : {1U, 9U, 64U, 512U}) {
            for (int i = 0; i < 25; ++i) {
                const Vector centre{place(random), place(random), height(random)};
                tree.nearest(centre, budget, 50.0, near);
                near.sort();
                builder.build(near, centre, set);
                ASSERT_LE(set.patches.size(), patches_max);
                EXPECT_LE(set.header.radius_nm * 1e-6, near.coverage);
                const auto faces = static_cast<std::size_t>(
                    std::count_if(set.patches.begin(), set.patches.end(),
                                  [](const phantom_patch& p) { return p.kind == PHANTOM_PATCH_FACE; }));
                if (faces < near.hits.size()) {
                    ++cut;
                    EXPECT_LE(set.header.radius_nm * 1e-6, near.hits[faces].distance) << "and says so";
                }
                faded += expect_known(scene, set, centre, random);
            }
        }
    }
    EXPECT_GT(faded, 3000U);
    EXPECT_GT(cut, 50U);
}

TEST(SetRims, AreWellMadeAndEachThereOnce)
{
    const scene::Scene scene = open_scene();
    const fdh::SceneTree<14> tree = scene::build_tree<14>(scene);
    feeder::SetBuilder builder(scene);
    device::PatchSet set;
    fdh::Nearest near;
    tree.nearest({19, 10, 1}, 100, 50.0, near);
    near.sort();
    builder.build(near, {19, 10, 1}, set);
    std::vector<std::array<std::uint32_t, 2>> seen;
    for (std::size_t i = 0; i < set.patches.size(); ++i) {
        const phantom_patch& patch = set.patches[i];
        const scene::Object& object = owner_of(scene, set, patch);
        EXPECT_TRUE(i == 0 || set.patches[i - 1].kind <= patch.kind) << "faces, fans, rims";
        EXPECT_EQ(patch.reserved, 0U);
        if (&object == &scene.objects[2]) {
            EXPECT_EQ(patch.surface, 0U) << "closed";
            EXPECT_EQ(patch.kind, PHANTOM_PATCH_FACE);
        }
        if (patch.kind != PHANTOM_PATCH_RIM)
            continue;
        seen.push_back({patch.vertex[0], patch.vertex[1]});
        EXPECT_EQ(patch.vertex[1], patch.vertex[2]);
        EXPECT_EQ(patch.face, PHANTOM_PATCH_NONE);
        EXPECT_GT(patch.surface, 0U);
        for (int corner = 0; corner < 3; ++corner) {
            double size = 0;
            for (const __s32 component : patch.normal_q30[corner])
                size += std::pow(static_cast<double>(component) / PHANTOM_Q30_ONE, 2);
            EXPECT_NEAR(size, 1, 1e-6);
            EXPECT_EQ(patch.neighbour[corner], PHANTOM_PATCH_NONE);
        }
    }
    ASSERT_GT(seen.size(), 10U);
    std::sort(seen.begin(), seen.end());
    EXPECT_EQ(std::unique(seen.begin(), seen.end()), seen.end());
    // of two objects: no number is that of both
    std::vector<std::uint32_t> surfaces;
    for (const phantom_patch& patch : set.patches)
        if (patch.kind == PHANTOM_PATCH_RIM)
            surfaces.push_back(patch.surface * 1000 + patch.object);
    std::sort(surfaces.begin(), surfaces.end());
    surfaces.erase(std::unique(surfaces.begin(), surfaces.end()), surfaces.end());
    ASSERT_EQ(surfaces.size(), 2U);
    EXPECT_NE(surfaces[0] / 1000, surfaces[1] / 1000);
}

TEST(SetRims, AllOfThemAreInASetOfEverything)
{
    const scene::Scene scene = open_scene();
    feeder::SetBuilder builder(scene);
    device::PatchSet set;
    builder.build_all({10, 10, 0}, set);
    EXPECT_EQ(set.patches.size(), scene.patches());
    EXPECT_EQ(std::count_if(set.patches.begin(), set.patches.end(),
                            [](const phantom_patch& p) { return p.kind == PHANTOM_PATCH_RIM; }),
              2 * (80 + 8));
    std::mt19937 random(6);
    set.header.radius_nm = 1000000000;
    EXPECT_GT(expect_known(scene, set, {10, 10, 0}, random), 1000U);
}

} // namespace
} // namespace phantom::test
