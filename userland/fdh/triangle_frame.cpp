// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/triangle_frame.hpp"

#include <algorithm>

namespace phantom::fdh {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Height over longest edge below which rounding leaves no normal. What is left out then is that thin.
constexpr double thinnest = 0x1p-50;

double inverse(double squared)
{
    return squared > 0 ? 1 / squared : 0;
}

/// Squared distance from p, relative to a segment's start, to the segment.
double squared_distance(const Point& p, const Point& direction, double inverse2)
{
    const double t = std::clamp(dot(p, direction) * inverse2, 0.0, 1.0);
    const Point r = plus(p, -t, direction);
    return dot(r, r);
}

/// Squared distance between two lines' nearest places where those lie within both segments, d from 0 and e
/// from w; infinite if they do not: then an end is nearest.
///
/// Of nearly parallel lines the places are found as badly as it matters little: with c = d × e, the parameter
/// is off by rounding / |sin|, and a way along the line alters the distance by |sin| times that. (d·d e·e -
/// (d·e)² for |c|² would square the loss.) What is returned is a distance between places of the two.
double between_lines2(const Point& d, const Point& w, const Point& e, double inverse_e2)
{
    const Point c = cross(d, e);
    const double cc = dot(c, c), s = dot(cross(w, e), c);
    if (!(s >= 0 && s <= cc && cc > 0))
        return infinity;
    const Point p = plus(w, -s / cc, d); // from the place on d to the start of e
    return squared_distance({-p[0], -p[1], -p[2]}, e, inverse_e2);
}

/// Of the interval between a and b from [0, high].
double gap(double a, double b, double high)
{
    return std::max({std::min(a, b) - high, -std::max(a, b), 0.0});
}

} // namespace

TriangleFrame::TriangleFrame(const Corners& corners) : corners_(corners)
{
    double longest = -1;
    int first = 0;
    for (int i = 0; i < 3; i++) {
        const Point e = minus(corners[(i + 1) % 3], corners[i]);
        if (const double squared = dot(e, e); squared > longest) {
            longest = squared;
            first = i;
        }
    }
    std::rotate(corners_.begin(), corners_.begin() + first, corners_.end());
    for (int i = 0; i < 3; i++) {
        edges_[i] = minus(corners_[(i + 1) % 3], corners_[i]);
        inverse2_[i] = inverse(dot(edges_[i], edges_[i]));
    }
    flat_ = true;
    base_ = std::sqrt(longest);
    if (!(base_ > 0))
        return;
    const Point &e = edges_[0], v = minus(corners_[2], corners_[0]);
    x_ = {e[0] / base_, e[1] / base_, e[2] / base_};
    Point n = cross(e, v);
    n = plus(n, -dot(n, x_), x_); // rounding may have left a part along the edge
    const double area2 = length(n);
    flat_ = !(area2 > thinnest * longest);
    if (flat_)
        return;
    z_ = {n[0] / area2, n[1] / area2, n[2] / area2};
    y_ = cross(z_, x_);
    apex_x_ = dot(v, x_);
    apex_y_ = area2 / base_;
}

Point TriangleFrame::to_frame(const Point& p) const
{
    const Point w = minus(p, corners_[0]);
    return {dot(w, x_), dot(w, y_), dot(w, z_)};
}

bool TriangleFrame::over(double x, double y) const
{
    return y >= 0 && apex_x_ * y <= apex_y_ * x && (base_ - apex_x_) * y <= apex_y_ * (base_ - x);
}

/// Over the interior the distance is |z|: least at an end, or nothing where z changes sign. That place is
/// found badly along a segment nearly parallel to the plane, but it is a place of the segment and at z = 0:
/// if it is over the triangle they meet, and if it is not and should be, the border is as near.
double TriangleFrame::to_interior(const Point& from, const Point& to) const
{
    double best = infinity;
    if (over(from[0], from[1]))
        best = std::abs(from[2]);
    if (over(to[0], to[1]))
        best = std::min(best, std::abs(to[2]));
    if ((from[2] < 0) != (to[2] < 0)) {
        const double t = from[2] / (from[2] - to[2]);
        if (over(from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])))
            best = 0;
    }
    return best;
}

double TriangleFrame::box_bound(const Point& from, const Point& to) const
{
    const double x = gap(from[0], to[0], base_), y = gap(from[1], to[1], apex_y_), z = gap(from[2], to[2], 0);
    return std::sqrt(x * x + y * y + z * z);
}

double TriangleFrame::to_border2(const Point& p) const
{
    double best = infinity;
    for (int i = 0; i < 3; i++)
        best = std::min(best, squared_distance(minus(p, corners_[i]), edges_[i], inverse2_[i]));
    return best;
}

double TriangleFrame::to_border2(const Segment& segment) const
{
    const Point way = minus(segment.to, segment.from);
    const double inverse2 = inverse(dot(way, way));
    if (inverse2 == 0)
        return to_border2(segment.from);
    double best = std::min(to_border2(segment.from), to_border2(segment.to));
    for (int i = 0; i < 3; i++) {
        const Point w = minus(corners_[i], segment.from);
        best = std::min(
            {best, squared_distance(w, way, inverse2), between_lines2(way, w, edges_[i], inverse2_[i])});
    }
    return best;
}

double TriangleFrame::distance(const Segment& segment, double limit) const
{
    double interior = infinity;
    if (!flat_) {
        const Point from = to_frame(segment.from), to = to_frame(segment.to);
        if (const double bound = box_bound(from, to); bound > limit)
            return bound;
        interior = to_interior(from, to);
        // All of it over the triangle: no edge is nearer.
        if (interior == 0 || (over(from[0], from[1]) && over(to[0], to[1])))
            return interior;
    }
    return std::min(interior, std::sqrt(to_border2(segment)));
}

double TriangleFrame::distance(const Point& p) const
{
    const Point q = flat_ ? Point{} : to_frame(p);
    return !flat_ && over(q[0], q[1]) ? std::abs(q[2]) : std::sqrt(to_border2(p));
}

double TriangleFrame::distance(const TriangleFrame& other, double limit) const
{
    // An edge of one of them is at the nearest place.
    double best = infinity;
    for (int i = 0; i < 3 && best > 0; i++)
        best = std::min(best, distance(other.edge(i), std::min(limit, best)));
    if (!other.flat_)
        for (int i = 0; i < 3 && best > 0; i++)
            best = std::min(
                best, other.to_interior(other.to_frame(corners_[i]), other.to_frame(corners_[(i + 1) % 3])));
    return best;
}

} // namespace phantom::fdh
