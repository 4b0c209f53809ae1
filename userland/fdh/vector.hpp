// SPDX-License-Identifier: GPL-2.0-or-later
// Arithmetic on points in double.
#pragma once

#include <cmath>

#include "fdh/hull.hpp"

namespace phantom::fdh {

using Corners = std::array<Point, 3>; ///< of a triangle

struct Segment {
    Point from, to;
};

inline Point minus(const Point& a, const Point& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
/// a + t b
inline Point plus(const Point& a, double t, const Point& b)
{
    return {a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]};
}
inline double dot(const Point& a, const Point& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Point cross(const Point& a, const Point& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Point& a)
{
    return std::sqrt(dot(a, a));
}

} // namespace phantom::fdh
