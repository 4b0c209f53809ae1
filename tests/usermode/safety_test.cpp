// SPDX-License-Identifier: GPL-2.0-or-later
// Clamp, slew and ramps in numbers, as they arrive at the device.
#include "machine.hpp"

namespace phantom::test {
namespace {

class Safety : public MachineTest {
  protected:
    /// A set that never gets stale, over a plane of 1 N/mm and R = 3 mm.
    void begin(File& feeder, phantom_start start, std::int64_t z, std::uint32_t stiffness = 1000)
    {
        Plane plane(1);
        plane.materials[0].stiffness_mn_mm = stiffness;
        ASSERT_EQ(feeder.submit(plane), 0);
        ASSERT_EQ(feeder.move(0, 0, z), 0);
        start.stale_ms = 1'000'000;
        ASSERT_EQ(feeder.start(start), 0);
    }
};

TEST_F(Safety, StartRampsLinearly)
{
    File feeder(machine);
    begin(feeder,
          {.flags = 0,
           .max_force_un = 0,
           .slew_un_per_ms = 0,
           .ramp_ms = 200,
           .max_speed_um_s = 0,
           .stall_us = 0,
           .stale_ms = 0,
           .crossfade_ms = 0},
          2'000'000);
    step(300);
    const auto records = feeder.read();
    for (std::size_t i = 30; i < 199; ++i) { // the first 20 ms fade in, too
        EXPECT_NEAR(records[i].force_un[2], 1e6 * double(i + 1) / 200, 5) << i;
        EXPECT_TRUE(records[i].flags & PHANTOM_TICK_RAMPING);
    }
    EXPECT_NEAR(records[199].force_un[2], 1'000'000, 5);
    EXPECT_FALSE(records[199].flags & PHANTOM_TICK_RAMPING);
}

TEST_F(Safety, RampIsOnByDefault)
{
    File feeder(machine);
    begin(feeder, {}, 2'000'000);
    step(125);
    EXPECT_NEAR(feeder.status().force_un[2], 500'000, 10) << "half of 250 ms";
}

TEST_F(Safety, RampDoesNotDependOnTheRate)
{
    create({.rate_hz = 8000});
    File feeder(machine);
    begin(feeder, {}, 2'000'000);
    step(1000); // 125 ms
    EXPECT_NEAR(feeder.status().force_un[2], 500'000, 10);
}

TEST_F(Safety, StopRampsFromWhereItIs)
{
    File feeder(machine);
    phantom_start start{};
    start.ramp_ms = 100;
    begin(feeder, start, 2'000'000);
    step(60); // in mid-ramp: 0.6 N
    EXPECT_NEAR(feeder.status().force_un[2], 600'000, 10);
    feeder.read();
    feeder.stop();
    const auto records = feeder.read();
    ASSERT_EQ(records.size(), 60u);
    for (std::size_t i = 0; i < records.size(); ++i)
        EXPECT_NEAR(records[i].force_un[2], 600'000 - 10'000.0 * double(i + 1), 10) << i;
    EXPECT_EQ(records.back().force_un[2], 0);
}

TEST_F(Safety, StopWhileFaultedEndsAtOnce)
{
    File feeder(machine);
    begin(feeder, {}, 2'000'000);
    step(300);
    phantom_um_inject_device_error(machine, -EIO);
    step();
    feeder.read();
    feeder.stop();
    EXPECT_EQ(feeder.read().size(), 1u);
}

TEST_F(Safety, ClearFaultRampsUpAgain)
{
    File feeder(machine);
    phantom_start start{};
    start.ramp_ms = 100;
    begin(feeder, start, 2'000'000);
    step(150);
    phantom_um_inject_device_error(machine, -EIO);
    step();
    phantom_um_inject_device_error(machine, 0);
    step();
    ASSERT_EQ(feeder.ioctl(PHANTOM_CLEAR_FAULT), 0);
    step(50);
    EXPECT_NEAR(feeder.status().force_un[2], 500'000, 10);
}

TEST_F(Safety, FaultCutsWithoutRampOrSlew)
{
    File feeder(machine);
    phantom_start start{};
    start.slew_un_per_ms = 10'000;
    begin(feeder, start, 1'000'000);
    step(1000);
    ASSERT_GT(feeder.status().force_un[2], 1'900'000);
    phantom_um_inject_stall(machine, 30'000'000);
    step();
    EXPECT_EQ(feeder.status().faults, PHANTOM_FAULT_STALL);
    EXPECT_EQ(feeder.status().force_un[2], 0);
}

/// A servo that skips periods tick after tick would leave its CPU to nobody: it gives contact up.
TEST_F(Safety, OverloadIsAFaultAndEndsTheWork)
{
    File feeder(machine);
    phantom_start start{};
    start.stall_us = 5000; // overloaded after ten times that
    begin(feeder, start, 2'000'000);
    step(500);
    ASSERT_GT(feeder.status().force_un[2], 0);
    const auto late_step = [this] {
        phantom_um_inject_stall(machine, 3'000'000); // ticks 3 ms apart, and every one skips periods
        step();
    };
    for (int i = 0; i < 15; ++i)
        late_step();
    EXPECT_EQ(feeder.status().faults, 0U);
    step(); // one in time: it can do the work
    for (int i = 0; i < 15; ++i)
        late_step();
    EXPECT_EQ(feeder.status().faults, 0U);
    for (int i = 0; i < 30; ++i)
        late_step();
    EXPECT_EQ(feeder.status().faults, PHANTOM_FAULT_STALL);
    EXPECT_EQ(feeder.status().contacts, 0U);
    EXPECT_EQ(feeder.ioctl(PHANTOM_CLEAR_FAULT), -EAGAIN);
    step(2);
    ASSERT_EQ(feeder.ioctl(PHANTOM_CLEAR_FAULT), 0);
    step(500);
    EXPECT_EQ(feeder.status().faults, 0U);
    EXPECT_GT(feeder.status().force_un[2], 0);
}

/// Nor may one that is never late but computes nearly all the time.
TEST_F(Safety, ComputingNearlyAllTheTimeIsAnOverload)
{
    File feeder(machine);
    begin(feeder, {}, 2'000'000);
    step(500);
    ASSERT_GT(feeder.status().force_un[2], 0);
    const auto busy_steps = [&](int ticks, std::uint32_t duration_ns) {
        phantom_tick record{};
        record.tick = feeder.status().tick;
        record.time_ns = feeder.status().time_ns;
        record.tip_nm[2] = 2'000'000;
        record.duration_ns = duration_ns;
        for (int i = 0; i < ticks; ++i) {
            ++record.tick;
            record.time_ns += 1'000'000;
            ASSERT_EQ(phantom_um_replay(machine, &record, record.time_ns), 1);
        }
    };
    busy_steps(2000, 850'000);
    EXPECT_EQ(feeder.status().faults, 0U) << "seven eighths of the time are allowed";
    busy_steps(300, 950'000); // 0.075 ms too much each, 25 ms are the limit
    EXPECT_EQ(feeder.status().faults, 0U);
    busy_steps(30, 10'000); // quiet ones: it was not on end
    busy_steps(300, 950'000);
    EXPECT_EQ(feeder.status().faults, 0U);
    busy_steps(60, 950'000);
    EXPECT_EQ(feeder.status().faults, PHANTOM_FAULT_STALL);
    EXPECT_EQ(feeder.status().contacts, 0U);
    step(10);
    ASSERT_EQ(feeder.ioctl(PHANTOM_CLEAR_FAULT), 0);
    step(500);
    EXPECT_EQ(feeder.status().faults, 0U);
    EXPECT_GT(feeder.status().force_un[2], 0);
}

TEST_F(Safety, ClampKeepsTheDirection)
{
    File feeder(machine);
    Plane plane(1);
    const double tilt = 0.5; // normals lean over, so the force has two components
    for (auto& patch : plane.patches)
        for (auto& normal : patch.normal_q30) {
            normal[0] = std::int32_t(std::sin(tilt) * PHANTOM_Q30_ONE);
            normal[2] = std::int32_t(std::cos(tilt) * PHANTOM_Q30_ONE);
        }
    plane.materials[0].stiffness_mn_mm = 5000;
    ASSERT_EQ(feeder.submit(plane), 0);
    feeder.move(0, 0, 500'000);
    phantom_start start{};
    start.max_force_un = 1'500'000;
    start.stale_ms = 1'000'000;
    ASSERT_EQ(feeder.start(start), 0);
    step(400);
    const phantom_status status = feeder.status();
    EXPECT_TRUE(status.flags & PHANTOM_TICK_CLAMPED);
    EXPECT_LE(norm(status.force_un), 1'500'000.0);
    EXPECT_NEAR(norm(status.force_un), 1'500'000.0, 3);
    EXPECT_NEAR(std::atan2(status.force_un[0], status.force_un[2]), tilt, 1e-5);
    EXPECT_GT(status.clamped, 100u);
}

TEST_F(Safety, DeviceForceIsTheDefaultClamp)
{
    create({.max_force_un = 800'000});
    File feeder(machine);
    begin(feeder, {}, 1'000'000);
    step(400);
    EXPECT_NEAR(feeder.status().force_un[2], 800'000, 2);
}

TEST_F(Safety, SlewLimitsTheChangePerMillisecond)
{
    for (std::uint32_t hz : {1000u, 4000u}) {
        create({.rate_hz = hz});
        File feeder(machine);
        phantom_start start{};
        start.slew_un_per_ms = 20'000;
        start.ramp_ms = 1;
        begin(feeder, start, 2'900'000);
        step(hz / 10);
        feeder.read();
        feeder.move(0, 0, 1'000'000); // asks for 2 N at once
        step(hz / 20);
        double last = 100'000;
        const double most = 20'000 * 1000.0 / hz;
        const auto records = feeder.read();
        for (const phantom_tick& record : records) {
            EXPECT_LE(record.force_un[2] - last, most + 1);
            last = record.force_un[2];
        }
        EXPECT_NEAR(last, 100'000 + 20'000 * 50, 50) << "50 ms later, and always at the limit";
        EXPECT_TRUE(records.back().flags & PHANTOM_TICK_SLEWED);
        step(hz / 5);
        EXPECT_NEAR(feeder.status().force_un[2], 2'000'000, 10) << "arrives";
        EXPECT_FALSE(feeder.status().flags & PHANTOM_TICK_SLEWED);
    }
}

TEST_F(Safety, LateTickDoesNotBuyALargerStep)
{
    File feeder(machine);
    phantom_start start{};
    start.slew_un_per_ms = 20'000;
    start.ramp_ms = 1;
    begin(feeder, start, 2'900'000);
    step(100);
    const double before = feeder.status().force_un[2];
    feeder.move(0, 0, 1'000'000);
    phantom_um_inject_stall(machine, 15'000'000);
    step();
    EXPECT_EQ(feeder.status().faults, 0u);
    EXPECT_LE(feeder.status().force_un[2] - before, 2 * 20'000 + 1) << "two periods' worth at most";
}

TEST_F(Safety, LimitsOffPassesEverything)
{
    create({.max_force_un = 1000});
    File feeder(machine);
    Plane plane(1);
    ASSERT_EQ(feeder.submit(plane), 0);
    feeder.move(0, 0, 20'000'000);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    step(30);
    feeder.move(0, 0, 500'000); // a jump of 19.5 mm, a force far above the device's
    step();
    const phantom_status status = feeder.status();
    EXPECT_EQ(status.faults, 0u);
    EXPECT_NEAR(status.force_un[2], 2'500'000, 5);
    EXPECT_EQ(status.flags & (PHANTOM_TICK_CLAMPED | PHANTOM_TICK_SLEWED | PHANTOM_TICK_RAMPING), 0u);
    feeder.read();
    feeder.stop();
    const auto records = feeder.read();
    ASSERT_EQ(records.size(), 1u);
    EXPECT_EQ(records[0].force_un[2], 0);
}

TEST_F(Safety, ForceOfAnyStiffnessStaysInRange)
{
    File feeder(machine);
    begin(feeder, {}, -100'000'000, 0xffffffff);
    feeder.move(0, 0, 2'000'000);
    step(5);
    std::int64_t z = 2'000'000;
    for (int tick = 0; tick < 400; ++tick) {
        feeder.move(0, 0, z -= 50'000);
        step();
        EXPECT_LE(norm(feeder.status().force_un), 10'000'000.0);
        EXPECT_GE(feeder.status().force_un[2], 0) << "never wraps";
    }
}

TEST_F(Safety, VelocityIsTheLowPassedDifference)
{
    File feeder(machine);
    begin(feeder, {}, 50'000'000);
    step(5);
    EXPECT_EQ(feeder.status().velocity_nm_s[0], 0);
    double expected = 0;
    for (int tick = 1; tick <= 30; ++tick) {
        feeder.move(tick * 100'000, 0, 50'000'000); // 100 mm/s
        step();
        expected += (1e8 - expected) * 1.0 / (2.0 + 1.0); // dt / (tau + dt)
        EXPECT_NEAR(feeder.status().velocity_nm_s[0], expected, 1e5) << tick;
    }
}

} // namespace
} // namespace phantom::test
