// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/triangle_box.hpp"

#include <algorithm>

namespace phantom::fdh {

namespace {

/// A convex polygon. A triangle gains a corner per plane; where rounding lets a plane that it nearly lies in
/// cut it more often than twice, half as many again as it has: 3, 4, 6, 9, 13, 19, 28.
struct Polygon {
    std::array<Point, 28> corners;
    int count = 0;

    void add(const Point& p) { corners[count++] = p; }
};

/// Keeps what is on the inner side of a plane: sign * coordinate >= sign * bound (Sutherland & Hodgman 1974).
/// A new corner lies between two old ones; where along them is rounded, which is as if the old corners had
/// been moved by rounding across the plane.
Polygon clipped(const Polygon& polygon, int axis, double sign, double bound)
{
    Polygon kept;
    for (int i = 0; i < polygon.count; i++) {
        const Point &a = polygon.corners[i], &b = polygon.corners[(i + 1) % polygon.count];
        const double inside_a = sign * (a[axis] - bound), inside_b = sign * (b[axis] - bound);
        if (inside_a >= 0)
            kept.add(a);
        if ((inside_a >= 0) != (inside_b >= 0))
            kept.add(plus(a, inside_a / (inside_a - inside_b), minus(b, a)));
    }
    return kept;
}

} // namespace

bool touches_box(const Corners& triangle, const Point& low, const Point& high)
{
    double magnitude = 0;
    for (int axis = 0; axis < 3; axis++) {
        const auto [least, most] = std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
        if (least > high[axis] || most < low[axis] || low[axis] > high[axis])
            return false;
        magnitude = std::max({magnitude, -least, most});
    }
    for (const Point& corner : triangle)
        if (corner[0] >= low[0] && corner[0] <= high[0] && corner[1] >= low[1] && corner[1] <= high[1] &&
            corner[2] >= low[2] && corner[2] <= high[2])
            return true;
    // Half of what is promised: the clipping rounds, too.
    const double slack = 0.5 * box_rounding * magnitude;
    Polygon polygon;
    for (const Point& corner : triangle)
        polygon.add(corner);
    for (int axis = 0; axis < 3 && polygon.count > 0; axis++)
        polygon = clipped(clipped(polygon, axis, 1, low[axis] - slack), axis, -1, high[axis] + slack);
    return polygon.count > 0;
}

} // namespace phantom::fdh
