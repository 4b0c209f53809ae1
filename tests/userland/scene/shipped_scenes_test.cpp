// SPDX-License-Identifier: GPL-2.0-or-later
// What lies in scenes/ loads without a defect, and the generated meshes are what the generator makes.
#include <cstdlib>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scene/scene.hpp"

namespace phantom::scene::test {
namespace {

const std::filesystem::path root = PHANTOM_ROOT;

TEST(ShippedScenes, LoadWithoutADefect)
{
    std::size_t scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(root / "scenes")) {
        if (entry.path().extension() != ".toml")
            continue;
        ++scenes;
        if (entry.path().filename() == "bunny.toml" &&
            !std::filesystem::exists("/usr/share/glmark2/models/bunny.obj"))
            continue; // package glmark2-data is not installed
        const auto scene = load(entry.path(), {});
        ASSERT_TRUE(scene.ok()) << scene.error().text();
        for (const Object& object : scene->objects) {
            EXPECT_TRUE(object.report.watertight) << entry.path() << " " << object.name;
            EXPECT_TRUE(object.report.warnings.empty()) << entry.path() << " " << object.name;
            EXPECT_EQ(object.report.normals_repaired, 0U) << entry.path() << " " << object.name;
        }
    }
    EXPECT_EQ(scenes, 13U);
}

TEST(ShippedScenes, PaperSceneHasAboutTwentyThousandTriangles)
{
    const auto scene = load(root / "scenes/paper20k.toml", {});
    ASSERT_TRUE(scene.ok()) << scene.error().text();
    EXPECT_EQ(scene->objects.size(), 5U);
    EXPECT_NEAR(static_cast<double>(scene->triangles()), 20000, 500);
    for (const Object& object : scene->objects)
        EXPECT_EQ(object.report.components_turned, 0U) << object.name;
}

TEST(ShippedScenes, GeneratorReproducesTheMeshes)
{
    if (std::system("python3 --version > /dev/null 2>&1") != 0)
        GTEST_SKIP() << "python3 is not installed";
    const std::string command = fmt::format("'{}' --check", (root / "tools/make-scenes").string());
    EXPECT_EQ(std::system(command.c_str()), 0);
}

} // namespace
} // namespace phantom::scene::test
