// SPDX-License-Identifier: GPL-2.0-or-later
// Effects of a scene as sets carry them: against the structs of the ABI, near and far, before and after a
// change. What is built goes to the module, which has the last word.
#include <cstring>

#include <gtest/gtest.h>

#include "feeder/effect_tables.hpp"
#include "feeder/feeder.hpp"
#include "scenes.hpp"

namespace phantom::test {
namespace {

class SpaceTables : public testing::Test {
  protected:
    SpaceTables() : scene(sphere_scene()) {}

    /// The tables of a set of that origin; the module must take it.
    const std::vector<std::uint64_t>& tables(feeder::EffectTables& effects, const Vector& origin_mm)
    {
        set = {};
        for (int axis = 0; axis < 3; ++axis)
            set.header.origin_nm[axis] = std::llround(origin_mm[axis] * 1e6);
        effects.fill({}, set);
        EXPECT_TRUE(device->submit(set));
        return set.effect_tables;
    }
    template <class T>
    T entry(std::size_t bytes) const
    {
        T out;
        EXPECT_LE(bytes + sizeof out, set.effect_tables.size() * sizeof(std::uint64_t));
        std::memcpy(&out, reinterpret_cast<const char*>(set.effect_tables.data()) + bytes, sizeof out);
        return out;
    }

    scene::Scene scene;
    Result<device::Device> device = device::Device::open_usermode({.virtual_clock = true});
    device::PatchSet set;
};

TEST_F(SpaceTables, OfAllKindsFollowTheOrderOfTheBits)
{
    scene.effects.push_back(
        {"rail", scene::Guide{scene::Guide::Place::line, {1, 2, 3}, {0, 0.6, 0.8}, 0.5, 2, 10}});
    scene.effects.push_back({"gravity", scene::ConstantForce{{0, 0, -0.5}}});
    scene.effects.push_back({"honey", scene::Viscosity{3, 2, {4, 5, 6}, 20, {}}});
    scene.effects.push_back({"air", scene::Viscosity{0, 1, {}, {}, {}}});
    scene.effects.push_back({"wind", scene::ConstantForce{{0.25, 0, 0}}});
    feeder::EffectTables effects(scene);
    tables(effects, {0, 0, 0});
    EXPECT_EQ(set.header.effects, PHANTOM_EFFECT_CONSTANT | PHANTOM_EFFECT_VISCOSITY | PHANTOM_EFFECT_GUIDE);
    const auto constant = entry<phantom_constant>(0);
    EXPECT_EQ(constant.force_un[0], 250'000); // both are there
    EXPECT_EQ(constant.force_un[2], -500'000);
    EXPECT_EQ(entry<phantom_effect_count>(16).count, 2U);
    const auto honey = entry<phantom_viscosity>(24);
    EXPECT_EQ(honey.centre_nm[1], 5'000'000);
    EXPECT_EQ(honey.radius_nm, 20'000'000U);
    EXPECT_EQ(honey.border_nm, 5'000'000U); // a quarter
    EXPECT_EQ(honey.viscosity_mns_m, 3000U);
    EXPECT_EQ(honey.drag_mns2_m2, 2000U);
    EXPECT_EQ(entry<phantom_viscosity>(24 + sizeof honey).radius_nm, 0U);
    const std::size_t guides = 24 + 2 * sizeof honey;
    EXPECT_EQ(entry<phantom_effect_count>(guides).count, 1U);
    const auto rail = entry<phantom_guide>(guides + 8);
    EXPECT_EQ(rail.kind, static_cast<__u32>(PHANTOM_GUIDE_LINE));
    EXPECT_EQ(rail.point_nm[2], 3'000'000);
    EXPECT_NEAR(rail.direction_q30[2], 0.8 * PHANTOM_Q30_ONE, 1);
    EXPECT_EQ(rail.stiffness_mn_mm, 500U);
    EXPECT_EQ(rail.force_un, 2'000'000U);
    EXPECT_EQ(rail.reach_nm, 10'000'000U);
    EXPECT_EQ(set.effect_tables.size() * 8, guides + 8 + sizeof rail);
}

TEST_F(SpaceTables, AFieldAndABallFollowTheGuides)
{
    scene::ForceField field;
    field.grid.corner_mm = {1, 2, 3};
    field.grid.spacing_mm = {10, 5, 4};
    field.grid.nodes = {3, 3, 3};
    field.grid.force_n.resize(27);
    field.grid.force_n[1] = {0.5, 0, -0.25};
    field.scale = 2;
    scene.effects.push_back({"ball", scene::BallTip{1.5}});
    scene.effects.push_back({"field", field});
    feeder::EffectTables effects(scene);
    tables(effects, {0, 0, 0});
    EXPECT_EQ(set.header.effects, PHANTOM_EFFECT_FIELD | PHANTOM_EFFECT_TIP);
    const auto grid = entry<phantom_field>(0);
    EXPECT_EQ(grid.corner_nm[2], 3'000'000);
    EXPECT_EQ(grid.spacing_nm[0], 10'000'000U);
    EXPECT_EQ(grid.nodes[1], 3U);
    EXPECT_EQ(grid.border_nm, 2'000'000U); // a quarter of 8 mm
    const auto node = entry<std::array<__s32, 3>>(sizeof grid + sizeof(std::array<__s32, 3>));
    EXPECT_EQ(node, (std::array<__s32, 3>{1'000'000, 0, -500'000}));
    // 27 nodes are 81 numbers and an empty one.
    EXPECT_EQ(entry<phantom_tip>(sizeof grid + 82 * sizeof(__s32)).radius_nm, 1'500'000U);
    tables(effects, {9000, 0, 0});
    EXPECT_EQ(set.header.effects, PHANTOM_EFFECT_TIP);
}

TEST_F(SpaceTables, HeightMapsAndImpactsAreSurfaces)
{
    scene::HeightMap map;
    map.samples.width = 8;
    map.samples.height = 4;
    map.samples.samples.assign(32, 0.5);
    map.samples.samples[1] = 1; // second column of the upper edge
    map.spacing_mm = 2;
    map.height_mm = 0.5;
    scene.materials[0].height_map = map;
    scene.materials[0].impact = scene::Impact{10, 200, 25, 2};
    scene.materials[0].friction = scene::Friction{0.5, {}, {}, 0};
    feeder::EffectTables effects(scene);
    const std::vector<std::uint32_t> materials = {0};
    effects.fill(materials, set);
    set.materials.push_back(effects.material(0));
    EXPECT_TRUE(device->submit(set));
    EXPECT_EQ(set.header.effects,
              PHANTOM_EFFECT_FRICTION | PHANTOM_EFFECT_HEIGHT_MAP | PHANTOM_EFFECT_IMPACT);
    EXPECT_EQ(entry<phantom_friction>(0).stiffness_mn_mm, 1000U); // the material's
    const auto first = entry<phantom_height_map>(sizeof(phantom_friction));
    EXPECT_EQ(first.columns, 8U);
    EXPECT_EQ(first.rows, 4U);
    EXPECT_EQ(first.spacing_nm, 2'000'000U);
    EXPECT_EQ(first.amplitude_nm, 250'000U);
    const auto heights = entry<std::array<__s32, 32>>(sizeof(phantom_friction) + sizeof first);
    for (std::size_t i = 0; i < heights.size(); ++i)
        EXPECT_EQ(heights[i], i == 3 * 8 + 1 ? 250'000 : 0) << i; // the upper edge is the last row
    const auto impact = entry<phantom_impact>(sizeof(phantom_friction) + sizeof first + sizeof heights);
    EXPECT_EQ(impact.gain_mns_m, 10'000U);
    EXPECT_EQ(impact.force_un, 2'000'000U);
    EXPECT_EQ(impact.frequency_hz, 200U);
    EXPECT_EQ(impact.decay_us, 25'000U);
}

TEST_F(SpaceTables, TwoGratingsShareATable)
{
    scene.materials[0].texture = scene::Texture{{0.05, 2, {1, 0, 0}}, scene::Grating{0.1, 4, {0, -0.6, 0.8}}};
    feeder::EffectTables effects(scene);
    const std::vector<std::uint32_t> materials = {0};
    effects.fill(materials, set);
    set.materials.push_back(effects.material(0));
    EXPECT_TRUE(device->submit(set));
    const auto texture = entry<phantom_texture>(0);
    EXPECT_EQ(texture.amplitude_nm[0], 50'000U);
    EXPECT_EQ(texture.wave_per_km[0][0], 500'000);
    EXPECT_EQ(texture.amplitude_nm[1], 100'000U);
    EXPECT_EQ(texture.wave_per_km[1][1], -150'000);
    EXPECT_EQ(texture.wave_per_km[1][2], 200'000);
}

TEST_F(SpaceTables, OfNothingAreNothing)
{
    feeder::EffectTables effects(scene);
    EXPECT_TRUE(tables(effects, {0, 0, 0}).empty());
    EXPECT_EQ(set.header.effects, 0U);
}

TEST_F(SpaceTables, AreTheSameWhereverTheSetIsNear)
{
    scene.effects.push_back({"p", scene::Guide{scene::Guide::Place::point, {10, 0, 0}, {}, 1, 1, {}}});
    scene.effects.push_back({"l", scene::Guide{scene::Guide::Place::line, {0, 9, 0}, {1, 0, 0}, 1, 1, {}}});
    feeder::EffectTables effects(scene);
    const auto here = tables(effects, {0, 0, 0});
    EXPECT_EQ(tables(effects, {499, -499, 499}), here);
    EXPECT_EQ(tables(effects, {900, 900, -900}), here) << "another window, the same places";
}

TEST_F(SpaceTables, FarPlacesAreNamedWithinReachOrLeftOut)
{
    scene.effects.push_back({"spring", scene::Guide{scene::Guide::Place::point, {0, 0, 0}, {}, 1, 1, {}}});
    scene.effects.push_back(
        {"plane", scene::Guide{scene::Guide::Place::plane, {0, 0, 7}, {0, 0, 1}, 1, 1, 100}});
    scene.effects.push_back({"ends", scene::Guide{scene::Guide::Place::point, {0, 0, 0}, {}, 1, 1, 1000}});
    scene.effects.push_back({"honey", scene::Viscosity{3, 0, {0, 0, 0}, 1000, {}}});
    feeder::EffectTables effects(scene);
    tables(effects, {0, 0, 0});
    EXPECT_EQ(set.header.effects, PHANTOM_EFFECT_VISCOSITY | PHANTOM_EFFECT_GUIDE);
    EXPECT_EQ(entry<phantom_effect_count>(8 + sizeof(phantom_viscosity)).count, 3U);
    // 20 m along x the plane is as near as ever, the spring still pulls back, the others have ended.
    tables(effects, {20'000, 0, 0});
    EXPECT_EQ(set.header.effects, PHANTOM_EFFECT_GUIDE);
    ASSERT_EQ(entry<phantom_effect_count>(0).count, 2U);
    const auto spring = entry<phantom_guide>(8), plane = entry<phantom_guide>(8 + sizeof spring);
    EXPECT_EQ(spring.point_nm[0], 20'000'000'000 - 3'100'000'000);
    EXPECT_EQ(spring.point_nm[1], 0);
    EXPECT_EQ(plane.point_nm[0], 20'000'000'000);
    EXPECT_EQ(plane.point_nm[2], 7'000'000);
    // Every origin is near enough to what was named before it.
    for (double x = 20'000; x > 0; x -= 100)
        tables(effects, {x, 0.3 * x, -0.3 * x});
    EXPECT_EQ(entry<phantom_effect_count>(8 + sizeof(phantom_viscosity)).count, 3U);
}

TEST_F(SpaceTables, AChangeRampsStiffnessAndDamping)
{
    feeder::EffectTables effects(scene);
    std::vector<scene::Material> harder = scene.materials;
    harder[0].stiffness_n_mm = 3;
    harder[0].damping_ns_m = 5;
    harder[0].friction = scene::Friction{0.5, {}, 1, 0};
    effects.change(harder, {});
    __u32 last = effects.material(0).stiffness_mn_mm;
    EXPECT_EQ(last, 1000U);
    for (std::uint32_t round = 0; round < feeder::EffectTables::ramp_rounds; ++round) {
        effects.begin_round();
        const __u32 now = effects.material(0).stiffness_mn_mm;
        EXPECT_LE(now - last, 2000U / feeder::EffectTables::ramp_rounds + 1) << round;
        last = now;
    }
    EXPECT_EQ(last, 3000U);
    EXPECT_EQ(effects.material(0).damping_mns_m, 5000U);
    EXPECT_EQ(effects.material(0).effects, PHANTOM_EFFECT_DAMPING | PHANTOM_EFFECT_FRICTION);
    // Damping leaves when it is nothing.
    effects.change(scene.materials, {});
    effects.begin_round();
    EXPECT_EQ(effects.material(0).effects, PHANTOM_EFFECT_DAMPING);
    for (std::uint32_t round = 0; round < feeder::EffectTables::ramp_rounds; ++round)
        effects.begin_round();
    EXPECT_EQ(effects.material(0).effects, 0U);
    EXPECT_EQ(effects.material(0).damping_mns_m, 0U);
    EXPECT_EQ(effects.material(0).stiffness_mn_mm, 1000U);
}

TEST_F(SpaceTables, AChangeReachesTheNextSetOfTheFeeder)
{
    const fdh::SceneTree<14> tree = scene::build_tree<14>(scene);
    feeder::Feeder feeder(scene, tree, *device, {});
    const Vector tip = {0, 0, 80};
    ASSERT_TRUE(feeder.feed(tip, tip, false));
    ASSERT_TRUE(device->move_simulated_tip({0, 0, 80'000'000}));
    phantom_start start{};
    start.flags = PHANTOM_START_LIMITS_OFF;
    ASSERT_TRUE(device->start(start));
    ASSERT_TRUE(device->step(50));
    EXPECT_EQ(device->status().force_un[1], 0);
    feeder.feel(scene.materials, {{"wind", scene::ConstantForce{{0, 0.5, 0}}}});
    ASSERT_TRUE(feeder.feed(tip, tip, false));
    std::int32_t last = 0;
    for (int tick = 0; tick < 50; ++tick) {
        ASSERT_TRUE(device->step(1));
        const std::int32_t now = device->status().force_un[1];
        EXPECT_LE(std::abs(now - last), 500'000 / 10) << tick; // it fades in 20 ms
        last = now;
    }
    EXPECT_EQ(last, 500'000);
}

} // namespace
} // namespace phantom::test
