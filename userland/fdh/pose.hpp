// SPDX-License-Identifier: GPL-2.0-or-later
// Hulls in other frames.
#pragma once

#include <algorithm>
#include <cmath>

#include "fdh/scene_tree.hpp"

namespace phantom::fdh {

inline bool finite(const Pose& pose)
{
    auto fits = [](double x) { return std::abs(x) <= largest_coordinate; };
    return std::all_of(pose.rotation.begin(), pose.rotation.end(), fits) &&
           std::all_of(pose.translation.begin(), pose.translation.end(), fits);
}

/// rotationᵀ (p - translation).
inline Point to_local(const Pose& pose, const Point& p)
{
    const auto& r = pose.rotation;
    const Point d = {p[0] - pose.translation[0], p[1] - pose.translation[1], p[2] - pose.translation[2]};
    return {r[0] * d[0] + r[3] * d[1] + r[6] * d[2], r[1] * d[0] + r[4] * d[1] + r[7] * d[2],
            r[2] * d[0] + r[5] * d[1] + r[8] * d[2]};
}

template <int K>
using Slabs = std::array<std::array<double, 2>, K / 2>; ///< low, high per direction of hull_directions<K>()

/// Upper bound of max c·x over a hull. The support function is sublinear: for c = Σ a_i d_i with a_i >= 0,
/// the bound Σ a_i h(d_i) holds. Tried are c over the axes alone, and one diagonal with the rest over the
/// axes.
template <int K>
double support_bound(const Slabs<K>& slabs, const Point& c)
{
    constexpr auto directions = hull_directions<K>();
    auto over_axes = [&](const Point& v) {
        double sum = 0;
        for (int axis = 0; axis < 3; axis++)
            sum += v[axis] == 0 ? 0 : v[axis] * slabs[axis][v[axis] > 0];
        return sum;
    };
    double best = over_axes(c);
    for (int k = 3; k < K / 2; k++) {
        const auto& d = directions[k];
        const bool positive = c[0] * d[0] + c[1] * d[1] + c[2] * d[2] > 0;
        for (int axis = 0; axis < 3; axis++) {
            // As much of the diagonal, in its own or the opposite sense, as leaves nothing along this axis.
            const double amount = d[axis] * c[axis]; // d is -1, 0 or 1
            if (amount == 0 || (amount > 0) != positive)
                continue;
            const Point rest = {c[0] - amount * d[0], c[1] - amount * d[1], c[2] - amount * d[2]};
            best = std::min(best, amount * slabs[k][positive] + over_axes(rest));
        }
    }
    return best;
}

/// A hull in world directions that holds the posed shape inside the given hull, rounding allowed for.
template <int K>
Slabs<K> posed_hull(const Slabs<K>& local, const Pose& pose)
{
    constexpr auto directions = hull_directions<K>();
    double magnitude = 0;
    for (int axis = 0; axis < 3; axis++)
        magnitude +=
            std::abs(pose.translation[axis]) + std::max(std::abs(local[axis][0]), std::abs(local[axis][1]));
    const double slack = 0x1p-46 * magnitude;
    Slabs<K> result;
    for (int k = 0; k < K / 2; k++) {
        Point world, c, opposite;
        for (int axis = 0; axis < 3; axis++)
            world[axis] = directions[k][axis];
        c = to_local({pose.rotation, {0, 0, 0}}, world);
        for (int axis = 0; axis < 3; axis++)
            opposite[axis] = -c[axis];
        const auto& t = pose.translation;
        const double shift = world[0] * t[0] + world[1] * t[1] + world[2] * t[2];
        result[k] = {shift - support_bound<K>(local, opposite) - slack,
                     shift + support_bound<K>(local, c) + slack};
    }
    return result;
}

} // namespace phantom::fdh
