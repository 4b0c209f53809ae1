// SPDX-License-Identifier: GPL-2.0-or-later
// Recordings computed again: whatever happened in a run, the bits are the same; and what differs is found.
#include <algorithm>
#include <array>
#include <cmath>
#include <fcntl.h>
#include <functional>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "device/recorder.hpp"
#include "feeder/feeder.hpp"
#include "feeder/path.hpp"
#include "phantom_usermode.h"
#include "scenes.hpp"
#include "study/replay.hpp"

namespace phantom::test {
namespace {

using device::Recording;
using study::ReplayReport;

const scene::Scene& the_scene()
{
    static const scene::Scene scene = [] {
        scene::Scene made = sphere_scene();
        made.materials.front().damping_ns_m = 0.8;
        made.materials.front().friction = scene::Friction{0.5, 0.3, 1, 20};
        made.materials.front().texture = scene::Texture{0.02, 1, {1, 0, 0}};
        return made;
    }();
    return scene;
}

const fdh::SceneTree<14>& the_tree()
{
    static const fdh::SceneTree<14> tree = scene::build_tree<14>(the_scene());
    return tree;
}

void check(const Status& status)
{
    if (!status)
        throw std::runtime_error(status.error().text());
}

/// A machine on a virtual clock, its feeder and its recorder.
class Machine {
  public:
    explicit Machine(std::uint32_t isa = PHANTOM_ISA_NONE)
    {
        device::UsermodeOptions options;
        options.virtual_clock = true;
        options.isa = isa;
        auto device = device::Device::open_usermode(options);
        device_.emplace(std::move(*device));
        recorder_ = std::make_unique<device::Recorder>(*device_, true, "sphere");
        device_->listen(recorder_.get());
        feeder_.emplace(the_scene(), the_tree(), *device_, feeder::FeederOptions{});
    }

    device::Device& device() { return *device_; }
    void move(const Vector& tip_mm)
    {
        tip_ = tip_mm;
        check(device_->move_simulated_tip(feeder::to_nanometres(tip_mm)));
    }
    void feed()
    {
        if (auto fed = feeder_->feed(tip_, tip_, false); !fed)
            throw std::runtime_error(fed.error().text());
    }
    void start(const phantom_start& start) { check(device_->start(start)); }
    void stop()
    {
        check(device_->stop());
        collect();
    }
    void step(std::uint32_t ticks)
    {
        check(device_->step(ticks));
        collect();
    }

    Recording recording()
    {
        recorder_->end();
        const std::string bytes = recorder_->take();
        auto all = device::parse_recordings(std::as_bytes(std::span(bytes)), "it");
        if (!all || all->size() != 1 || !all->front().cut.empty())
            throw std::runtime_error("the recording is not whole");
        return all->front();
    }

  private:
    void collect()
    {
        for (;;) {
            const phantom_status before = device_->status();
            const auto ticks = device_->read_ticks();
            recorder_->add(*ticks, before);
            if (ticks->empty())
                return;
        }
    }

    std::unique_ptr<device::Recorder> recorder_;
    std::optional<device::Device> device_;
    std::optional<feeder::Feeder> feeder_;
    Vector tip_{};
};

/// Round the sphere of 50 mm: into its shell, below its surface, out again.
Vector along_sphere(double time_s)
{
    const double turn = 0.9 * time_s, tilt = 0.4 + 0.5 * time_s;
    const double distance = 50.0 + 1.5 + 3.0 * std::cos(9.0 * time_s);
    return {distance * std::cos(turn) * std::sin(tilt), distance * std::sin(turn) * std::sin(tilt),
            distance * std::cos(tilt)};
}

/// Two runs in which everything happens that can: rates, models, late sets, sets that do not reach, jumps
/// that are a fault, CLEAR_FAULT, STOP in mid-ramp.
Recording random_runs(unsigned seed)
{
    std::mt19937 random(seed);
    const auto one_in = [&random](unsigned n) { return random() % n == 0; };
    Machine machine;
    double time_s = 0.01 * seed;
    for (int run = 0; run < 2; ++run) {
        machine.move(along_sphere(time_s));
        machine.feed();
        phantom_start start{};
        start.ramp_ms = 40 + random() % 40;
        start.slew_un_per_ms = one_in(2) ? 60'000 : 0;
        start.max_force_un = one_in(2) ? 1'500'000 : 0;
        start.stale_ms = 30;
        machine.start(start);
        for (int i = 0; i < 900; ++i) {
            time_s += 0.001;
            Vector tip = along_sphere(time_s);
            if (one_in(300))
                tip[2] += 80.0;
            machine.move(tip);
            if (i % 100 < 60 && i % 8 == 0)
                machine.feed();
            if (one_in(100))
                check(machine.device().set_rate(1000 + random() % 9000));
            if (one_in(100))
                check(machine.device().set_model(*device::model_from_words(
                    one_in(2) ? "paper" : "projected", one_in(2) ? "paper" : "bounded",
                    one_in(2) ? "paper" : "off", "float", static_cast<int>(random() % 4))));
            if (i % 40 == 39)
                (void)machine.device().clear_fault();
            machine.step(1 + random() % 3);
        }
        machine.stop();
        check(machine.device().clear_fault());
    }
    return machine.recording();
}

ReplayReport replayed(const Recording& recording, std::uint32_t isa = PHANTOM_ISA_NONE)
{
    study::ReplayOptions options;
    options.isa = isa;
    auto report = study::replay(recording, options);
    if (!report)
        throw std::runtime_error(report.error().text());
    return *report;
}

std::string told(const ReplayReport& report)
{
    return report.first ? "tick " + std::to_string(report.first->recorded.tick) + " of run " +
                              std::to_string(report.first->run) + ": " + report.first->fields
                        : "no difference";
}

TEST(Replay, WhateverHappensTheBitsAreTheSameWithEveryInstructionSet)
{
    ReplayReport sum;
    for (unsigned seed = 1; seed <= 2; ++seed) {
        const Recording recording = random_runs(seed);
        for (const std::uint32_t isa : {PHANTOM_ISA_SSE2, PHANTOM_ISA_NONE}) {
            const ReplayReport report = replayed(recording, isa);
            EXPECT_EQ(report.differ, 0U) << "seed " << seed << ": " << told(report);
            EXPECT_EQ(report.ticks, recording.ticks());
            EXPECT_EQ(report.runs, 2U);
            EXPECT_EQ(report.uncompared, 0U);
            sum.contact_ticks += report.contact_ticks;
            sum.inside_ticks += report.inside_ticks;
            sum.fading_ticks += report.fading_ticks;
            sum.ramping_ticks += report.ramping_ticks;
            sum.fault_ticks += report.fault_ticks;
        }
    }
    // A comparison of nothing but zeros would prove nothing.
    EXPECT_GT(sum.contact_ticks, 1500U);
    EXPECT_GT(sum.inside_ticks, 500U);
    EXPECT_GT(sum.fading_ticks, 500U);
    EXPECT_GT(sum.ramping_ticks, 500U);
    EXPECT_GT(sum.fault_ticks, 250U);
}

/// A run on the machine itself, where a test can do to it what a Device cannot.
class RawMachine {
  public:
    RawMachine()
    {
        phantom_um_config config{};
        config.clock = PHANTOM_UM_CLOCK_VIRTUAL;
        config.cpu = -1;
        int error = 0;
        machine = phantom_um_create(&config, &error);
        file = phantom_um_open(machine, O_RDWR | O_NONBLOCK, &error);
        ioctl(PHANTOM_GET_INFO, &recording.origin.info);
        recording.origin.flags = RECORDING_FED;
        recording.runs.resize(1);
        recording.runs[0].started = true;
    }
    ~RawMachine()
    {
        phantom_um_close(file);
        phantom_um_destroy(machine);
    }

    void ioctl(unsigned long request, void* argument)
    {
        if (const int rc = phantom_um_ioctl(file, request, argument); rc < 0)
            throw std::runtime_error("ioctl " + std::to_string(rc));
    }
    void move(const Vector& tip_mm)
    {
        phantom_sim_move move{};
        for (int axis = 0; axis < 3; ++axis)
            move.tip_nm[axis] = std::llround(tip_mm[axis] * 1e6);
        ioctl(PHANTOM_SIM_MOVE, &move);
    }
    void feed(const Vector& tip_mm)
    {
        fdh::Nearest nearest;
        the_tree().nearest(tip_mm, 64, 50.0, nearest);
        device::PatchSet set;
        nearest.sort();
        builder_.build(nearest, tip_mm, set);
        set.header.id = ++last_id_;
        set.header.patch_count = static_cast<__u32>(set.patches.size());
        set.header.material_count = static_cast<__u32>(set.materials.size());
        set.header.object_count = static_cast<__u32>(set.objects.size());
        set.header.patches = reinterpret_cast<std::uintptr_t>(set.patches.data());
        // the tables lie behind the one material
        struct {
            phantom_material material;
            std::array<std::uint64_t, 16> tables;
        } described{set.materials.at(0), {}};
        std::copy(set.effect_tables.begin(), set.effect_tables.end(), described.tables.begin());
        set.header.materials = reinterpret_cast<std::uintptr_t>(&described);
        set.header.objects = reinterpret_cast<std::uintptr_t>(set.objects.data());
        set.header.effects = set.materials[0].effects;
        set.header.effect_bytes = static_cast<__u32>(set.effect_tables.size() * sizeof(std::uint64_t));
        ioctl(PHANTOM_SUBMIT_SET, &set.header);
        recording.sets[last_id_] = std::move(set);
    }
    void start()
    {
        phantom_start start{};
        start.ramp_ms = 30;
        ioctl(PHANTOM_START, &start);
        recording.runs[0].start = start;
    }
    void collect()
    {
        phantom_tick tick;
        while (phantom_um_read(file, &tick, sizeof tick) == sizeof tick)
            recording.runs[0].ticks.push_back(tick);
    }
    /// A stroke with `disturb` before every tick.
    void stroke(int ticks, const std::function<void(int)>& disturb)
    {
        for (int i = 0; i < ticks; ++i) {
            const Vector tip = along_sphere(0.001 * i);
            move(tip);
            if (i % 5 == 0)
                feed(tip);
            if (i == 0)
                start();
            disturb(i);
            phantom_um_step(machine, 1);
            collect();
        }
    }

    phantom_um* machine;
    phantom_um_file* file;
    Recording recording;

  private:
    feeder::SetBuilder builder_{the_scene()};
    std::uint64_t last_id_ = 0;
};

TEST(Replay, MissedPeriodsAndAStallComeOutTheSame)
{
    RawMachine raw;
    raw.stroke(600, [&](int i) {
        if (i % 97 == 96)
            phantom_um_inject_stall(raw.machine, 2'700'000);
        if (i == 350)
            phantom_um_inject_stall(raw.machine, 25'000'000);
        if (i == 380)
            raw.ioctl(PHANTOM_CLEAR_FAULT, nullptr);
    });
    const ReplayReport report = replayed(raw.recording);
    EXPECT_EQ(report.differ, 0U) << told(report);
    EXPECT_GE(report.missed, 30U);
    EXPECT_GT(report.fault_ticks, 20U);
    EXPECT_GT(report.contact_ticks, 200U);
}

TEST(Replay, ErrorsOfTheDeviceComeOutTheSame)
{
    RawMachine raw;
    raw.stroke(500, [&](int i) {
        phantom_um_inject_device_error(raw.machine, i >= 200 && i < 203 ? -EIO : 0);
        if (i == 230)
            raw.ioctl(PHANTOM_CLEAR_FAULT, nullptr);
    });
    const ReplayReport report = replayed(raw.recording);
    EXPECT_EQ(report.differ, 0U) << told(report);
    EXPECT_EQ(report.fault_ticks, 30U);
}

TEST(Replay, ASleepOfTheMachineComesOutTheSame)
{
    RawMachine raw;
    raw.stroke(500, [&](int i) {
        if (i == 250) {
            phantom_um_suspend(raw.machine);
            EXPECT_EQ(phantom_um_resume(raw.machine), 0);
            raw.collect();
        }
        if (i == 280)
            raw.ioctl(PHANTOM_CLEAR_FAULT, nullptr);
    });
    const ReplayReport report = replayed(raw.recording);
    EXPECT_EQ(report.differ, 0U) << told(report);
    EXPECT_GT(report.fault_ticks, 20U);
}

TEST(Replay, OneBitOfATickIsFoundAndNamed)
{
    const Recording recording = random_runs(1);
    const std::size_t at = 700;
    struct Flip {
        const char* field;
        void (*flip)(phantom_tick&);
    };
    const Flip flips[] = {{"force", [](phantom_tick& tick) { tick.force_un[2] ^= 1; }},
                          {"proxy", [](phantom_tick& tick) { tick.proxy_nm[0] ^= 1; }},
                          {"contacts", [](phantom_tick& tick) { tick.contacts ^= 1; }},
                          {"flags", [](phantom_tick& tick) { tick.flags ^= PHANTOM_TICK_FADING; }},
                          {"faults", [](phantom_tick& tick) { tick.faults ^= PHANTOM_FAULT_NUMERIC; }}};
    for (const Flip& flip : flips) {
        Recording changed = recording;
        phantom_tick& tick = changed.runs[0].ticks[at];
        flip.flip(tick);
        const ReplayReport report = replayed(changed);
        EXPECT_EQ(report.differ, 1U) << flip.field;
        ASSERT_TRUE(report.first) << flip.field;
        EXPECT_EQ(report.first->fields, flip.field);
        EXPECT_EQ(report.first->run, 0U);
        EXPECT_EQ(report.first->recorded.tick, tick.tick);
    }
}

/// Each of what a tick is computed from must matter: changed in the recording, the ticks come out otherwise.
TEST(Replay, AnotherInputGivesAnotherOutcome)
{
    const Recording recording = random_runs(2);
    const auto differ_after = [&recording](const std::function<void(Recording&)>& change) {
        Recording changed = recording;
        change(changed);
        return replayed(changed).differ;
    };
    const auto ticks_of = [](Recording& changed) -> std::vector<phantom_tick>& {
        return changed.runs[0].ticks;
    };
    EXPECT_GT(differ_after([&](Recording& r) {
                  for (phantom_tick& tick : ticks_of(r))
                      tick.tip_nm[0] += 2000;
              }),
              100U);
    EXPECT_GT(differ_after([&](Recording& r) { r.runs[0].start.ramp_ms *= 2; }), 20U);
    EXPECT_GT(differ_after([&](Recording& r) {
                  for (auto& [id, set] : r.sets)
                      set.materials[0].stiffness_mn_mm += 1;
              }),
              100U);
    EXPECT_GT(differ_after([&](Recording& r) {
                  for (auto& [id, set] : r.sets)
                      set.materials[0].damping_mns_m *= 2;
              }),
              20U);
    EXPECT_GT(differ_after([&](Recording& r) {
                  for (auto& [id, set] : r.sets)
                      set.effect_tables.at(0) -= 100'000; // static friction, the first word of them
              }),
              20U);
    EXPECT_GT(differ_after([&](Recording& r) {
                  for (phantom_tick& tick : ticks_of(r))
                      tick.model ^= 1U << 8;
              }),
              5U);
}

TEST(Replay, BehindALostRecordNothingIsComparedAndItIsSaid)
{
    Recording recording = random_runs(3);
    std::vector<phantom_tick>& ticks = recording.runs[0].ticks;
    const std::size_t all = recording.ticks();
    ticks.erase(ticks.begin() + 500, ticks.begin() + 510);
    const ReplayReport report = replayed(recording);
    EXPECT_EQ(report.lost, 10U);
    EXPECT_EQ(report.ticks, 500U);
    EXPECT_EQ(report.uncompared, all - 510);
    EXPECT_EQ(report.differ, 0U) << told(report);
    ASSERT_FALSE(report.notes.empty());
    EXPECT_NE(report.notes[0].find("10 records are missing from tick 501 on"), std::string::npos)
        << report.notes[0];
}

TEST(Replay, WhatCannotBeComputedIsRefusedWithTheReason)
{
    Recording observed = random_runs(1);
    observed.origin.flags = 0;
    const auto without_sets = study::replay(observed, {});
    ASSERT_FALSE(without_sets);
    EXPECT_NE(without_sets.error().text().find("no sets"), std::string::npos);

    Recording torn = random_runs(1);
    torn.sets.erase(3);
    const auto missing = study::replay(torn, {});
    ASSERT_FALSE(missing);
    EXPECT_NE(missing.error().text().find("set 3"), std::string::npos) << missing.error().text();
}

TEST(Replay, InDoubleTheForcesAreTheSameToWhatFloatResolves)
{
    Machine machine;
    machine.move(along_sphere(0));
    machine.feed();
    phantom_start start{};
    start.flags = PHANTOM_START_LIMITS_OFF;
    machine.start(start);
    for (int i = 0; i < 500; ++i) {
        machine.move(along_sphere(0.001 * i));
        if (i % 4 == 0)
            machine.feed();
        machine.step(1);
    }
    machine.stop();
    const ReplayReport report = replayed(machine.recording(), PHANTOM_ISA_DOUBLE);
    EXPECT_EQ(report.isa, "double");
    EXPECT_GT(report.differ, 0U) << "float32 and double cannot agree in every bit";
    EXPECT_LT(report.worst_force_n, 1e-4);
    EXPECT_LT(report.worst_proxy_mm, 1e-4);
}

} // namespace
} // namespace phantom::test
