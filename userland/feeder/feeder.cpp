// SPDX-License-Identifier: GPL-2.0-or-later
// The slow loop. How far a set must reach, seen from its centre C:
//
//   outside   C = tip                     need = R + way
//   inside    C = (tip + proxy) / 2       need = |tip - proxy| / 2 + R + way
//
// with R the largest contact radius of the scene and `way` how far the tip may go until the next set is
// there: as far as it came since the last one. The tip of the round before must be covered as well: the
// servo looks for crossings on the path from there to here.
//
// Where the scene has levels of detail, that need decides on the level first (level_choice.hpp), by the speed
// that the status page knows and the time between two rounds. The budget grows only where the level's
// triangles are smaller than elsewhere.
//
// Where something moves, every round begins with where it is now: `way` is then the largest of the tip's ways
// as seen from the scene at rest and from each object that may be felt, and so is its speed. Motion is a
// function of the device's clock, so a virtual one gives the same sets every time.
#include "feeder/feeder.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <thread>
#include <utility>

#include "base/vector.hpp"
#include "feeder/effect_tables.hpp"
#include "feeder/level_choice.hpp"
#include "feeder/moving_objects.hpp"

namespace phantom::feeder {

namespace {

using Clock = std::chrono::steady_clock;
using Vector = std::array<double, 3>;

constexpr double mm_per_nm = 1e-6;

/// Two rounds are never closer than this part of the period, however loud the servo calls: a tip that no set
/// can cover (more than 512 triangles within R) keeps asking.
constexpr int early_rounds_max = 4;

/// How many samples Feeder::Totals keeps.
constexpr std::size_t samples_max = 65536;

/// How many sets' query times are kept.
constexpr std::size_t query_times_max = 4096;

/// The servo takes a set within a tick. On top of the need, as a fraction of R.
constexpr double margin_of_radius = 0.05;

double distance(const Vector& a, const Vector& b)
{
    return length(a - b);
}

double microseconds(Clock::duration d)
{
    return std::chrono::duration<double, std::micro>(d).count();
}

/// A ring of the last samples_max values.
struct Samples {
    std::vector<float> values;
    std::size_t next = 0;

    void add(double value)
    {
        if (values.size() < samples_max)
            values.push_back(static_cast<float>(value));
        else
            values[next] = static_cast<float>(value);
        next = (next + 1) % samples_max;
    }
};

/// What a level of detail is fed from.
struct Detail {
    Detail(const scene::Scene& scene, const fdh::SceneTree<14>& tree_, std::uint32_t patches_max,
           std::shared_ptr<EffectTables> effects)
        : live(scene::LiveScene::is_called_for(scene) ? std::make_unique<scene::LiveScene>(scene, tree_)
                                                      : nullptr),
          tree(live ? live->tree() : tree_),
          builder(live ? live->scene() : scene, patches_max, std::move(effects))
    {
    }
    std::unique_ptr<scene::LiveScene> live; ///< where something moves or deforms
    const fdh::SceneTree<14>& tree;
    SetBuilder builder;
    std::uint32_t error_nm = 0;
};

} // namespace

struct Feeder::Impl {
    Impl(const scene::Scene& scene_, const fdh::SceneTree<14>& tree_, device::Device& device_,
         const FeederOptions& options_)
        : scene(scene_),
          device(device_),
          options(options_),
          radius_mm(scene_.max_radius_mm()),
          budget(first_budget()),
          effects(std::make_shared<EffectTables>(scene_)),
          choice(std::vector<DetailLevel>(1)),
          moving(scene_)
    {
        details.push_back(std::make_unique<Detail>(scene_, tree_, device_.info().patches_max, effects));
    }

    /// Options as wide as the module allows; user mode may raise patches_max.
    std::uint32_t budget_max() const { return std::max(1U, device.info().patches_max); }
    std::uint32_t first_budget() const { return std::clamp(options.budget, 1U, budget_max()); }
    std::uint32_t growth_max() const
    {
        return options.grow_budget
                   ? std::max(first_budget(), std::min<std::uint32_t>(PHANTOM_PATCHES_MAX, budget_max()))
                   : first_budget();
    }

    /// On the clock that the servo's ticks are on.
    [[nodiscard]] std::uint64_t now_ns() const
    {
        if (device.has_virtual_clock())
            return device.status().time_ns;
        // On Linux that is CLOCK_MONOTONIC.
        return static_cast<std::uint64_t>(
            std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch()).count());
    }

    static Vector velocity_mm_s(const phantom_status& status)
    {
        Vector velocity{};
        for (int axis = 0; axis < 3; ++axis)
            velocity[axis] = static_cast<double>(status.velocity_nm_s[axis]) * mm_per_nm;
        return velocity;
    }

    /// Takes everything that moves to where it is now.
    Status move(const Vector& tip)
    {
        scene::LiveScene* live = details.front()->live.get();
        if (!live)
            return success();
        if (!moving.none() && !(device.info().features & PHANTOM_FEATURE_MOVING_OBJECTS))
            return Error{device.name(), "cannot move objects, and the scene has some that do",
                         "leave out motion, or use another version of the module"};
        when.time_ns = now_ns();
        const double t_s =
            motion_begin_ns
                ? 1e-9 * (static_cast<double>(when.time_ns) - static_cast<double>(*motion_begin_ns))
                : -1.0;
        live->advance(t_s);
        moment = live->moment();
        when.moment = moment.get();
        if (!moving.none()) {
            const phantom_status status = device.status();
            moving.look({*moment, tip, velocity_mm_s(status), 1.0 / std::max(1.0, options.rate_hz)},
                        radius_mm * (1.0 + margin_of_radius));
            when.near = moving.near();
        }
        return success();
    }

    /// Takes what use() was given, if anything.
    void take_levels()
    {
        std::shared_ptr<const scene::Levels> given;
        {
            const std::lock_guard lock(mutex);
            given = std::move(offered);
        }
        if (!given)
            return;
        details.resize(1);
        for (const scene::Level& level : given->coarser) {
            details.push_back(
                std::make_unique<Detail>(level.scene, level.tree, device.info().patches_max, effects));
            details.back()->error_nm =
                static_cast<std::uint32_t>(std::clamp(level.error_mm / mm_per_nm, 0.0, 4e9));
        }
        choice = LevelChoice(details_of(*given));
        levels = std::move(given); // its scenes and trees live as long as the details
    }

    /// Takes what feel() was given, if anything.
    void take_feel()
    {
        std::optional<Feel> given;
        {
            const std::lock_guard lock(mutex);
            given.swap(wished);
        }
        if (given)
            effects->change(std::move(given->materials), std::move(given->effects));
        effects->begin_round();
    }

    /// The time until the next set: the period, or as long as it took last time.
    double delay_s(const phantom_status& status) const
    {
        const double period_s = 1.0 / std::max(1.0, options.rate_hz);
        return previous_ns ? std::max(period_s, 1e-9 * static_cast<double>(status.time_ns - previous_ns))
                           : period_s;
    }

    /// The level for this round.
    std::uint32_t choose_level(const Vector& tip, const Vector& proxy, bool inside)
    {
        take_levels();
        if (details.size() == 1)
            return 0;
        if (options.level)
            return std::min(*options.level, static_cast<std::uint32_t>(details.size() - 1));
        const phantom_status status = device.status();
        const Vector velocity = velocity_mm_s(status);
        LevelDemand demand;
        demand.speed_mm_s = std::max(length(velocity), moving.speed_mm_s());
        demand.delay_s = delay_s(status);
        demand.contact_radius_mm = radius_mm;
        if (inside) {
            const Vector deep = tip - proxy;
            demand.depth_mm = length(deep);
            demand.dive_mm_s = std::max(dot(velocity, unit(deep)), moving.speed_mm_s());
        }
        previous_ns = status.time_ns;
        return static_cast<std::uint32_t>(choice.choose(demand));
    }

    struct Wanted {
        Vector centre;
        double need_mm; ///< coverage from centre
    };
    Wanted wanted(const Vector& tip, const Vector& proxy, bool inside) const
    {
        const double way = std::max(has_previous ? distance(tip, previous) : 0.0, moving.way_mm());
        Vector centre = tip;
        double need = radius_mm * (1.0 + margin_of_radius) + way;
        if (inside) {
            for (int axis = 0; axis < 3; ++axis)
                centre[axis] = 0.5 * (tip[axis] + proxy[axis]);
            need += distance(tip, centre);
        }
        if (has_previous)
            need = std::max(need, distance(previous, centre));
        return {centre, need};
    }

    /// The nearest triangles, as many as the need asks for.
    void query(const Wanted& want, const fdh::SceneTree<14>& tree)
    {
        // Twice search_radius is what check_reach() leaves room for.
        const double search_mm =
            std::clamp(want.need_mm, options.search_radius_mm, 2.0 * options.search_radius_mm);
        for (;;) {
            tree.nearest(want.centre, budget, search_mm, nearest);
            if (nearest.coverage >= want.need_mm || nearest.hits.size() < budget || budget >= growth_max())
                break;
            budget = std::min(2 * budget, growth_max());
        }
        // Back to smaller sets once there is room: a set of half the triangles covers about 0.7 of the
        // radius.
        if (budget > first_budget() && nearest.coverage > 2.0 * want.need_mm)
            budget = std::max(first_budget(), budget / 2);
    }

    /// Hands set over; set_id stays 0 when a virtual clock has no slot free.
    Status submit(FeedReport& report)
    {
        if (device.has_virtual_clock()) {
            Result<bool> taken = device.try_submit(set);
            if (!taken)
                return taken.error();
            report.set_id = *taken ? set.header.id : 0;
            return success();
        }
        if (Status status = device.submit(set); !status)
            return status;
        report.set_id = set.header.id;
        return success();
    }

    void publish(const FeedReport& report, Clock::time_point now)
    {
        const std::lock_guard lock(mutex);
        ++totals.sets;
        totals.level_sets.resize(std::max(totals.level_sets.size(), details.size()));
        ++totals.level_sets[report.level];
        totals.level_changes += totals.sets > 1 && report.level != last.level;
        query_us.add(report.query_us);
        query_times[report.set_id % query_times_max] = {report.set_id, report.query_us};
        if (last_time != Clock::time_point{})
            interval_ms.add(microseconds(now - last_time) * 1e-3);
        last_time = now;
        last = report;
        last_moment = moment;
    }

    const scene::Scene& scene;
    device::Device& device;
    FeederOptions options;
    double radius_mm;
    std::uint32_t budget;                  ///< of the next query; grows and shrinks
    std::shared_ptr<EffectTables> effects; ///< of every detail's sets
    LevelChoice choice;
    std::vector<std::unique_ptr<Detail>> details; ///< by level, at least the scene itself
    std::shared_ptr<const scene::Levels> levels;  ///< what the coarser details are of
    Vector previous{};                            ///< tip of the round before
    bool has_previous = false;
    std::uint64_t previous_ns = 0; ///< time of the status that the last level was chosen by, or 0
    MovingObjects moving;
    std::optional<std::uint64_t> motion_begin_ns; ///< nothing: not yet
    std::shared_ptr<const scene::Moment> moment;  ///< of the set in hand, which is of
    SetTime when;
    fdh::Nearest nearest;
    device::PatchSet set;

    mutable std::mutex mutex; ///< protects what follows
    std::shared_ptr<const scene::Levels> offered;
    struct Feel {
        std::vector<scene::Material> materials;
        std::vector<scene::SpaceEffect> effects;
    };
    std::optional<Feel> wished;
    Totals totals;
    Samples query_us, interval_ms;
    struct QueryTime {
        std::uint64_t set_id = 0;
        double us = 0;
    };
    std::vector<QueryTime> query_times = std::vector<QueryTime>(query_times_max); ///< at set_id % size
    Clock::time_point last_time{};
    FeedReport last;
    std::shared_ptr<const scene::Moment> last_moment;
};

Feeder::Feeder(const scene::Scene& scene, const fdh::SceneTree<14>& tree, device::Device& device,
               const FeederOptions& options)
    : impl_(std::make_shared<Impl>(scene, tree, device, options))
{
}

void Feeder::use(std::shared_ptr<const scene::Levels> levels)
{
    const std::lock_guard lock(impl_->mutex);
    impl_->offered = std::move(levels);
}

void Feeder::feel(std::vector<scene::Material> materials, std::vector<scene::SpaceEffect> effects)
{
    const std::lock_guard lock(impl_->mutex);
    impl_->wished = Impl::Feel{std::move(materials), std::move(effects)};
}

void Feeder::begin_motion()
{
    impl_->motion_begin_ns = impl_->now_ns();
}

std::shared_ptr<const scene::Moment> Feeder::moment() const
{
    const std::lock_guard lock(impl_->mutex);
    return impl_->last_moment;
}

Result<FeedReport> Feeder::feed(const std::array<double, 3>& tip_mm, const std::array<double, 3>& proxy_mm,
                                bool inside)
{
    Impl& self = *impl_;
    FeedReport report;
    const auto begin = Clock::now();
    auto queried = begin;
    self.take_feel();
    if (Status status = self.move(tip_mm); !status)
        return status.error();
    if (self.options.all) {
        const mesh::Bounds bounds = self.scene.bounds();
        Vector middle{};
        for (int axis = 0; axis < 3; ++axis)
            middle[axis] = 0.5 * (bounds.low[axis] + bounds.high[axis]);
        self.details.front()->builder.build_all(middle, self.set, self.when);
    } else {
        report.level = self.choose_level(tip_mm, proxy_mm, inside);
        Detail& detail = *self.details[report.level];
        if (detail.live && report.level > 0)
            detail.live->follow(*self.details.front()->live);
        const Impl::Wanted want = self.wanted(tip_mm, proxy_mm, inside);
        self.query(want, detail.tree);
        queried = Clock::now();
        self.nearest.sort();
        detail.builder.build(self.nearest, want.centre, self.set, self.when);
        report.hits = self.nearest.hits;
        self.set.header.level = report.level;
        self.set.header.level_error_nm = detail.error_nm;
    }
    const auto built = Clock::now();
    report.patches = static_cast<std::uint32_t>(self.set.patches.size());
    report.coverage_mm = self.set.header.radius_nm * mm_per_nm;
    report.query_us = microseconds(queried - begin);
    report.build_us = microseconds(built - begin);
    if (Status status = self.submit(report); !status)
        return status.error();
    self.previous = tip_mm;
    self.has_previous = true;
    self.publish(report, built);
    return report;
}

Result<FeedReport> Feeder::feed()
{
    const phantom_status status = impl_->device.status();
    Vector tip, proxy;
    for (int axis = 0; axis < 3; ++axis) {
        tip[axis] = static_cast<double>(status.tip_nm[axis]) * mm_per_nm;
        proxy[axis] = static_cast<double>(status.proxy_nm[axis]) * mm_per_nm;
    }
    return feed(tip, proxy, (status.flags & PHANTOM_TICK_INSIDE) != 0);
}

// By value, as std::jthread hands it over.
Status Feeder::run(std::stop_token stop) // NOLINT(performance-unnecessary-value-param)
{
    const auto period = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(1.0 / std::max(1.0, impl_->options.rate_hz)));
    auto next = Clock::now();
    while (!stop.stop_requested()) {
        const auto begin = Clock::now();
        if (Result<FeedReport> report = feed(); !report)
            return report.error();
        next = std::max(next + period, begin);
        std::this_thread::sleep_until(begin + period / early_rounds_max);
        const auto rest = std::chrono::floor<std::chrono::milliseconds>(next - Clock::now());
        if (rest.count() > 0) {
            Result<bool> event = impl_->device.wait_event(rest);
            if (!event)
                return event.error();
            if (*event) {
                next = Clock::now();
                continue;
            }
        }
        std::this_thread::sleep_until(next);
    }
    return success();
}

Feeder::Totals Feeder::totals() const
{
    const std::lock_guard lock(impl_->mutex);
    Totals totals = impl_->totals;
    totals.query_us = impl_->query_us.values;
    totals.interval_ms = impl_->interval_ms.values;
    return totals;
}

double Feeder::query_us(std::uint64_t set_id) const
{
    const std::lock_guard lock(impl_->mutex);
    const Impl::QueryTime& time = impl_->query_times[set_id % query_times_max];
    return time.set_id == set_id ? time.us : 0.0;
}

FeedReport Feeder::last() const
{
    const std::lock_guard lock(impl_->mutex);
    return impl_->last;
}

} // namespace phantom::feeder
