// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/triangle_frame.hpp"

#include <algorithm>

namespace phantom::fdh {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Height over longest edge below which rounding leaves no normal. What is left out then is that thin.
constexpr double thinnest = 0x1p-50;

/// Where on s the foot of p lies: 0 at its start, 1 at its end.
double foot(const Point& p, const Point& from, const Point& direction)
{
    const double squared = dot(direction, direction);
    return squared > 0 ? std::clamp(dot(minus(p, from), direction) / squared, 0.0, 1.0) : 0;
}

/// Of the interval between a and b from [0, high].
double gap(double a, double b, double high)
{
    return std::max({std::min(a, b) - high, -std::max(a, b), 0.0});
}

} // namespace

double squared_distance(const Point& p, const Segment& s)
{
    const Point d = minus(s.to, s.from), w = minus(p, s.from);
    const Point r = plus(w, -foot(p, s.from, d), d);
    return dot(r, r);
}

/// The nearest places are an end of one of them, or where the common perpendicular meets both lines. Of
/// nearly parallel lines that is found as badly as it matters little: with c = d × e, an error of the
/// parameter is rounding / |sin|, and moves along the line by it change the distance by |sin| times that.
/// (d·d e·e - (d·e)² for |c|² would square the loss.) All candidates are distances between places of the two.
double squared_distance(const Segment& a, const Segment& b)
{
    double best = std::min({squared_distance(a.from, b), squared_distance(a.to, b),
                            squared_distance(b.from, a), squared_distance(b.to, a)});
    const Point d = minus(a.to, a.from), e = minus(b.to, b.from), c = cross(d, e);
    const double cc = dot(c, c);
    if (cc > 0) {
        const double s = std::clamp(dot(cross(minus(b.from, a.from), e), c) / cc, 0.0, 1.0);
        const Point q = plus(b.from, foot(plus(a.from, s, d), b.from, e), e);
        best = std::min(best, squared_distance(q, a));
    }
    return best;
}

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
    flat_ = true;
    base_ = std::sqrt(longest);
    if (!(base_ > 0))
        return;
    const Point e = minus(corners_[1], corners_[0]), v = minus(corners_[2], corners_[0]);
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

double TriangleFrame::distance(const Segment& segment, double limit) const
{
    double interior = infinity;
    if (!flat_) {
        const Point from = to_frame(segment.from), to = to_frame(segment.to);
        if (const double bound = box_bound(from, to); bound > limit)
            return bound;
        interior = to_interior(from, to);
        if (interior == 0)
            return 0;
    }
    double border2 = infinity;
    for (int i = 0; i < 3; i++)
        border2 = std::min(border2, squared_distance(segment, edge(i)));
    return std::min(interior, std::sqrt(border2));
}

double TriangleFrame::distance(const Point& p) const
{
    const Point q = flat_ ? Point{} : to_frame(p);
    if (!flat_ && over(q[0], q[1]))
        return std::abs(q[2]);
    return std::sqrt(
        std::min({squared_distance(p, edge(0)), squared_distance(p, edge(1)), squared_distance(p, edge(2))}));
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
