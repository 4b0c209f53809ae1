// SPDX-License-Identifier: GPL-2.0-or-later
// The shape of a hierarchy over boxes: which eight subsets at each node. Knows neither triangles nor hulls;
// level one (objects) and level two (triangles) both come from here.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fdh/layout.hpp"

namespace phantom::fdh {

/// The axis-aligned box of one primitive. 32 bytes: read as two vector registers.
struct alignas(16) PrimitiveBox {
    float low[3];
    std::uint32_t index; ///< of the primitive
    float high[3];
    std::uint32_t unused;
};

/// A node of the finished shape. Children that are leaves hold primitives [begin, end) of the reordered
/// boxes; leaves are numbered in the order of their primitives.
struct ShapeNode {
    struct Child {
        std::uint32_t begin, end;
        std::uint32_t reference; ///< as Node::child
    };
    Child children[lanes];
    int count = 0;
};

struct Shape {
    std::vector<ShapeNode>
        nodes; ///< parents before children; [0] is the root; empty if there are no primitives
    std::uint32_t leaves = 0;
};

/// Reorders the boxes and groups them, at most `leaf_size` to a leaf, by the surface area heuristic with
/// binned centroids (Wald 2007), then collapses the binary tree to eight children per node by largest area
/// first. The same result for any number of threads. Depth is at most `deepest` whatever the input.
Shape split(std::span<PrimitiveBox> boxes, unsigned leaf_size, unsigned threads);

} // namespace phantom::fdh
