// SPDX-License-Identifier: GPL-2.0-or-later
// Order among hits: by (distance, object, triangle). The squared distances of triangles round a point on a
// surface are about evenly spread, so hits are dealt into buckets by them, and compared only within a bucket:
// a sort of 64 by comparison alone would take longer than the search.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fdh/query.hpp"

namespace phantom::fdh {

inline bool nearer(const Hit& a, const Hit& b)
{
    if (a.distance != b.distance)
        return a.distance < b.distance;
    return a.object != b.object ? a.object < b.object : a.triangle < b.triangle;
}

/// Moves the `wanted` nearest (1 <= wanted <= hits.size()) to the front, the farthest of them last, the
/// others in any order.
void select_nearest(std::span<Hit> hits, std::size_t wanted);

/// The `wanted` nearest in order, or all if there are fewer. `sorted` may not be what `hits` looks into.
void sort_nearest(std::span<const Hit> hits, std::size_t wanted, std::vector<Hit>& sorted);

} // namespace phantom::fdh
