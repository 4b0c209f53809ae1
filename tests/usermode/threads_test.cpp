// SPDX-License-Identifier: GPL-2.0-or-later
// A real clock and several threads: counts and order, never durations. Meant for the thread sanitizer, too.
#include <atomic>
#include <thread>

#include "machine.hpp"

namespace phantom::test {
namespace {

using namespace std::chrono_literals;

class Threads : public MachineTest {
  protected:
    void SetUp() override { create({.clock = PHANTOM_UM_CLOCK_REAL}); }

    static phantom_start patient()
    {
        phantom_start start{};
        start.flags = PHANTOM_START_LIMITS_OFF; // a loaded test machine stalls
        start.stale_ms = 1'000'000;
        return start;
    }
    static void wait_for_ticks(File& file, std::uint64_t ticks)
    {
        while (file.status().tick < ticks)
            std::this_thread::sleep_for(1ms);
    }
};

class RealClock : public Threads, public ::testing::WithParamInterface<std::uint32_t> {};

TEST_P(RealClock, EveryPeriodIsATickOrCountedAsMissed)
{
    create({.clock = PHANTOM_UM_CLOCK_REAL, .rate_hz = GetParam()});
    File feeder(machine), reader(machine, O_RDONLY);
    Plane plane(1);
    feeder.submit(plane);
    feeder.move(0, 0, 2'000'000);
    ASSERT_EQ(feeder.start(patient()), 0);
    std::vector<phantom_tick> records;
    while (records.size() < 600) { // blocking reads
        const auto some = reader.read(64);
        ASSERT_FALSE(some.empty());
        records.insert(records.end(), some.begin(), some.end());
    }
    ASSERT_EQ(feeder.stop(), 0);
    for (auto some = reader.read(); !some.empty(); some = reader.read())
        records.insert(records.end(), some.begin(), some.end());

    const phantom_status status = feeder.status();
    const std::uint64_t period = 1'000'000'000 / GetParam();
    std::uint64_t gaps = records[0].tick - 1;
    for (std::size_t i = 0; i < records.size(); ++i) {
        EXPECT_GE(records[i].time_ns, status.start_ns + records[i].tick * period) << "never early";
        if (i == 0)
            continue;
        EXPECT_GT(records[i].tick, records[i - 1].tick);
        EXPECT_GT(records[i].time_ns, records[i - 1].time_ns);
        gaps += records[i].tick - records[i - 1].tick - 1;
    }
    // the last tick may be followed by periods that nobody served any more
    EXPECT_LE(gaps, status.missed);
    EXPECT_EQ(records.size() + status.missed, status.tick);
    EXPECT_EQ(records.back().force_un[2], 0);
    phantom_um_thread_info info;
    phantom_um_thread(machine, &info);
    EXPECT_TRUE(info.fifo == 0 || info.fifo == 1);
    EXPECT_EQ(info.cpu, -1);
}

INSTANTIATE_TEST_SUITE_P(Hz, RealClock, ::testing::Values(1000u, 3000u));

TEST_F(Threads, PinnedThreadReportsItsCpu)
{
    create({.clock = PHANTOM_UM_CLOCK_REAL, .cpu = 0});
    File feeder(machine);
    ASSERT_EQ(feeder.start(patient()), 0);
    wait_for_ticks(feeder, 3);
    phantom_um_thread_info info;
    phantom_um_thread(machine, &info);
    EXPECT_EQ(info.cpu, 0);
}

TEST_F(Threads, CpuThatIsNotThereFailsTheStart)
{
    create({.clock = PHANTOM_UM_CLOCK_REAL, .cpu = 1000});
    File feeder(machine);
    EXPECT_EQ(feeder.start(patient()), -EINVAL);
    EXPECT_EQ(feeder.status().state, std::uint32_t(PHANTOM_STATE_IDLE));
}

TEST_F(Threads, InjectedStallIsAFaultOnARealClockToo)
{
    File feeder(machine);
    phantom_start start{};
    start.stall_us = 50'000;
    ASSERT_EQ(feeder.start(start), 0);
    phantom_um_inject_stall(machine, 200'000'000);
    EXPECT_EQ(feeder.poll(POLLPRI, 10'000), POLLPRI);
    while (!feeder.status().faults)
        std::this_thread::sleep_for(1ms);
    EXPECT_TRUE(feeder.status().faults & PHANTOM_FAULT_STALL);
    EXPECT_GT(feeder.status().missed, 100u);
}

TEST_F(Threads, StepIsForVirtualClocksOnly)
{
    EXPECT_EQ(step(), -EINVAL);
}

TEST_F(Threads, BlockingReaderIsWokenByTheEnd)
{
    File feeder(machine), reader(machine, O_RDONLY);
    ASSERT_EQ(feeder.start(patient()), 0);
    std::thread blocked([&] {
        while (!reader.read(64).empty()) {
        }
    });
    wait_for_ticks(feeder, 20);
    feeder.stop();
    blocked.join();
}

/// Feeder, mover, readers, observer and changes of rate and model, all at once, over three runs.
TEST_F(Threads, EverythingAtOnceLeavesAConsistentMachine)
{
    File feeder(machine);
    std::atomic<bool> over{false};
    std::atomic<int> wrong{0};
    Plane first(1);
    ASSERT_EQ(feeder.submit(first), 0);
    ASSERT_EQ(feeder.start(patient()), 0);

    std::vector<std::thread> threads;
    threads.emplace_back([&] {
        for (std::uint64_t id = 2; !over; ++id) {
            Plane plane(id, 50'000'000, 40'000'000, {std::int64_t(id % 1000) * 1000, 0, 0});
            const int error = feeder.submit(plane);
            wrong += error != 0 && error != -EAGAIN;
        }
    });
    threads.emplace_back([&] {
        for (int i = 0; !over; ++i)
            wrong += feeder.move(i % 1000 * 1000, 0, 2'000'000) != 0;
    });
    threads.emplace_back([&] {
        for (std::uint32_t i = 0; !over; ++i) {
            wrong += feeder.rate(1000 + i % 9000) != 0;
            phantom_model model{1 + i / 64 % 2, i % 4, i % 2, PHANTOM_PROXY_PAPER, PHANTOM_ARITH_FLOAT, {}};
            wrong += feeder.ioctl(PHANTOM_SET_MODEL, &model) != 0;
            std::this_thread::sleep_for(100us);
        }
    });
    for (int reader = 0; reader < 2; ++reader)
        threads.emplace_back([&] {
            File file(machine, O_RDONLY);
            std::uint64_t last = 0;
            while (!over)
                for (const phantom_tick& record : file.read(100)) {
                    wrong += record.tick <= last && record.tick != 1;
                    // a torn record would mix tips: y is always 0, z always 2 mm, or both are before the
                    // first move
                    wrong +=
                        record.tip_nm[1] != 0 || (record.tip_nm[2] != 2'000'000 && record.tip_nm[2] != 0);
                    last = record.tick;
                }
        });
    threads.emplace_back([&] {
        File file(machine, O_RDONLY);
        while (!over) {
            const phantom_status status = file.status();
            wrong += status.tip_nm[2] == 0 && status.tip_nm[0] != 0;
            wrong += status.abi_version != PHANTOM_ABI_VERSION;
            phantom_um_poll(file.raw(), POLLIN | POLLPRI, 1);
        }
    });
    for (int run = 0; run < 3; ++run) {
        wait_for_ticks(feeder, 100);
        EXPECT_EQ(feeder.stop(), 0);
        EXPECT_EQ(feeder.start(patient()), 0);
    }
    wait_for_ticks(feeder, 50);
    over = true;
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(feeder.stop(), 0);
}

TEST_F(Threads, FileClosedDuringACallIsReleasedWithIt)
{
    int error = 0;
    phantom_um_file* file = phantom_um_open(machine, O_RDWR, &error);
    ASSERT_EQ(error, 0);
    File observer(machine, O_RDONLY);
    phantom_start start{};
    start.ramp_ms = 100;
    start.stall_us = 10'000'000;
    ASSERT_EQ(phantom_um_ioctl(file, PHANTOM_START, &start), 0);
    while (observer.status().tick == 0 || observer.status().flags & PHANTOM_TICK_RAMPING)
        std::this_thread::sleep_for(1ms);
    std::atomic<int> stopped{1};
    std::thread stopper([&] { stopped = phantom_um_ioctl(file, PHANTOM_STOP, nullptr); });
    while (!(observer.status().flags & PHANTOM_TICK_RAMPING) && stopped == 1)
        std::this_thread::yield();
    EXPECT_EQ(phantom_um_close(file), 0) << "STOP is still ramping down in the other thread";
    stopper.join();
    EXPECT_EQ(stopped, 0);
    EXPECT_EQ(observer.status().state, std::uint32_t(PHANTOM_STATE_IDLE));
    File next(machine);
    EXPECT_EQ(next.error(), 0) << "released with the last call";
}

TEST_F(Threads, VirtualClockMayBeSteppedWhileOthersCall)
{
    create({});
    File feeder(machine);
    Plane plane(1);
    feeder.submit(plane);
    ASSERT_EQ(feeder.start(patient()), 0);
    std::atomic<bool> over{false};
    std::thread other([&] {
        for (std::uint64_t id = 2; !over; ++id) {
            Plane next(id);
            feeder.submit(next);
            feeder.move(0, 0, 2'000'000);
            feeder.read(10);
        }
    });
    EXPECT_EQ(step(2000), 2000);
    EXPECT_EQ(feeder.stop(), 0);
    over = true;
    other.join();
}

} // namespace
} // namespace phantom::test
