// SPDX-License-Identifier: GPL-2.0-or-later
// Every effect with an arm, its encoder and a hand in the loop: nothing drifts, buzzes or gives energy.
#include <algorithm>
#include <cstdio>

#include "arm.hpp"

namespace phantom::test {
namespace {

/// An arm on the plane, pressed with about 1 N.
Arm resting()
{
    Arm arm;
    arm.at = {0, 0, 2};
    return arm;
}

class FrictionLoop : public LoopTest {
  protected:
    void press(const phantom_friction& law, std::uint32_t hz = 1000)
    {
        begin({.friction = law}, resting(), hz);
        hand.target = {0, 0, 2 - 1 / hand.spring_n_mm};
        run(0.5);
    }
};

TEST_F(FrictionLoop, HoldsTheHandAndDoesNotDrift)
{
    for (const std::uint32_t hz : {1000u, 10'000u}) {
        press(friction(0.6, 0.4, 1), hz);
        hand.target_velocity = {2, 1, 0}; // up to 0.45 N within a second
        while (hand.target[0] < 0.4 / hand.spring_n_mm)
            tick();
        hand.target_velocity = {};
        run(1);
        const Place before = arm.at;
        double fastest = 0;
        for (double t = 0; t < 10; t += period_s) {
            tick();
            fastest = std::max(fastest, length(arm.velocity));
        }
        EXPECT_LT(length(minus(arm.at, before)), 0.01) << hz << " Hz, after 10 s";
        EXPECT_LT(fastest, 0.1) << hz << " Hz: it does not buzz";
        const Place pull = hand.force(arm);
        EXPECT_GT(std::hypot(pull[0], pull[1]), 0.3);
        EXPECT_NEAR(std::hypot(servo[0] + pull[0], servo[1] + pull[1]), 0, arm.coulomb_n + 1e-3);
    }
}

TEST_F(FrictionLoop, SlidesWithoutChatter)
{
    for (const std::uint32_t hz : {1000u, 10'000u}) {
        press(friction(0.5, 0.5, 1), hz);
        hand.target_velocity = {20, 0, 0};
        run(1);
        double slowest = 1e9, fastest = 0, least = 1e9, most = 0;
        for (double t = 0; t < 2; t += period_s) {
            tick();
            slowest = std::min(slowest, arm.velocity[0]);
            fastest = std::max(fastest, arm.velocity[0]);
            least = std::min(least, -servo[0] / servo[2]);
            most = std::max(most, -servo[0] / servo[2]);
        }
        EXPECT_GT(slowest, 15) << hz;
        EXPECT_LT(fastest, 25) << hz;
        // an encoder's step is 0.055 mm: 0.055 N of the spring
        EXPECT_NEAR(least, 0.5, 0.06) << hz;
        EXPECT_NEAR(most, 0.5, 0.01) << hz;
    }
}

TEST_F(FrictionLoop, StickSlipsWhereTheCoefficientsDifferAndTheHandIsSoft)
{
    press(friction(0.9, 0.2, 2), 1000);
    hand.target_velocity = {2, 0, 0};
    run(1);
    int stops = 0;
    bool slow = false;
    for (double t = 0; t < 5; t += period_s) {
        tick();
        if (!slow && arm.velocity[0] < 0.5) {
            ++stops;
            slow = true;
        }
        slow = slow && arm.velocity[0] < 5;
        ASSERT_LT(std::hypot(servo[0], servo[1]), 0.9 * servo[2] + 0.12) << "never above static";
        ASSERT_LT(length(arm.velocity), 100);
    }
    EXPECT_GT(stops, 2);
    EXPECT_LT(stops, 30);
}

TEST_F(FrictionLoop, TakesEnergyAndGivesNone)
{
    press(friction(0.8, 0.4, 2), 1000);
    work_n_mm = 0;
    double path = 0;
    for (int i = 0; i < 8000; ++i) {
        const Place before = arm.at;
        hand.target_velocity = {60 * std::cos(i * 2e-3), 60 * std::sin(i * 2e-3), 0};
        tick();
        path += length(minus(arm.at, before));
    }
    EXPECT_GT(path, 300);
    EXPECT_LT(work_n_mm, -0.8 * 0.4 * path) << "at least most of dynamic friction on the whole way";
}

// ---- viscosity

class ViscosityLoop : public LoopTest {};

TEST_F(ViscosityLoop, TheMostThatIsAllowedStopsALightArm)
{
    for (const double mass : {0.020, 0.045, 0.2}) {
        Arm arm;
        arm.mass_kg = mass;
        arm.step_mm = arm.coulomb_n = 0;
        arm.viscous_ns_mm = 0;
        arm.at = {0, 0, 50};
        arm.velocity = {200, 0, 0};
        held = false;
        begin({.viscosity = {{{0, 0, 0}, 0, 0, PHANTOM_VISCOSITY_MAX_MNS_M, 0}}}, arm);
        run(0.4);
        EXPECT_LT(length(this->arm.velocity), 0.2) << mass << " kg";
        EXPECT_LT(work_n_mm, 0);
        EXPECT_LT(this->arm.at[0], 200 * 0.2) << "b / m and the filter: it stops within some cm";
    }
}

TEST_F(ViscosityLoop, AnEncoderDoesNotMakeItHum)
{
    begin({.viscosity = {{{0, 0, 0}, 0, 0, PHANTOM_VISCOSITY_MAX_MNS_M, 0}}}, {.at = {0, 0, 50}});
    hand.target_velocity = {10, 0, 0};
    run(1);
    hand.target_velocity = {};
    run(1);
    double fastest = 0;
    for (int i = 0; i < 2000; ++i) {
        tick();
        fastest = std::max(fastest, length(arm.velocity));
    }
    EXPECT_LT(fastest, 1) << "at rest";
}

// ---- guides

class GuideLoop : public LoopTest {};

TEST_F(GuideLoop, ASpringBringsAFreeArmToItsPlace)
{
    held = false;
    begin({.viscosity = {{{0, 0, 0}, 0, 0, 5000, 0}},
           .guides = {{{0, 0, 50'000'000}, {0, 0, 0}, PHANTOM_GUIDE_POINT, 500, 2'000'000, 0, 0}}},
          {.at = {20, -5, 60}});
    run(1.5);
    EXPECT_LT(length(minus(arm.at, {0, 0, 50})), arm.coulomb_n / 0.5 + arm.step_mm)
        << "but for the arm's own friction and an encoder's step";
    EXPECT_LT(length(arm.velocity), 1);
}

TEST_F(GuideLoop, ALineLeadsTheHandAndLetsGo)
{
    begin({.guides = {{{0, 0, 50'000'000},
                       {PHANTOM_Q30_ONE, 0, 0},
                       PHANTOM_GUIDE_LINE,
                       500,
                       1'000'000,
                       10'000'000,
                       0}}},
          {.at = {0, 1, 50}});
    hand.target_velocity = {30, 0, 0};
    run(1);
    EXPECT_NEAR(arm.at[0], 30, 1);
    EXPECT_NEAR(arm.at[1], 0.3 / 0.8, 0.1) << "the stiffer spring wins";
    hand.target_velocity = {0, 20, 0};
    run(1);
    hand.target_velocity = {};
    run(0.5);
    EXPECT_NEAR(arm.at[1], 21, 0.1) << "out of its reach";
    EXPECT_EQ(length(servo), 0);
}

// ---- magnet

class MagnetLoop : public LoopTest {};

TEST_F(MagnetLoop, HoldsUntilItsForceAndDoesNotBounce)
{
    Arm start;
    start.at = {0, 0, 4};
    begin({.magnet = phantom_magnet{1'000'000, 500'000}}, start);
    hand.target_velocity = {0, 0, -5};
    run(0.5); // pulled in
    hand.target_velocity = {};
    run(1);
    double fastest = 0;
    for (int i = 0; i < 1000; ++i) {
        tick();
        fastest = std::max(fastest, length(arm.velocity));
    }
    EXPECT_LT(fastest, 0.5) << "at rest on the surface";
    hand.target_velocity = {0, 0, 2};
    double most = 0;
    for (int i = 0; i < 3000; ++i) {
        tick();
        most = std::max(most, -servo[2]);
    }
    EXPECT_NEAR(most, 0.5, 0.03) << "what it takes to pull it off";
    EXPECT_EQ(length(servo), 0) << "and it is off";
}

// ---- texture

class TextureLoop : public LoopTest {};

TEST_F(TextureLoop, AStrokeNeitherGainsEnergyNorRings)
{
    for (const double speed : {5.0, 40.0, 150.0, 400.0}) {
        begin({.texture = phantom_texture{{50'000, 0}, {{500'000, 0, 0}, {0, 0, 0}}}}, resting());
        hand.target = {-20, 0, 2 - 1 / hand.spring_n_mm};
        run(0.5);
        work_n_mm = 0;
        hand.target_velocity = {speed, 0, 0};
        double highest = 0, lowest = 9;
        for (double t = 0; t < std::min(2.0, 60 / speed); t += period_s) {
            tick();
            highest = std::max(highest, arm.at[2]);
            lowest = std::min(lowest, arm.at[2]);
        }
        EXPECT_LT(highest - lowest, 1.0) << speed << " mm/s";
        hand.target_velocity = {};
        run(1);
        EXPECT_LT(work_n_mm, 0.2) << speed << " mm/s";
        double fastest = 0;
        for (int i = 0; i < 1000; ++i) {
            tick();
            fastest = std::max(fastest, length(arm.velocity));
        }
        EXPECT_LT(fastest, 0.5) << speed << " mm/s: at rest again";
    }
}

} // namespace
} // namespace phantom::test
