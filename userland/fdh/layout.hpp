// SPDX-License-Identifier: GPL-2.0-or-later
// A triangle tree in memory: sixteen-wide nodes and leaves, each field an array over the sixteen lanes so
// that one instruction tests them all. Coordinates are whole grid steps (grid.hpp).
//
// The tree is full: all leaves but the last hold sixteen triangles, all nodes but the last of each level have
// sixteen children, and all leaves are equally deep. So no child needs a reference: child j of node i of a
// level is number 16 i + j of the level below (of the leaves, for the lowest).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace phantom::fdh {

inline constexpr int lanes = 16;

/// Most triangles a tree holds: the top bit of their numbers is needle_flag.
inline constexpr std::size_t most_triangles = 0x7fffffff;
/// Levels of nodes above most_triangles / 16 leaves.
inline constexpr int most_levels = 7;

/// Hulls of up to sixteen children. An unused lane is the empty hull (low = +inf, high = -inf): infinitely
/// far from every point, and neutral in a union.
template <int K>
struct alignas(64) Node {
    float low[K / 2][lanes];
    float high[K / 2][lanes];
};

/// Up to sixteen triangles: a vertex, opposite the longest edge, and the edges from it to the next and the
/// one after, all exact. An unused lane has a NaN vertex: its distance is NaN, which compares as no hit.
struct alignas(64) Leaf {
    float vertex[3][lanes];
    float edge1[3][lanes];
    float edge2[3][lanes];
    /// Number of the triangle, and needle_flag.
    std::uint32_t triangle[lanes];
};

/// Set for a triangle so thin that floats would not know its plane well enough: its distance is computed in
/// double. Also set in no_triangle.
inline constexpr std::uint32_t needle_flag = 0x80000000u;
/// Where the sine of the largest angle is below this. A thin triangle with a short edge is none: its angles
/// at that edge are wide.
inline constexpr double needle_sine = 0.25;
inline constexpr std::uint32_t no_triangle = std::numeric_limits<std::uint32_t>::max();

/// How many levels of nodes stand above so many leaves, and where each begins. Level 0 is the lowest; the
/// root stands first in memory.
struct Levels {
    int count = 0;
    std::uint32_t base[most_levels] = {}; ///< index of the level's first node
    std::uint32_t size[most_levels] = {};

    static constexpr Levels above(std::size_t leaves)
    {
        Levels levels;
        if (leaves == 0)
            return levels;
        do {
            leaves = (leaves + lanes - 1) / lanes;
            levels.size[levels.count++] = static_cast<std::uint32_t>(leaves);
        } while (leaves > 1);
        std::uint32_t first = 0;
        for (int level = levels.count; level-- > 0;) {
            levels.base[level] = first;
            first += levels.size[level];
        }
        return levels;
    }
    /// Of all levels.
    [[nodiscard]] constexpr std::size_t nodes() const { return count ? std::size_t{base[0]} + size[0] : 0; }
};

/// What a search walks; somebody else owns it. No classes of the standard library: the search is compiled for
/// other instruction sets, and their inline functions must not be.
template <int K>
struct TreeView {
    const Node<K>* nodes;
    const Leaf* leaves;
    Levels levels;
};

} // namespace phantom::fdh
