// SPDX-License-Identifier: GPL-2.0-or-later
// The search in double: for points so far away that floats cannot tell the mesh's triangles apart, and the
// distances of triangles so thin that floats do not know their plane. Not made to be fast.
#pragma once

#include <cstdint>

#include "fdh/hull.hpp"
#include "fdh/layout.hpp"
#include "fdh/query.hpp"

namespace phantom::fdh {

/// Squared distance from a point to one triangle of a leaf [steps²].
///
/// As in TriangleDistance (search_kernels.hpp); with the edges exact and the normal (at most 2^49 square
/// steps) exact in double, a degenerate triangle is recognised exactly, a needle's plane is its true plane,
/// and a wall's sign is wrong only within 2^-50 of the distance from it.
double precise_distance2(const Leaf& leaf, int lane, const double (&point)[3]);

/// Where a precise search puts what it finds.
class DistanceSink {
  public:
    virtual ~DistanceSink() = default;
    /// Called for every triangle within limit().
    virtual void add(std::uint32_t triangle, double distance_steps) = 0;
    /// Nothing farther is wanted [steps]; may shrink with every add().
    [[nodiscard]] virtual double limit() const = 0;
};

/// Every triangle of the tree within sink.limit() of the point [steps]; near ones first, roughly.
template <int K>
void precise_search(const TreeView<K>& tree, const Point& steps, DistanceSink& sink, QueryCounts& counts);

} // namespace phantom::fdh
