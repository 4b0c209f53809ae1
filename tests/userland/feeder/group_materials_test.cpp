// SPDX-License-Identifier: GPL-2.0-or-later
// Materials of groups of faces, from the scene file to the patches of a set.
#include <gtest/gtest.h>

#include "../scene/folder.hpp"
#include "feeder/feeder.hpp"
#include "scene/scene.hpp"

namespace phantom::feeder {
namespace {

/// A plate of two by one quads; the left one is "soft", the right one "hard".
constexpr const char* const plate = "v 0 0 0\nv 20 0 0\nv 40 0 0\nv 0 20 0\nv 20 20 0\nv 40 20 0\n"
                                    "usemtl soft\nf 1 2 5 4\nusemtl hard\nf 2 3 6 5\n";

class GroupMaterials : public ::testing::Test {
  protected:
    GroupMaterials() { folder.write("plate.obj", plate); }

    Result<scene::Scene> scene_of(const std::string& keys, const scene::LoadOptions& options = {})
    {
        return scene::load(folder.write("a.toml", "[material.gum]\nstiffness_n_mm = 0.2\nradius_mm = 4\n"
                                                  "[material.steel]\nstiffness_n_mm = 3\n"
                                                  "[[object]]\nmesh = \"plate.obj\"\n" +
                                                      keys + "\n"),
                           options);
    }
    std::string error_of(const std::string& keys)
    {
        const auto scene = scene_of(keys);
        if (scene)
            return "none";
        const std::string text = scene.error().text();
        return text.substr(text.find("a.toml"));
    }
    static device::PatchSet set_of(const scene::Scene& scene, const Vec3& centre)
    {
        const auto tree = scene::build_tree<14>(scene);
        fdh::Nearest near;
        tree.nearest(centre, 64, 100, near);
        near.sort();
        device::PatchSet set;
        SetBuilder(scene).build(near, centre, set);
        return set;
    }
    /// By where the patches are.
    static void expect_halves(const device::PatchSet& set, std::uint32_t left, std::uint32_t right)
    {
        ASSERT_GE(set.patches.size(), 4U);
        for (const phantom_patch& patch : set.patches) {
            double x = 0;
            for (const auto& vertex : patch.vertex_nm)
                x += (vertex[0] + static_cast<double>(set.header.origin_nm[0])) / 3e6;
            if (patch.kind == PHANTOM_PATCH_FACE) {
                EXPECT_EQ(set.materials[patch.material].stiffness_mn_mm, x < 20 ? left : right) << x;
            }
        }
    }
    scene::test::Folder folder;
};

TEST_F(GroupMaterials, GoToThePatchesOfTheirFaces)
{
    const auto both = scene_of("material = \"steel\"\nmaterials = { soft = \"gum\" }\nsplit_mm = 9");
    ASSERT_TRUE(both) << both.error().text();
    expect_halves(set_of(*both, {19, 8, 1}), 200, 3000);
    EXPECT_EQ(both->max_radius_mm(both->objects.front()), 4);
    EXPECT_TRUE(both->uses(0) && both->uses(1));
    const auto named = scene_of("materials = { soft = \"steel\", hard = \"gum\" }");
    ASSERT_TRUE(named) << named.error().text();
    expect_halves(set_of(*named, {19, 8, 1}), 3000, 200);
    const auto one = scene_of("material = \"gum\"");
    ASSERT_TRUE(one) << one.error().text();
    EXPECT_TRUE(one->objects.front().group_materials.empty());
    EXPECT_EQ(set_of(*one, {19, 8, 1}).materials.size(), 1U);
    // The builder forgets which material had which number.
    const auto tree = scene::build_tree<14>(*both);
    SetBuilder builder(*both);
    fdh::Nearest near;
    for (const Vec3& centre : {Vec3{1, 1, 1}, Vec3{39, 19, 1}, Vec3{20, 10, 1}}) {
        tree.nearest(centre, 4, 100, near);
        near.sort();
        device::PatchSet again, fresh;
        builder.build(near, centre, again);
        SetBuilder(*both).build(near, centre, fresh);
        ASSERT_EQ(again.materials.size(), fresh.materials.size());
        for (std::size_t i = 0; i < again.patches.size(); ++i)
            EXPECT_EQ(again.patches[i].material, fresh.patches[i].material);
    }
}

TEST_F(GroupMaterials, ComeOutOfTheCacheAsTheyWere)
{
    scene::LoadOptions options;
    options.cache = folder.path() / "cache";
    for (const bool cached : {false, true}) {
        const auto scene = scene_of("material = \"steel\"\nmaterials = { soft = \"gum\" }", options);
        ASSERT_TRUE(scene) << scene.error().text();
        EXPECT_EQ(scene->objects.front().from_cache, cached);
        EXPECT_EQ(scene->objects.front().mesh.group_names, (std::vector<std::string>{"soft", "hard"}));
        expect_halves(set_of(*scene, {19, 8, 1}), 200, 3000);
    }
}

TEST_F(GroupMaterials, FaultsAreNamedWithTheirLine)
{
    EXPECT_EQ(error_of("materials = { sofd = \"gum\" }"),
              "a.toml:8: plate: materials.sofd: the mesh has no such group of faces, expected soft, hard");
    EXPECT_EQ(error_of("materials = { soft = \"rubber\" }"),
              "a.toml:8: object 1: materials.soft: no [material.rubber] in this file");
    EXPECT_EQ(error_of("materials = { soft = 3 }"),
              "a.toml:8: object 1: materials.soft: is 3, expected the name of a [material.NAME]");
    EXPECT_EQ(error_of("materials = \"gum\""), "a.toml:8: object 1: materials: is \"gum\", expected a table");
    folder.write("plate.obj", "v 0 0 0\nv 20 0 0\nv 0 20 0\nf 1 2 3\n");
    EXPECT_EQ(error_of("materials = { soft = \"gum\" }"),
              "a.toml:8: plate: materials.soft: the mesh has no such group of faces, and no group at all");
}

} // namespace
} // namespace phantom::feeder
