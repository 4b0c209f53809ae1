// SPDX-License-Identifier: GPL-2.0-or-later
// Order among hits: by (distance, object, triangle). Squared distances round a point on a surface are about
// evenly spread, so hits are dealt into buckets by their value, and only within a bucket compared: a sort of
// 64 by comparison alone would take longer than the search.
#pragma once

#include <cstddef>
#include <span>

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

/// Copies in order. `to` has the same size as `from` and does not overlap it.
void sort_into(std::span<const Hit> from, std::span<Hit> to);

} // namespace phantom::fdh
