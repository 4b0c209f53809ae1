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

constexpr Vec3 up{0, 0, 1};

/// Parts of the time spent speeding up, and the same slowing down.
constexpr double ease_part = 0.1;

/// The walk aims at this part of the speed limit: smoothing and the way down come on top.
constexpr double speed_part = 0.8;

/// The way between two rows of the walk, as part of the scene's size.
constexpr double step_part = 1.0 / 1500.0;

/// Waypoints of one round of sweeps: a Lissajous figure of 3 to 2 over this part of the scene's footprint.
constexpr int waypoints = 60;
constexpr double footprint_part = 0.36;

/// Places where the tip presses in, and how much slower it moves there than in a sweep.
constexpr std::size_t presses = 6;
constexpr double press_slowness = 6.0;

/// Height of the sweeps when none is asked for, in contact radii: a hand presses now more, now less.
constexpr double height_mean = 0.45;
constexpr double height_swing = 0.35;
/// Way of one swing, as part of the scene's size.
constexpr double swing_part = 0.4;

/// A polyline by the part of its length; parts must not fall from call to call.
class Along {
  public:
    explicit Along(const std::vector<Vec3>& line) : line_(&line), way_(line.size(), 0.0)
    {
        for (std::size_t i = 1; i < line.size(); ++i)
            way_[i] = way_[i - 1] + length(line[i] - line[i - 1]);
    }
    Vec3 at(double part)
    {
        const std::vector<Vec3>& line = *line_;
        if (line.size() < 2)
            return line.front();
        const double gone = part * way_.back();
        while (segment_ + 2 < line.size() && way_[segment_ + 1] < gone)
            ++segment_;
        const double span = way_[segment_ + 1] - way_[segment_];
        const double t = span > 0 ? std::clamp((gone - way_[segment_]) / span, 0.0, 1.0) : 0.0;
        return line[segment_] + t * (line[segment_ + 1] - line[segment_]);
    }

  private:
    const std::vector<Vec3>* line_;
    std::vector<double> way_;
    std::size_t segment_ = 0;
};

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
        return timed(with_presses(lifted()));
    }

  private:
    void find_waypoints()
    {
        const double top = bounds_.high[2] + step_mm_;
        for (int i = 0; i < waypoints; ++i) {
            const double turn = 2.0 * std::numbers::pi * i / waypoints;
            const double part[2] = {std::sin(3.0 * turn), std::sin(2.0 * turn + 0.5)};
            Vec3 start{0, 0, top};
            for (int axis = 0; axis < 2; ++axis)
                start[axis] = 0.5 * (bounds_.low[axis] + bounds_.high[axis]) +
                              footprint_part * part[axis] * (bounds_.high[axis] - bounds_.low[axis]);
            if (const auto point = surface_.trace(start, -1.0 * up, top - bounds_.low[2] + step_mm_))
                seen_.push_back(*point);
        }
    }

    /// How long the walk may be, approach and lift included; pressing takes its share of the time.
    double length_wanted() const
    {
        const double pressing_mm = 4.0 * presses * press_slowness * radius_mm_;
        const double whole_mm = speed_part * options_.speed_limit_mm_s * options_.seconds * (1.0 - ease_part);
        return std::max(0.2 * whole_mm, whole_mm - pressing_mm);
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
            const Vec3 way = seen_[target].position_mm - here.position_mm;
            const Vec3 tangent = way - dot(way, here.normal) * here.normal;
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

    /// A way from rest to rest. Slowness stretches its share of the time.
    struct Piece {
        std::vector<Vec3> line;
        double slowness = 1.0;

        [[nodiscard]] double way_mm() const
        {
            double sum = 0;
            for (std::size_t i = 1; i < line.size(); ++i)
                sum += length(line[i] - line[i - 1]);
            return sum;
        }
    };

    /// Above the surface, so far along the walk.
    double height_mm(double gone_mm) const
    {
        if (options_.height_mm)
            return *options_.height_mm;
        const double turn = 2.0 * std::numbers::pi * gone_mm / (swing_part * bounds_.extent());
        return radius_mm_ * (height_mean + height_swing * std::sin(turn));
    }

    /// The walk at its height, smoothed, with the way down before it and the way up behind it.
    struct Lifted {
        std::vector<Vec3> line;
        std::size_t first = 0; ///< of the walk in line
    };
    Lifted lifted() const
    {
        Lifted out;
        const auto climb = [&](const Vec3& from, const Vec3& to) {
            const int pieces = std::max(1, static_cast<int>(length(to - from) / step_mm_));
            for (int i = 0; i < pieces; ++i)
                out.line.push_back(from + (static_cast<double>(i) / pieces) * (to - from));
        };
        double gone_mm = 0;
        const auto at = [&](const SurfacePoint& point) {
            return point.position_mm + height_mm(gone_mm) * point.normal;
        };
        climb(walk_.front().position_mm + clearance_mm() * up, at(walk_.front()));
        out.first = out.line.size();
        for (std::size_t i = 0; i < walk_.size(); ++i) {
            gone_mm += i > 0 ? length(walk_[i].position_mm - walk_[i - 1].position_mm) : 0.0;
            out.line.push_back(at(walk_[i]));
        }
        const Vec3 away = walk_.back().position_mm + clearance_mm() * walk_.back().normal;
        climb(at(walk_.back()), away);
        out.line.push_back(away);
        smooth(out.line);
        return out;
    }

    /// Cuts the way at a few places of the walk and presses in there: straight down and back, so that the
    /// proxy has nowhere to go but where the tip came in.
    std::vector<Piece> with_presses(const Lifted& lifted) const
    {
        const double depth = options_.depth_mm.value_or(0.5 * radius_mm_);
        std::vector<Piece> pieces(1);
        std::size_t pressed = 0;
        for (std::size_t i = 0; i < lifted.line.size(); ++i) {
            pieces.back().line.push_back(lifted.line[i]);
            const std::size_t place = lifted.first + (2 * pressed + 1) * walk_.size() / (2 * presses);
            if (depth == 0 || pressed == presses || i != place)
                continue;
            const SurfacePoint& under = walk_[i - lifted.first];
            const Vec3 deep = under.position_mm - depth * under.normal;
            pieces.push_back({{lifted.line[i], deep}, press_slowness});
            pieces.push_back({{deep, lifted.line[i]}, press_slowness});
            pieces.push_back({{lifted.line[i]}, 1.0});
            ++pressed;
        }
        return pieces;
    }

    /// Running means over a few steps, three times: nearly Gaussian, ends fixed.
    static void smooth(std::vector<Vec3>& line)
    {
        constexpr std::ptrdiff_t half = 6;
        const auto size = static_cast<std::ptrdiff_t>(line.size());
        for (int pass = 0; pass < 3; ++pass) {
            std::vector<Vec3> out(line.size());
            for (std::ptrdiff_t i = 0; i < size; ++i) {
                const std::ptrdiff_t reach = std::min({half, i, size - 1 - i});
                Vec3 sum{};
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

    /// Rows of the whole: every piece gets its share of the time.
    Result<feeder::Path> timed(const std::vector<Piece>& pieces) const
    {
        double weight = 0;
        for (const Piece& piece : pieces)
            weight += piece.way_mm() * piece.slowness;
        const double speed = weight / (options_.seconds * (1.0 - ease_part));
        if (speed > options_.speed_limit_mm_s)
            return Error{"",
                         fmt::format("the stroke needs {:.0f} mm/s, the limit is {:g}", speed,
                                     options_.speed_limit_mm_s),
                         "more --seconds, or a higher --speed-limit"};
        const auto rows = static_cast<std::size_t>(std::llround(options_.seconds * options_.rate_hz)) + 1;
        feeder::Path path;
        path.reserve(rows);
        std::size_t current = 0;
        double begin_s = 0;
        const auto span_s = [&] {
            return options_.seconds * pieces[current].way_mm() * pieces[current].slowness / weight;
        };
        Along along(pieces[0].line);
        double piece_s = span_s();
        for (std::size_t row = 0; row < rows; ++row) {
            const double time_s = static_cast<double>(row) / options_.rate_hz;
            while (time_s > begin_s + piece_s && current + 1 < pieces.size()) {
                begin_s += piece_s;
                along = Along(pieces[++current].line);
                piece_s = span_s();
            }
            const double part = piece_s > 0 ? std::clamp((time_s - begin_s) / piece_s, 0.0, 1.0) : 1.0;
            path.push_back({time_s, along.at(eased(part))});
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
