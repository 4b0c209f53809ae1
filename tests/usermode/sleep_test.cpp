// SPDX-License-Identifier: GPL-2.0-or-later
// The machine goes to sleep and wakes up: what is left of the force, the fault, the ticks.
#include "machine.hpp"

namespace phantom::test {
namespace {

class Sleep : public MachineTest {
  protected:
    static constexpr std::int32_t full_un = 2'000'000; // 1 N/mm, R = 3 mm, 1 mm above the plane

    void start_in_contact(File& feeder)
    {
        Plane plane(1);
        ASSERT_EQ(feeder.submit(plane), 0);
        ASSERT_EQ(feeder.move(0, 0, 1'000'000), 0);
        phantom_start start{};
        start.stale_ms = 1'000'000;
        ASSERT_EQ(feeder.start(start), 0);
        step(600);
        ASSERT_EQ(feeder.status().force_un[2], full_un);
    }
};

TEST_F(Sleep, TakesTheForceAwayByARampAndLatchesAFault)
{
    File feeder(machine), observer(machine, O_RDONLY | O_NONBLOCK);
    start_in_contact(feeder);
    observer.read();
    const std::uint64_t asleep_ns = feeder.status().time_ns;
    phantom_um_suspend(machine);

    const phantom_status status = feeder.status();
    EXPECT_EQ(status.state, std::uint32_t(PHANTOM_STATE_FAULT));
    EXPECT_EQ(status.faults, PHANTOM_FAULT_SUSPENDED);
    EXPECT_EQ(norm(status.force_un), 0.0);
    EXPECT_TRUE(observer.poll(POLLPRI) & POLLPRI);
    std::int32_t last = full_un;
    const auto records = observer.read();
    ASSERT_GT(records.size(), 5u) << "a ramp, not a step";
    for (const phantom_tick& record : records) {
        EXPECT_LE(record.force_un[2], last);
        EXPECT_GE(record.force_un[2], last - 200'000);
        EXPECT_LE(record.time_ns, asleep_ns + PHANTOM_FADE_NS);
        last = record.force_un[2];
    }
    EXPECT_EQ(last, 0);
    EXPECT_EQ(step(), -EAGAIN) << "no tick in a sleeping machine";
}

TEST_F(Sleep, WakesInFaultWithoutAMissedTickAndClearFaultRampsUp)
{
    File feeder(machine);
    start_in_contact(feeder);
    const phantom_status before = feeder.status();
    phantom_um_suspend(machine);
    const std::uint64_t ticks = feeder.status().tick;
    EXPECT_EQ(phantom_um_resume(machine), 0);
    EXPECT_EQ(step(100), 100);

    phantom_status status = feeder.status();
    EXPECT_EQ(status.state, std::uint32_t(PHANTOM_STATE_FAULT));
    EXPECT_EQ(status.faults, PHANTOM_FAULT_SUSPENDED) << "no stall, nothing else";
    EXPECT_EQ(norm(status.force_un), 0.0);
    EXPECT_EQ(status.tick, ticks + 100);
    EXPECT_EQ(status.missed, 0u);
    EXPECT_EQ(status.start_ns, before.start_ns);
    EXPECT_EQ(feeder.start(), -EBUSY);

    EXPECT_EQ(feeder.ioctl(PHANTOM_CLEAR_FAULT), 0);
    std::int32_t last = 0;
    for (int i = 0; i < 400; ++i) {
        step();
        const std::int32_t force = feeder.status().force_un[2];
        EXPECT_LE(std::abs(force - last), 1'000'000 / 100) << "tick " << i;
        last = force;
    }
    EXPECT_EQ(last, full_un);
    EXPECT_EQ(feeder.status().state, std::uint32_t(PHANTOM_STATE_RUNNING));
}

/// The arm was moved while the machine slept: that is no speed.
TEST_F(Sleep, TipThatMovedMeanwhileIsNoOverspeed)
{
    File feeder(machine);
    start_in_contact(feeder);
    phantom_um_suspend(machine);
    feeder.move(80'000'000, -80'000'000, 90'000'000);
    EXPECT_EQ(phantom_um_resume(machine), 0);
    step(10);
    EXPECT_EQ(feeder.status().faults, PHANTOM_FAULT_SUSPENDED);
}

/// What STOP's short ramp did to the limits is not kept.
TEST_F(Sleep, LimitsOfTheRunComeBack)
{
    File feeder(machine);
    Plane plane(1);
    feeder.submit(plane);
    feeder.move(0, 0, 1'000'000);
    phantom_start start{};
    start.stale_ms = 1'000'000;
    start.slew_un_per_ms = 5'000;
    start.ramp_ms = 100;
    ASSERT_EQ(feeder.start(start), 0);
    step(500);
    ASSERT_EQ(feeder.status().force_un[2], full_un);
    phantom_um_suspend(machine);
    EXPECT_EQ(phantom_um_resume(machine), 0);
    step(5);
    EXPECT_EQ(feeder.ioctl(PHANTOM_CLEAR_FAULT), 0);
    std::int32_t last = 0;
    for (int i = 0; i < 450; ++i) {
        step();
        EXPECT_LE(feeder.status().force_un[2] - last, 5'000);
        last = feeder.status().force_un[2];
    }
    EXPECT_EQ(last, full_un);
}

TEST_F(Sleep, CallsInASleepingMachine)
{
    File feeder(machine);
    start_in_contact(feeder);
    phantom_um_suspend(machine);
    phantom_um_suspend(machine); // once is enough
    EXPECT_EQ(feeder.ioctl(PHANTOM_CLEAR_FAULT), -EAGAIN);
    EXPECT_EQ(feeder.start(), -EBUSY);
    for (std::uint64_t id = 2; id < 10; ++id) {
        Plane plane(id);
        EXPECT_EQ(feeder.submit(plane), 0) << id;
    }
    EXPECT_EQ(feeder.rate(2000), 0);
    EXPECT_EQ(phantom_um_resume(machine), 0);
    EXPECT_EQ(phantom_um_resume(machine), 0);
    step(5);
    EXPECT_EQ(feeder.status().set_id, 9u);
    EXPECT_EQ(feeder.status().rate_hz, 2000u);
}

TEST_F(Sleep, StopInASleepingMachineEndsTheRun)
{
    File feeder(machine);
    start_in_contact(feeder);
    phantom_um_suspend(machine);
    EXPECT_EQ(feeder.stop(), 0);
    EXPECT_EQ(feeder.status().state, std::uint32_t(PHANTOM_STATE_IDLE));
    EXPECT_EQ(feeder.status().faults, PHANTOM_FAULT_SUSPENDED);
    EXPECT_EQ(feeder.ioctl(PHANTOM_CLEAR_FAULT), 0);
    EXPECT_EQ(feeder.start(), -EBUSY) << "it still sleeps";
    EXPECT_EQ(phantom_um_resume(machine), 0);
    EXPECT_EQ(step(), -EAGAIN);
    EXPECT_EQ(feeder.start(), 0);
    EXPECT_EQ(step(5), 5);
}

TEST_F(Sleep, FeederThatClosesInASleepingMachineLeavesIt)
{
    File observer(machine, O_RDONLY);
    {
        File feeder(machine);
        start_in_contact(feeder);
        phantom_um_suspend(machine);
    }
    EXPECT_EQ(observer.status().state, std::uint32_t(PHANTOM_STATE_IDLE));
    EXPECT_EQ(phantom_um_resume(machine), 0);
    File next(machine);
    EXPECT_EQ(next.ioctl(PHANTOM_CLEAR_FAULT), 0);
    EXPECT_EQ(next.start(), 0);
}

TEST_F(Sleep, IdleMachineSleepsWithoutAFault)
{
    File feeder(machine);
    phantom_um_suspend(machine);
    EXPECT_EQ(feeder.status().state, std::uint32_t(PHANTOM_STATE_IDLE));
    EXPECT_EQ(feeder.status().faults, 0u);
    EXPECT_EQ(feeder.start(), -EBUSY);
    EXPECT_EQ(phantom_um_resume(machine), 0);
    EXPECT_EQ(feeder.start(), 0);
}

TEST_F(Sleep, EarlierFaultStaysLatchedBesideIt)
{
    File feeder(machine);
    start_in_contact(feeder);
    phantom_um_inject_device_error(machine, -EIO);
    step();
    phantom_um_inject_device_error(machine, 0);
    phantom_um_suspend(machine);
    EXPECT_EQ(phantom_um_resume(machine), 0);
    step(3);
    EXPECT_EQ(feeder.status().faults, PHANTOM_FAULT_SUSPENDED | PHANTOM_FAULT_DEVICE);
    EXPECT_EQ(feeder.ioctl(PHANTOM_CLEAR_FAULT), 0);
    step();
    EXPECT_EQ(feeder.status().faults, 0u);
}

/// A clock that jumps far ahead, as after a halt of the whole machine: one late tick, no burst.
TEST_F(Sleep, JumpOfTheClockIsOneLateTickAndAStall)
{
    File feeder(machine);
    start_in_contact(feeder);
    const phantom_status before = feeder.status();
    const std::uint64_t hour_ns = 3'600'000'000'000;
    phantom_um_inject_stall(machine, hour_ns);
    step();
    phantom_status status = feeder.status();
    EXPECT_EQ(status.faults, PHANTOM_FAULT_STALL);
    EXPECT_EQ(norm(status.force_un), 0.0);
    step(10);
    status = feeder.status();
    // the late tick is the period's that it slept for, and the one that begins as it comes is served
    EXPECT_EQ(status.missed, hour_ns / 1'000'000 - 1);
    EXPECT_EQ(status.tick - before.tick, 11 + status.missed);
    EXPECT_EQ(status.time_ns - before.time_ns, hour_ns + 10 * 1'000'000);
}

} // namespace
} // namespace phantom::test
