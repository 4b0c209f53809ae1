// SPDX-License-Identifier: GPL-2.0-or-later
// Effects of space and of surfaces as scene files name them: what is read, and what is refused.
#include <gtest/gtest.h>

#include "folder.hpp"
#include "scene/scene.hpp"

namespace phantom::scene::test {
namespace {

class EffectKeys : public testing::Test {
  protected:
    /// A sound object on lines 1 to 3, the text from line 4 on.
    Result<Scene> scene_of(const std::string& text)
    {
        folder.write("part.obj", tetrahedron);
        return load(folder.write("a.toml", "[[object]]\nmesh = \"part.obj\"\nmaterial = \"m\"\n" + text), {});
    }
    /// Of the text below [material.m] on line 4.
    std::string error_of(const std::string& text)
    {
        const auto scene = scene_of("[material.m]\n" + text);
        if (scene)
            return "none";
        const std::string error = scene.error().text();
        return error.substr(error.find("a.toml"));
    }
    Folder folder;
};

TEST_F(EffectKeys, OfSpaceAreRead)
{
    const auto scene = scene_of(
        "[material.m]\n[effect.gravity]\nkind = \"constant\"\nforce_n = [0.25, 0, -0.5]\n"
        "[effect.honey]\nkind = \"viscosity\"\nviscosity_ns_m = 3\ndrag_ns2_m2 = 2\ncentre_mm = [1, 2, 3]\n"
        "radius_mm = 20\nborder_mm = 5\n"
        "[effect.air]\nkind = \"viscosity\"\ndrag_ns2_m2 = 1\n"
        "[effect.rail]\nkind = \"guide\"\nto = \"line\"\npoint_mm = [0, 0, 50]\ndirection = [0, 3, 4]\n"
        "stiffness_n_mm = 0.5\nforce_n = 2\nreach_mm = 10\n");
    ASSERT_TRUE(scene) << scene.error().text();
    ASSERT_EQ(scene->effects.size(), 4U);
    const auto named = [&scene](const std::string& name) -> const SpaceEffect& {
        return *std::find_if(scene->effects.begin(), scene->effects.end(),
                             [&name](const SpaceEffect& effect) { return effect.name == name; });
    };
    EXPECT_EQ(std::get<ConstantForce>(named("gravity").law).force_n, (std::array<double, 3>{0.25, 0, -0.5}));
    const auto& honey = std::get<Viscosity>(named("honey").law);
    EXPECT_EQ(honey.viscosity_ns_m, 3);
    EXPECT_EQ(honey.drag_ns2_m2, 2);
    EXPECT_EQ(honey.centre_mm, (std::array<double, 3>{1, 2, 3}));
    EXPECT_EQ(honey.radius_mm, 20);
    EXPECT_EQ(honey.border_mm, 5);
    const auto& air = std::get<Viscosity>(named("air").law);
    EXPECT_FALSE(air.radius_mm || air.border_mm);
    const auto& rail = std::get<Guide>(named("rail").law);
    EXPECT_EQ(rail.to, Guide::Place::line);
    EXPECT_EQ(rail.point_mm, (std::array<double, 3>{0, 0, 50}));
    EXPECT_EQ(rail.direction, (std::array<double, 3>{0, 0.6, 0.8}));
    EXPECT_EQ(rail.stiffness_n_mm, 0.5);
    EXPECT_EQ(rail.force_n, 2);
    EXPECT_EQ(rail.reach_mm, 10);
}

TEST_F(EffectKeys, OfSpaceThatAreWrongAreToldWithTheirLine)
{
    EXPECT_EQ(error_of("[effect]\nx = 3\n"), "a.toml:6: effect.x: is 3, expected a table [effect.NAME]");
    EXPECT_EQ(error_of("[effect.x]\nforce_n = [0, 0, 0]\n"),
              "a.toml:5: effect.x.kind: is missing, expected \"constant\" or \"viscosity\" or \"guide\"");
    EXPECT_EQ(error_of("[effect.x]\nkind = \"wind\"\n"),
              "a.toml:6: effect.x.kind: is \"wind\", expected \"constant\" or \"viscosity\" or \"guide\"");
    EXPECT_EQ(error_of("[effect.m]\nkind = \"constant\"\nforce_n = [0, 0, 0]\n"),
              "a.toml:5: effect.m: is the name of a material, expected another");
    EXPECT_EQ(error_of("[effect.x]\nkind = \"constant\"\n"),
              "a.toml:5: effect.x.force_n: is missing, expected [x, y, z], each -100 ... 100 N");
    EXPECT_EQ(error_of("[effect.x]\nkind = \"constant\"\nforce_n = [0, 0, 101]\n"),
              "a.toml:7: effect.x.force_n: number 3 is 101, expected -100 ... 100 N");
    EXPECT_EQ(error_of("[effect.x]\nkind = \"constant\"\nforce_n = 3\n"),
              "a.toml:7: effect.x.force_n: is 3, expected [3 numbers]");
    EXPECT_EQ(error_of("[effect.x]\nkind = \"constant\"\nforce_n = [0, 0, 0]\nradius_mm = 3\n"),
              "a.toml:8: effect.x.radius_mm: unknown key, expected kind, force_n");
}

TEST_F(EffectKeys, MediaThatAreWrongAreToldWithTheirLine)
{
    const std::string medium = "[effect.x]\nkind = \"viscosity\"\n";
    EXPECT_EQ(error_of(medium), "a.toml:5: effect.x.viscosity_ns_m: is zero as drag_ns2_m2 is, expected one "
                                "of them to be more");
    EXPECT_EQ(error_of(medium + "viscosity_ns_m = 20.1\n"),
              "a.toml:7: effect.x.viscosity_ns_m: is 20.1, expected 0 ... 20 N*s/m");
    EXPECT_EQ(error_of(medium + "drag_ns2_m2 = -1\n"),
              "a.toml:7: effect.x.drag_ns2_m2: is -1, expected 0 ... 1000 N*s^2/m^2");
    EXPECT_EQ(error_of(medium + "viscosity_ns_m = 1\nborder_mm = 1\n"),
              "a.toml:8: effect.x.border_mm: has no meaning without radius_mm");
    EXPECT_EQ(error_of(medium + "viscosity_ns_m = 1\ncentre_mm = [1, 0, 0]\n"),
              "a.toml:8: effect.x.centre_mm: has no meaning without radius_mm");
    EXPECT_EQ(error_of(medium + "viscosity_ns_m = 1\nradius_mm = 0.01\n"),
              "a.toml:8: effect.x.radius_mm: is 0.01, expected 0.1 ... 1000 mm");
    EXPECT_EQ(error_of(medium + "viscosity_ns_m = 1\nradius_mm = 2\nborder_mm = 3\n"),
              "a.toml:9: effect.x.border_mm: is 3, expected no more than radius_mm, 2");
}

TEST_F(EffectKeys, GuidesThatAreWrongAreToldWithTheirLine)
{
    const std::string guide =
        "[effect.x]\nkind = \"guide\"\npoint_mm = [0, 0, 0]\nstiffness_n_mm = 1\nforce_n = 1\n";
    EXPECT_EQ(error_of(guide),
              "a.toml:5: effect.x.to: is missing, expected \"point\" or \"line\" or \"plane\"");
    EXPECT_EQ(error_of(guide + "to = \"ring\"\n"),
              "a.toml:10: effect.x.to: is \"ring\", expected point, line, plane");
    EXPECT_EQ(error_of(guide + "to = \"line\"\n"),
              "a.toml:5: effect.x.direction: is missing, expected [x, y, z] along the line");
    EXPECT_EQ(error_of(guide + "to = \"plane\"\n"),
              "a.toml:5: effect.x.direction: is missing, expected [x, y, z] across the plane");
    EXPECT_EQ(error_of(guide + "to = \"plane\"\ndirection = [0, 0, 0]\n"),
              "a.toml:11: effect.x.direction: has no length, expected a direction");
    EXPECT_EQ(error_of(guide + "to = \"point\"\ndirection = [0, 0, 1]\n"),
              "a.toml:11: effect.x.direction: has no meaning with to = \"point\"");
    EXPECT_EQ(error_of(guide + "to = \"point\"\nreach_mm = 1001\n"),
              "a.toml:11: effect.x.reach_mm: is 1001, expected 0.1 ... 1000 mm");
    EXPECT_EQ(error_of("[effect.x]\nkind = \"guide\"\nto = \"point\"\npoint_mm = [0, 0, 0]\nforce_n = 1\n"
                       "stiffness_n_mm = 0\n"),
              "a.toml:10: effect.x.stiffness_n_mm: is 0, expected 0.001 ... 100 N/mm");
}

TEST_F(EffectKeys, MoreThanASetCarriesAreRefused)
{
    std::string media, forces;
    for (int i = 1; i <= 9; ++i)
        media += "[effect.m" + std::to_string(i) + "]\nkind = \"viscosity\"\nviscosity_ns_m = 1\n";
    EXPECT_EQ(error_of(media),
              "a.toml:29: effect.m9: is one too many, expected at most 8 of the kind \"viscosity\"");
    for (int i = 1; i <= 3; ++i)
        forces += "[effect.f" + std::to_string(i) + "]\nkind = \"constant\"\nforce_n = [0, -40, 0]\n";
    EXPECT_EQ(error_of(forces), "a.toml:11: effect.f3: all constant forces together are -120 N along an "
                                "axis, expected -100 ... 100 N");
}

TEST_F(EffectKeys, ASecondGratingSharesTheSlope)
{
    const std::string first = "[material.m.texture]\namplitude_mm = 0.1\nwavelength_mm = 1\n";
    const auto scene = scene_of("[material.m]\n" + first +
                                "second = { amplitude_mm = 0.05, wavelength_mm = 2, direction = "
                                "[0, 2, 0] }\n");
    ASSERT_TRUE(scene) << scene.error().text();
    const Texture& texture = *scene->materials.front().texture;
    EXPECT_EQ(texture.first.amplitude_mm, 0.1);
    ASSERT_TRUE(texture.second);
    EXPECT_EQ(texture.second->amplitude_mm, 0.05);
    EXPECT_EQ(texture.second->direction, (std::array<double, 3>{0, 1, 0}));
    // 1 is the steepest: 0.999 - 0.628 is left.
    EXPECT_EQ(
        error_of(first + "second = { amplitude_mm = 0.06, wavelength_mm = 1 }\n"),
        "a.toml:8: material.m.texture.second.amplitude_mm: is 0.06, expected at most 0.059 for waves of "
        "1 mm beside the other grating");
    EXPECT_EQ(error_of(first + "second = 3\n"),
              "a.toml:8: material.m.texture.second: is 3, expected a table: another grating");
    EXPECT_EQ(error_of(first + "second = { amplitude_mm = 0.01 }\n"),
              "a.toml:8: material.m.texture.second.wavelength_mm: is missing, expected 0.02 ... 1000 mm");
}

TEST_F(EffectKeys, OnlyWhatIsUsedIsCalledFor)
{
    const auto scene = scene_of("[material.m]\n[material.other]\ndamping_ns_m = 1\n"
                                "[effect.x]\nkind = \"guide\"\nto = \"point\"\npoint_mm = [0, 0, 0]\n"
                                "stiffness_n_mm = 1\nforce_n = 1\n");
    ASSERT_TRUE(scene) << scene.error().text();
    EXPECT_EQ(scene->effects_called_for(), std::vector<std::string>{"guide"});
}

} // namespace
} // namespace phantom::scene::test
