// SPDX-License-Identifier: GPL-2.0-or-later
// From a point to a triangle in float, one triangle at a time: what a callback of a library that knows only
// boxes has to compute. Ericson, Real-Time Collision Detection, 5.1.5, which leaves early for corners and
// edges.
#pragma once

#include <algorithm>
#include <array>

namespace phantom::peers {

struct FloatVector {
    float x, y, z;
};

inline FloatVector operator-(const FloatVector& a, const FloatVector& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline FloatVector operator*(float s, const FloatVector& a)
{
    return {s * a.x, s * a.y, s * a.z};
}
inline float dot(const FloatVector& a, const FloatVector& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline FloatVector cross(const FloatVector& a, const FloatVector& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline FloatVector as_vector(const std::array<float, 4>& a)
{
    return {a[0], a[1], a[2]};
}

/// Squared distance from q to the segment from 0 to e; of no length as well.
inline float squared_to_segment(const FloatVector& q, const FloatVector& e)
{
    const float length2 = dot(e, e), along = dot(q, e);
    const FloatVector away = q - (length2 > 0 ? std::clamp(along / length2, 0.0F, 1.0F) : 0.0F) * e;
    return dot(away, away);
}

/// Squared distance from p to the triangle a b c; without area as well.
inline float squared_distance(const FloatVector& p, const FloatVector& a, const FloatVector& b,
                              const FloatVector& c)
{
    const FloatVector ab = b - a, ac = c - a, ap = p - a;
    const float d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0)
        return dot(ap, ap);
    const FloatVector bp = p - b;
    const float d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3)
        return dot(bp, bp);
    const FloatVector cp = p - c;
    const float d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6)
        return dot(cp, cp);
    const float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    const FloatVector normal = cross(ab, ac);
    const float area2 = dot(normal, normal);
    // Products of lengths to the fourth: a sliver's signs are noise, so its edges are asked instead.
    if (va > 0 && vb > 0 && vc > 0 && area2 > 1e-8F * dot(ab, ab) * dot(ac, ac)) {
        const float height = dot(ap, normal);
        return height * height / area2;
    }
    return std::min({squared_to_segment(ap, ab), squared_to_segment(ap, ac), squared_to_segment(bp, c - b)});
}

} // namespace phantom::peers
