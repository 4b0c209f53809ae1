// SPDX-License-Identifier: GPL-2.0-or-later
// Arithmetic on points and directions as the user side writes them: std::array of three doubles.
#pragma once

#include <array>
#include <cmath>

namespace phantom {

using Vec3 = std::array<double, 3>;

inline Vec3 operator+(const Vec3& a, const Vec3& b)
{
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vec3 operator-(const Vec3& a, const Vec3& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vec3 operator*(double s, const Vec3& a)
{
    return {s * a[0], s * a[1], s * a[2]};
}
inline double dot(const Vec3& a, const Vec3& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vec3 cross(const Vec3& a, const Vec3& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Vec3& a)
{
    return std::sqrt(dot(a, a));
}

/// a / |a|, or `otherwise` where a has no direction.
inline Vec3 unit_or(const Vec3& a, const Vec3& otherwise)
{
    const double norm = length(a);
    return norm > 1e-12 ? (1.0 / norm) * a : otherwise;
}

/// a / |a|; +z where a has no direction.
inline Vec3 unit(const Vec3& a)
{
    return unit_or(a, {0, 0, 1});
}

/// A unit vector at right angles to the unit vector n, as near to `wish` as can be.
inline Vec3 perpendicular(const Vec3& n, const Vec3& wish)
{
    const Vec3 flat = wish - dot(wish, n) * n;
    if (length(flat) > 1e-6)
        return unit_or(flat, {});
    const Vec3 axis = std::abs(n[0]) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    return unit_or(axis - dot(axis, n) * n, {0, 0, 1});
}

} // namespace phantom
