// SPDX-License-Identifier: GPL-2.0-or-later
// Three doubles.
#pragma once

#include <array>
#include <cmath>

namespace phantom::study {

using Vector = std::array<double, 3>;

inline Vector operator+(const Vector& a, const Vector& b)
{
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vector operator-(const Vector& a, const Vector& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vector operator*(double s, const Vector& a)
{
    return {s * a[0], s * a[1], s * a[2]};
}
inline double dot(const Vector& a, const Vector& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline double length(const Vector& a)
{
    return std::sqrt(dot(a, a));
}
/// a / |a|, or `otherwise` where a has no direction.
inline Vector unit(const Vector& a, const Vector& otherwise = {0, 0, 1})
{
    const double norm = length(a);
    return norm > 1e-12 ? (1.0 / norm) * a : otherwise;
}

} // namespace phantom::study
