// SPDX-License-Identifier: GPL-2.0-or-later
// Who may open, and how the states IDLE, RUNNING and FAULT follow one another.
#include "machine.hpp"

namespace phantom::test {
namespace {

class States : public MachineTest {
  protected:
    static std::uint32_t state(File& file) { return file.status().state; }
};

TEST_F(States, OneFeederManyObservers)
{
    File feeder(machine);
    ASSERT_EQ(feeder.error(), 0);
    File second(machine), write_only(machine, O_WRONLY);
    EXPECT_EQ(second.error(), -EBUSY);
    EXPECT_EQ(write_only.error(), -EBUSY);
    File a(machine, O_RDONLY), b(machine, O_RDONLY), c(machine, O_RDONLY);
    EXPECT_EQ(a.error() | b.error() | c.error(), 0);
    feeder.close();
    File third(machine);
    EXPECT_EQ(third.error(), 0);
}

TEST_F(States, StartRunsAndStopEnds)
{
    File feeder(machine);
    EXPECT_EQ(state(feeder), std::uint32_t(PHANTOM_STATE_IDLE));
    EXPECT_EQ(step(), -EAGAIN);
    EXPECT_EQ(feeder.start(), 0);
    EXPECT_EQ(state(feeder), std::uint32_t(PHANTOM_STATE_RUNNING));
    EXPECT_EQ(step(10), 10);
    EXPECT_EQ(feeder.status().tick, 10u);
    EXPECT_EQ(feeder.start(), -EBUSY);
    EXPECT_EQ(feeder.stop(), 0);
    EXPECT_EQ(state(feeder), std::uint32_t(PHANTOM_STATE_IDLE));
    EXPECT_EQ(step(), -EAGAIN);
    EXPECT_EQ(feeder.stop(), 0) << "idle already";
}

TEST_F(States, StartBeginsCountersAnew)
{
    File feeder(machine);
    Plane plane(1);
    feeder.submit(plane);
    ASSERT_EQ(feeder.start(), 0);
    step(500);
    feeder.stop();
    const std::uint64_t end = feeder.status().time_ns;
    ASSERT_EQ(feeder.start(), 0);
    step();
    const phantom_status status = feeder.status();
    EXPECT_EQ(status.tick, 1u);
    EXPECT_EQ(status.missed, 0u);
    EXPECT_EQ(status.sets, 0u) << "taken in the run before";
    EXPECT_EQ(status.set_id, 1u) << "and still in use";
    EXPECT_EQ(status.start_ns, end);
}

TEST_F(States, DeviceErrorIsALatchedFaultAndZeroForceAtOnce)
{
    File feeder(machine);
    Plane plane(1);
    feeder.submit(plane);
    feeder.move(0, 0, 1'000'000);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    step(50);
    ASSERT_GT(feeder.status().force_un[2], 1'900'000);

    phantom_um_inject_device_error(machine, -EIO);
    step();
    phantom_status status = feeder.status();
    EXPECT_EQ(status.state, std::uint32_t(PHANTOM_STATE_FAULT));
    EXPECT_EQ(status.faults, PHANTOM_FAULT_DEVICE);
    EXPECT_EQ(norm(status.force_un), 0.0);
    EXPECT_EQ(status.tip_nm[2], 1'000'000) << "the last that was known";
    EXPECT_TRUE(feeder.poll(POLLPRI) & POLLPRI);

    EXPECT_EQ(feeder.ioctl(PHANTOM_CLEAR_FAULT), -EAGAIN) << "the cause is still there";
    phantom_um_inject_device_error(machine, 0);
    step(20);
    EXPECT_EQ(feeder.status().state, std::uint32_t(PHANTOM_STATE_FAULT)) << "latched";
    EXPECT_EQ(norm(feeder.status().force_un), 0.0);
    EXPECT_EQ(feeder.start(), -EBUSY);

    EXPECT_EQ(feeder.ioctl(PHANTOM_CLEAR_FAULT), 0);
    step();
    status = feeder.status();
    EXPECT_EQ(status.state, std::uint32_t(PHANTOM_STATE_RUNNING));
    EXPECT_EQ(status.faults, 0u);
    EXPECT_GT(status.force_un[2], 1'900'000) << "without limits there is no ramp";
    EXPECT_EQ(feeder.ioctl(PHANTOM_CLEAR_FAULT), 0) << "nothing to clear";
}

TEST_F(States, UnpluggedIsItsOwnFault)
{
    File feeder(machine);
    ASSERT_EQ(feeder.start(), 0);
    step();
    phantom_um_inject_device_error(machine, -ENODEV);
    step();
    EXPECT_EQ(feeder.status().faults, PHANTOM_FAULT_UNPLUGGED);
}

TEST_F(States, StopLeavesTheFaultLatched)
{
    File feeder(machine);
    ASSERT_EQ(feeder.start(), 0);
    phantom_um_inject_device_error(machine, -EIO);
    step();
    phantom_um_inject_device_error(machine, 0);
    EXPECT_EQ(feeder.stop(), 0);
    EXPECT_EQ(state(feeder), std::uint32_t(PHANTOM_STATE_IDLE));
    EXPECT_EQ(feeder.status().faults, PHANTOM_FAULT_DEVICE);
    EXPECT_EQ(feeder.start(), -EIO);
    EXPECT_EQ(feeder.ioctl(PHANTOM_CLEAR_FAULT), 0);
    EXPECT_EQ(feeder.start(), 0);
}

TEST_F(States, StallIsAFault)
{
    File feeder(machine);
    phantom_start start{};
    start.stall_us = 5000;
    ASSERT_EQ(feeder.start(start), 0);
    step(10);
    phantom_um_inject_stall(machine, 5'000'000);
    step();
    EXPECT_EQ(feeder.status().faults, 0u) << "exactly the limit";
    phantom_um_inject_stall(machine, 5'000'001);
    step();
    EXPECT_EQ(feeder.status().faults, PHANTOM_FAULT_STALL);
    step();
    EXPECT_EQ(feeder.ioctl(PHANTOM_CLEAR_FAULT), 0) << "a stall is over when it is seen";
}

TEST_F(States, OverspeedIsAFault)
{
    File feeder(machine);
    phantom_start start{};
    start.max_speed_um_s = 500'000; // 0.5 m/s
    ASSERT_EQ(feeder.start(start), 0);
    std::int64_t x = 0;
    for (int tick = 0; tick < 100; ++tick) {
        feeder.move(x += 490'000, 0, 0); // 0.49 m/s at 1 kHz
        step();
    }
    EXPECT_EQ(feeder.status().faults, 0u);
    EXPECT_NEAR(feeder.status().velocity_nm_s[0], 490'000'000, 1'000'000);
    for (int tick = 0; tick < 20; ++tick) {
        feeder.move(x += 510'000, 0, 0);
        step();
    }
    EXPECT_EQ(feeder.status().faults, PHANTOM_FAULT_OVERSPEED);
}

TEST_F(States, TeleportIsAFaultNotAForce)
{
    File feeder(machine);
    Plane plane(1);
    feeder.submit(plane);
    feeder.move(0, 0, 30'000'000);
    ASSERT_EQ(feeder.start(), 0);
    step(300);
    feeder.move(0, 0, 1'000'000);
    step();
    EXPECT_EQ(feeder.status().faults, PHANTOM_FAULT_OVERSPEED);
    EXPECT_EQ(norm(feeder.status().force_un), 0.0);
}

TEST_F(States, ClosingInContactEndsTheForceWithinTheFadeAndForgetsTheScene)
{
    constexpr double full_un = 2'000'000;
    const auto fade_ticks = std::size_t(PHANTOM_FADE_NS / 1'000'000); // at 1 kHz
    File observer(machine, O_RDONLY | O_NONBLOCK);
    {
        File feeder(machine);
        Plane plane(7);
        feeder.submit(plane);
        feeder.move(0, 0, 1'000'000);
        phantom_start start{};
        start.ramp_ms = 50;
        start.slew_un_per_ms = 50'000; // 40 ms for 2 N: must give way too
        start.stale_ms = 10'000;
        ASSERT_EQ(feeder.start(start), 0);
        step(200);
        ASSERT_NEAR(feeder.status().force_un[2], full_un, 2000);
    }
    EXPECT_EQ(observer.status().state, std::uint32_t(PHANTOM_STATE_IDLE));
    const auto records = observer.read();
    ASSERT_GT(records.size(), 205u);
    ASSERT_LE(records.size(), 200 + fade_ticks);
    EXPECT_EQ(norm(records.back().force_un), 0.0);
    for (std::size_t i = 200; i < records.size(); ++i) {
        EXPECT_LE(records[i].force_un[2], records[i - 1].force_un[2]);
        EXPECT_LE(distance(records[i].force_un, records[i - 1].force_un), full_un / 15 + 2000) << i;
    }
    EXPECT_EQ(observer.status().set_id, 0u);

    File next(machine);
    Plane plane(1);
    EXPECT_EQ(next.submit(plane), 0) << "ids begin anew with a new feeder";
}

TEST_F(States, SetInFlightWhenTheFeederClosesIsDropped)
{
    {
        File feeder(machine);
        Plane plane(1);
        ASSERT_EQ(feeder.submit(plane), 0); // never taken: no tick ran
    }
    File feeder(machine);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    step(3);
    EXPECT_EQ(feeder.status().set_id, 0u);
    EXPECT_TRUE(feeder.status().flags & PHANTOM_TICK_UNCOVERED);
}

} // namespace
} // namespace phantom::test
