// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/polygon.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

/// A turn by less than this (sine of the angle) goes straight on: rounding of the coordinates.
constexpr double straight = 1e-12;

/// A corner farther off the plane than this part of the polygon's size makes it bent.
constexpr double flat = 1e-6;

/// So often all that is left is looked at again for ears.
constexpr int looks_max = 4;

/// Twice the area of a triangle over its longest side's square: 0 for a line, 0.87 for an equilateral one.
double shape(const Vec3& a, const Vec3& b, const Vec3& c)
{
    const Vec3 u = subtract(b, a), v = subtract(c, a), w = subtract(c, b);
    const double longest = std::max({dot(u, u), dot(v, v), dot(w, w)});
    return longest > 0 ? length(cross(u, v)) / longest : 0;
}

} // namespace

/// Along the axis that the normal (Newell's: twice the area over each coordinate plane) is next to.
bool PolygonCutter::project()
{
    normal_ = {0, 0, 0};
    const Vec3& origin = corners_.front();
    for (std::size_t i = 0; i < corners_.size(); ++i)
        normal_ = add(normal_, cross(subtract(corners_[i], origin),
                                     subtract(corners_[(i + 1) % corners_.size()], origin)));
    std::size_t axis = 0;
    for (const std::size_t other : {1U, 2U}) {
        if (std::abs(normal_[other]) > std::abs(normal_[axis]))
            axis = other;
    }
    if (!(std::abs(normal_[axis]) > 0) || !is_finite(normal_))
        return false;
    std::size_t x = (axis + 1) % 3, y = (axis + 2) % 3;
    if (normal_[axis] < 0)
        std::swap(x, y);
    points_.clear();
    for (const Vec3& corner : corners_)
        points_.push_back({corner[x] - origin[x], corner[y] - origin[y]});
    normal_ = normalized(normal_);
    return true;
}

bool PolygonCutter::turns_left(std::uint32_t a, std::uint32_t b, std::uint32_t c) const
{
    const double ux = points_[b].x - points_[a].x, uy = points_[b].y - points_[a].y;
    const double vx = points_[c].x - points_[b].x, vy = points_[c].y - points_[b].y;
    return ux * vy - uy * vx > straight * std::sqrt((ux * ux + uy * uy) * (vx * vx + vy * vy));
}

/// Turns left at every corner, and goes round once: there is one leftmost corner.
bool PolygonCutter::is_convex() const
{
    const auto count = static_cast<std::uint32_t>(points_.size());
    std::uint32_t turns_back = 0; // of x
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t j = (i + 1) % count, k = (i + 2) % count;
        if (!turns_left(i, j, k))
            return false;
        turns_back += points_[i].x > points_[j].x && points_[j].x <= points_[k].x;
    }
    return turns_back == 1;
}

bool PolygonCutter::is_flat() const
{
    double off = 0, size = 0;
    for (const Vec3& corner : corners_) {
        const Vec3 out = subtract(corner, corners_.front());
        off = std::max(off, std::abs(dot(normal_, out)));
        size = std::max(size, dot(out, out));
    }
    return off <= flat * std::sqrt(size);
}

/// The turns at the corners of an outline that does not cross itself add up to one (Hopf's Umlaufsatz).
bool PolygonCutter::goes_round_once() const
{
    const std::size_t count = points_.size();
    double sum = 0, ux = 0, uy = 0;
    for (std::size_t i = 0; i < 2 * count; ++i) {
        const Point &a = points_[i % count], &b = points_[(i + 1) % count];
        const double vx = b.x - a.x, vy = b.y - a.y;
        if (vx == 0 && vy == 0)
            continue; // the same place twice
        if (i >= count)
            sum += std::atan2(ux * vy - uy * vx, ux * vx + uy * vy);
        ux = vx;
        uy = vy;
    }
    return std::abs(sum - 2 * std::numbers::pi) < 1;
}

bool PolygonCutter::cut_quadrilateral(std::vector<Triple>& out) const
{
    const auto bend = [this](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        const auto normal = [this](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
            return cross(subtract(corners_[j], corners_[i]), subtract(corners_[k], corners_[i]));
        };
        return angle_between(normal(a, b, c), normal(a, c, d));
    };
    // The second only where it is clearly better: rounding must not decide.
    if (bend(1, 2, 3, 0) < bend(0, 1, 2, 3) - 1e-6)
        out.insert(out.end(), {{1, 2, 3}, {1, 3, 0}});
    else
        out.insert(out.end(), {{0, 1, 2}, {0, 2, 3}});
    return true;
}

bool PolygonCutter::cut(std::span<const Vec3> corners, std::vector<Triple>& out)
{
    corners_ = corners;
    const auto count = static_cast<std::uint32_t>(corners.size());
    const bool seen = count > 3 && project();
    const bool convex = seen && is_convex();
    if (convex && count == 4 && !is_flat())
        return cut_quadrilateral(out);
    if (seen && !(convex && is_flat()))
        return clip_ears(out);
    bool has_area = false;
    for (std::uint32_t i = 1; i + 1 < count; ++i) {
        out.push_back({0, i, i + 1});
        has_area = has_area || shape(corners[0], corners[i], corners[i + 1]) > straight;
    }
    // parts with an area that add up to none lie one against the other
    return count == 3 || seen || !has_area;
}

std::size_t PolygonCutter::cell_of(double at, double low, double high) const
{
    const double part = high > low ? std::clamp((at - low) / (high - low), 0.0, 1.0) : 0;
    return std::min(side_ - 1, static_cast<std::size_t>(part * static_cast<double>(side_)));
}

/// Only corners that do not turn left can lie in an ear.
void PolygonCutter::sort_into_cells()
{
    const auto count = static_cast<std::uint32_t>(points_.size());
    low_ = high_ = points_.front();
    for (const Point& p : points_) {
        low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
        high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
    }
    side_ = static_cast<std::size_t>(std::sqrt(count / 4.0)) + 1;
    first_.assign(side_ * side_ + 1, 0);
    const auto cell = [this](std::uint32_t i) {
        return cell_of(points_[i].x, low_.x, high_.x) * side_ + cell_of(points_[i].y, low_.y, high_.y);
    };
    const auto hollow = [&](std::uint32_t i) { return !turns_left(before_[i], i, after_[i]); };
    for (std::uint32_t i = 0; i < count; ++i)
        first_[cell(i) + 1] += hollow(i);
    for (std::size_t c = 0; c < side_ * side_; ++c)
        first_[c + 1] += first_[c];
    in_cell_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < count; ++i) {
        if (hollow(i))
            in_cell_[next[cell(i)]++] = i;
    }
}

bool PolygonCutter::holds_another(std::uint32_t corner) const
{
    const std::uint32_t ia = before_[corner], ic = after_[corner];
    const Point &a = points_[ia], &b = points_[corner], &c = points_[ic];
    const auto side = [](const Point& from, const Point& to, const Point& p) {
        const double ux = to.x - from.x, uy = to.y - from.y, vx = p.x - from.x, vy = p.y - from.y;
        return ux * vy - uy * vx >= -straight * std::sqrt((ux * ux + uy * uy) * (vx * vx + vy * vy));
    };
    const std::size_t left = cell_of(std::min({a.x, b.x, c.x}), low_.x, high_.x);
    const std::size_t right = cell_of(std::max({a.x, b.x, c.x}), low_.x, high_.x);
    const std::size_t bottom = cell_of(std::min({a.y, b.y, c.y}), low_.y, high_.y);
    const std::size_t top = cell_of(std::max({a.y, b.y, c.y}), low_.y, high_.y);
    for (std::size_t x = left; x <= right; ++x) {
        for (std::uint32_t i = first_[x * side_ + bottom]; i < first_[x * side_ + top + 1]; ++i) {
            const std::uint32_t other = in_cell_[i];
            const Point& p = points_[other];
            // a bridge to a hole comes to the same place twice
            const auto is_at = [&p](const Point& q) { return p.x == q.x && p.y == q.y; };
            if (stamp_[other] == no_neighbour || is_at(a) || is_at(b) || is_at(c))
                continue;
            if (side(a, b, p) && side(b, c, p) && side(c, a, p))
                return true;
        }
    }
    return false;
}

bool PolygonCutter::is_ear(std::uint32_t corner) const
{
    return turns_left(before_[corner], corner, after_[corner]) && !holds_another(corner);
}

double PolygonCutter::shape_of(std::uint32_t corner) const
{
    return shape(corners_[before_[corner]], corners_[corner], corners_[after_[corner]]);
}

void PolygonCutter::consider(std::uint32_t corner)
{
    ++stamp_[corner];
    if (!is_ear(corner))
        return;
    ears_.push_back({shape_of(corner), corner, stamp_[corner]});
    std::push_heap(ears_.begin(), ears_.end());
}

void PolygonCutter::clip(std::uint32_t corner, std::vector<Triple>& out)
{
    const std::uint32_t a = before_[corner], c = after_[corner];
    out.push_back({a, corner, c});
    stamp_[corner] = no_neighbour;
    after_[a] = c;
    before_[c] = a;
}

std::uint32_t PolygonCutter::best_ear()
{
    while (!ears_.empty()) {
        std::pop_heap(ears_.begin(), ears_.end());
        const Ear ear = ears_.back();
        ears_.pop_back();
        if (stamp_[ear.corner] == ear.stamp)
            return ear.corner;
    }
    return no_neighbour;
}

bool PolygonCutter::clip_ears(std::vector<Triple>& out)
{
    const auto count = static_cast<std::uint32_t>(corners_.size());
    before_.resize(count);
    after_.resize(count);
    stamp_.assign(count, 0);
    ears_.clear();
    for (std::uint32_t i = 0; i < count; ++i) {
        before_[i] = (i + count - 1) % count;
        after_[i] = (i + 1) % count;
    }
    sort_into_cells();
    for (std::uint32_t i = 0; i < count; ++i)
        consider(i);
    bool clean = goes_round_once();
    int looks_left = looks_max;
    std::uint32_t any = 0; // a corner that is left
    for (std::uint32_t left = count; left > 3; --left) {
        std::uint32_t corner = best_ear();
        for (; corner == no_neighbour && looks_left > 0; --looks_left, corner = best_ear()) {
            // only rounding can have hidden one: an outline that does not cross itself has two
            for (std::uint32_t i = 0; i < count; ++i) {
                if (stamp_[i] != no_neighbour)
                    consider(i);
            }
        }
        if (corner == no_neighbour) {
            clean = false;
            corner = any;
        }
        any = after_[corner];
        clip(corner, out);
        // others become ears only by a change of the outline beside them
        consider(before_[any]);
        consider(any);
    }
    clip(any, out);
    return clean;
}

} // namespace phantom::mesh
