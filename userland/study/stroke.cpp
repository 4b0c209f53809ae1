// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/stroke.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "study/surface_point.hpp"

namespace phantom::study {

namespace {

constexpr Vector up{0, 0, 1};

/// Parts of the time spent speeding up, and the same slowing down.
constexpr double ease_part = 0.1;

/// The walk aims at this part of the speed limit: smoothing and the way down come on top.
constexpr double speed_part = 0.8;

/// The way between two rows of the walk, as part of the scene's size.
constexpr double step_part = 1.0 / 1500.0;

/// Waypoints of one round of sweeps: a Lissajous figure of 3 to 2 over this part of the scene's footprint.
constexpr int waypoints = 60;
constexpr double footprint_part = 0.36;

/// Between deepest and highest the stroke goes once in this part of its way.
constexpr double wave_part = 0.25;

class Stroke {
  public:
    Stroke(const scene::Scene& scene, const fdh::SceneTree<14>& tree, const StrokeOptions& options)
        : surface_(scene, tree),
          bounds_(scene.bounds()),
          options_(options),
          radius_mm_(scene.max_radius_mm()),
          step_mm_(std::max(1e-6, bounds_.extent() * step_part))
    {
    }

    Result<feeder::Path> make()
    {
        find_waypoints();
        if (seen_.empty())
            return Error{"", "no surface is seen from above (+z)",
                         "turn the object with a pose in a scene file"};
        walk();
        std::vector<Vector> line = lifted();
        smooth(line);
        return timed(line);
    }

  private:
    void find_waypoints()
    {
        const double top = bounds_.high[2] + step_mm_;
        for (int i = 0; i < waypoints; ++i) {
            const double turn = 2.0 * std::numbers::pi * i / waypoints;
            const double part[2] = {std::sin(3.0 * turn), std::sin(2.0 * turn + 0.5)};
            Vector start{0, 0, top};
            for (int axis = 0; axis < 2; ++axis)
                start[axis] = 0.5 * (bounds_.low[axis] + bounds_.high[axis]) +
                              footprint_part * part[axis] * (bounds_.high[axis] - bounds_.low[axis]);
            if (const auto point = surface_.trace(start, -1.0 * up, top - bounds_.low[2] + step_mm_))
                seen_.push_back(*point);
        }
    }

    /// How long the walk may be, approach and lift included.
    double length_wanted() const
    {
        return speed_part * options_.speed_limit_mm_s * options_.seconds * (1.0 - ease_part);
    }

    double clearance_mm() const { return 2.0 * radius_mm_ + 0.05 * bounds_.extent(); }

    /// From waypoint to waypoint on the surface: a step in the tangent plane, back to the nearest point.
    void walk()
    {
        SurfacePoint here = seen_.front();
        walk_.push_back(here);
        double gone_mm = 2.0 * clearance_mm();
        std::size_t target = 1 % seen_.size();
        double nearest_mm = length(seen_[target].position_mm - here.position_mm);
        int stuck = 0;
        const auto next_target = [&] {
            target = (target + 1) % seen_.size();
            nearest_mm = length(seen_[target].position_mm - here.position_mm);
            stuck = 0;
        };
        // Every step goes on or brings the next waypoint nearer; the count bounds a scene of one flat speck.
        const std::size_t steps_max = static_cast<std::size_t>(length_wanted() / step_mm_) * 4 + 1000;
        for (std::size_t step = 0; step < steps_max && gone_mm < length_wanted(); ++step) {
            const Vector way = seen_[target].position_mm - here.position_mm;
            const Vector tangent = way - dot(way, here.normal) * here.normal;
            const double way_mm = length(way);
            if (way_mm < 1.5 * step_mm_ || length(tangent) < 0.1 * way_mm || stuck > 20) {
                next_target();
                continue;
            }
            const auto point = surface_.nearest(here.position_mm + step_mm_ * unit(tangent), 10.0 * step_mm_);
            if (!point)
                return;
            gone_mm += length(point->position_mm - here.position_mm);
            here = *point;
            walk_.push_back(here);
            const double rest_mm = length(seen_[target].position_mm - here.position_mm);
            stuck = rest_mm < nearest_mm ? 0 : stuck + 1;
            nearest_mm = std::min(nearest_mm, rest_mm);
        }
    }

    /// The walk at its heights, with the way down and the way up.
    std::vector<Vector> lifted() const
    {
        const double high = options_.height_mm.value_or(0.5 * radius_mm_), low = -options_.depth_mm;
        std::vector<Vector> line;
        const auto climb = [&](const Vector& from, const Vector& to) {
            const int pieces = std::max(1, static_cast<int>(length(to - from) / step_mm_));
            for (int i = 0; i < pieces; ++i)
                line.push_back(from + (static_cast<double>(i) / pieces) * (to - from));
        };
        const auto at = [&](std::size_t i) {
            const double wave = std::cos(2.0 * std::numbers::pi * static_cast<double>(i) /
                                         (wave_part * static_cast<double>(walk_.size())));
            return walk_[i].position_mm + (0.5 * (high + low) + 0.5 * (high - low) * wave) * walk_[i].normal;
        };
        climb(walk_.front().position_mm + clearance_mm() * up, at(0));
        for (std::size_t i = 0; i < walk_.size(); ++i)
            line.push_back(at(i));
        const SurfacePoint& end = walk_.back();
        climb(at(walk_.size() - 1), end.position_mm + clearance_mm() * end.normal);
        line.push_back(end.position_mm + clearance_mm() * end.normal);
        return line;
    }

    /// Running means over a few steps, three times: nearly Gaussian, ends fixed.
    static void smooth(std::vector<Vector>& line)
    {
        constexpr std::ptrdiff_t half = 6;
        const auto size = static_cast<std::ptrdiff_t>(line.size());
        for (int pass = 0; pass < 3; ++pass) {
            std::vector<Vector> out(line.size());
            for (std::ptrdiff_t i = 0; i < size; ++i) {
                const std::ptrdiff_t reach = std::min({half, i, size - 1 - i});
                Vector sum{};
                for (std::ptrdiff_t k = i - reach; k <= i + reach; ++k)
                    sum = sum + line[static_cast<std::size_t>(k)];
                out[static_cast<std::size_t>(i)] = (1.0 / static_cast<double>(2 * reach + 1)) * sum;
            }
            line = std::move(out);
        }
    }

    /// Part of the way after part of the time: sine-shaped speeding up and slowing down, even between.
    static double eased(double part)
    {
        const auto begin = [](double t) {
            return 0.5 * (t - ease_part / std::numbers::pi * std::sin(std::numbers::pi * t / ease_part));
        };
        const double whole = 1.0 - ease_part;
        if (part < ease_part)
            return begin(part) / whole;
        if (part > 1.0 - ease_part)
            return 1.0 - begin(1.0 - part) / whole;
        return (part - 0.5 * ease_part) / whole;
    }

    Result<feeder::Path> timed(const std::vector<Vector>& line) const
    {
        std::vector<double> way(line.size(), 0.0);
        for (std::size_t i = 1; i < line.size(); ++i)
            way[i] = way[i - 1] + length(line[i] - line[i - 1]);
        const double speed = way.back() / (options_.seconds * (1.0 - ease_part));
        if (speed > options_.speed_limit_mm_s)
            return Error{"",
                         fmt::format("a stroke of {:.0f} mm in {:g} s needs {:.0f} mm/s, the limit is {:g}",
                                     way.back(), options_.seconds, speed, options_.speed_limit_mm_s),
                         "more --seconds, or a higher --speed-limit"};
        const auto rows = static_cast<std::size_t>(std::llround(options_.seconds * options_.rate_hz)) + 1;
        feeder::Path path;
        path.reserve(rows);
        std::size_t piece = 0;
        for (std::size_t row = 0; row < rows; ++row) {
            const double time_s = static_cast<double>(row) / options_.rate_hz;
            const double gone = way.back() * eased(std::min(1.0, time_s / options_.seconds));
            while (piece + 2 < line.size() && way[piece + 1] < gone)
                ++piece;
            const double span = way[piece + 1] - way[piece];
            const double t = span > 0 ? std::clamp((gone - way[piece]) / span, 0.0, 1.0) : 0.0;
            path.push_back({time_s, line[piece] + t * (line[piece + 1] - line[piece])});
        }
        return path;
    }

    Surface surface_;
    mesh::Bounds bounds_;
    const StrokeOptions& options_;
    double radius_mm_, step_mm_;
    std::vector<SurfacePoint> seen_; ///< waypoints
    std::vector<SurfacePoint> walk_;
};

} // namespace

Result<feeder::Path> make_stroke(const scene::Scene& scene, const fdh::SceneTree<14>& tree,
                                 const StrokeOptions& options)
{
    return Stroke(scene, tree, options).make();
}

} // namespace phantom::study
