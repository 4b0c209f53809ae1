// SPDX-License-Identifier: GPL-2.0-or-later
// Hulls as intervals in double, one per direction: what a query asks with, and what posed objects are
// compared by. A point, a segment and a box are hulls, too.
#pragma once

#include <algorithm>
#include <cmath>

#include "fdh/hull.hpp"

namespace phantom::fdh {

/// Low and high in each direction of hull_directions<K>(). low > high: nothing is inside.
template <int K>
using Slabs = std::array<std::array<double, 2>, K / 2>;

template <int K>
Slabs<K> empty_slabs()
{
    Slabs<K> slabs;
    slabs.fill({std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()});
    return slabs;
}

/// A hull that holds the point: three products and two additions round far below the slack.
template <int K>
Slabs<K> slabs_of(const Point& p)
{
    constexpr auto directions = hull_directions<K>();
    const double slack = 0x1p-50 * (std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]));
    Slabs<K> slabs;
    for (int k = 0; k < K / 2; k++) {
        const auto& d = directions[k];
        const double x = d[0] * p[0] + d[1] * p[1] + d[2] * p[2];
        slabs[k] = {x - slack, x + slack};
    }
    return slabs;
}

/// A hull that holds the box, as far as there can be anything in it.
template <int K>
Slabs<K> slabs_of_box(const Box& box)
{
    constexpr auto directions = hull_directions<K>();
    constexpr double far = 8 * largest_coordinate; // beyond any posed vertex; infinities would make NaNs
    Slabs<K> slabs;
    for (int k = 0; k < K / 2; k++) {
        double low = 0, high = 0, magnitude = 0;
        for (int axis = 0; axis < 3; axis++) {
            const double d = directions[k][axis];
            const double a = std::clamp(box.low[axis], -far, far), b = std::clamp(box.high[axis], -far, far);
            low += std::min(d * a, d * b);
            high += std::max(d * a, d * b);
            magnitude += std::max(std::abs(a), std::abs(b));
        }
        slabs[k] = {low - 0x1p-50 * magnitude, high + 0x1p-50 * magnitude};
    }
    return slabs;
}

/// Makes `slabs` hold `other` as well.
template <int K>
void grow(Slabs<K>& slabs, const Slabs<K>& other)
{
    for (int k = 0; k < K / 2; k++)
        slabs[k] = {std::min(slabs[k][0], other[k][0]), std::max(slabs[k][1], other[k][1])};
}

/// Lower bound of the squared distance between two shapes from the gaps between their hulls. gap2(k) is the
/// square of the gap in direction k, 0 where the intervals meet. With w the vector between the shapes'
/// nearest points, |d·w| is at least the gap, so
///   axes            |w|² >= Σ gap²
///   cube diagonals  |w|² >= gap²/3 each, and Σ gap² / 4, because Σ d dᵀ = 4 I
///   face diagonals  |w|² >= (gap² + gap'²)/2 + g² for the two in the plane of two axes and g of the third
/// and the largest holds.
/// Scalar is the type of one gap; gap2 may return it or a vector of it.
template <int K, class Scalar, class Gap2>
auto squared_distance_bound(const Gap2& gap2)
{
    auto larger = [](auto a, auto b) { return a > b ? a : b; };
    const auto x = gap2(0), y = gap2(1), z = gap2(2);
    auto bound = x + y + z;
    if constexpr (K == 14 || K == 26) {
        const auto a = gap2(3), b = gap2(4), c = gap2(5), d = gap2(6);
        bound = larger(bound, larger(larger(a, b), larger(c, d)) * Scalar(1.0 / 3));
        bound = larger(bound, ((a + b) + (c + d)) * Scalar(0.25));
    }
    if constexpr (K == 18 || K == 26) {
        constexpr int first = K == 18 ? 3 : 7;
        bound = larger(bound, (gap2(first) + gap2(first + 1)) * Scalar(0.5) + z);
        bound = larger(bound, (gap2(first + 2) + gap2(first + 3)) * Scalar(0.5) + y);
        bound = larger(bound, (gap2(first + 4) + gap2(first + 5)) * Scalar(0.5) + x);
    }
    return bound;
}

/// Lower bound of the distance between what two hulls hold, rounding allowed for. Infinite if one is empty.
template <int K>
double distance_bound(const Slabs<K>& a, const Slabs<K>& b)
{
    const double squared = squared_distance_bound<K, double>([&](int k) {
        const double gap = std::max({a[k][0] - b[k][1], b[k][0] - a[k][1], 0.0});
        return gap * gap;
    });
    return std::sqrt(squared) * (1 - 0x1p-48);
}

} // namespace phantom::fdh
