// SPDX-License-Identifier: GPL-2.0-or-later
// Distances from a triangle in double, to within rounding whatever its shape.
//
// The triangle is seen from a right-handed frame of its own: x along its longest edge, y in its plane towards
// the third corner (the apex), z along its normal. There it is (0, 0), (base, 0), (apex_x, apex_y), its sharp
// angles lie on the x axis, and whether a point is over it is decided by two numbers that one rounding made:
// of a needle, too, no point is over it that is beyond its tip. A frame is orthonormal even where rounding
// has tilted it about the longest edge, which moves no point of the triangle by more than rounding.
//
// Accuracy: a distance is off by at most `rounding` times the largest magnitude of a coordinate (differences
// of coordinates are rounded, so it is the coordinates that count). Nothing overflows while the squares of
// distances, and the product of the segment's and the triangle's length, stay below 1e150.
#pragma once

#include "fdh/vector.hpp"

namespace phantom::fdh {

class TriangleFrame {
  public:
    static constexpr double rounding = 0x1p-48;

    /// Any corners: also of a segment or a point.
    explicit TriangleFrame(const Corners& corners);

    /// 0 where they cross. Where the distance is more than `limit`, any number that is, too, and is no larger
    /// than the distance, may stand for it. The segment may be a point.
    [[nodiscard]] double distance(const Segment& segment, double limit) const;
    [[nodiscard]] double distance(const Point& p) const;
    /// Between two triangles.
    [[nodiscard]] double distance(const TriangleFrame& other, double limit) const;

  private:
    /// In the frame; z is 0 if there is no plane.
    [[nodiscard]] Point to_frame(const Point& p) const;
    [[nodiscard]] Segment edge(int i) const { return {corners_[i], corners_[(i + 1) % 3]}; }
    /// Squared distance to the nearest edge.
    [[nodiscard]] double to_border2(const Segment& segment) const;
    [[nodiscard]] double to_border2(const Point& p) const;
    /// Over the triangle, seen along z.
    [[nodiscard]] bool over(double x, double y) const;
    /// To the nearest place in the triangle's interior if that is where the segment, given in the frame,
    /// comes nearest; infinite if it is not.
    [[nodiscard]] double to_interior(const Point& from, const Point& to) const;
    /// Lower bound of the distance from what has these two ends, from the triangle's box in the frame.
    [[nodiscard]] double box_bound(const Point& from, const Point& to) const;

    Corners corners_; ///< the longest edge is from [0] to [1]
    std::array<Point, 3> edges_{};
    std::array<double, 3> inverse2_{}; ///< one over their squared lengths; 0 of none
    Point x_{}, y_{}, z_{};
    double base_ = 0, apex_x_ = 0, apex_y_ = 0;
    bool flat_ = false; ///< a segment or a point: has no plane
};

} // namespace phantom::fdh
