// SPDX-License-Identifier: GPL-2.0-or-later
// A set against the scene it was built from.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include "feeder/feeder.hpp"
#include "mesh/nearest_on_triangle.hpp"
#include "scenes.hpp"

namespace phantom::test {
namespace {

/// Two spheres that touch, the second turned and moved, of two materials.
scene::Scene two_spheres()
{
    scene::Scene scene;
    scene.materials.push_back({"unused", 9.0, 9.0, 9.0});
    scene.materials.push_back({"plain", 0.5, 2.0, {}});
    scene.materials.push_back({"damped", 1.25, 1.5, 0.75});
    add_object(scene, sphere(20.0, 16, 32), {}, 1);
    add_object(scene, sphere(20.0, 16, 32), quarter_turn({40.0, 0.0, 0.0}), 2);
    return scene;
}

/// As a query might answer, exactly.
fdh::Nearest answer(std::vector<fdh::Hit> hits, double coverage)
{
    fdh::Nearest nearest;
    nearest.hits = std::move(hits);
    nearest.coverage = coverage;
    return nearest;
}

struct Built {
    scene::Scene scene = two_spheres();
    fdh::SceneTree<14> tree = scene::build_tree<14>(scene);
    feeder::SetBuilder builder{scene};
    device::PatchSet set;
    fdh::Nearest near;

    void at(const Vector& centre, std::size_t count)
    {
        tree.nearest(centre, count, 50.0, near);
        near.sort();
        builder.build(near, centre, set);
    }
    /// A corner of a patch, in the world, as the scene has it.
    Vector corner(const phantom_patch& patch, int corner_number) const
    {
        const scene::Object& object = scene.objects[patch.face >= scene.objects[1].first_face ? 1 : 0];
        return corner(object, patch.face - object.first_face, corner_number);
    }
    static Vector corner(const scene::Object& object, std::uint32_t face, int corner_number)
    {
        const Vector& v = object.mesh.vertices[object.mesh.faces[face][corner_number]];
        const auto& r = object.pose.rotation;
        Vector out = object.pose.translation;
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                out[row] += r[3 * row + column] * v[column];
        return out;
    }
};

/// Between the spheres, nearer to the second.
constexpr Vector between{20.7, 0.31, 1.123456789};

TEST(SetBuilder, PositionsAreTheWorldPositionsRoundedToNanometres)
{
    Built built;
    built.at(between, 100);
    ASSERT_EQ(built.set.patches.size(), 100U);
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_EQ(built.set.header.origin_nm[axis], std::llround(between[axis] * 1e6));
    for (const phantom_patch& patch : built.set.patches)
        for (int corner = 0; corner < 3; ++corner) {
            const Vector world = built.corner(patch, corner);
            for (int axis = 0; axis < 3; ++axis) {
                const double nm =
                    static_cast<double>(built.set.header.origin_nm[axis] + patch.vertex_nm[corner][axis]);
                EXPECT_LE(std::abs(nm - world[axis] * 1e6), 0.5 + 1e-6);
            }
        }
}

TEST(SetBuilder, NormalsAreUnitInQ30AndTurnedWithTheObject)
{
    Built built;
    built.at(between, 100);
    bool turned = false;
    for (const phantom_patch& patch : built.set.patches) {
        const scene::Object& object = built.scene.objects[built.set.objects[patch.object].object];
        turned = turned || &object == &built.scene.objects[1];
        for (int corner = 0; corner < 3; ++corner) {
            const Vector world = built.corner(patch, corner);
            double squared = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const double n = patch.normal_q30[corner][axis] / double{PHANTOM_Q30_ONE};
                squared += n * n;
                // Radial: the sphere's own normal, wherever the sphere is.
                EXPECT_NEAR(n, (world[axis] - object.pose.translation[axis]) / 20.0, 2e-9);
            }
            EXPECT_NEAR(std::sqrt(squared), 1.0, 2e-9);
        }
    }
    EXPECT_TRUE(turned);
}

TEST(SetBuilder, ANormalWithoutDirectionBecomesTheFacesOwn)
{
    scene::Scene scene;
    scene.materials.push_back({});
    mesh::Mesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.faces = {{0, 1, 2}};
    mesh.normals = {{0, 0, 0}};
    mesh.face_normals = {{0, 0, 0}};
    connect(mesh);
    add_object(scene, mesh, {}, 0);
    feeder::SetBuilder builder(scene);
    device::PatchSet set;
    builder.build(answer({{0, 0, 0.0}}, 1.0), {0, 0, 0}, set);
    ASSERT_EQ(set.patches.size(), 1U);
    for (int corner = 0; corner < 3; ++corner)
        EXPECT_EQ(set.patches[0].normal_q30[corner][2], PHANTOM_Q30_ONE);
}

TEST(SetBuilder, AdjacencyIsSymmetricAndNamesTheSceneNeighbour)
{
    Built built;
    built.at(between, 100);
    const auto& patches = built.set.patches;
    int inside = 0, outside = 0;
    for (std::uint32_t i = 0; i < patches.size(); ++i) {
        const scene::Object& object = built.scene.objects[built.set.objects[patches[i].object].object];
        const mesh::Triple& expected = object.mesh.neighbours[patches[i].face - object.first_face];
        for (int edge = 0; edge < 3; ++edge) {
            const std::uint32_t neighbour = patches[i].neighbour[edge];
            if (neighbour == PHANTOM_PATCH_NONE) {
                ++outside;
                for (const phantom_patch& patch : patches)
                    EXPECT_NE(patch.face, object.first_face + expected[edge]);
                continue;
            }
            ++inside;
            ASSERT_LT(neighbour, patches.size());
            EXPECT_EQ(patches[neighbour].face, object.first_face + expected[edge]);
            EXPECT_EQ(std::count(patches[neighbour].neighbour, patches[neighbour].neighbour + 3, i), 1);
        }
    }
    EXPECT_GT(inside, 100);
    EXPECT_GT(outside, 5);
}

TEST(SetBuilder, FacesAndVerticesHaveSceneWideNumbers)
{
    Built built;
    built.at(between, 100);
    for (const phantom_patch& patch : built.set.patches) {
        const scene::Object& object = built.scene.objects[built.set.objects[patch.object].object];
        const mesh::Triple& corners = object.mesh.faces[patch.face - object.first_face];
        for (int corner = 0; corner < 3; ++corner)
            EXPECT_EQ(patch.vertex[corner], object.first_vertex + corners[corner]);
    }
}

TEST(SetBuilder, OnlyMaterialsThatAreUsedAreCarriedWithTheirEffects)
{
    Built built;
    built.at(between, 100);
    ASSERT_EQ(built.set.materials.size(), 2U);
    ASSERT_EQ(built.set.objects.size(), 2U);
    for (const phantom_patch& patch : built.set.patches) {
        const bool second = built.set.objects[patch.object].object == 1;
        const phantom_material& material = built.set.materials[patch.material];
        EXPECT_EQ(material.stiffness_mn_mm, second ? 1250U : 500U);
        EXPECT_EQ(material.radius_nm, second ? 1500000U : 2000000U);
        EXPECT_EQ(material.damping_mns_m, second ? 750U : 0U);
        EXPECT_EQ(material.effects, second ? PHANTOM_EFFECT_DAMPING : 0U);
    }
    // Far from the damped one nobody calls for damping.
    built.at({-20.5, 0, 0}, 20);
    ASSERT_EQ(built.set.materials.size(), 1U);
    EXPECT_EQ(built.set.materials[0].effects, 0U);
}

TEST(SetBuilder, EffectsHaveTheirTablesAndTheModuleTakesThem)
{
    Built built;
    scene::Material& left = built.scene.materials[built.scene.objects[0].material];
    scene::Material& right = built.scene.materials[built.scene.objects[1].material];
    left.friction = scene::Friction{0.6, 0.4, 2, 10};
    right.friction = scene::Friction{0.3, 0.2, 1, 0};
    right.magnet = scene::Magnet{0.25, 0.1};
    right.texture = scene::Texture{{0.05, 2, {0, -1, 0}}, {}};
    feeder::SetBuilder builder(built.scene);
    const auto build = [&built, &builder](const Vector& centre, std::size_t count) {
        built.tree.nearest(centre, count, 50.0, built.near);
        built.near.sort();
        builder.build(built.near, centre, built.set);
    };
    Result<device::Device> device = device::Device::open_usermode({.virtual_clock = true});
    ASSERT_TRUE(device);
    build(between, 100);
    const phantom_magnet magnet{250'000, 100'000};
    const phantom_friction first{600'000, 400'000, 2000, 10'000}, second{300'000, 200'000, 1000, 0};
    const phantom_texture texture{{50'000, 0}, {{0, -500'000, 0}, {0, 0, 0}}};
    std::vector<std::uint64_t> expected;
    const auto add = [&expected](const auto& entry) {
        const std::size_t before = expected.size();
        expected.resize(before + sizeof entry / sizeof(std::uint64_t));
        std::memcpy(&expected[before], &entry, sizeof entry);
    };
    add(magnet);
    add(first);
    add(second);
    add(texture);
    EXPECT_EQ(built.set.effect_tables, expected);
    EXPECT_TRUE(device->submit(built.set));
    EXPECT_EQ(built.set.header.effects & ~PHANTOM_EFFECT_DAMPING,
              PHANTOM_EFFECT_MAGNET | PHANTOM_EFFECT_FRICTION | PHANTOM_EFFECT_TEXTURE);
    // Only the first sphere's, where it is alone.
    build({-20.5, 0, 0}, 20);
    expected.clear();
    add(first);
    EXPECT_EQ(built.set.effect_tables, expected);
    EXPECT_TRUE(device->submit(built.set));
}

TEST(SetBuilder, CoverageHoldsAgainstBruteForce)
{
    Built built;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> coordinate(-30, 70);
    for (int round = 0; round < 200; ++round) {
        const Vector centre{coordinate(random), coordinate(random) / 3, coordinate(random) / 3};
        built.at(centre, 40);
        const double covered_mm = built.set.header.radius_nm * 1e-6;
        EXPECT_LE(covered_mm, built.near.coverage);
        EXPECT_GE(covered_mm, built.near.coverage - 4e-6);
        std::vector<std::uint32_t> faces;
        for (const phantom_patch& patch : built.set.patches)
            faces.push_back(patch.face);
        // Every triangle that the whole scene has within the promise is there.
        for (const scene::Object& object : built.scene.objects)
            for (std::uint32_t face = 0; face < object.mesh.faces.size(); ++face) {
                std::array<mesh::Vec3, 3> x;
                for (int i = 0; i < 3; ++i)
                    x[i] = Built::corner(object, face, i);
                if (mesh::distance_to_triangle(centre, x) < covered_mm) {
                    EXPECT_EQ(std::count(faces.begin(), faces.end(), object.first_face + face), 1);
                }
            }
    }
}

TEST(SetBuilder, TheOrderOfTheHitsChangesNoBit)
{
    Built built;
    built.at(between, 60);
    const auto expected = built.set.patches;
    fdh::Nearest near = built.near;
    std::mt19937 random(6);
    std::shuffle(near.hits.begin(), near.hits.end(), random);
    built.builder.build(near, between, built.set);
    ASSERT_EQ(built.set.patches.size(), expected.size());
    EXPECT_EQ(std::memcmp(built.set.patches.data(), expected.data(), expected.size() * sizeof(phantom_patch)),
              0);
}

TEST(SetBuilder, TooManyMaterialsEndTheCoverageAtTheFirstLeftOut)
{
    scene::Scene scene;
    std::vector<fdh::Hit> hits;
    for (std::uint32_t i = 0; i < PHANTOM_MATERIALS_MAX + 3; ++i) {
        scene.materials.push_back({});
        add_object(scene, sphere(1.0, 4, 6), {}, i);
        hits.push_back({i, 0, 0.5 * i});
    }
    feeder::SetBuilder builder(scene);
    device::PatchSet set;
    fdh::Nearest near = answer(hits, 100.0);
    near.distance_error = 0.25;
    builder.build(near, {0, 0, 0}, set);
    EXPECT_EQ(set.materials.size(), std::size_t{PHANTOM_MATERIALS_MAX});
    EXPECT_EQ(set.patches.size(), std::size_t{PHANTOM_MATERIALS_MAX});
    EXPECT_LE(set.header.radius_nm, 7750000U) << "16 half millimetres, less what they may be off by";
    EXPECT_GE(set.header.radius_nm, 7749990U);
    // The scratch is clean: the next set knows nothing of this one.
    builder.build(answer({hits[17]}, 1.0), {0, 0, 0}, set);
    ASSERT_EQ(set.materials.size(), 1U);
    EXPECT_EQ(set.patches[0].material, 0U);
}

TEST(SetBuilder, EverythingCoversEverything)
{
    Built built;
    built.builder.build_all({20, 0, 0}, built.set);
    EXPECT_EQ(built.set.patches.size(), built.scene.triangles());
    EXPECT_EQ(built.set.header.radius_nm, 0xffffffffU);
    for (const phantom_patch& patch : built.set.patches)
        for (const __u32 neighbour : patch.neighbour)
            EXPECT_NE(neighbour, PHANTOM_PATCH_NONE);
}

/// A box with face normals: two fans over each of 12 edges, one over each of 8 corners.
scene::Scene creased_box()
{
    mesh::Soup soup;
    for (int c = 0; c < 8; ++c)
        soup.vertices.push_back({c & 1 ? 5.0 : -5.0, c & 2 ? 4.0 : -4.0, c & 4 ? 3.0 : -3.0});
    soup.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                  {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    auto prepared = mesh::prepare(std::move(soup), {}, "box");
    scene::Scene scene;
    scene.materials.push_back({});
    add_object(scene, std::move(prepared->mesh), quarter_turn({100, 0, 0}), 0);
    scene.objects[0].fans = mesh::make_fans(scene.objects[0].mesh);
    return scene;
}

TEST(SetBuilder, FansFollowTheFacesTheyLieAt)
{
    const scene::Scene scene = creased_box();
    feeder::SetBuilder builder(scene);
    device::PatchSet set;
    builder.build_all({100, 0, 0}, set);
    ASSERT_EQ(set.patches.size(), 12U + 32U);
    EXPECT_EQ(scene.patches(), set.patches.size());
    std::array<int, 3> kinds{};
    for (std::size_t i = 0; i < set.patches.size(); ++i) {
        const phantom_patch& patch = set.patches[i];
        ++kinds[patch.kind];
        EXPECT_EQ(patch.kind == PHANTOM_PATCH_FACE, i < 12);
        if (i < 12)
            continue;
        EXPECT_EQ(patch.face, PHANTOM_PATCH_NONE);
        for (int corner = 0; corner < 3; ++corner) {
            EXPECT_EQ(patch.neighbour[corner], PHANTOM_PATCH_NONE);
            // turned with the object: the normals of a box lean to the side where their corner is
            double lean = 0;
            for (int axis = 0; axis < 3; ++axis)
                lean += static_cast<double>(patch.normal_q30[corner][axis]) * patch.vertex_nm[corner][axis];
            EXPECT_GT(lean, 0);
        }
    }
    EXPECT_EQ(kinds, (std::array<int, 3>{12, 24, 8}));
}

TEST(SetBuilder, TooManyPatchesEndTheCoverageAtTheFirstFaceLeftOut)
{
    const scene::Scene scene = creased_box();
    const fdh::SceneTree<14> tree = scene::build_tree<14>(scene);
    feeder::SetBuilder builder(scene, 20);
    fdh::Nearest near;
    tree.nearest({107, 0, 0}, 12, 50.0, near);
    device::PatchSet set;
    near.sort();
    builder.build(near, {107, 0, 0}, set);
    EXPECT_LE(set.patches.size(), 20U);
    const auto faces = std::count_if(set.patches.begin(), set.patches.end(),
                                     [](const phantom_patch& p) { return p.kind == PHANTOM_PATCH_FACE; });
    ASSERT_LT(faces, 12);
    ASSERT_GT(faces, 0);
    EXPECT_LE(set.header.radius_nm * 1e-6, near.hits[static_cast<std::size_t>(faces)].distance);
}

TEST(CheckReach, RefusesATriangleThatNoSetCanCarryAndNamesTheRemedy)
{
    scene::Scene scene;
    scene.materials.push_back({});
    mesh::Mesh mesh;
    mesh.vertices = {{0, 0, 0}, {2000, 0, 0}, {0, 10, 0}};
    mesh.faces = {{0, 1, 2}};
    mesh.normals = {{0, 0, 1}};
    mesh.face_normals = {{0, 0, 0}};
    connect(mesh);
    add_object(scene, mesh, {}, 0);
    const Status status = feeder::check_reach(scene, {});
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.error().text().find("face 0"), std::string::npos);
    EXPECT_NE(status.error().text().find("--split"), std::string::npos);
    EXPECT_TRUE(feeder::check_reach(sphere_scene(), {}).ok());
}

} // namespace
} // namespace phantom::test
