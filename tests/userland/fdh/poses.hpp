// SPDX-License-Identifier: GPL-2.0-or-later
// Posed meshes, and the truth about distances between triangles.
#pragma once

#include "fdh/pose.hpp"
#include "fdh/vector.hpp"
#include "meshes.hpp"

namespace phantom::fdh::test {

/// Rotation by an angle [rad] about an axis of any length (Rodrigues), then a translation.
Pose turn(Point axis, double angle, const Point& translation);
/// Any rotation, and a translation of up to `reach` along each axis.
Pose random_pose(double reach, std::mt19937_64& random);

Point to_world(const Pose& pose, const Point& v);
/// The mesh in world coordinates.
Mesh posed(Mesh mesh, const Pose& pose);

Corners corners(const Mesh& mesh, std::size_t triangle);

/// Distance from a segment to a triangle in long double. That of a point of the segment is a convex function
/// of where it is: found by golden section, with no case for crossing, parallel or degenerate ones.
long double true_distance(const Segment& segment, const Corners& triangle);
/// Distance between two triangles: an edge of one of them is always at the nearest place.
long double true_distance(const Corners& a, const Corners& b);
/// A lower bound of that, from spheres.
double sphere_bound(const Corners& a, const Corners& b);
/// The least between their triangles, looked for no farther than `cutoff`: beyond, that is the answer.
long double true_distance(const Mesh& a, const Mesh& b, long double cutoff);

} // namespace phantom::fdh::test
