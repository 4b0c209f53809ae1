// SPDX-License-Identifier: GPL-2.0-or-later
// The grid a tree rounds its vertices to, and what that rounding is worth.
//
// A tree stores vertices as whole numbers of grid steps from its own origin, |number| <= 2^23. The step is
// a power of two, so scaling is exact. What this buys:
//   - edges (<= 2^24 steps) are exact in float, the normal (<= 2^49 square steps) is exact in double, so a
//     degenerate triangle is recognised exactly and a needle's plane is its true plane;
//   - hulls are exact, but for projections above 2^24 steps, which are rounded outward;
//   - a mesh 5e9 mm from the origin, 10 um or 1e50 mm across gives the same tree as at the origin at unit
//   size.
// What it costs: a vertex moves by at most half a step per coordinate. For a mesh 120 mm across the step is
// 7.6 nm. A triangle moves by no more than its vertices do, so neither does any distance.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>

#include "fdh/hull.hpp"

namespace phantom::fdh {

struct Grid {
    Point origin{0, 0, 0};
    double step = 1;           ///< power of two [mesh unit]
    double steps_per_unit = 1; ///< 1 / step: exact

    /// Whole steps from the centre of a box to its faces, at most.
    static constexpr double half_extent_steps = 8388608; // 2^23
    /// Finest step: with largest_coordinate it keeps squared distances in steps finite.
    static constexpr int finest_exponent = -150;
    /// Rounding of everything computed in double (origin shift, pose, distance), relative to the distance
    /// from the origin: about 20 operations of 2^-53 each, with a wide margin.
    static constexpr double arithmetic = 0x1p-46;

    /// Centred on the box; its half extent is at most 2^23 steps.
    static Grid over(const Point& low, const Point& high)
    {
        Grid grid;
        double half = 0;
        for (int i = 0; i < 3; i++) {
            grid.origin[i] = low[i] + (high[i] - low[i]) / 2;
            half = std::max({half, high[i] - grid.origin[i], grid.origin[i] - low[i]});
        }
        int exponent = 0;
        std::frexp(half, &exponent); // half < 2^exponent
        grid.step = std::ldexp(1.0, half > 0 ? std::max(exponent - 23, finest_exponent) : finest_exponent);
        grid.steps_per_unit = 1 / grid.step;
        return grid;
    }

    /// In steps from the origin, unrounded.
    [[nodiscard]] Point to_steps(const Point& p) const
    {
        return {(p[0] - origin[0]) * steps_per_unit, (p[1] - origin[1]) * steps_per_unit,
                (p[2] - origin[2]) * steps_per_unit};
    }

    /// A vertex of the mesh, rounded to whole steps: exact as float.
    [[nodiscard]] std::array<float, 3> round(const Point& vertex) const
    {
        // Where doubles are one apart, a sum rounds to a whole number; no library call.
        constexpr double whole = 0x1.8p52;
        const Point s = to_steps(vertex);
        return {static_cast<float>(s[0] + whole - whole), static_cast<float>(s[1] + whole - whole),
                static_cast<float>(s[2] + whole - whole)};
    }

    /// How far a vertex moved at most [mesh unit]: half the diagonal of a step, and a little for the origin
    /// shift.
    [[nodiscard]] double vertex_error() const { return 0.8661 * step; }

    /// Bound of |computed - true| distance for a query from a point at `steps`.
    [[nodiscard]] double distance_error(const Point& steps) const
    {
        const double far =
            std::abs(steps[0]) + std::abs(steps[1]) + std::abs(steps[2]) + 3 * half_extent_steps;
        return vertex_error() + arithmetic * far * step;
    }
};

/// The next float up or down; of an infinity, itself.
inline float next_up(float f)
{
    if (!(f < std::numeric_limits<float>::infinity()))
        return f;
    const auto bits = std::bit_cast<std::int32_t>(f + 0.0f); // no -0
    return std::bit_cast<float>(bits >= 0 ? bits + 1 : bits - 1);
}
inline float next_down(float f)
{
    return -next_up(-f);
}

/// Nearest float not above / not below x.
inline float round_down(double x)
{
    const auto f = static_cast<float>(x);
    return f > x ? next_down(f) : f;
}
inline float round_up(double x)
{
    const auto f = static_cast<float>(x);
    return f < x ? next_up(f) : f;
}

} // namespace phantom::fdh
