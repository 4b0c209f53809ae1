// SPDX-License-Identifier: GPL-2.0-or-later
// What comes out: the status page, the records of read(), what poll() says.
#include <sys/mman.h>

#include "machine.hpp"

namespace phantom::test {
namespace {

constexpr std::size_t ring_records = 8192;

class Records : public MachineTest {};

TEST_F(Records, ReadNeedsRoomForOne)
{
    File feeder(machine);
    phantom_tick record;
    EXPECT_EQ(phantom_um_read(feeder.raw(), &record, sizeof(record) - 1), -EINVAL);
    EXPECT_EQ(phantom_um_read(feeder.raw(), &record, 0), -EINVAL);
}

TEST_F(Records, ReadSaysEndWhenNotRunningAndAgainWhenRunning)
{
    File feeder(machine), blocking(machine, O_RDONLY);
    phantom_tick record;
    EXPECT_EQ(phantom_um_read(feeder.raw(), &record, sizeof(record)), 0);
    EXPECT_EQ(phantom_um_read(blocking.raw(), &record, sizeof(record)), 0) << "does not wait for a start";
    ASSERT_EQ(feeder.start_unlimited(), 0);
    EXPECT_EQ(phantom_um_read(feeder.raw(), &record, sizeof(record)), -EAGAIN);
    step();
    EXPECT_EQ(phantom_um_read(feeder.raw(), &record, sizeof(record)), ssize_t(sizeof(record)));
    EXPECT_EQ(phantom_um_read(feeder.raw(), &record, sizeof(record)), -EAGAIN);
}

TEST_F(Records, UnwritableBufferIsEFAULTAndLosesNothing)
{
    File feeder(machine);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    step(2);
    EXPECT_EQ(phantom_um_read(feeder.raw(), nullptr, 1000), -EFAULT);
    const auto records = feeder.read();
    ASSERT_EQ(records.size(), 2u);
    EXPECT_EQ(records[0].tick, 1u);
}

TEST_F(Records, OneRecordATickWithItsNumbers)
{
    File feeder(machine);
    Plane plane(9);
    feeder.submit(plane);
    feeder.move(1'000, 2'000, 2'000'000);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    const std::uint64_t begin = feeder.status().start_ns;
    step(100);
    auto buffer = std::vector<phantom_tick>(101, dirty<phantom_tick>());
    ASSERT_EQ(phantom_um_read(feeder.raw(), buffer.data(), 101 * sizeof(phantom_tick) - 1),
              ssize_t(100 * sizeof(phantom_tick)))
        << "whole records only";
    for (std::uint64_t i = 0; i < 100; ++i) {
        EXPECT_EQ(buffer[i].tick, i + 1);
        EXPECT_EQ(buffer[i].time_ns, begin + (i + 1) * 1'000'000);
        EXPECT_EQ(buffer[i].set_id, 9u);
        EXPECT_EQ(buffer[i].tip_nm[0], 1'000);
        EXPECT_EQ(buffer[i].proxy_nm[2], 2'000'000) << "outside: the tip";
        EXPECT_EQ(buffer[i].faults, 0u);
        EXPECT_EQ(buffer[i].duration_ns, 0u) << "a virtual clock does not run while a tick does";
    }
    EXPECT_GE(buffer[99].contacts, 1u);
}

TEST_F(Records, ReadersHaveCursorsOfTheirOwn)
{
    File feeder(machine), early(machine, O_RDONLY | O_NONBLOCK);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    step(10);
    File late(machine, O_RDONLY | O_NONBLOCK);
    step(5);
    EXPECT_EQ(early.read(4).size(), 4u);
    const auto of_late = late.read();
    ASSERT_EQ(of_late.size(), 5u);
    EXPECT_EQ(of_late[0].tick, 11u) << "records from open() on";
    const auto of_early = early.read();
    ASSERT_EQ(of_early.size(), 11u);
    EXPECT_EQ(of_early[0].tick, 5u);
}

TEST_F(Records, LaggingReaderLosesTheOldestAndSeesTheGap)
{
    File feeder(machine);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    step(3);
    ASSERT_EQ(feeder.read().size(), 3u);
    step(20'000);
    const auto records = feeder.read();
    ASSERT_EQ(records.size(), ring_records - 1);
    EXPECT_EQ(records.front().tick, 20'003 - ring_records + 2);
    EXPECT_GT(records.front().tick, 4u) << "the gap";
    for (std::size_t i = 1; i < records.size(); ++i)
        ASSERT_EQ(records[i].tick, records[i - 1].tick + 1) << "and no other";
    EXPECT_EQ(records.back().tick, 20'003u);
    step();
    EXPECT_EQ(feeder.status().lost, records.front().tick - 4) << "and the page counts what it took";
}

TEST_F(Records, RecordsOutliveTheRun)
{
    File feeder(machine), observer(machine, O_RDONLY | O_NONBLOCK);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    step(10);
    feeder.stop();
    EXPECT_TRUE(observer.poll(POLLIN) & POLLIN);
    EXPECT_EQ(observer.read().size(), 11u) << "ten and the one that sent zero";
    EXPECT_TRUE(observer.poll(POLLIN) & POLLIN) << "the end is to be read";
    EXPECT_EQ(observer.read().size(), 0u);
    EXPECT_EQ(observer.poll(POLLIN), 0);
}

TEST_F(Records, PollTellsOfRecords)
{
    File feeder(machine);
    EXPECT_EQ(feeder.poll(POLLIN), 0);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    EXPECT_EQ(feeder.poll(POLLIN, 1), 0);
    step();
    EXPECT_EQ(feeder.poll(POLLIN), POLLIN);
    feeder.read();
    EXPECT_EQ(feeder.poll(POLLIN), 0);
}

TEST_F(Records, PollAsksForASetUntilOneCoversTheTip)
{
    File feeder(machine);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    EXPECT_EQ(feeder.poll(POLLPRI), 0);
    step();
    EXPECT_EQ(feeder.poll(POLLPRI), POLLPRI) << "there is none";
    Plane elsewhere(1, 50'000'000, 5'000'000);
    feeder.move(10'000'000, 0, 5'000'000);
    feeder.submit(elsewhere);
    EXPECT_EQ(feeder.poll(POLLPRI), 0) << "answered";
    step();
    EXPECT_EQ(feeder.poll(POLLPRI), POLLPRI) << "but not well";
    Plane here(2, 50'000'000, 40'000'000);
    feeder.submit(here);
    step(10);
    EXPECT_EQ(feeder.poll(POLLPRI), 0);
}

TEST_F(Records, PollRemindsWhileTheTipIsUncovered)
{
    File feeder(machine), observer(machine, O_RDONLY | O_NONBLOCK);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    step();
    EXPECT_EQ(observer.poll(POLLPRI), POLLPRI);
    observer.read();
    EXPECT_EQ(observer.poll(POLLPRI), 0) << "told";
    step(PHANTOM_REMIND_NS / 1'000'000);
    EXPECT_EQ(observer.poll(POLLPRI), POLLPRI) << "told again";
}

TEST_F(Records, PollWarnsOnceWhenHalfOfTheSlackIsUsedUp)
{
    File feeder(machine);
    Plane plane(1, 50'000'000, 23'000'000); // slack 20 mm: radius less the contact radius of 3 mm
    feeder.submit(plane);
    feeder.move(0, 0, 9'900'000);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    step(5);
    EXPECT_EQ(feeder.poll(POLLPRI), 0);
    feeder.move(0, 0, 10'100'000);
    step();
    EXPECT_EQ(feeder.poll(POLLPRI), POLLPRI);
    EXPECT_FALSE(feeder.status().flags & PHANTOM_TICK_UNCOVERED);
    feeder.read();
    step(50);
    EXPECT_EQ(feeder.poll(POLLPRI), 0) << "once a set";
}

TEST_F(Records, StatusPageIsReadOnlyMemory)
{
    File observer(machine, O_RDONLY);
    int error = 0;
    const phantom_status* page = phantom_um_mmap(observer.raw(), &error);
    ASSERT_NE(page, nullptr);
    EXPECT_EQ(page->abi_version, std::uint32_t(PHANTOM_ABI_VERSION));
    EXPECT_EQ(phantom_um_mmap(observer.raw(), &error), page) << "one mapping a file";
    EXPECT_DEATH(const_cast<phantom_status*>(page)->state = 2, "") << "written to";
}

TEST_F(Records, PageAndRecordAgree)
{
    File feeder(machine);
    Plane plane(3);
    feeder.submit(plane);
    feeder.move(0, 0, 1'500'000);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    for (int i = 0; i < 40; ++i) {
        feeder.move(i * 10'000, 0, 1'500'000 + i * 20'000);
        step();
        const auto records = feeder.read();
        const phantom_status status = feeder.status();
        ASSERT_EQ(records.size(), 1u);
        EXPECT_EQ(status.tick, records[0].tick);
        EXPECT_EQ(status.time_ns, records[0].time_ns);
        EXPECT_EQ(status.flags, records[0].flags);
        EXPECT_EQ(status.contacts, records[0].contacts);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_EQ(status.tip_nm[axis], records[0].tip_nm[axis]);
            EXPECT_EQ(status.force_un[axis], records[0].force_un[axis]);
        }
    }
    EXPECT_EQ(feeder.status().normal_q30[2], PHANTOM_Q30_ONE);
    EXPECT_EQ(feeder.status().sections, 40u);
}

TEST_F(Records, HistogramsCountEveryTickInItsBucket)
{
    File feeder(machine);
    phantom_start start{};
    start.stall_us = 100'000;
    ASSERT_EQ(feeder.start(start), 0);
    step(5);
    const auto late = [&](std::uint64_t ns) {
        phantom_um_inject_stall(machine, ns);
        step();
    };
    for (std::uint64_t ns : {7u, 8u, 15u, 16u, 17u, 18u, 1000u})
        late(ns);
    const phantom_status status = feeder.status();
    const auto& count = status.latency.count;
    EXPECT_EQ(count[0], 5u);
    EXPECT_EQ(count[7], 1u);
    EXPECT_EQ(count[8], 1u) << "8 ... 9 ns";
    EXPECT_EQ(count[15], 1u);
    EXPECT_EQ(count[16], 2u) << "16 and 17 ns share a bucket";
    EXPECT_EQ(count[17], 1u);
    EXPECT_EQ(count[8 * (9 - 2) + 7], 1u) << "1000 ns: octave 512, (1000 - 512) / 64 = 7";
    EXPECT_EQ(status.latency.max_ns, 1000u);
    std::uint64_t total = 0;
    for (std::uint32_t c : count)
        total += c;
    EXPECT_EQ(total, 12u);
}

} // namespace
} // namespace phantom::test
