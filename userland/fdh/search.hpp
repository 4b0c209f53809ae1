// SPDX-License-Identifier: GPL-2.0-or-later
// The search through one tree, as a table of functions per instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fdh/isa.hpp"
#include "fdh/layout.hpp"
#include "fdh/query.hpp"

namespace phantom::fdh {

/// Where a search puts what it finds. Plain data: it crosses into units compiled for other instruction sets.
struct Sink {
    Hit* hits = nullptr;
    std::size_t size = 0;
    std::size_t capacity = 0;
    double limit = 0; ///< distance beyond which nothing is wanted; may shrink in `full`
    /// Called when fewer than `lanes` places are left; makes room, and may shrink the limit.
    void (*full)(Sink&) = nullptr;
    void* owner = nullptr;
    QueryCounts counts;
};

/// A query point as a tree's hulls see it: its projections as float intervals that surely hold the true
/// value.
template <int K>
struct ProjectedPoint {
    float low[K / 2];
    float high[K / 2];
};

/// Bounds the projections of p [steps]. Beyond 2^61 steps they are cut off, so that squares stay finite in
/// float; the distances that follow are then too small, which a lower bound may be.
template <int K>
ProjectedPoint<K> project(const Point& p);

template <int K>
struct SearchQuery {
    double point[3];             ///< [steps]
    ProjectedPoint<K> projected; ///< of the same
    double step;                 ///< grid step [mesh unit]
    std::uint32_t object;        ///< written to the hits
};

template <int K>
struct SearchKernels {
    /// Every triangle of the tree that is within sink.limit (which may shrink on the way) of the point, and
    /// perhaps a few at the limit's rounding beyond; near ones first, roughly.
    void (*search)(const Node<K>* nodes, const Leaf* leaves, const SearchQuery<K>& query, Sink& sink);
    /// Lower bounds of the squared distance [steps²] from the point to each child; +inf for unused lanes.
    void (*bounds)(const Node<K>& node, const ProjectedPoint<K>& point, float (&distance2)[lanes]);
};

/// Takes a squared limit in double to the float that bounds of hulls are held against: a child is left out if
/// !(bound < result). Covers the rounding of a dozen float operations in `bounds`.
float search_limit(double limit2);

/// The functions for an available instruction set.
template <int K>
const SearchKernels<K>& search_kernels(Isa isa);

/// One unit per instruction set defines these.
template <Isa I, int K>
const SearchKernels<K>& kernels_of();

} // namespace phantom::fdh
