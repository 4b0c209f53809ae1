// SPDX-License-Identifier: GPL-2.0-or-later
// Arithmetic on Vec3. Doubles, no contraction tricks: the same bits on every machine.
#pragma once

#include <cmath>

#include "mesh/mesh.hpp"

namespace phantom::mesh {

constexpr Vec3 add(const Vec3& a, const Vec3& b)
{
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

constexpr Vec3 subtract(const Vec3& a, const Vec3& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

constexpr Vec3 scaled(const Vec3& a, double factor)
{
    return {a[0] * factor, a[1] * factor, a[2] * factor};
}

constexpr double dot(const Vec3& a, const Vec3& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

constexpr Vec3 cross(const Vec3& a, const Vec3& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline double length(const Vec3& a)
{
    return std::sqrt(dot(a, a));
}

inline double distance(const Vec3& a, const Vec3& b)
{
    return length(subtract(a, b));
}

/// Unit vector, or zero where there is no direction (zero, NaN, infinite).
inline Vec3 normalized(const Vec3& a)
{
    const double size = length(a);
    if (size > 0 && std::isfinite(size))
        return scaled(a, 1.0 / size);
    // The square under- or overflowed: once more at unit scale.
    const double largest = std::fmax(std::abs(a[0]), std::fmax(std::abs(a[1]), std::abs(a[2])));
    if (!(largest > 0) || !std::isfinite(a[0] + a[1] + a[2]))
        return {0, 0, 0};
    const Vec3 unit = {a[0] / largest, a[1] / largest, a[2] / largest};
    return scaled(unit, 1.0 / length(unit));
}

inline bool is_finite(const Vec3& a)
{
    return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]);
}

/// Angle between two vectors in radians, exact for tiny and for straight angles; 0 for a zero vector.
inline double angle_between(const Vec3& a, const Vec3& b)
{
    return std::atan2(length(cross(a, b)), dot(a, b));
}

} // namespace phantom::mesh
