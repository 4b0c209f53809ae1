// SPDX-License-Identifier: GPL-2.0-or-later
// Effects changed by words: what takes, what is refused, and that a refusal changes nothing.
#include <gtest/gtest.h>

#include "scene/effect_book.hpp"

namespace phantom::scene::test {
namespace {

/// Two materials in use, one that is not, and two effects of space.
Scene scene_with_effects()
{
    Scene scene;
    scene.materials.resize(3);
    scene.materials[0].name = "plate";
    scene.materials[0].friction = Friction{0.6, 0.4, {}, 0};
    scene.materials[1].name = "unused";
    scene.materials[2].name = "ball";
    for (const std::uint32_t material : {0U, 2U}) {
        Object object;
        object.material = material;
        scene.objects.push_back(object);
    }
    scene.effects.push_back({"gravity", ConstantForce{{0, 0, -0.5}}});
    scene.effects.push_back({"honey", Viscosity{3, 0, {}, {}, {}}});
    return scene;
}

class EffectWords : public testing::Test {
  protected:
    std::string error_of(const std::string& name, const EffectBook::Words& words)
    {
        const Status status = book.change(name, words);
        return status ? "none" : status.error().text();
    }
    EffectBook book{scene_with_effects()};
};

TEST_F(EffectWords, ListNamesWhatIsUsed)
{
    std::vector<std::string> names;
    for (const EffectBook::Entry& entry : book.list())
        names.push_back(entry.name);
    EXPECT_EQ(names, (std::vector<std::string>{"plate", "plate.friction", "ball", "gravity", "honey"}));
    const auto friction = book.entry("plate.friction");
    ASSERT_TRUE(friction);
    EXPECT_EQ(friction->kind, "friction");
    ASSERT_EQ(friction->values.size(), 3U);
    EXPECT_EQ(friction->values[0].key, "static");
    EXPECT_EQ(friction->values[0].numbers, std::vector<double>{0.6});
    EXPECT_EQ(book.entry("gravity")->values[0].numbers, (std::vector<double>{0, 0, -0.5}));
}

TEST_F(EffectWords, ChangeWhatTheyName)
{
    EXPECT_EQ(error_of("plate.friction", {{"static", "0.5"}}), "none");
    EXPECT_EQ(error_of("plate", {{"stiffness_n_mm", "2"}, {"damping_ns_m", "1.5"}}), "none");
    EXPECT_EQ(error_of("gravity", {{"force_n", "0,1,-2"}}), "none");
    EXPECT_EQ(error_of("honey", {{"radius_mm", "9"}, {"centre_mm", "1,2,3"}}), "none");
    const auto materials = book.materials();
    EXPECT_EQ(materials[0].friction->statical, 0.5);
    EXPECT_EQ(materials[0].friction->dynamic, 0.4);
    EXPECT_EQ(materials[0].stiffness_n_mm, 2);
    EXPECT_EQ(materials[0].damping_ns_m, 1.5);
    const auto effects = book.effects();
    EXPECT_EQ(std::get<ConstantForce>(effects[0].law).force_n, (std::array<double, 3>{0, 1, -2}));
    EXPECT_EQ(std::get<Viscosity>(effects[1].law).radius_mm, 9);
    EXPECT_EQ(std::get<Viscosity>(effects[1].law).viscosity_ns_m, 3);
}

TEST_F(EffectWords, AddWhatTheMaterialHasNotYet)
{
    EXPECT_EQ(error_of("ball.magnet", {{"range_mm", "0.5"}}),
              "effect ball.magnet: force_n: is missing, expected 0 ... 100 N");
    EXPECT_FALSE(book.materials()[2].magnet);
    EXPECT_EQ(error_of("ball.magnet", {{"range_mm", "0.5"}, {"force_n", "1"}}), "none");
    EXPECT_EQ(book.materials()[2].magnet->range_mm, 0.5);
    EXPECT_EQ(error_of("ball.texture.second", {{"amplitude_mm", "0.1"}, {"wavelength_mm", "1"}}),
              "effect ball.texture.second: ball.texture is missing, expected it before its second grating");
    EXPECT_EQ(error_of("ball.texture", {{"amplitude_mm", "0.1"}, {"wavelength_mm", "1"}}), "none");
    EXPECT_EQ(error_of("ball.texture.second", {{"amplitude_mm", "0.06"}, {"wavelength_mm", "1"}}),
              "effect ball.texture.second: amplitude_mm: is 0.06, expected at most 0.059 for waves of 1 mm "
              "beside the other grating");
    EXPECT_EQ(error_of("ball.texture.second", {{"amplitude_mm", "0.05"}, {"wavelength_mm", "1"}}), "none");
    EXPECT_EQ(error_of("ball.texture", {{"amplitude_mm", "0.12"}}),
              "effect ball.texture: amplitude_mm: is 0.12, expected at most 0.109 for waves of 1 mm beside "
              "the other grating");
    EXPECT_EQ(book.materials()[2].texture->second->amplitude_mm, 0.05);
}

TEST_F(EffectWords, AreHeldToTheRangesOfSceneFiles)
{
    EXPECT_EQ(error_of("plate.friction", {{"static", "5"}}),
              "effect plate.friction: static: is 5, expected 0 ... 4");
    EXPECT_EQ(error_of("plate.friction", {{"static", "nan"}}),
              "effect plate.friction: static: is nan, expected 0 ... 4");
    EXPECT_EQ(error_of("plate.friction", {{"static", "0.5x"}}),
              "effect plate.friction: static: is 0.5x, expected 0 ... 4");
    EXPECT_EQ(error_of("plate.friction", {{"static", "0.3"}}),
              "effect plate.friction: dynamic: is 0.4, expected no more than static, 0.3");
    EXPECT_EQ(error_of("plate.friction", {{"sliding", "0.3"}}),
              "effect plate.friction: sliding: unknown key, expected static, dynamic, stiffness_n_mm, "
              "stribeck_mm_s");
    EXPECT_EQ(error_of("gravity", {{"force_n", "0,0"}}),
              "effect gravity: force_n: is 0,0, expected x,y,z, each -100 ... 100 N");
    EXPECT_EQ(error_of("gravity", {{"force_n", "0,0,0,0"}}),
              "effect gravity: force_n: is 0,0,0,0, expected x,y,z, each -100 ... 100 N");
    EXPECT_EQ(error_of("honey", {{"viscosity_ns_m", "0"}}),
              "effect honey: viscosity_ns_m: is zero as drag_ns2_m2 is, expected one of them to be more");
    EXPECT_EQ(error_of("unused", {{"stiffness_n_mm", "2"}}),
              "effect unused: there is none, expected plate, plate.friction, ball, gravity, honey");
    EXPECT_EQ(error_of("plate.gloss", {{"x", "2"}}),
              "effect plate.gloss: there is none, expected plate, plate.friction, ball, gravity, honey");
    EXPECT_EQ(book.materials()[0].friction->statical, 0.6);
    EXPECT_EQ(std::get<Viscosity>(book.effects()[1].law).viscosity_ns_m, 3);
}

TEST_F(EffectWords, OffKeepsTheValuesForOn)
{
    ASSERT_TRUE(book.turn("plate.friction", false));
    ASSERT_TRUE(book.turn("gravity", false));
    EXPECT_FALSE(book.materials()[0].friction);
    ASSERT_EQ(book.effects().size(), 1U);
    EXPECT_EQ(book.effects()[0].name, "honey");
    EXPECT_FALSE(book.entry("gravity")->on);
    ASSERT_TRUE(book.turn("plate.friction", true));
    EXPECT_EQ(book.materials()[0].friction->dynamic, 0.4);
    // A change of what is off brings it back.
    EXPECT_EQ(error_of("gravity", {{"force_n", "0,0,1"}}), "none");
    EXPECT_EQ(book.effects().size(), 2U);
    EXPECT_EQ(book.turn("plate", false).error().text(),
              "effect plate: is a material, which is always on; its damping_ns_m = 0 is none");
    EXPECT_FALSE(book.turn("ball.magnet", true));
}

TEST_F(EffectWords, WhatDecidesOnOtherKeysStays)
{
    Scene scene = scene_with_effects();
    scene.effects.push_back({"rail", Guide{Guide::Place::plane, {}, {0, 0, 1}, 1, 1, {}}});
    EffectBook guides(scene);
    const Status status = guides.change("rail", {{"to", "point"}});
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().text(), "effect rail: to: stays as the scene has it");
    EXPECT_TRUE(guides.change("rail", {{"direction", "0,3,0"}}));
    EXPECT_EQ(std::get<Guide>(guides.effects()[2].law).direction, (std::array<double, 3>{0, 1, 0}));
}

} // namespace
} // namespace phantom::scene::test
