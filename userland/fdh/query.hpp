// SPDX-License-Identifier: GPL-2.0-or-later
// What queries take and give.
#pragma once

#include <cstdint>
#include <vector>

#include "fdh/hull.hpp"

namespace phantom::fdh {

/// One triangle near the query point.
struct Hit {
    std::uint32_t object = 0;   ///< 0 in a query of a single tree
    std::uint32_t triangle = 0; ///< index in the MeshView it was built from
    double distance = 0;        ///< from the query's point, or segment, to the nearest point of the triangle
};

/// A triangle of one object and one of another.
struct TrianglePair {
    std::uint32_t first, second;
    double distance; ///< 0 where they cross
};

/// What one query looked at, for benchmarks.
struct QueryCounts {
    std::uint64_t nodes = 0;     ///< inner nodes, sixteen hulls each
    std::uint64_t leaves = 0;    ///< up to sixteen triangles each
    std::uint64_t triangles = 0; ///< found near enough, of which the nearest were kept
};

/// Result of "the N nearest within a radius", and the radius they cover: every triangle nearer than
/// `coverage` is among the hits. coverage = max_radius when fewer than N triangles were found, otherwise the
/// distance of the nearest one left out, rounded down so that it holds.
struct Nearest {
    std::vector<Hit> hits; ///< in no order; among equally near ones those of the lowest (object, triangle)
    double coverage = 0;
    double distance_error = 0; ///< how far the distances of the hits may be from the true ones, at most
    QueryCounts counts;
    std::vector<float> distances2; ///< the query's own, kept so that the next one need not allocate
    std::vector<std::uint32_t> triangles;

    void clear()
    {
        hits.clear();
        coverage = 0;
        distance_error = 0;
        counts = {};
    }
    /// Orders the hits by ascending (distance, object, triangle). A query leaves that out because not
    /// everyone needs it. Does not allocate once it has sorted as many.
    void sort();
    std::vector<Hit> sorted; ///< sort()'s own
};

} // namespace phantom::fdh
