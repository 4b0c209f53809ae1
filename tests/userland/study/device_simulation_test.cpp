// SPDX-License-Identifier: GPL-2.0-or-later
// The simulated device against what is known of springs, masses and delays, and in the loop of a trace.
#include <cmath>
#include <numbers>
#include <sstream>

#include <gtest/gtest.h>

#include "../feeder/scenes.hpp"
#include "study/device_simulation.hpp"
#include "study/trace.hpp"

namespace phantom::test {
namespace {

constexpr double period_s = 1e-3;

scene::DeviceSettings held()
{
    scene::DeviceSettings device;
    device.mass_kg = 0.05;
    device.hand = scene::HandSettings{0.2, 0, 0.15};
    return device;
}

TEST(DeviceSimulation, ArmAndHandSwingAsASpringAndItsMasses)
{
    study::DeviceSimulation simulation(held(), {0, 0, 0});
    // Led away by 1 mm in one period, then left there: it swings round that place.
    const Vec3 away = {1, 0, 0};
    simulation.pass({}, {}, away, period_s);
    const double energy = simulation.energy_n_mm();
    int crossings = 0;
    double first = 0, last = 0, before = simulation.read(away)[0] - 1;
    for (int i = 1; i <= 10'000; ++i) {
        simulation.pass({}, away, away, period_s);
        const double now = simulation.read(away)[0] - 1;
        if (before < 0 && now >= 0) {
            last = (i - now / (now - before)) * period_s;
            first = crossings++ == 0 ? last : first;
        }
        before = now;
    }
    const double expected_s = 2 * std::numbers::pi * std::sqrt(0.2 / 200.0); // 0.2 kg at 200 N/m
    EXPECT_NEAR((last - first) / (crossings - 1), expected_s, 1e-4 * expected_s);
    EXPECT_NEAR(simulation.energy_n_mm(), energy, 1e-2 * energy) << "nothing takes any";
}

TEST(DeviceSimulation, WorkOfTheActuatorIsWhatTheSwingHas)
{
    study::DeviceSimulation simulation(held(), {0, 0, 0});
    for (int i = 0; i < 1000; ++i)
        simulation.pass({0.5 * std::sin(0.03 * i), 0.2, 0}, {}, {}, period_s);
    EXPECT_GT(simulation.work_n_mm(), 0.1);
    EXPECT_NEAR(simulation.energy_n_mm(), simulation.work_n_mm(), 2e-2 * simulation.work_n_mm());
}

TEST(DeviceSimulation, FrictionHoldsTheArmUpToItsForce)
{
    scene::DeviceSettings device = held();
    device.friction_n = 0.3;
    study::DeviceSimulation simulation(device, {0, 0, 0});
    for (int i = 0; i < 500; ++i)
        simulation.pass({0.29, 0, 0}, {}, {}, period_s);
    EXPECT_EQ(simulation.read({})[0], 0);
    for (int i = 0; i < 500; ++i)
        simulation.pass({0.5, 0, 0}, {}, {}, period_s);
    EXPECT_GT(simulation.read({})[0], 0.5);
}

/// Ticks until a force that begins at once has moved the tip.
int ticks_until_it_moves(const scene::DeviceSettings& device)
{
    study::DeviceSimulation simulation(device, {0, 0, 0});
    for (int tick = 1; tick < 100; ++tick) {
        simulation.pass({1, 0, 0}, {}, {}, period_s);
        if (simulation.read({})[0] > 0)
            return tick;
    }
    return 100;
}

TEST(DeviceSimulation, ADelayIsWaitedFor)
{
    scene::DeviceSettings device = held();
    EXPECT_EQ(ticks_until_it_moves(device), 1);
    device.delay_ms = 5;
    EXPECT_EQ(ticks_until_it_moves(device), 6);
}

TEST(DeviceSimulation, AnAmplifierSaturatesAndIsSlow)
{
    study::Actuator actuator;
    actuator.max_force_n = 2;
    actuator.bandwidth_hz = 50;
    constexpr double dt = 1e-5;
    actuator.command({3, 4, 0}, dt);
    Vec3 now{};
    const double tau_s = 1 / (2 * std::numbers::pi * 50);
    for (double t = 0; t < tau_s; t += dt)
        now = actuator.drive(dt);
    EXPECT_NEAR(length(now), 2 * (1 - std::exp(-1)), 0.01);
    EXPECT_NEAR(now[1] / now[0], 4.0 / 3.0, 1e-9);
    for (double t = 0; t < 20 * tau_s; t += dt)
        now = actuator.drive(dt);
    EXPECT_NEAR(length(now), 2, 1e-6);
}

std::vector<std::vector<double>> rows_of(const std::string& csv)
{
    std::istringstream text(csv);
    std::string line;
    std::getline(text, line);
    std::vector<std::vector<double>> rows;
    while (std::getline(text, line)) {
        std::istringstream cells(line);
        rows.emplace_back();
        for (std::string cell; std::getline(cells, cell, ',');)
            rows.back().push_back(std::stod(cell));
    }
    return rows;
}

/// A path that goes 4 mm down from above the north pole of the sphere, whose shell is 3 mm thick, and rests.
feeder::Path dive(int ticks)
{
    feeder::Path path;
    for (int i = 0; i < ticks; ++i)
        path.push_back({i * period_s, {0, 0, 55 - 4 * std::min(1.0, i / 500.0)}});
    return path;
}

std::vector<std::vector<double>> traced(const scene::DeviceSettings& device, int ticks)
{
    scene::Scene scene = sphere_scene();
    scene.device = device;
    const auto run = study::run_trace(scene, dive(ticks), {});
    EXPECT_TRUE(run);
    return run ? rows_of(run->csv) : std::vector<std::vector<double>>{};
}

TEST(DeviceSimulation, InTheLoopHandAndSurfaceShareTheForce)
{
    scene::DeviceSettings device = held();
    device.hand->damping_ns_m = 10;
    const auto rows = traced(device, 3000);
    ASSERT_EQ(rows.size(), 3000U);
    EXPECT_EQ(rows.front()[3], 55);
    // In the air it follows the hand, whose damper knows how fast that goes.
    EXPECT_NEAR(rows[240][3], 55 - 8 * 0.24, 0.02);
    // 1 N/mm (53 - z) = 0.2 N/mm (z - 51)
    const double z = (1.0 * 53 + 0.2 * 51) / 1.2;
    EXPECT_NEAR(rows.back()[3], z, 1e-3);
    EXPECT_NEAR(rows.back()[6], 53 - z, 1e-3);
}

TEST(DeviceSimulation, AnEncoderAloneRoundsThePath)
{
    scene::DeviceSettings device;
    device.encoder_mm = 0.25;
    const auto rows = traced(device, 600);
    const feeder::Path path = dive(600);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(rows[i][3], 0.25 * std::round(rows[i][3] / 0.25)) << i;
        EXPECT_NEAR(rows[i][3], path[i].tip_mm[2], 0.125 + 1e-9) << i;
    }
}

TEST(DeviceSimulation, WhatIsNotNamedChangesNoBit)
{
    scene::DeviceSettings limits;
    limits.max_force_n = 5;
    const auto plain = traced({}, 600), limited = traced(limits, 600);
    const feeder::Path path = dive(600);
    ASSERT_EQ(plain.size(), limited.size());
    for (std::size_t i = 0; i < plain.size(); ++i) {
        EXPECT_NEAR(plain[i][3], path[i].tip_mm[2], 1e-7) << i; // nine digits
        for (std::size_t column = 0; column < 12; ++column)
            EXPECT_EQ(plain[i][column], limited[i][column]) << i << " " << column;
    }
}

} // namespace
} // namespace phantom::test
