// SPDX-License-Identifier: GPL-2.0-or-later
// A region of space as the hulls of a tree see it, and the leaves' triangles as they are compared with it.
#pragma once

#include "fdh/grid.hpp"
#include "fdh/layout.hpp"
#include "fdh/slabs.hpp"
#include "fdh/vector.hpp"

namespace phantom::fdh {

/// Intervals of sixteen hulls, as a node has them.
template <int K>
struct Intervals {
    const float (&low)[K / 2][lanes];
    const float (&high)[K / 2][lanes];
};

/// What hulls are compared with [steps]: the region's own hull, and how far from it the region reaches.
/// Where the region is a segment, each hull widened by the radius also cuts it: what is left in all slabs
/// must not be empty. That rules out most of what lies in the hull of a long slanting segment but far from
/// it.
template <int K>
class RegionHull {
  public:
    /// All within `reach` of a hull.
    RegionHull(const Slabs<K>& slabs, double reach)
    {
        // Coordinates are cut off, so that squares stay finite: gaps become smaller by it, never larger.
        constexpr double farthest = 0x1p61;
        for (int k = 0; k < K / 2; k++) {
            low_[k] = round_down(std::clamp(slabs[k][0], -farthest, farthest));
            high_[k] = round_up(std::clamp(slabs[k][1], -farthest, farthest));
        }
        // The bound's own rounding, of a dozen operations, is far below 2^-19.
        reach2_ = round_up(std::min(reach * reach, 0x1p124) * (1 + 0x1p-19));
    }

    /// All within `reach` of a segment.
    RegionHull(const Segment& segment, double reach) : RegionHull(slabs_round(segment), reach)
    {
        constexpr auto directions = hull_directions<K>();
        // Where floats are a step or two apart, and the sum of three coordinates is off by six.
        constexpr double projection_steps = 16;
        const Slabs<K> from = slabs_of<K>(segment.from), to = slabs_of<K>(segment.to);
        for (int k = 0; k < K / 2; k++) {
            const auto& d = directions[k];
            const double norm = std::sqrt(double(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
            const double a = from[k][0], way = to[k][0] - a,
                         most = std::abs(a) + std::abs(way) + norm * reach;
            // Above, floats are too coarse to cut with; below, it does not move.
            if (most > 0x1p40 || std::abs(way) < 1)
                continue;
            start_[k] = static_cast<float>(a);
            inverse_[k] = static_cast<float>(1 / way);
            reach_[k] = round_up(norm * reach + projection_steps + 0x1p-20 * most);
            cuts_[k] = true;
        }
    }

    /// Bit i set where hull i may be near.
    [[nodiscard]] unsigned near(const Intervals<K>& hulls) const
    {
        constexpr int step = sizeof(V) / sizeof(float);
        unsigned result = 0;
        for (int lane = 0; lane < lanes; lane += step) {
            const V bound2 = squared_distance_bound<K, float>([&](int k) {
                const V below = load(hulls.low[k] + lane) - high_[k],
                        above = low_[k] - load(hulls.high[k] + lane);
                const V gap = below > above ? below : above;
                return gap > 0 ? gap * gap : V{};
            });
            V enter{}, leave = enter + 1;
            for (int k = 0; k < K / 2; k++) {
                if (!cuts_[k])
                    continue;
                const V low = (load(hulls.low[k] + lane) - reach_[k] - start_[k]) * inverse_[k];
                const V high = (load(hulls.high[k] + lane) + reach_[k] - start_[k]) * inverse_[k];
                const V first = inverse_[k] > 0 ? low : high, last = inverse_[k] > 0 ? high : low;
                enter = first > enter ? first : enter;
                leave = last < leave ? last : leave;
            }
            const auto both = (bound2 <= reach2_) & (enter <= leave);
            for (int i = 0; i < step; i++)
                result |= (static_cast<unsigned>(both[i]) & 1u) << (lane + i);
        }
        return result;
    }

  private:
    /// Four lanes: every x86-64 and every arm64 has these.
    typedef float V __attribute__((vector_size(16)));

    static V load(const float* p)
    {
        V v;
        __builtin_memcpy(&v, p, sizeof v);
        return v;
    }
    static Slabs<K> slabs_round(const Segment& segment)
    {
        Slabs<K> slabs = slabs_of<K>(segment.from);
        grow<K>(slabs, slabs_of<K>(segment.to));
        return slabs;
    }

    float low_[K / 2], high_[K / 2];
    float reach2_;
    bool cuts_[K / 2] = {};
    float start_[K / 2] = {}, inverse_[K / 2] = {}, reach_[K / 2] = {};
};

inline Point lane_of(const float (&field)[3][lanes], int lane)
{
    return {field[0][lane], field[1][lane], field[2][lane]};
}

inline Corners corners_of(const Leaf& leaf, int lane)
{
    const Point a = lane_of(leaf.vertex, lane);
    return {a, plus(a, 1, lane_of(leaf.edge1, lane)), plus(a, 1, lane_of(leaf.edge2, lane))};
}

/// The boxes of a leaf's triangles; NaN where there is none, so that it may seem near.
struct LeafBoxes {
    float low[3][lanes], high[3][lanes];

    explicit LeafBoxes(const Leaf& leaf)
    {
        for (int axis = 0; axis < 3; axis++)
            for (int lane = 0; lane < lanes; lane++) {
                const float a = leaf.vertex[axis][lane], b = a + leaf.edge1[axis][lane],
                            c = a + leaf.edge2[axis][lane];
                const float lower = a < b ? a : b, higher = a > b ? a : b;
                low[axis][lane] = c < lower ? c : lower;
                high[axis][lane] = c > higher ? c : higher;
            }
    }
    [[nodiscard]] Intervals<6> intervals() const { return {low, high}; }
};

} // namespace phantom::fdh
