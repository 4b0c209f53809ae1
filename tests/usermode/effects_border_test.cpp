// SPDX-License-Identifier: GPL-2.0-or-later
// Tables of effects at the border: every wrong one is refused, the limits are not, and none costs a byte.
#include <functional>

#include "effects.hpp"

extern "C" {
#include "phantom_float.h"
}

namespace phantom::test {
namespace {

Feel good()
{
    return {.magnet = phantom_magnet{500'000, 300'000},
            .friction = friction(0.6, 0.4, 2, 10),
            .texture = phantom_texture{{50'000, 20'000}, {{1'000'000, 0, 0}, {0, 900'000, 0}}},
            .height_map = HeightMap{{8, 4, 200'000, 50'000}, std::vector<std::int32_t>(32, 50'000)},
            .impact = phantom_impact{5000, 2'000'000, 200, 20'000},
            .constant = phantom_constant{{1, 2, 3}, 0},
            .viscosity = {{{5'000'000, 0, 0}, 30'000'000, 5'000'000, 2000, 300}, {{0, 0, 0}, 0, 0, 500, 0}},
            .guides = {{{0, 0, 0}, {0, 0, 0}, PHANTOM_GUIDE_POINT, 50, 200'000, 0, 0},
                       {{0, 0, 0}, {PHANTOM_Q30_ONE, 0, 0}, PHANTOM_GUIDE_LINE, 50, 200'000, 0, 0}},
            .field = Field{{{-9'000'000, 0, 5}, {1'000'000, 2'000'000, 3'000'000}, {5, 3, 3}, 2'000'000, 0},
                           std::vector<std::array<std::int32_t, 3>>(45, {1, 2, 3})},
            .tip = phantom_tip{500'000, 0}};
}

struct BadFeel {
    const char* name;
    std::function<void(Feel&)> spoil;
};

const BadFeel bad_feels[] = {
    {"magnet without a range", [](Feel& f) { f.magnet->range_nm = 0; }},
    {"magnet as wide as the contact radius", [](Feel& f) { f.magnet->range_nm = 3'000'000; }},
    {"magnet too strong", [](Feel& f) { f.magnet->force_un = PHANTOM_EFFECT_FORCE_MAX_UN + 1; }},
    {"static friction too large", [](Feel& f) { f.friction->static_ppm = PHANTOM_FRICTION_MAX_PPM + 1; }},
    {"dynamic above static", [](Feel& f) { f.friction->dynamic_ppm = f.friction->static_ppm + 1; }},
    {"friction without a spring", [](Feel& f) { f.friction->stiffness_mn_mm = 0; }},
    {"friction with too stiff a spring",
     [](Feel& f) { f.friction->stiffness_mn_mm = PHANTOM_EFFECT_STIFFNESS_MAX_MN_MM + 1; }},
    {"Stribeck too fast", [](Feel& f) { f.friction->stribeck_um_s = PHANTOM_FRICTION_SPEED_MAX_UM_S + 1; }},
    {"wave too short", [](Feel& f) { f.texture->wave_per_km[1][2] = PHANTOM_WAVE_MAX_PER_KM + 1; }},
    {"wave too short the other way",
     [](Feel& f) {
         f.texture->wave_per_km[1][2] = INT32_MIN;
         f.texture->amplitude_nm[1] = 1;
     }},
    {"relief too steep", [](Feel& f) { f.texture->amplitude_nm[0] = 200'000; }},
    {"amplitude without a wave", [](Feel& f) { f.texture->wave_per_km[0][0] = 0; }},
    {"wave without an amplitude", [](Feel& f) { f.texture->amplitude_nm[1] = 0; }},
    {"map of three columns",
     [](Feel& f) {
         f.height_map->header.columns = 3;
         f.height_map->height_nm.resize(12);
     }},
    {"map of six rows",
     [](Feel& f) {
         f.height_map->header.rows = 6;
         f.height_map->height_nm.resize(48);
     }},
    {"map of 128 columns",
     [](Feel& f) {
         f.height_map->header.columns = 128;
         f.height_map->height_nm.resize(512);
     }},
    {"map without columns", [](Feel& f) { f.height_map->header.columns = 0; }},
    {"map too large for a number", [](Feel& f) { f.height_map->header.rows = 0x80000000; }},
    {"map too fine",
     [](Feel& f) {
         f.height_map->header.spacing_nm = PHANTOM_MAP_SPACING_MIN_NM - 1;
         f.height_map->height_nm.assign(32, 0);
     }},
    {"height above the amplitude", [](Feel& f) { f.height_map->height_nm[31] = 50'001; }},
    {"height below the amplitude",
     [](Feel& f) {
         f.height_map->header.spacing_nm = 1'000'000'000;
         f.height_map->height_nm[0] = -50'001;
     }},
    {"height as low as can be", [](Feel& f) { f.height_map->height_nm[5] = INT32_MIN; }},
    {"map too steep along and across",
     [](Feel& f) {
         f.height_map->header.spacing_nm = 199'999;
         f.height_map->height_nm[9] = -50'000;
     }},
    {"map too steep round the tile",
     [](Feel& f) {
         f.height_map->header.amplitude_nm = 210'000;
         for (std::size_t i = 0; i < 32; ++i)
             f.height_map->height_nm[i] = std::int32_t(i % 8 * 30'000);
     }},
    {"map longer than it says", [](Feel& f) { f.height_map->height_nm.resize(34); }},
    {"map shorter than it says", [](Feel& f) { f.height_map->height_nm.resize(30); }},
    {"ringing too high", [](Feel& f) { f.impact->frequency_hz = PHANTOM_IMPACT_FREQUENCY_MAX_HZ + 1; }},
    {"ringing too low",
     [](Feel& f) {
         f.impact->frequency_hz = PHANTOM_IMPACT_FREQUENCY_MIN_HZ - 1;
         f.impact->gain_mns_m = 0;
     }},
    {"ringing too much",
     [](Feel& f) { f.impact->gain_mns_m = 200 * PHANTOM_IMPACT_GAIN_MAX_MNS_M_PER_HZ + 1; }},
    {"ringing too short", [](Feel& f) { f.impact->decay_us = PHANTOM_IMPACT_DECAY_MIN_US - 1; }},
    {"ringing too long", [](Feel& f) { f.impact->decay_us = PHANTOM_IMPACT_DECAY_MAX_US + 1; }},
    {"ringing too hard", [](Feel& f) { f.impact->force_un = PHANTOM_EFFECT_FORCE_MAX_UN + 1; }},
    {"field of one layer",
     [](Feel& f) {
         f.field->header.nodes[2] = 1;
         f.field->force_un.resize(15);
     }},
    {"field without nodes", [](Feel& f) { f.field->header.nodes[0] = 0; }},
    {"field of 2^32 nodes", [](Feel& f) { f.field->header.nodes[0] = f.field->header.nodes[1] = 0x10000; }},
    {"field of too many nodes",
     [](Feel& f) {
         std::copy_n(std::array{17u, 241u, 2u}.data(), 3, f.field->header.nodes);
         f.field->force_un.assign(17 * 241 * 2, {0, 0, 0});
     }},
    {"field too fine",
     [](Feel& f) {
         f.field->header.spacing_nm[1] = PHANTOM_FIELD_SPACING_MIN_NM - 1;
         f.field->header.border_nm = PHANTOM_BORDER_MIN_NM;
     }},
    {"field too wide", [](Feel& f) { f.field->header.spacing_nm[0] = 1'000'000'001; }},
    {"field without a border", [](Feel& f) { f.field->header.border_nm = PHANTOM_BORDER_MIN_NM - 1; }},
    {"field that is border only", [](Feel& f) { f.field->header.border_nm = 2'000'001; }},
    {"field reserved", [](Feel& f) { f.field->header.reserved = 1; }},
    {"field too far", [](Feel& f) { f.field->header.corner_nm[1] = PHANTOM_EFFECT_REACH_MAX_NM + 1; }},
    {"field at the end of s64", [](Feel& f) { f.field->header.corner_nm[2] = INT64_MIN; }},
    {"field too strong",
     [](Feel& f) {
         f.field->force_un.assign(45, {0, 0, PHANTOM_EFFECT_FORCE_MAX_UN + 1});
     }},
    {"field too strong, negative",
     [](Feel& f) {
         f.field->force_un.assign(45, {INT32_MIN, 0, 0});
     }},
    {"field too stiff along x",
     [](Feel& f) {
         std::copy_n(std::array{100'000u, 400'000u, 400'000u}.data(), 3, f.field->header.spacing_nm);
         f.field->header.border_nm = 200'000;
         f.field->force_un[12][1] = 10'000'003;
     }},
    {"field too stiff along y",
     [](Feel& f) {
         std::copy_n(std::array{400'000u, 100'000u, 400'000u}.data(), 3, f.field->header.spacing_nm);
         f.field->header.border_nm = 100'000;
         f.field->force_un[12][1] = -10'000'000 + 1;
     }},
    {"field too stiff along z",
     [](Feel& f) {
         std::copy_n(std::array{400'000u, 400'000u, 100'000u}.data(), 3, f.field->header.spacing_nm);
         f.field->header.border_nm = 100'000;
         f.field->force_un[12][1] = 10'000'003;
     }},
    {"field longer than it says", [](Feel& f) { f.field->force_un.resize(47); }},
    {"field shorter than it says", [](Feel& f) { f.field->force_un.resize(43); }},
    {"tip without a radius", [](Feel& f) { f.tip->radius_nm = 0; }},
    {"tip too large", [](Feel& f) { f.tip->radius_nm = PHANTOM_TIP_RADIUS_MAX_NM + 1; }},
    {"tip reserved", [](Feel& f) { f.tip->reserved = 1; }},
    {"constant too large", [](Feel& f) { f.constant->force_un[1] = PHANTOM_EFFECT_FORCE_MAX_UN + 1; }},
    {"constant too large, negative", [](Feel& f) { f.constant->force_un[2] = INT32_MIN; }},
    {"constant reserved", [](Feel& f) { f.constant->reserved = 1; }},
    {"viscosity too large",
     [](Feel& f) { f.viscosity[1].viscosity_mns_m = PHANTOM_VISCOSITY_MAX_MNS_M + 1; }},
    {"drag too large", [](Feel& f) { f.viscosity[0].drag_mns2_m2 = PHANTOM_DRAG_MAX_MNS2_M2 + 1; }},
    {"everywhere with a border", [](Feel& f) { f.viscosity[1].border_nm = PHANTOM_BORDER_MIN_NM; }},
    {"everywhere with a centre", [](Feel& f) { f.viscosity[1].centre_nm[2] = -1; }},
    {"region without a border", [](Feel& f) { f.viscosity[0].border_nm = PHANTOM_BORDER_MIN_NM - 1; }},
    {"border wider than the region", [](Feel& f) { f.viscosity[0].border_nm = 30'000'001; }},
    {"region too far", [](Feel& f) { f.viscosity[0].centre_nm[1] = PHANTOM_EFFECT_REACH_MAX_NM + 1; }},
    {"region at the end of s64", [](Feel& f) { f.viscosity[0].centre_nm[1] = INT64_MIN; }},
    {"nine regions", [](Feel& f) { f.viscosity.resize(PHANTOM_REGIONS_MAX + 1, f.viscosity[1]); }},
    {"nine guides", [](Feel& f) { f.guides.resize(PHANTOM_REGIONS_MAX + 1, f.guides[0]); }},
    {"unknown guide", [](Feel& f) { f.guides[1].kind = PHANTOM_GUIDE_PLANE + 1; }},
    {"guide without stiffness", [](Feel& f) { f.guides[0].stiffness_mn_mm = 0; }},
    {"guide too stiff",
     [](Feel& f) { f.guides[0].stiffness_mn_mm = PHANTOM_EFFECT_STIFFNESS_MAX_MN_MM + 1; }},
    {"guide without force", [](Feel& f) { f.guides[0].force_un = 0; }},
    {"guide too strong", [](Feel& f) { f.guides[0].force_un = PHANTOM_EFFECT_FORCE_MAX_UN + 1; }},
    {"guide reserved", [](Feel& f) { f.guides[0].reserved = 1; }},
    {"point with a direction", [](Feel& f) { f.guides[0].direction_q30[0] = PHANTOM_Q30_ONE; }},
    {"line without a direction", [](Feel& f) { f.guides[1].direction_q30[0] = 0; }},
    {"guide too far", [](Feel& f) { f.guides[0].point_nm[0] = -PHANTOM_EFFECT_REACH_MAX_NM - 1; }},
};

class EffectBorder : public EffectTest {
  protected:
    void SetUp() override
    {
        EffectTest::SetUp();
        feeder.emplace(machine);
    }
    int submit_plane(Plane& plane) { return feeder->submit(plane); }
    int submit_feel(const Feel& feel, const std::function<void(Plane&)>& spoil = {})
    {
        Plane plane(++set_id);
        add_effects(plane, feel);
        if (spoil)
            spoil(plane);
        return feeder->submit(plane);
    }
};

TEST_F(EffectBorder, AWrongParameterIsRefused)
{
    for (const BadFeel& bad : bad_feels) {
        ASSERT_EQ(submit_feel(good()), 0);
        Feel feel = good();
        bad.spoil(feel);
        EXPECT_EQ(submit_feel(feel), -EINVAL) << bad.name;
    }
}

TEST_F(EffectBorder, TheLimitsThemselvesAreNot)
{
    Feel feel = good();
    feel.magnet = phantom_magnet{2'999'999, PHANTOM_EFFECT_FORCE_MAX_UN};
    feel.friction = phantom_friction{PHANTOM_FRICTION_MAX_PPM, PHANTOM_FRICTION_MAX_PPM,
                                     PHANTOM_EFFECT_STIFFNESS_MAX_MN_MM, PHANTOM_FRICTION_SPEED_MAX_UM_S};
    feel.texture = phantom_texture{{159'154, 0}, {{1'000'000, 0, 0}, {0, 0, 0}}};
    feel.constant = phantom_constant{{PHANTOM_EFFECT_FORCE_MAX_UN, -PHANTOM_EFFECT_FORCE_MAX_UN, 0}, 0};
    feel.viscosity.assign(PHANTOM_REGIONS_MAX,
                          {{PHANTOM_EFFECT_REACH_MAX_NM, 0, -PHANTOM_EFFECT_REACH_MAX_NM},
                           PHANTOM_BORDER_MIN_NM,
                           PHANTOM_BORDER_MIN_NM,
                           PHANTOM_VISCOSITY_MAX_MNS_M,
                           PHANTOM_DRAG_MAX_MNS2_M2});
    feel.guides.assign(PHANTOM_REGIONS_MAX, {{0, PHANTOM_EFFECT_REACH_MAX_NM, 0},
                                             {0, 0, -PHANTOM_Q30_ONE},
                                             PHANTOM_GUIDE_PLANE,
                                             PHANTOM_EFFECT_STIFFNESS_MAX_MN_MM,
                                             PHANTOM_EFFECT_FORCE_MAX_UN,
                                             0xffffffff,
                                             0});
    feel.height_map = HeightMap{{64, 64, 100'000, 50'000}, std::vector<std::int32_t>(64 * 64, 0)};
    for (std::size_t i = 0; i < 64 * 64; ++i) // a chessboard along x: 100 um up and down, none along y
        feel.height_map->height_nm[i] = i % 2 ? 50'000 : -50'000;
    feel.impact = phantom_impact{PHANTOM_IMPACT_FREQUENCY_MAX_HZ * PHANTOM_IMPACT_GAIN_MAX_MNS_M_PER_HZ,
                                 PHANTOM_EFFECT_FORCE_MAX_UN, PHANTOM_IMPACT_FREQUENCY_MAX_HZ,
                                 PHANTOM_IMPACT_DECAY_MAX_US};
    feel.field = Field{{{0, 0, 0}, {2'000'000, 2'000'000, 2'000'000}, {16, 16, 16}, 15'000'000, 0},
                       std::vector<std::array<std::int32_t, 3>>(4096, {PHANTOM_EFFECT_FORCE_MAX_UN, 0, 0})};
    for (std::size_t i = 0; i < 4096; i += 2) // 200 N from node to node
        feel.field->force_un[i][0] = -PHANTOM_EFFECT_FORCE_MAX_UN;
    feel.tip = phantom_tip{PHANTOM_TIP_RADIUS_MAX_NM, 0};
    EXPECT_EQ(submit_feel(feel), 0);
    feel.tip->radius_nm = 1;
    feel.height_map->header.amplitude_nm = 0;
    feel.height_map->height_nm.assign(64 * 64, 0);
    feel.impact = phantom_impact{0, 0, PHANTOM_IMPACT_FREQUENCY_MIN_HZ, PHANTOM_IMPACT_DECAY_MIN_US};
    feel.friction = phantom_friction{0, 0, 1, 0};
    feel.magnet = phantom_magnet{1, 0};
    feel.texture = phantom_texture{};
    EXPECT_EQ(submit_feel(feel), 0) << "nothing of it";
    feel.texture =
        phantom_texture{{1, 1}, {{PHANTOM_WAVE_MAX_PER_KM, 0, 0}, {0, -PHANTOM_WAVE_MAX_PER_KM, 0}}};
    EXPECT_EQ(submit_feel(feel), 0);
}

TEST_F(EffectBorder, TheTablesAreAsLongAsTheEffectsCallFor)
{
    EXPECT_EQ(submit_feel(good(), [](Plane& p) { p.tables.pop_back(); }), -EINVAL);
    EXPECT_EQ(submit_feel(good(), [](Plane& p) { p.tables.push_back(0); }), -EINVAL);
    EXPECT_EQ(submit_feel(good(), [](Plane& p) { p.tables.clear(); }), -EINVAL);
    EXPECT_EQ(submit_feel({.friction = friction(1, 1, 1)}, [](Plane& p) { p.tables.pop_back(); }), -EINVAL);
    EXPECT_EQ(submit_feel({}, [](Plane& p) { p.tables.push_back(0); }), -EINVAL);
    for (const std::uint32_t count : {0u, 9u, 0xffffffffu})
        EXPECT_EQ(submit_feel({.guides = good().guides}, [&](Plane& p) { p.tables[0] = count; }), -EINVAL);
    EXPECT_EQ(submit_feel({.guides = good().guides}, [](Plane& p) { p.tables[0] |= 1ULL << 32; }), -EINVAL)
        << "reserved";
}

TEST_F(EffectBorder, WhatFillsAFieldUpIsZero)
{
    const Feel feel{.field = good().field}; // 45 nodes: 135 integers
    EXPECT_EQ(submit_feel(feel), 0);
    EXPECT_EQ(submit_feel(feel, [](Plane& p) { p.tables.back() |= 1ULL << 32; }), -EINVAL);
}

TEST_F(EffectBorder, ATipMakesNoContactRadiusWrap)
{
    const auto with = [&](std::uint32_t radius_nm) {
        return submit_feel({.tip = phantom_tip{1000, 0}},
                           [&](Plane& p) { p.materials[0].radius_nm = radius_nm; });
    };
    EXPECT_EQ(with(0xffffffff - 1000), 0);
    EXPECT_EQ(with(0xffffffff - 999), -EINVAL);
}

TEST_F(EffectBorder, OneEntryForEachMaterialThatNamesIt)
{
    const auto with = [&](int entries) {
        Plane plane(++set_id);
        plane.materials.resize(5, plane.materials[0]);
        for (const int user : {1, 2, 4})
            plane.materials[std::size_t(user)].effects = PHANTOM_EFFECT_FRICTION;
        plane.header.effects = PHANTOM_EFFECT_FRICTION;
        for (int i = 0; i < entries; ++i)
            plane.add_table(friction(0.1 * (i + 1), 0, 1));
        return submit_plane(plane);
    };
    EXPECT_EQ(with(2), -EINVAL);
    EXPECT_EQ(with(3), 0);
    EXPECT_EQ(with(4), -EINVAL);
    EXPECT_EQ(with(5), -EINVAL);
}

TEST_F(EffectBorder, MaterialsNameSurfaceEffectsAndOnlyThose)
{
    for (int bit = 0; bit < 32; ++bit) {
        const std::uint32_t effect = 1u << bit;
        const int in_both =
            submit_feel({}, [&](Plane& p) { p.materials[0].effects = p.header.effects = effect; });
        EXPECT_EQ(in_both, effect == PHANTOM_EFFECT_DAMPING ? 0 : -EINVAL) << bit;
        EXPECT_EQ(submit_feel(good(), [&](Plane& p) { p.header.effects ^= effect; }), -EINVAL) << bit;
        EXPECT_EQ(submit_feel(good(), [&](Plane& p) { p.materials[0].effects ^= effect; }), -EINVAL) << bit;
    }
}

TEST_F(EffectBorder, TheWorstThatIsAllowedIsStillANumberAndAsSmooth)
{
    Feel worst = good();
    worst.magnet = phantom_magnet{1, PHANTOM_EFFECT_FORCE_MAX_UN};
    worst.friction = phantom_friction{PHANTOM_FRICTION_MAX_PPM, 0, PHANTOM_EFFECT_STIFFNESS_MAX_MN_MM, 1};
    worst.texture = phantom_texture{{0xffffffff, 1}, {{37, 0, 0}, {0, 0, PHANTOM_WAVE_MAX_PER_KM}}};
    worst.guides[0].stiffness_mn_mm = PHANTOM_EFFECT_STIFFNESS_MAX_MN_MM;
    worst.guides[0].reach_nm = 1;
    worst.viscosity[1].drag_mns2_m2 = PHANTOM_DRAG_MAX_MNS2_M2;
    for (const std::uint32_t arith : {PHANTOM_ARITH_FLOAT, PHANTOM_ARITH_FIXED, PHANTOM_ARITH_DOUBLE}) {
        feel(worst, {0, 0, 2}, {}, arith);
        for (int i = 0; i < 3000; ++i) {
            const Place f = force({0.7 * std::sin(i), i % 5 ? 0.0 : 30 * std::cos(i), 3 - 0.002 * i});
            ASSERT_LT(length(f), 1e3) << i;
        }
        EXPECT_EQ(feeder->status().faults, 0u);
    }
}

TEST_F(EffectBorder, AnEffectThatIsNotNamedHasNoByteInTheSet)
{
    const auto* ops = &phantom_float_sse2;
    phantom_effects none{};
    const std::size_t frame = ops->effect_bytes(&none, 4);
    const auto bytes = [&](auto&& name) {
        phantom_effects effects{};
        name(effects);
        return ops->effect_bytes(&effects, 4) - frame;
    };
    const phantom_magnet magnet{};
    const phantom_friction rough{};
    EXPECT_LE(frame, 64u) << "a set without tables has not even this";
    EXPECT_EQ(bytes([](auto&) {}), 0u);
    const std::size_t weights = 4 * 4;
    EXPECT_EQ(bytes([&](auto& e) { e.magnet = &magnet, e.mask = PHANTOM_EFFECT_MAGNET; }), 4 * 8 + weights);
    EXPECT_EQ(bytes([&](auto& e) { e.friction = &rough, e.mask = PHANTOM_EFFECT_FRICTION; }),
              4 * 16 + weights);
}

TEST_F(EffectBorder, TooLittleMemoryLeavesTheSetInUse)
{
    ASSERT_EQ(submit_feel({}), 0);
    phantom_um_inject_allocation_failure(1);
    EXPECT_EQ(submit_feel(good()), -ENOMEM);
    phantom_um_inject_allocation_failure(0);
    EXPECT_EQ(submit_feel(good()), 0);
}

} // namespace
} // namespace phantom::test
