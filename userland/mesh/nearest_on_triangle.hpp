// SPDX-License-Identifier: GPL-2.0-or-later
// The point of a triangle nearest to another point.
#pragma once

#include <array>

#include "mesh/mesh.hpp"

namespace phantom::mesh {

/// Corner weights (they add up to one, none is below zero) of the point of the triangle x nearest to p. For
/// triangles without area as well: a segment, a point.
std::array<double, 3> nearest_on_triangle(const Vec3& p, const std::array<Vec3, 3>& x);

/// From p to the triangle.
double distance_to_triangle(const Vec3& p, const std::array<Vec3, 3>& x);

} // namespace phantom::mesh
