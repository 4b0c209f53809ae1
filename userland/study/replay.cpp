// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/replay.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "feeder/trace_file.hpp"

namespace phantom::study {

namespace {

using device::RecordedRun;
using device::Recording;

template <typename T>
double distance(const T (&a)[3], const T (&b)[3], double unit)
{
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double difference = unit * (static_cast<double>(a[axis]) - static_cast<double>(b[axis]));
        sum += difference * difference;
    }
    return std::sqrt(sum);
}

/// Which fields of the two differ, as a mask of ReplayField.
unsigned differing(const phantom_tick& a, const phantom_tick& b)
{
    const auto bit = [](ReplayField field, bool differs) { return differs ? 1U << field : 0U; };
    return bit(force, std::memcmp(a.force_un, b.force_un, sizeof a.force_un) != 0) |
           bit(proxy, std::memcmp(a.proxy_nm, b.proxy_nm, sizeof a.proxy_nm) != 0) |
           bit(contacts, a.contacts != b.contacts) | bit(set, a.set_id != b.set_id) |
           bit(flags, a.flags != b.flags) | bit(faults, a.faults != b.faults);
}

std::string field_names(unsigned mask)
{
    std::string names;
    for (int field = 0; field < replay_fields; ++field)
        if (mask & 1U << field)
            names += (names.empty() ? "" : ", ") + std::string(field_name(field));
    return names;
}

class Replayer {
  public:
    Replayer(const Recording& recording, const ReplayOptions& options)
        : recording_(recording), options_(options), all_(recording.ticks())
    {
    }

    Result<ReplayReport> run()
    {
        if (!recording_.fed())
            return Error{recording_.origin.device,
                         "the recording holds ticks and no sets: there is nothing to compute them from",
                         "fdhctl load SCENE --record FILE.rec records both"};
        if (Status status = open(); !status)
            return status.error();
        if (options_.csv)
            report_.csv = std::string(feeder::trace_header) + "\n";
        for (std::size_t i = 0; i < recording_.runs.size(); ++i)
            if (Status status = run_one(i); !status)
                return status.error();
        if (!recording_.cut.empty())
            report_.notes.push_back("the recording ends early: " + recording_.cut);
        report_.isa = device::isa_name(device_->status().isa);
        return std::move(report_);
    }

  private:
    Status open()
    {
        const phantom_info& info = recording_.origin.info;
        device::UsermodeOptions usermode;
        usermode.virtual_clock = true;
        usermode.rate_hz = 0;
        usermode.isa = options_.isa;
        usermode.max_force_un = info.max_force_un;
        usermode.patches_max = info.patches_max;
        Result<device::Device> device = device::Device::open_usermode(usermode);
        if (!device)
            return device.error();
        device_.emplace(std::move(*device));
        return success();
    }

    Status run_one(std::size_t index)
    {
        const RecordedRun& run = recording_.runs[index];
        const RecordedRun::Losses losses = run.losses();
        report_.lost += losses.lost;
        const std::size_t count = run.started && !broken_ ? losses.before : 0;
        if (losses.lost != 0 && count < run.ticks.size())
            report_.notes.push_back(
                fmt::format("run {}: {} records are missing from tick {} on: what comes behind them "
                            "is not compared",
                            index + 1, losses.lost, count ? run.ticks[count - 1].tick + 1 : 1));
        else if (!run.started)
            report_.notes.push_back(
                fmt::format("run {}: its START was not recorded: not compared", index + 1));
        // What a set or a fault left behind is not known any more.
        broken_ = broken_ || count < run.ticks.size();
        report_.uncompared += run.ticks.size() - count;
        if (count == 0)
            return success();
        ++report_.runs;
        if (Status status = begin(run); !status)
            return status;
        for (std::size_t i = 0; i < count; ++i)
            if (Status status = tick(index, run.ticks[i]); !status)
                return status;
        return end();
    }

    Status begin(const RecordedRun& run)
    {
        // Whoever started it had cleared the faults of the run before.
        if (Status status = device_->clear_fault(); !status)
            return status;
        if (Status status = give(run.ticks.front()); !status)
            return status;
        if (Status status = device_->set_time(run.start_ns); !status)
            return status;
        due_ns_ = tick_ = 0;
        faults_ = 0;
        first_ns_ = run.ticks.front().time_ns;
        return device_->start(run.start);
    }

    /// Whatever is still running here is ended; its records are nobody's.
    Status end()
    {
        if (Status status = device_->stop(); !status)
            return status;
        for (;;) {
            const auto rest = device_->read_ticks();
            if (!rest)
                return rest.error();
            if (rest->empty())
                return success();
        }
    }

    /// Model, rate and set that the tick was computed with.
    Status give(const phantom_tick& tick)
    {
        if (tick.model != model_ || tick.rate_hz != rate_hz_) {
            phantom_model model = device::model_of(tick);
            if (options_.isa == PHANTOM_ISA_DOUBLE)
                model.arith = PHANTOM_ARITH_DOUBLE;
            if (Status status = device_->set_model(model); !status)
                return status;
            if (Status status = device_->set_rate(tick.rate_hz); !status)
                return status;
            model_ = tick.model;
            rate_hz_ = tick.rate_hz;
        }
        if (tick.set_id == set_id_ || tick.set_id == 0)
            return success();
        const auto found = recording_.sets.find(tick.set_id);
        if (found == recording_.sets.end())
            return Error{
                recording_.origin.device,
                fmt::format("tick {} used set {}, which the recording has not", tick.tick, tick.set_id)};
        device::PatchSet set = found->second;
        if (Status status = device_->submit_as(set); !status)
            return status;
        set_id_ = tick.set_id;
        ++report_.sets;
        return success();
    }

    Status tick(std::size_t run, const phantom_tick& recorded)
    {
        if (Status status = give(recorded); !status)
            return status;
        // Each period begins where the one before ended; a latency too long to be recorded leaves that alone.
        const std::uint64_t periods = recorded.tick - tick_;
        const bool known = recorded.latency_ns != UINT32_MAX || tick_ == 0;
        due_ns_ = known ? device::due_ns(recorded) : due_ns_ + periods * period_ns_;
        report_.missed += tick_ ? periods - 1 : 0;
        tick_ = recorded.tick;
        period_ns_ = 1000000000ULL / recorded.rate_hz;

        const std::uint32_t came = recorded.faults & ~faults_;
        faults_ = recorded.faults;
        if (came & PHANTOM_FAULT_SUSPENDED)
            if (Status status = device_->replay_sleep(recorded, due_ns_); !status)
                return status;
        const Result<bool> ran = device_->replay(recorded, due_ns_);
        if (!ran)
            return ran.error();
        phantom_tick here{};
        if (*ran) {
            const auto records = device_->read_ticks();
            if (!records)
                return records.error();
            if (records->size() != 1)
                return Error{device_->name(),
                             fmt::format("expected one record a tick, got {}", records->size())};
            here = records->front();
        }
        compare(run, recorded, here);
        if (options_.progress && report_.ticks % 512 == 0)
            options_.progress(static_cast<double>(report_.ticks) / static_cast<double>(all_));
        return success();
    }

    void compare(std::size_t run, const phantom_tick& recorded, const phantom_tick& here)
    {
        ++report_.ticks;
        report_.contact_ticks += recorded.contacts > 0;
        report_.inside_ticks += (recorded.flags & PHANTOM_TICK_INSIDE) != 0;
        report_.fading_ticks += (recorded.flags & PHANTOM_TICK_FADING) != 0;
        report_.ramping_ticks += (recorded.flags & PHANTOM_TICK_RAMPING) != 0;
        report_.fault_ticks += recorded.faults != 0;
        if (options_.csv)
            feeder::append_trace_row(
                report_.csv,
                feeder::trace_row(here, 1e-9 * static_cast<double>(recorded.time_ns - first_ns_)));
        const unsigned mask = differing(recorded, here);
        if (mask == 0)
            return;
        ++report_.differ;
        for (int field = 0; field < replay_fields; ++field)
            report_.field_differs[static_cast<std::size_t>(field)] += mask >> field & 1U;
        report_.worst_force_n =
            std::max(report_.worst_force_n, distance(recorded.force_un, here.force_un, 1e-6));
        report_.worst_proxy_mm =
            std::max(report_.worst_proxy_mm, distance(recorded.proxy_nm, here.proxy_nm, 1e-6));
        if (!report_.first)
            report_.first = ReplayDifference{run, recorded, here, field_names(mask)};
    }

    const Recording& recording_;
    const ReplayOptions& options_;
    std::size_t all_;
    std::optional<device::Device> device_;
    ReplayReport report_;
    bool broken_ = false; ///< something before is not known
    std::uint32_t model_ = UINT32_MAX, rate_hz_ = 0;
    std::uint64_t set_id_ = 0;
    std::uint64_t tick_ = 0, due_ns_ = 0, period_ns_ = 0; ///< of the tick before
    std::uint64_t first_ns_ = 0;
    std::uint32_t faults_ = 0; ///< of the tick before
};

} // namespace

const char* field_name(int field)
{
    constexpr const char* names[] = {"force", "proxy", "contacts", "set", "flags", "faults"};
    static_assert(std::size(names) == replay_fields);
    return names[field];
}

Result<ReplayReport> replay(const device::Recording& recording, const ReplayOptions& options)
{
    Replayer replayer(recording, options);
    Result<ReplayReport> report = replayer.run();
    return report;
}

} // namespace phantom::study
