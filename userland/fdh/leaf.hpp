// SPDX-License-Identifier: GPL-2.0-or-later
// From the corners of sixteen triangles to a leaf and its hull, as a table of functions per instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fdh/hull.hpp"
#include "fdh/isa.hpp"
#include "fdh/layout.hpp"

namespace phantom::fdh {

/// The corners of a leaf's triangles in whole steps: [corner][axis][lane].
using LeafCorners = float[3][3][lanes];

/// What making a leaf tells about it.
template <int K>
struct MadeLeaf {
    float low[K / 2], high[K / 2]; ///< of the corners; sums of three coordinates may be rounded by one step
    float twice_area[lanes];       ///< of each triangle [steps²]
    float longest_edge2;
    std::uint32_t needles; ///< bit i: triangle i needs needle_flag
};

template <int K>
struct LeafKernels {
    /// Fills in everything but the numbers of the triangles.
    void (*make)(const LeafCorners& corners, Leaf& leaf, MadeLeaf<K>& made);
};

template <int K>
const LeafKernels<K>& leaf_kernels(Isa isa);

/// One unit per instruction set defines these.
template <Isa I, int K>
const LeafKernels<K>& leaf_kernels_of();

/// 0, 1, ... N - 1 as template arguments, without the standard library (search_kernels.hpp says why).
template <std::size_t... I>
struct Indices {
};
template <std::size_t N, std::size_t... I>
struct Counted : Counted<N - 1, N - 1, I...> {
};
template <std::size_t... I>
struct Counted<0, I...> {
    using Type = Indices<I...>;
};

} // namespace phantom::fdh
