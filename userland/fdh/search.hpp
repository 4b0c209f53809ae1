// SPDX-License-Identifier: GPL-2.0-or-later
// The search through one tree, as a table of functions per instruction set.
//
// Two searches. `search` computes distances in float, relative to the point and so as exactly as floats can:
// each is off by at most float_error times (distance + longest edge). It is for points in the mesh's
// neighbourhood. precise_search.hpp computes in double, for points far away and for instruction counts that
// do not matter.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fdh/isa.hpp"
#include "fdh/layout.hpp"
#include "fdh/precise_search.hpp"
#include "fdh/query.hpp"

namespace phantom::fdh {

/// Of a distance computed in float, relative to the distance plus the longest edge of the mesh. The analysis
/// stands at TriangleDistance.
inline constexpr double float_error = 0x1p-18;

/// Where a search puts what it finds: two arrays side by side. Plain data: it crosses into units compiled for
/// other instruction sets. `full` is called when fewer than `lanes` + `slack` places are left; it grows the
/// arrays or empties them.
struct Candidates {
    static constexpr std::size_t slack = lanes; ///< written beyond the last candidate

    float* distance2 = nullptr; ///< [steps²]
    std::uint32_t* triangle = nullptr;
    std::size_t size = 0;
    std::size_t capacity = 0;
    std::size_t keep = 0; ///< no more are wanted: the nearest, ties by lower number
    float limit2 = 0;     ///< nothing beyond is wanted [steps²]; shrinks once `keep` are known
    void (*full)(Candidates&) = nullptr;
    void* owner = nullptr;
    QueryCounts counts;
};

/// A query point as a tree sees it [steps].
template <int K>
struct SearchPoint {
    float whole[3];         ///< the nearest whole numbers: exact differences from vertices
    float fraction[3];      ///< and what is left, at most a half
    float projected[K / 2]; ///< on the hulls' directions, rounded
    double exact[3];
    float hull_slack; ///< what bounds of hulls may be off by, and triangles nearer than computed [steps]
    bool prefetch;    ///< the tree is larger than the nearest caches
};

/// Where a search puts whole triangles: as leaves have them, but field by field. As many as there is room
/// for.
struct Gathered {
    static constexpr std::size_t most = 1024;

    float field[9][most + lanes]; ///< vertex, edge1, edge2
    std::uint32_t triangle[most + lanes];
    std::size_t size = 0;
    bool complete = true; ///< there was room for all
};

template <int K>
struct SearchKernels {
    /// Every triangle of the tree whose computed distance is within out.limit2 (which may shrink on the way).
    void (*search)(const TreeView<K>& tree, const SearchPoint<K>& point, Candidates& out);
    /// The same for some leaves, whatever tree they are of.
    void (*scan)(const Leaf* leaves, std::size_t count, const SearchPoint<K>& point, Candidates& out);
    /// Every triangle of the tree whose computed squared distance is within limit2.
    void (*gather)(const TreeView<K>& tree, const SearchPoint<K>& point, float limit2, Gathered& out);
    /// Once there are out.keep: moves those to the front, the farthest of them last, forgets the others, and
    /// makes its squared distance the limit.
    void (*select)(Candidates& out);
    /// `hits` has room for as many as there are candidates, which are overwritten.
    void (*to_hits)(Candidates& from, std::uint32_t object, double step, Hit* hits);
};

/// Points farther than this from the tree's origin in some axis are not for `search` [steps]: whole numbers
/// up to here, less a vertex, are floats.
inline constexpr double farthest_point = 16777216; // 2^24

/// The functions for an available instruction set.
template <int K>
const SearchKernels<K>& search_kernels(Isa isa);

/// One unit per instruction set defines these.
template <Isa I, int K>
const SearchKernels<K>& kernels_of();

/// A query point for these kernels, if it is not too far away.
template <int K>
SearchPoint<K> search_point(const Point& steps, double longest_edge, bool prefetch);

/// The float for Candidates::limit2 that keeps every distance up to `limit` [steps].
float search_limit2(double limit);

} // namespace phantom::fdh
