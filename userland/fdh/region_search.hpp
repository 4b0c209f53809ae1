// SPDX-License-Identifier: GPL-2.0-or-later
// Every triangle of a tree that comes near a segment or touches a box. The same code on every instruction
// set: hulls are compared in float, sixteen at a time, triangles one by one in double.
#pragma once

#include <cstdint>
#include <vector>

#include "fdh/grid.hpp"
#include "fdh/layout.hpp"
#include "fdh/pose.hpp"
#include "fdh/query.hpp"
#include "fdh/vector.hpp"

namespace phantom::fdh {

/// Adds a hit for every triangle within `radius` of the segment, both in mesh coordinates; for some that are
/// farther, too, by no more than twice the error bound of distances from the segment's ends.
template <int K>
void search_along(const TreeView<K>& tree, const Grid& grid, const Segment& segment, double radius,
                  std::uint32_t object, std::vector<Hit>& out);

/// Adds a hit, with distance 0, for every triangle of the posed tree that touches the box, which stands along
/// the axes of the frame that the pose leads to; for some, too, that touch it only when widened on every side
/// by twice the error bound of distances.
template <int K>
void search_box(const TreeView<K>& tree, const Grid& grid, const Pose& pose, const Box& box,
                std::uint32_t object, std::vector<Hit>& out);

/// Whether a query can be answered at all; if not, the answer is empty.
bool valid_segment(const Segment& segment, double radius);
bool valid_box(const Box& box);

} // namespace phantom::fdh
