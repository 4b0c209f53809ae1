// SPDX-License-Identifier: GPL-2.0-or-later
// Rigid poses, and hulls in other frames.
#pragma once

#include "fdh/slabs.hpp"

namespace phantom::fdh {

/// world = rotation * local + translation. rotation is orthonormal, row-major.
struct Pose {
    std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};
    Point translation{0, 0, 0};
};

inline bool finite(const Pose& pose)
{
    auto fits = [](double x) { return std::abs(x) <= largest_coordinate; };
    return std::all_of(pose.rotation.begin(), pose.rotation.end(), fits) &&
           std::all_of(pose.translation.begin(), pose.translation.end(), fits);
}

/// rotationᵀ v: a direction in the pose's frame.
inline Point rotate_back(const Pose& pose, const Point& v)
{
    const auto& r = pose.rotation;
    return {r[0] * v[0] + r[3] * v[1] + r[6] * v[2], r[1] * v[0] + r[4] * v[1] + r[7] * v[2],
            r[2] * v[0] + r[5] * v[1] + r[8] * v[2]};
}

/// rotationᵀ (p - translation).
inline Point to_local(const Pose& pose, const Point& p)
{
    const auto& t = pose.translation;
    return rotate_back(pose, {p[0] - t[0], p[1] - t[1], p[2] - t[2]});
}

/// `other` as seen from the frame of `pose`.
inline Pose relative_pose(const Pose& pose, const Pose& other)
{
    Pose relative;
    for (int column = 0; column < 3; column++) {
        const auto& r = other.rotation;
        const Point c = rotate_back(pose, {r[column], r[3 + column], r[6 + column]});
        for (int row = 0; row < 3; row++)
            relative.rotation[3 * row + column] = c[row];
    }
    relative.translation = to_local(pose, other.translation);
    return relative;
}

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

/// A hull in the directions of the frame that the pose leads to, which holds the posed shape inside the given
/// hull, rounding allowed for; `uncertainty` more where the pose itself was rounded [mesh unit].
template <int K>
Slabs<K> posed_hull(const Slabs<K>& local, const Pose& pose, double uncertainty = 0)
{
    constexpr auto directions = hull_directions<K>();
    double magnitude = 0;
    for (int axis = 0; axis < 3; axis++)
        magnitude +=
            std::abs(pose.translation[axis]) + std::max(std::abs(local[axis][0]), std::abs(local[axis][1]));
    const double slack = 0x1p-46 * magnitude + uncertainty;
    Slabs<K> result;
    for (int k = 0; k < K / 2; k++) {
        Point world, opposite;
        for (int axis = 0; axis < 3; axis++)
            world[axis] = directions[k][axis];
        const Point c = rotate_back(pose, world);
        for (int axis = 0; axis < 3; axis++)
            opposite[axis] = -c[axis];
        const auto& t = pose.translation;
        const double shift = world[0] * t[0] + world[1] * t[1] + world[2] * t[2];
        result[k] = {shift - support_bound<K>(local, opposite) - slack,
                     shift + support_bound<K>(local, c) + slack};
    }
    return result;
}

/// Lower bound of the distance between the posed shapes inside two hulls, as seen in the frame of `a`.
template <int K>
double distance_bound_in_frame(const Slabs<K>& a_local, const Pose& a, const Slabs<K>& b_local, const Pose& b)
{
    double magnitude = 0; // of what relative_pose rounds
    for (int axis = 0; axis < 3; axis++)
        magnitude += std::abs(a.translation[axis]) + std::abs(b.translation[axis]);
    return distance_bound<K>(a_local, posed_hull<K>(b_local, relative_pose(a, b), 0x1p-46 * magnitude));
}

} // namespace phantom::fdh
