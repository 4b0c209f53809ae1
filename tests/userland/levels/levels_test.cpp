// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/levels.hpp"

#include <gtest/gtest.h>

#include "study/bumpy_sphere.hpp"
#include "surfaces.hpp"

namespace phantom::test {
namespace {

scene::Object object_of(const std::string& name, mesh::Mesh mesh)
{
    scene::Object object;
    object.name = name;
    object.mesh = std::move(mesh);
    object.fans = mesh::make_fans(object.mesh);
    return object;
}

scene::Scene fine_and_coarse()
{
    scene::Scene scene;
    scene.materials.push_back({.name = "fine", .radius_mm = 0.5});
    scene.materials.push_back({.name = "coarse", .radius_mm = 0.5});
    scene.objects.push_back(object_of("sphere", *study::bumpy_sphere(40)));
    scene.objects.push_back(object_of("cube", prepared(cut_cube(2, {200, 0, 0}))));
    scene.objects[1].material = 1;
    scene.objects[1].first_face = static_cast<std::uint32_t>(scene.objects[0].mesh.faces.size());
    scene.objects[1].first_vertex = static_cast<std::uint32_t>(scene.objects[0].mesh.vertices.size());
    return scene;
}

TEST(Levels, OfASceneThatDoesNotNeedThemAreNone)
{
    scene::Scene scene;
    scene.materials.push_back({});
    scene.objects.push_back(object_of("cube", prepared(cut_cube(2))));
    const scene::Levels levels = scene::build_levels(scene, scene::build_tree<14>(scene));
    EXPECT_EQ(levels.size(), 1U);
    EXPECT_GT(levels.finest.p1_mm, 8.5);
    EXPECT_EQ(levels.error_mm(0), 0);
}

TEST(Levels, LastUntilTheSpeedThatTheyAreBuiltFor)
{
    const scene::Scene scene = fine_and_coarse();
    const scene::Levels levels = scene::build_levels(scene, scene::build_tree<14>(scene));
    ASSERT_GT(levels.size(), 2U);
    const double needed_mm = scene::reach_needed_mm(0.5, scene::fastest_hand_mm_s, scene::slow_feed_s);
    EXPECT_NEAR(needed_mm, 8, 1e-9);
    EXPECT_LT(levels.finest.p1_mm, needed_mm);
    EXPECT_GE(levels.coverage(levels.size() - 1).p1_mm, needed_mm);
    EXPECT_LT(levels.coverage(levels.size() - 2).p1_mm, needed_mm);
    for (std::size_t i = 1; i < levels.size(); ++i) {
        EXPECT_GT(levels.error_mm(i), levels.error_mm(i - 1));
        EXPECT_LT(levels.coarser[i - 1].scene.triangles(), scene.triangles());
    }
    // Less is asked for: fewer levels.
    const scene::Levels slower =
        scene::build_levels(scene, scene::build_tree<14>(scene), {.speed_mm_s = 100});
    EXPECT_LT(slower.size(), levels.size());
}

TEST(Levels, ShareWhatIsTheSame)
{
    const scene::Scene scene = fine_and_coarse();
    const scene::Levels levels =
        scene::build_levels(scene, scene::build_tree<14>(scene), {.speed_mm_s = 300});
    ASSERT_GT(levels.size(), 1U);
    for (const scene::Level& level : levels.coarser) {
        ASSERT_EQ(level.scene.objects.size(), 2U);
        const scene::Object &sphere = level.scene.objects[0], &cube = level.scene.objects[1];
        EXPECT_LT(sphere.mesh.faces.size(), scene.objects[0].mesh.faces.size());
        EXPECT_EQ(cube.mesh.vertices.data(), scene.objects[1].mesh.vertices.data()) << "not a copy";
        EXPECT_EQ(cube.material, 1U);
        EXPECT_EQ(level.scene.materials[1].name, "coarse");
        EXPECT_EQ(cube.first_face, sphere.mesh.faces.size());
        EXPECT_EQ(cube.first_vertex, sphere.mesh.vertices.size());
        EXPECT_EQ(level.tree.triangles(), level.scene.triangles());
        EXPECT_EQ(level.tree.tree(0).triangles(), sphere.mesh.faces.size());
        EXPECT_DOUBLE_EQ(level.error_mm, sphere.error_mm);
    }
}

TEST(Levels, WishIsOneOfThreeWords)
{
    EXPECT_TRUE(scene::level_wish("auto")->on);
    EXPECT_FALSE(scene::level_wish("auto")->fixed);
    EXPECT_FALSE(scene::level_wish("off")->on);
    EXPECT_EQ(scene::level_wish("3")->fixed, 3U);
    for (const char* word : {"", "on", "-1", "1.5", "2x", "99999999999"})
        EXPECT_FALSE(scene::level_wish(word)) << word;
}

} // namespace
} // namespace phantom::test
