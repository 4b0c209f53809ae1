// SPDX-License-Identifier: GPL-2.0-or-later
// An arm over a link: reports, commands, limits of its currents, silence, deafness, the pulled cable.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <poll.h>
#include <vector>

#include <gtest/gtest.h>

#include "arm_machine.h"
#include "machine.hpp"

namespace phantom::test {
namespace {

constexpr std::uint64_t ms = 1'000'000;

class ArmTest : public ::testing::Test {
  protected:
    void SetUp() override
    {
        machine = arm_machine_create(10'000'000);
        ASSERT_NE(machine, nullptr);
    }
    void TearDown() override { arm_machine_destroy(machine); }

    int start()
    {
        phantom_start start{};
        start.stale_ms = 1'000'000;
        return arm_machine_ioctl(machine, PHANTOM_START, &start);
    }
    std::array<int, 3> currents()
    {
        std::int16_t current[3];
        arm_machine_currents(machine, current);
        return {current[0], current[1], current[2]};
    }
    const phantom_status& status() { return *arm_machine_status(machine); }

    /// In contact with a plane of 1 N/mm, 2 mm inside its shell of 3 mm; the force has ramped up.
    void touch()
    {
        Plane plane(1);
        ASSERT_EQ(arm_machine_ioctl(machine, PHANTOM_SUBMIT_SET, &plane.set()), 0);
        const std::int16_t near_origin[3] = {0, 1332, 2579}; // tip about (0.0, 0, 1.0) mm
        arm_machine_move(machine, near_origin);
        ASSERT_EQ(start(), 0);
        ASSERT_EQ(arm_machine_step(machine, 400), 400);
        ASSERT_EQ(status().faults, 0u);
        ASSERT_GT(status().force_un[2], 500'000);
        ASSERT_NE(currents(), (std::array<int, 3>{0, 0, 0}));
    }

    arm_machine* machine = nullptr;
};

constexpr std::array<int, 3> off{0, 0, 0};

TEST_F(ArmTest, TellsItsNumbers)
{
    auto info = dirty<phantom_info>();
    ASSERT_EQ(arm_machine_ioctl(machine, PHANTOM_GET_INFO, &info), 0);
    EXPECT_EQ(info.device, std::uint32_t(PHANTOM_DEVICE_HID));
    EXPECT_EQ(info.max_force_un, 5'000'000u); // its own, below what the module allows
    EXPECT_EQ(info.continuous_force_un, 4'300'000u);
    EXPECT_EQ(info.device_rate_hz, 1000u);
    EXPECT_EQ(info.workspace_max_nm[2], 100'000'000);
    EXPECT_EQ(info.features & PHANTOM_FEATURE_SIM_MOVE, 0u);
}

TEST_F(ArmTest, CommandsAreTheFirmwaresBytes)
{
    // motors a, b, c; then the encoders' rest pose with command 1
    const std::int32_t current[3] = {0x0102, -2, 0x0304};
    std::uint8_t command[ARM_COMMAND_BYTES];
    EXPECT_EQ(arm_machine_drive(machine, current, 0), 0);
    arm_machine_command(machine, command);
    EXPECT_EQ(std::vector<int>(command, command + sizeof(command)),
              (std::vector<int>{0x02, 0x01, 0xfe, 0xff, 0x04, 0x03, 0, 0, 0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(arm_machine_calibrate(machine), 0);
    arm_machine_command(machine, command);
    EXPECT_EQ(std::vector<int>(command, command + sizeof(command)),
              (std::vector<int>{0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0x70, 0x17}));
}

TEST_F(ArmTest, ReportsAreReadAsTheFirmwareWritesThem)
{
    // 64 bytes as a Teensy sends them; encoders 0, 0, 6000 and rubbish behind
    std::uint8_t report[64];
    std::memset(report, 0xa5, sizeof(report));
    const std::uint8_t encoders[6] = {0, 0, 0, 0, 0x70, 0x17};
    std::memcpy(report, encoders, sizeof(encoders));
    ASSERT_EQ(start(), 0);
    arm_machine_mute(machine, 1);
    EXPECT_EQ(arm_machine_receive(machine, report, sizeof(report)), 0);
    EXPECT_EQ(arm_machine_receive(machine, report, 13), -EINVAL);
    ASSERT_EQ(arm_machine_step(machine, 1), 1);
    EXPECT_EQ(status().tip_nm[0], 25'000'000);
    EXPECT_EQ(status().tip_nm[1], 0);
    EXPECT_EQ(status().tip_nm[2], 205'000'000);
}

TEST_F(ArmTest, ForceInContactGoesOutAsItsCurrents)
{
    touch();
    const std::int32_t encoder[3] = {0, 1332, 2579};
    std::int32_t expected[3], tip[3];
    arm_pose(encoder, tip);
    arm_drive(encoder, status().force_un, expected);
    EXPECT_EQ(currents(), (std::array<int, 3>{expected[0], expected[1], expected[2]}));
    EXPECT_NEAR(status().force_un[2], (3'000'000 - tip[2]) / 1000 * 1000, 2000);
    EXPECT_EQ(status().sections, 3 * status().tick); // pose, contact, drive
}

TEST_F(ArmTest, StopAndCloseSwitchTheMotorsOff)
{
    touch();
    ASSERT_EQ(arm_machine_ioctl(machine, PHANTOM_STOP, nullptr), 0);
    EXPECT_EQ(currents(), off);
}

TEST_F(ArmTest, ZeroForceIsZeroCurrentWhateverTheLinkageSays)
{
    const std::int32_t current[3] = {1000, 1000, 1000};
    arm_machine_drive(machine, current, 0);
    EXPECT_NE(currents(), off);
    arm_machine_drive_zero(machine);
    EXPECT_EQ(currents(), off);
}

TEST_F(ArmTest, PeakCurrentScalesAllMotorsAlike)
{
    const std::int32_t current[3] = {12000, -6000, 3000};
    arm_machine_drive(machine, current, 0);
    EXPECT_EQ(currents(), (std::array<int, 3>{6000, -3000, 1500}));
    const std::int32_t huge[3] = {INT32_MIN + 1, INT32_MAX, 0};
    arm_machine_drive(machine, huge, 0);
    EXPECT_EQ(currents(), (std::array<int, 3>{-5999, 5999, 0})) << "rounded towards zero";
}

TEST_F(ArmTest, WarmWindingsGetTheirContinuousCurrentAndNoStep)
{
    const std::int32_t current[3] = {6000, 3000, 0};
    int last = 6000;
    double square = 0;
    for (int i = 0; i < 120'000; ++i) { // two minutes
        ASSERT_EQ(arm_machine_drive(machine, current, ms), 0);
        const auto now = currents();
        ASSERT_LE(std::abs(now[0] - last), 5) << i;
        ASSERT_NEAR(now[1], now[0] / 2, 1);
        last = now[0];
        square += (double(last) * last - square) * 1e-3 / 16.3;
        ASSERT_LE(std::sqrt(square), 3440 * 1.001) << i;
        if (i == 1000) {
            EXPECT_EQ(last, 6000) << "a second of it does no harm";
        }
    }
    EXPECT_GT(last, 3100);
    EXPECT_LE(last, 3440);
    const std::int32_t none[3] = {0, 0, 0};
    arm_machine_drive(machine, none, 60'000 * ms); // a minute later the mean square has not yet moved,
    arm_machine_drive(machine, none, 60'000 * ms); // but this minute without current has cooled it
    arm_machine_drive(machine, current, 0);
    EXPECT_EQ(currents()[0], 6000);
}

TEST_F(ArmTest, SilenceOfTenMillisecondsIsAFaultThatCanBeCleared)
{
    touch();
    arm_machine_mute(machine, 1);
    arm_machine_step(machine, 9); // the last report is a millisecond older than its tick
    EXPECT_EQ(status().faults, 0u);
    arm_machine_step(machine, 1);
    EXPECT_EQ(status().faults, std::uint32_t(PHANTOM_FAULT_DEVICE));
    EXPECT_EQ(currents(), off);
    EXPECT_EQ(arm_machine_ioctl(machine, PHANTOM_CLEAR_FAULT, nullptr), -EAGAIN);
    arm_machine_mute(machine, 0);
    arm_machine_step(machine, 2);
    EXPECT_EQ(arm_machine_ioctl(machine, PHANTOM_CLEAR_FAULT, nullptr), 0);
    arm_machine_step(machine, 400);
    EXPECT_EQ(status().state, std::uint32_t(PHANTOM_STATE_RUNNING));
    EXPECT_NE(currents(), off);
}

TEST_F(ArmTest, SilentOrDeafArmDoesNotStart)
{
    arm_machine_mute(machine, 1);
    EXPECT_EQ(start(), -ETIMEDOUT);
    arm_machine_mute(machine, 0);
    arm_machine_deafen(machine, 1, 0);
    EXPECT_EQ(start(), -ETIMEDOUT);
    EXPECT_EQ(status().state, std::uint32_t(PHANTOM_STATE_IDLE));
    arm_machine_deafen(machine, 0, 0);
    EXPECT_EQ(start(), 0);
}

TEST_F(ArmTest, DeafArmIsAFaultWithinATenthOfASecond)
{
    touch();
    arm_machine_deafen(machine, 1, 0);
    arm_machine_step(machine, 90);
    EXPECT_EQ(status().faults, 0u);
    arm_machine_step(machine, 20);
    EXPECT_EQ(status().faults, std::uint32_t(PHANTOM_FAULT_DEVICE));
    EXPECT_EQ(currents(), off);
}

TEST_F(ArmTest, CommandThatCannotBeSentIsAFault)
{
    touch();
    arm_machine_deafen(machine, 0, -EPIPE);
    arm_machine_step(machine, 3);
    EXPECT_EQ(status().faults, std::uint32_t(PHANTOM_FAULT_DEVICE));
}

TEST_F(ArmTest, EncoderThatJumpsIsAnOverspeed)
{
    touch();
    const std::int16_t glitch[3] = {0, 5332, 2579};
    arm_machine_move(machine, glitch);
    arm_machine_step(machine, 2);
    EXPECT_EQ(status().faults, std::uint32_t(PHANTOM_FAULT_OVERSPEED));
    EXPECT_EQ(currents(), off);
}

TEST_F(ArmTest, CalibrationIsRefusedWhileItRuns)
{
    ASSERT_EQ(start(), 0);
    EXPECT_EQ(arm_machine_calibrate(machine), -EBUSY);
    ASSERT_EQ(arm_machine_ioctl(machine, PHANTOM_STOP, nullptr), 0);
    EXPECT_EQ(arm_machine_calibrate(machine), 0);
}

TEST_F(ArmTest, PresetThatIsNotSentIsAnErrorEvenIfTheNextCommandIs)
{
    arm_machine_fail_once(machine, -EIO);
    EXPECT_EQ(arm_machine_calibrate(machine), -EIO);
    EXPECT_EQ(arm_machine_calibrate(machine), 0);
}

TEST_F(ArmTest, PulledCableEndsTheRunAndEveryCall)
{
    touch();
    EXPECT_EQ(arm_machine_poll(machine) & (POLLHUP | POLLERR), 0);
    arm_machine_unplug(machine);
    arm_machine_step(machine, 5);
    EXPECT_EQ(status().state, std::uint32_t(PHANTOM_STATE_FAULT));
    EXPECT_EQ(status().faults, std::uint32_t(PHANTOM_FAULT_UNPLUGGED));
    EXPECT_EQ(status().force_un[2], 0);
    EXPECT_EQ(status().tick, 401u) << "one more tick to say so, and no other";
    EXPECT_EQ(arm_machine_poll(machine) & (POLLHUP | POLLERR), POLLHUP | POLLERR);

    alignas(8) unsigned char argument[4096] = {};
    for (const unsigned long request :
         {PHANTOM_GET_INFO, PHANTOM_SET_RATE, PHANTOM_SET_MODEL, PHANTOM_START, PHANTOM_SUBMIT_SET,
          PHANTOM_SIM_MOVE, (unsigned long)PHANTOM_STOP, (unsigned long)PHANTOM_CLEAR_FAULT})
        EXPECT_EQ(arm_machine_ioctl(machine, request, argument), -ENODEV) << request;
    EXPECT_EQ(arm_machine_open_again(machine), -ENODEV);
    EXPECT_EQ(arm_machine_check_mmap(machine), -ENODEV);
    EXPECT_EQ(arm_machine_calibrate(machine), -ENODEV);

    std::vector<phantom_tick> records(500);
    const ssize_t bytes = arm_machine_read(machine, records.data(), records.size() * sizeof(phantom_tick));
    ASSERT_EQ(bytes, ssize_t(401 * sizeof(phantom_tick)));
    EXPECT_EQ(records[400].faults, std::uint32_t(PHANTOM_FAULT_UNPLUGGED));
    EXPECT_EQ(records[400].force_un[2], 0);
    EXPECT_EQ(arm_machine_read(machine, records.data(), sizeof(phantom_tick)), -ENODEV);
}

TEST_F(ArmTest, PulledCableOfAnIdleArm)
{
    arm_machine_unplug(machine);
    phantom_tick record;
    EXPECT_EQ(arm_machine_read(machine, &record, sizeof(record)), -ENODEV);
    EXPECT_EQ(start(), -ENODEV);
    EXPECT_EQ(status().state, std::uint32_t(PHANTOM_STATE_IDLE));
}

} // namespace
} // namespace phantom::test
