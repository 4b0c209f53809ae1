// SPDX-License-Identifier: GPL-2.0-or-later
#include "distance.hpp"

#include <algorithm>
#include <cmath>

namespace phantom::hard {

namespace {

/// Two faces that meet at the nearest point are equally near, but for rounding (mm).
constexpr double as_near = 1e-9;

/// From the point to the nearest point of the triangle.
Vec3 way_to(const reference::Triangle& t, const Vec3& area, const Vec3& p)
{
    Vec3 best{1e150, 0, 0};
    bool over = true;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 e = subtract(t.corner[(i + 1) % 3], t.corner[i]), q = subtract(p, t.corner[i]);
        over = over && dot(cross(area, e), q) >= 0;
        const double along = dot(e, e) > 0 ? std::clamp(dot(e, q) / dot(e, e), 0.0, 1.0) : 0.0;
        const Vec3 way = subtract(scale(along, e), q);
        if (dot(way, way) < dot(best, best))
            best = way;
    }
    if (!over)
        return best;
    return scale(-dot(area, subtract(p, t.corner[0])) / dot(area, area), area);
}

} // namespace

Nearest nearest(const std::vector<reference::Triangle>& mesh, const Vec3& point)
{
    Nearest out;
    double facing = 0;
    for (const reference::Triangle& t : mesh) {
        const Vec3 area = cross(subtract(t.corner[1], t.corner[0]), subtract(t.corner[2], t.corner[0]));
        if (t.fan || !(dot(area, area) > 0))
            continue;
        const double distance = length(way_to(t, area, point));
        if (distance > out.distance + as_near)
            continue;
        const double height = dot(unit(area), subtract(point, t.corner[0]));
        if (distance < out.distance - as_near || std::abs(height) > std::abs(facing)) {
            facing = height;
            out.in_front = height >= 0;
        }
        out.distance = std::min(out.distance, distance);
    }
    return out;
}

} // namespace phantom::hard
