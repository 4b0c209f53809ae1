// SPDX-License-Identifier: GPL-2.0-or-later
// Whether a triangle touches a box: it is clipped by the box's six planes, and what is left decides. The
// places left lie on the triangle and in the box to within rounding, so a yes is as good as a no; the
// separating axes of Akenine-Moeller (2001), with rounding allowed for on each, would say yes to triangles
// that are farther.
#pragma once

#include "fdh/vector.hpp"

namespace phantom::fdh {

/// Rounding in units of the largest magnitude of a coordinate: five roundings per plane, six planes, and as
/// much again.
inline constexpr double box_rounding = 0x1p-46;

/// True if the triangle touches the box between low and high, its surface included; may be true if it touches
/// only the box widened on every side by box_rounding times the largest magnitude of a coordinate. Any
/// triangle, also a segment or a point; a box may be flat. False if low > high along an axis.
bool touches_box(const Corners& triangle, const Point& low, const Point& high);

} // namespace phantom::fdh
