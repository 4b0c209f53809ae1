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

constexpr double stiffness_n_mm = 0.5;
constexpr double contact_radius_mm = 0.2;

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

Vec3 millimetres(const __s64 nm[3])
{
    return {1e-6 * static_cast<double>(nm[0]), 1e-6 * static_cast<double>(nm[1]),
            1e-6 * static_cast<double>(nm[2])};
}

class Run {
  public:
    Run(const BruteForce& oracle, const PenetrationOptions& options, device::Device device,
        const scene::Scene& scene, const fdh::SceneTree<14>& tree)
        : oracle_(oracle),
          options_(options),
          device_(std::move(device)),
          feeder_(scene, tree, device_, {.budget = options.budget, .grow_budget = options.grow_budget})
    {
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
    Status tick(const Vec3& tip, std::size_t index)
    {
        if (index == 0)
            seen_ = tip;
        if (index % options_.feed_every == 0) {
            const Vec3& at = options_.feed_every == 1 ? tip : seen_;
            const Result<feeder::FeedReport> report = feeder_.feed(at, inside_ ? proxy_ : at, inside_);
            if (!report)
                return report.error();
            result_.patches_max = std::max(result_.patches_max, report->patches);
        }
        if (Status status = device_.move_simulated_tip(feeder::to_nanometres(tip)); !status)
            return status;
        if (index == 0) {
            phantom_start start{};
            start.flags = PHANTOM_START_LIMITS_OFF;
            start.stale_ms = never_stale_ms;
            if (Status status = device_.start(start); !status)
                return status;
        }
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
        const Vec3 force{1e-6 * record.force_un[0], 1e-6 * record.force_un[1], 1e-6 * record.force_un[2]};
        seen_ = millimetres(record.tip_nm);
        proxy_ = millimetres(record.proxy_nm);
        inside_ = (record.flags & PHANTOM_TICK_INSIDE) != 0;
        const bool touching = record.contacts > 0 && (record.flags & PHANTOM_TICK_FADING) == 0;
        if (touching && touching_)
            result_.step_max = std::max(result_.step_max, length(force - force_));
        touching_ = touching;
        force_ = force;
    }

    void compare(const phantom_tick& record)
    {
        const BruteForce::Point nearest = oracle_.nearest(seen_);
        if (nearest.distance_mm < sure_mm)
            return;
        if (!nearest.inside) {
            ++result_.outside;
            result_.kept += inside_;
            return;
        }
        ++result_.under;
        if (record.flags & PHANTOM_TICK_UNCOVERED)
            ++result_.lost;
        else if (!inside_)
            ++result_.fell_through;
        else {
            errors_.push_back(stiffness_n_mm * length(proxy_ - nearest.at));
            result_.stuck += length(proxy_ - seen_) > nearest.distance_mm + stuck_mm;
        }
    }

    const BruteForce& oracle_;
    const PenetrationOptions& options_;
    device::Device device_;
    feeder::Feeder feeder_;
    Vec3 seen_{}, proxy_{}, force_{}; ///< after the tick before
    bool inside_ = false, touching_ = false;
    std::vector<double> errors_;
    PenetrationResult result_;
};

} // namespace

scene::Scene penetration_scene(mesh::Mesh mesh)
{
    scene::Scene scene;
    scene.materials.push_back({"soft", stiffness_n_mm, contact_radius_mm, {}});
    scene::Object object;
    object.name = "bumpy sphere";
    object.mesh = std::move(mesh);
    scene.objects.push_back(std::move(object));
    return scene;
}

Result<PenetrationResult> run_penetration(const scene::Scene& scene, const fdh::SceneTree<14>& tree,
                                          const BruteForce& oracle, const PenetrationOptions& options)
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
    return Run(oracle, options, std::move(*device), scene, tree).run();
}

} // namespace phantom::study
