// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/trace.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "feeder/servo_choice.hpp"
#include "study/device_simulation.hpp"

namespace phantom::study {

namespace {

using Clock = std::chrono::steady_clock;

/// Without limits a set may be as old as it likes: --feed-every asks what an old set costs.
constexpr std::uint32_t never_stale_ms = 1000000000;

double median_of(std::vector<double>& values)
{
    if (values.empty())
        return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

class Tracer {
  public:
    Tracer(const scene::Scene& scene, const TraceOptions& options) : scene_(scene), options_(options) {}

    Status open()
    {
        if (Status status = feeder::check_reach(scene_, options_.feeder); !status)
            return status;
        const Result<std::uint32_t> rate = feeder::choose_rate(options_.servo, scene_.servo);
        if (!rate)
            return rate.error();
        device::UsermodeOptions usermode;
        usermode.virtual_clock = true;
        rate_hz_ = *rate;
        usermode.rate_hz = *rate;
        usermode.isa = wants_double() ? PHANTOM_ISA_DOUBLE : options_.isa;
        usermode.patches_max = patches_max();
        Result<device::Device> device = device::Device::open_usermode(usermode);
        if (!device)
            return device.error();
        device_.emplace(std::move(*device));
        const Result<phantom_model> model =
            feeder::choose_model(options_.servo, scene_.servo, device_->info().features);
        if (!model)
            return model.error();
        model_ = *model;
        if (Status status = device_->set_model(model_); !status)
            return status;
        tree_.emplace(options_.feeder.all && !scene::LiveScene::is_called_for(scene_)
                          ? fdh::SceneTree<14>()
                          : scene::build_tree<14>(scene_));
        feeder::FeederOptions feeding = options_.feeder;
        feeding.rate_hz = static_cast<double>(rate_hz_) / options_.feed_every;
        feeding.level = options_.levels.fixed;
        feeder_.emplace(scene_, *tree_, *device_, feeding);
        if (options_.levels.on && !feeding.all)
            use_levels(feeding);
        return success();
    }

    Result<TraceRun> run(const feeder::Path& path)
    {
        run_.csv = std::string(feeder::trace_header) + "\n";
        run_.csv.reserve(path.size() * 160);
        run_.summary.simulated = scene_.device.simulated();
        if (!run_.summary.simulated.empty() && !path.empty())
            simulation_.emplace(scene_.device, path.front().tip_mm);
        for (std::size_t i = 0; i < path.size(); ++i) {
            if (Status status = row(path[i], i); !status)
                return status.error();
            if (simulation_ && i + 1 < path.size())
                simulation_->pass(force_n_, path[i].tip_mm, path[i + 1].tip_mm, 1.0 / rate_hz_);
            if (options_.progress && i % 256 == 0)
                options_.progress(static_cast<double>(i) / static_cast<double>(path.size()));
        }
        summarise();
        return std::move(run_);
    }

  private:
    bool wants_double() const
    {
        return options_.servo.arith.value_or(scene_.servo.arith.value_or("")) == "double";
    }

    void use_levels(const feeder::FeederOptions& feeding)
    {
        scene::LevelOptions wanted;
        wanted.budget = feeding.budget;
        wanted.edge_max_mm = feeder::edge_max_mm(feeding);
        const auto levels =
            std::make_shared<const scene::Levels>(scene::build_levels(scene_, *tree_, wanted));
        for (std::size_t level = 0; level < levels->size(); ++level)
            run_.summary.level_error_mm.push_back(levels->error_mm(level));
        feeder_->use(levels);
    }

    /// 0 = what the module takes by itself.
    std::uint32_t patches_max() const
    {
        const std::uint64_t wanted = options_.feeder.all ? scene_.patches() : options_.feeder.budget;
        return wanted > PHANTOM_PATCHES_MAX ? static_cast<std::uint32_t>(wanted) : 0;
    }

    Status begin()
    {
        phantom_start start{};
        if (options_.limits) {
            start = feeder::choose_start(start, scene_.device, scene_.servo);
        } else {
            start.flags = PHANTOM_START_LIMITS_OFF;
            start.stale_ms = never_stale_ms;
        }
        if (Status status = device_->start(start); !status)
            return status;
        if (Status status = options_.limits ? success() : settle(); !status)
            return status;
        feeder_->begin_motion();
        return success();
    }

    /// The servo fades its first set in. Without limits that is stepped away at the first position, so that
    /// the first row has its full force.
    Status settle()
    {
        const std::uint32_t ticks_max = 2 + 2 * static_cast<std::uint32_t>(1e-9 * PHANTOM_FADE_NS * rate_hz_);
        for (std::uint32_t tick = 0; tick < ticks_max; ++tick) {
            if (Status status = device_->step(1); !status)
                return status;
            const Result<std::vector<phantom_tick>> ticks = device_->read_ticks();
            if (!ticks)
                return ticks.error();
            if (ticks->empty() || (ticks->back().flags & PHANTOM_TICK_FADING) == 0)
                break;
        }
        return success();
    }

    /// Whether this tick gets a set. A set of everything stays good until it is stale.
    bool feeds(std::size_t index) const
    {
        if (options_.feeder.all && !options_.limits)
            return index == 0;
        return index % options_.feed_every == 0 || retry_;
    }

    Status feed(const feeder::PathRow& at, double& query_us)
    {
        Result<feeder::FeedReport> report = feeder_->feed(at.tip_mm, proxy_mm_, inside_);
        if (!report)
            return report.error();
        retry_ = report->set_id == 0;
        query_us = report->query_us;
        query_us_.push_back(report->query_us);
        run_.summary.sets += report->set_id != 0;
        run_.summary.patches_max = std::max(run_.summary.patches_max, report->patches);
        return success();
    }

    /// led: the path's own row; with a device in the loop the tip is where that says.
    Status row(const feeder::PathRow& led, std::size_t index)
    {
        feeder::PathRow at = led;
        if (simulation_)
            at.tip_mm = simulation_->read(led.tip_mm);
        if (Status status = device_->move_simulated_tip(feeder::to_nanometres(at.tip_mm)); !status)
            return status;
        double query_us = 0.0;
        if (feeds(index))
            if (Status status = feed(at, query_us); !status)
                return status;
        if (index == 0)
            if (Status status = begin(); !status)
                return status;
        const auto before = Clock::now();
        if (Status status = device_->step(1); !status)
            return status;
        const double step_ns = std::chrono::duration<double, std::nano>(Clock::now() - before).count();
        Result<std::vector<phantom_tick>> ticks = device_->read_ticks();
        if (!ticks)
            return ticks.error();
        if (ticks->size() != 1)
            return Error{device_->name(), fmt::format("expected one record a tick, got {}", ticks->size())};
        add(at, ticks->front(), query_us, step_ns);
        return success();
    }

    void add(const feeder::PathRow& at, const phantom_tick& tick, double query_us, double step_ns)
    {
        feeder::TraceRow row = feeder::trace_row(tick, at.time_s);
        proxy_mm_ = row.inside ? row.proxy_mm : at.tip_mm;
        inside_ = row.inside;
        // The row's own position, not the one rounded to nm.
        row.tip_mm = at.tip_mm;
        row.proxy_mm = proxy_mm_;
        row.query_us = query_us;
        row.tick_ns = step_ns;
        feeder::append_trace_row(run_.csv, row);

        TraceSummary& sum = run_.summary;
        const std::array<double, 3>& f = row.force_n;
        const std::array<double, 3>& g = force_n_;
        sum.contact_ticks += row.contacts > 0;
        sum.inside_ticks += row.inside;
        sum.uncovered_ticks += (row.flags & PHANTOM_TICK_UNCOVERED) != 0;
        sum.force_max_n = std::max(sum.force_max_n, std::hypot(f[0], f[1], f[2]));
        if (sum.ticks > 0)
            sum.force_step_max_n =
                std::max(sum.force_step_max_n, std::hypot(f[0] - g[0], f[1] - g[1], f[2] - g[2]));
        force_n_ = f;
        ++sum.ticks;
        tick_ns_.push_back(step_ns);
    }

    void summarise()
    {
        const phantom_status status = device_->status();
        TraceSummary& sum = run_.summary;
        sum.model = device::model_text(model_);
        sum.isa = device::isa_name(status.isa);
        sum.refused = status.refused;
        sum.saturated = status.saturated;
        sum.faults = device::fault_names(status.faults);
        const feeder::Feeder::Totals fed = feeder_->totals();
        sum.level_sets = fed.level_sets;
        sum.level_changes = fed.level_changes;
        sum.query_median_us = median_of(query_us_);
        sum.tick_median_ns = median_of(tick_ns_);
    }

    const scene::Scene& scene_;
    const TraceOptions& options_;
    std::optional<device::Device> device_;
    std::optional<fdh::SceneTree<14>> tree_;
    std::optional<feeder::Feeder> feeder_;
    phantom_model model_{};
    std::uint32_t rate_hz_ = 0;
    std::array<double, 3> proxy_mm_{}; ///< after the tick before
    std::array<double, 3> force_n_{};  ///< of the tick before
    bool inside_ = false;
    bool retry_ = false;                         ///< the last set found no slot
    std::optional<DeviceSimulation> simulation_; ///< of what [device] names
    TraceRun run_;
    std::vector<double> query_us_, tick_ns_;
};

} // namespace

Result<TraceRun> run_trace(const scene::Scene& scene, const feeder::Path& path, const TraceOptions& options)
{
    Tracer tracer(scene, options);
    if (Status status = tracer.open(); !status)
        return status.error();
    return tracer.run(path);
}

} // namespace phantom::study
