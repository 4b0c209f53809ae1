// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/nearest_on_triangle.hpp"

#include <algorithm>

#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

/// Part of the way from a to b.
double nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b)
{
    const Vec3 ab = subtract(b, a);
    const double squared = dot(ab, ab);
    return squared > 0 ? std::clamp(dot(subtract(p, a), ab) / squared, 0.0, 1.0) : 0.0;
}

Vec3 point_of(const std::array<Vec3, 3>& x, const std::array<double, 3>& weights)
{
    return add(add(scaled(x[0], weights[0]), scaled(x[1], weights[1])), scaled(x[2], weights[2]));
}

} // namespace

std::array<double, 3> nearest_on_triangle(const Vec3& p, const std::array<Vec3, 3>& x)
{
    const Vec3 e1 = subtract(x[1], x[0]), e2 = subtract(x[2], x[0]), q = subtract(p, x[0]);
    const double d11 = dot(e1, e1), d12 = dot(e1, e2), d22 = dot(e2, e2), q1 = dot(q, e1), q2 = dot(q, e2);
    const double determinant = d11 * d22 - d12 * d12;
    if (determinant > 0) {
        const double v = (d22 * q1 - d12 * q2) / determinant, w = (d11 * q2 - d12 * q1) / determinant;
        if (v >= 0 && w >= 0 && v + w <= 1)
            return {1 - v - w, v, w};
    }
    std::array<double, 3> best{1, 0, 0};
    double best_squared = -1;
    for (std::size_t from = 0; from < 3; ++from) {
        const std::size_t to = (from + 1) % 3;
        const double part = nearest_on_segment(p, x[from], x[to]);
        std::array<double, 3> weights{};
        weights[from] = 1.0 - part;
        weights[to] = part;
        const Vec3 away = subtract(p, point_of(x, weights));
        const double squared = dot(away, away);
        if (best_squared < 0 || squared < best_squared) {
            best_squared = squared;
            best = weights;
        }
    }
    return best;
}

double distance_to_triangle(const Vec3& p, const std::array<Vec3, 3>& x)
{
    return distance(p, point_of(x, nearest_on_triangle(p, x)));
}

} // namespace phantom::mesh
