// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/penetration.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/vector.hpp"
#include "device/device.hpp"
#include "feeder/feeder.hpp"
#include "feeder/servo_choice.hpp"

namespace phantom::study {

namespace {

/// The tip's side is compared only this far from the surface: nearer, rounding to nm may decide.
constexpr double sure_mm = 1e-4;

/// A proxy that much farther from the tip than the surface is has not come along.
constexpr double stuck_mm = 1.0;

/// A set may be as old as the case asks for.
constexpr std::uint32_t never_stale_ms = 1000000000;

double percentile(std::vector<double>& sorted, double part)
{
    return sorted.empty() ? 0.0
                          : sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
}

template <class Integer>
Vec3 from_micro(const Integer (&v)[3])
{
    return {1e-6 * static_cast<double>(v[0]), 1e-6 * static_cast<double>(v[1]),
            1e-6 * static_cast<double>(v[2])};
}

class Run {
  public:
    Run(const PenetrationSurface& surface, const PenetrationOptions& options, device::Device device)
        : surface_(surface),
          options_(options),
          device_(std::move(device)),
          feeder_(surface.scene(), surface.tree(), device_, feeder_options(surface, options))
    {
        feeder_.use(surface.levels());
        result_.level_ticks.resize(surface.levels()->size());
    }

    Result<PenetrationResult> run()
    {
        const feeder::Path path = spiral_path(options_.path);
        for (std::size_t i = 0; i < path.size(); ++i)
            if (Status status = tick(path[i].tip_mm, i); !status)
                return status.error();
        result_.ticks = path.size();
        std::sort(errors_.begin(), errors_.end());
        result_.error_p50 = percentile(errors_, 0.5);
        result_.error_p99 = percentile(errors_, 0.99);
        result_.error_max = percentile(errors_, 1.0);
        return result_;
    }

  private:
    static feeder::FeederOptions feeder_options(const PenetrationSurface& surface,
                                                const PenetrationOptions& options)
    {
        feeder::FeederOptions out;
        out.budget = surface.budget();
        out.grow_budget = false;
        out.rate_hz = options.path.rate_hz / options.feed_every;
        if (options.timely)
            out.level = 0;
        return out;
    }

    Status feed(const Vec3& tip)
    {
        const Vec3& at = options_.timely ? tip : seen_;
        const Result<feeder::FeedReport> report = feeder_.feed(at, inside_ ? proxy_ : at, inside_);
        if (!report)
            return report.error();
        result_.level_changes += inside_ && report->level != level_;
        level_ = report->level;
        result_.patches_max = std::max(result_.patches_max, report->patches);
        return success();
    }

    Status begin()
    {
        phantom_start start{};
        start.flags = PHANTOM_START_LIMITS_OFF;
        start.stale_ms = never_stale_ms;
        return device_.start(start);
    }

    Status tick(const Vec3& tip, std::size_t index)
    {
        if (index == 0)
            seen_ = tip;
        if (index % options_.feed_every == 0)
            if (Status status = feed(tip); !status)
                return status;
        if (Status status = device_.move_simulated_tip(feeder::to_nanometres(tip)); !status)
            return status;
        if (index == 0)
            if (Status status = begin(); !status)
                return status;
        if (Status status = device_.step(1); !status)
            return status;
        const Result<std::vector<phantom_tick>> ticks = device_.read_ticks();
        if (!ticks)
            return ticks.error();
        if (ticks->size() != 1)
            return Error{device_.name(), fmt::format("expected one record a tick, got {}", ticks->size())};
        take(ticks->front());
        if (index % options_.check_every == 0)
            compare(ticks->front());
        return success();
    }

    void take(const phantom_tick& record)
    {
        const Vec3 force = from_micro(record.force_un);
        const bool inside = (record.flags & PHANTOM_TICK_INSIDE) != 0;
        if (inside && inside_)
            result_.step_max = std::max(result_.step_max, length(force - force_));
        seen_ = from_micro(record.tip_nm);
        proxy_ = from_micro(record.proxy_nm);
        inside_ = inside;
        force_ = force;
    }

    void compare(const phantom_tick& record)
    {
        const BruteForce::Point nearest = surface_.oracle().nearest(seen_);
        if (nearest.distance_mm < sure_mm)
            return;
        // What lies between two levels is inside for the one and outside for the other.
        const double doubt_mm = surface_.levels()->error_mm(level_) + sure_mm;
        if (!nearest.inside) {
            ++result_.outside;
            result_.kept += inside_ && nearest.distance_mm > doubt_mm;
            return;
        }
        ++result_.under;
        ++result_.level_ticks[level_];
        if (record.flags & PHANTOM_TICK_UNCOVERED) {
            ++result_.lost;
        } else if (!inside_) {
            result_.fell_through += nearest.distance_mm > doubt_mm;
        } else {
            const Vec3 exact = soft_stiffness_n_mm * (soft_radius_mm * nearest.normal + (nearest.at - seen_));
            errors_.push_back(length(force_ - exact));
            result_.stuck += length(proxy_ - seen_) > nearest.distance_mm + stuck_mm;
        }
    }

    const PenetrationSurface& surface_;
    const PenetrationOptions& options_;
    device::Device device_;
    feeder::Feeder feeder_;
    std::uint32_t level_ = 0;         ///< of the set in use
    Vec3 seen_{}, proxy_{}, force_{}; ///< after the tick before
    bool inside_ = false;
    std::vector<double> errors_;
    PenetrationResult result_;
};

} // namespace

Result<PenetrationResult> run_penetration(const PenetrationSurface& surface,
                                          const PenetrationOptions& options)
{
    device::UsermodeOptions usermode;
    usermode.virtual_clock = true;
    usermode.rate_hz = static_cast<std::uint32_t>(options.path.rate_hz);
    Result<device::Device> device = device::Device::open_usermode(usermode);
    if (!device)
        return device.error();
    scene::ServoSettings servo;
    servo.proxy = options.proxy;
    const Result<phantom_model> model = feeder::choose_model(servo, {}, device->info().features);
    if (!model)
        return model.error();
    if (Status status = device->set_model(*model); !status)
        return status.error();
    return Run(surface, options, std::move(*device)).run();
}

} // namespace phantom::study
