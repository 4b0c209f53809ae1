// SPDX-License-Identifier: GPL-2.0-or-later
// The tree in memory: eight-wide nodes and leaves, each field an array over the eight lanes so that one
// instruction tests them all. Coordinates are whole grid steps (grid.hpp).
#pragma once

#include <cstdint>
#include <limits>

namespace phantom::fdh {

inline constexpr int lanes = 8;

/// Deepest binary tree the builder makes, so that a search needs a stack of bounded size: below
/// `balanced_depth` levels it splits by count, which ends after at most 32 more.
inline constexpr int balanced_depth = 48;
inline constexpr int deepest = balanced_depth + 32;
/// A search leaves at most lanes - 1 children waiting per level.
inline constexpr int stack_size = (lanes - 1) * deepest + lanes;

/// A child: a node's index, or a leaf's with the top bit set.
inline constexpr std::uint32_t leaf_flag = 0x80000000u;

/// Hulls of up to eight children. An unused lane is the empty hull (low = +inf, high = -inf): infinitely far
/// from every point, and neutral in a union.
template <int K>
struct alignas(32) Node {
    float low[K / 2][lanes];
    float high[K / 2][lanes];
    std::uint32_t child[lanes];
};

/// Up to eight triangles: first vertex and the edges from it to the second and the third, all exact. An
/// unused lane has a NaN vertex: its distance is NaN, which compares as no hit.
struct alignas(64) Leaf {
    float vertex[3][lanes];
    float edge1[3][lanes];
    float edge2[3][lanes];
    std::uint32_t triangle[lanes];
};

inline constexpr std::uint32_t no_triangle = std::numeric_limits<std::uint32_t>::max();

} // namespace phantom::fdh
