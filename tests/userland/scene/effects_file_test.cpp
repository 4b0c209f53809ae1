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
              "a.toml:5: effect.x.kind: is missing, expected \"constant\" or \"viscosity\" or \"guide\" or "
              "\"field\" or \"tip\"");
    EXPECT_EQ(error_of("[effect.x]\nkind = \"wind\"\n"),
              "a.toml:6: effect.x.kind: is \"wind\", expected \"constant\" or \"viscosity\" or \"guide\" or "
              "\"field\" or \"tip\"");
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

/// 4 x 4 samples: one white among black ones.
const std::string speck = "P2\n4 4\n255\n255 0 0 0  0 0 0 0  0 0 0 0  0 0 0 0\n";

TEST_F(EffectKeys, AHeightMapIsAnImage)
{
    folder.write("speck.pgm", speck);
    folder.write("odd.pgm", "P2\n4 3\n255\n255 0 0 0  0 0 0 0  0 0 0 0\n");
    const std::string map = "[material.m.height_map]\nspacing_mm = 1\n";
    const auto scene = scene_of("[material.m]\n" + map + "height_mm = 0.4\nimage = \"speck.pgm\"\n");
    ASSERT_TRUE(scene) << scene.error().text();
    const HeightMap& read = *scene->materials.front().height_map;
    EXPECT_EQ(read.height_mm, 0.4);
    EXPECT_EQ(read.samples.at(0, 0), 1.0);
    EXPECT_EQ(read.steepest(), 2.0);
    EXPECT_EQ(scene->effects_called_for(), std::vector<std::string>{"height_map"});
    // Up and down by that much from one sample to the next, both ways: 45 degrees at half the spacing.
    EXPECT_EQ(
        error_of(map + "height_mm = 0.5\nimage = \"speck.pgm\"\n"),
        "a.toml:7: material.m.height_map.height_mm: is 0.5, expected at most 0.499 with that image and a "
        "spacing of 1 mm: no steeper than 45 degrees");
    EXPECT_EQ(error_of(map + "height_mm = 0.1\n"),
              "a.toml:5: material.m.height_map.image: is missing, expected a file");
    const std::string odd = error_of(map + "height_mm = 0.1\nimage = \"odd.pgm\"\n");
    EXPECT_TRUE(odd.starts_with("a.toml:8: material.m.height_map.image: ")) << odd;
    EXPECT_TRUE(odd.ends_with("odd.pgm: is 4 x 3, expected 4, 8, 16, 32 or 64 samples each way")) << odd;
    const std::string gone = error_of(map + "height_mm = 0.1\nimage = \"gone.pgm\"\n");
    EXPECT_TRUE(gone.starts_with("a.toml:8: material.m.height_map.image: ")) << gone;
    EXPECT_NE(gone.find("gone.pgm"), std::string::npos) << gone;
}

TEST_F(EffectKeys, ImpactsKeepTheirEnergyBounded)
{
    const std::string impact = "[material.m.impact]\nfrequency_hz = 100\ndecay_ms = 20\nforce_n = 1\n";
    const auto scene = scene_of("[material.m]\n" + impact + "gain_ns_m = 12.5\n");
    ASSERT_TRUE(scene) << scene.error().text();
    EXPECT_EQ(scene->materials.front().impact->gain_ns_m, 12.5);
    EXPECT_EQ(error_of(impact + "gain_ns_m = 12.6\n"),
              "a.toml:9: material.m.impact.gain_ns_m: is 12.6, expected at most 12.5 at 100 Hz");
    EXPECT_EQ(error_of("[material.m.impact]\nfrequency_hz = 9\ndecay_ms = 20\nforce_n = 1\ngain_ns_m = 1\n"),
              "a.toml:6: material.m.impact.frequency_hz: is 9, expected 10 ... 1000 Hz");
    EXPECT_EQ(error_of("[material.m.impact]\nfrequency_hz = 90\ndecay_ms = 0\nforce_n = 1\ngain_ns_m = 1\n"),
              "a.toml:7: material.m.impact.decay_ms: is 0, expected 1 ... 500 ms");
}

TEST_F(EffectKeys, ABallIsTheTipAndReachesFarther)
{
    const auto scene =
        scene_of("[material.m]\nradius_mm = 2\n[effect.ball]\nkind = \"tip\"\nradius_mm = 3\n");
    ASSERT_TRUE(scene) << scene.error().text();
    EXPECT_EQ(scene->tip_radius_mm(), 3);
    EXPECT_EQ(scene->max_radius_mm(), 5);
    EXPECT_EQ(error_of("[effect.a]\nkind = \"tip\"\nradius_mm = 51\n"),
              "a.toml:7: effect.a.radius_mm: is 51, expected 0.000001 ... 50 mm");
    EXPECT_EQ(
        error_of("[effect.a]\nkind = \"tip\"\nradius_mm = 1\n[effect.b]\nkind = \"tip\"\nradius_mm = 1\n"),
        "a.toml:8: effect.b: is one too many, expected at most 1 of the kind \"tip\"");
}

TEST_F(EffectKeys, AFieldIsAGridOfForces)
{
    const std::string header = "x_mm,y_mm,z_mm,fx_N,fy_N,fz_N\n";
    std::string rows;
    for (int z = 0; z < 2; ++z)
        for (int x = 0; x < 3; ++x)
            for (int y = 0; y < 2; ++y)
                rows += std::to_string(2 * x) + "," + std::to_string(10 * y) + "," + std::to_string(z - 5) +
                        "," + std::to_string(x) + ",0,-1\n";
    folder.write("grid.csv", header + rows);
    const std::string field = "[effect.wind]\nkind = \"field\"\nfile = \"grid.csv\"\n";
    const auto scene = scene_of("[material.m]\n" + field + "border_mm = 0.5\nscale = 2\n");
    ASSERT_TRUE(scene) << scene.error().text();
    const ForceGrid& grid = std::get<ForceField>(scene->effects.front().law).grid;
    EXPECT_EQ(grid.nodes, (std::array<std::uint32_t, 3>{3, 2, 2}));
    EXPECT_EQ(grid.corner_mm, (std::array<double, 3>{0, 0, -5}));
    EXPECT_EQ(grid.spacing_mm, (std::array<double, 3>{2, 10, 1}));
    EXPECT_EQ(grid.force_n[0][0], 0);
    EXPECT_EQ(grid.force_n[2][0], 2); // x is the fastest
    EXPECT_EQ(grid.force_n[3 + 6][2], -1);
    EXPECT_EQ(grid.force_max_n(), 2);
    EXPECT_EQ(grid.slope_max_n_mm(), 0.5);
    EXPECT_EQ(error_of(field + "border_mm = 0.6\n"),
              "a.toml:8: effect.wind.border_mm: is 0.6, expected at most half of the shortest side, 0.5");
    EXPECT_EQ(error_of(field + "scale = 51\n"),
              "a.toml:8: effect.wind.scale: makes forces of 102 N, expected at most 100 N");
    const auto file_error = [&](const std::string& text) {
        folder.write("grid.csv", text);
        const std::string error = error_of(field);
        EXPECT_TRUE(error.starts_with("a.toml:7: effect.wind.file: ")) << error;
        return error.substr(error.find("grid.csv") + 8);
    };
    EXPECT_EQ(file_error("x,y,z\n"), ":1: expected the header x_mm,y_mm,z_mm,fx_N,fy_N,fz_N");
    EXPECT_EQ(file_error(header + "0,0,0,0,0\n"),
              ":2: expected 6 columns (x_mm,y_mm,z_mm,fx_N,fy_N,fz_N), found 5");
    EXPECT_EQ(file_error(header + "0,0,0,0,0,x\n"), ":2: expected -100 ... 100 N, found 'x'");
    EXPECT_EQ(file_error(header + "0,0,0,0,0,nan\n"), ":2: expected -100 ... 100 N, found 'nan'");
    EXPECT_EQ(file_error(header + rows.substr(0, rows.rfind('\n', rows.size() - 2) + 1)),
              ": has 11 nodes, expected 3 x 2 x 2: every node of the grid once");
    EXPECT_EQ(file_error(header + rows.substr(0, rows.rfind('\n', rows.size() - 2) + 1) + "0,0,-5,0,0,0\n"),
              ": names the node at 0, 0, -5 twice");
    EXPECT_EQ(file_error(header + "0,0,0,0,0,0\n"), ": has 1 place along x, expected at least 2");
    EXPECT_EQ(file_error(header + "0,0,0,0,0,0\n1,0,0,0,0,0\n3,0,0,0,0,0\n"),
              ": x_mm = 1 is not evenly spaced, expected steps of 1.5 mm");
    EXPECT_EQ(
        file_error(header + "0,0,0,0,0,0\n0.05,0,0,0,0,0\n"),
        ": is 0.05 mm long along x in steps of 0.05 mm, expected at most 1000 in steps of at least 0.1");
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
