// SPDX-License-Identifier: GPL-2.0-or-later
// A tree over boxes, for what is near to what: edges at a boundary, parts of a mesh.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "mesh/mesh.hpp"

namespace phantom::mesh {

/// Boxes in preorder, halved at the median of their longest side: a query of what meets a small box takes
/// O(log n). Memory: 64 bytes a box.
class BoxTree {
  public:
    explicit BoxTree(const std::vector<Bounds>& boxes) : boxes_(boxes), order_(boxes.size())
    {
        std::iota(order_.begin(), order_.end(), 0U);
        if (!boxes.empty())
            add(0, static_cast<std::uint32_t>(boxes.size()));
    }

    /// Calls visit(number) for every box that meets this one, sides included.
    template <typename Visit>
    void visit_meeting(const Bounds& box, Visit&& visit) const
    {
        for (std::uint32_t at = 0; at < nodes_.size();) {
            const Node& node = nodes_[at];
            if (!meet(node.box, box)) {
                at = node.skip;
                continue;
            }
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
                if (meet(boxes_[order_[i]], box))
                    visit(order_[i]);
            }
            ++at;
        }
    }

  private:
    static constexpr std::uint32_t leaf_size = 8;

    struct Node {
        Bounds box;
        std::uint32_t skip;         ///< the next node that does not lie in this one
        std::uint32_t first, count; ///< of order_, at a leaf; count 0 elsewhere
    };

    static bool meet(const Bounds& a, const Bounds& b)
    {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (a.high[axis] < b.low[axis] || b.high[axis] < a.low[axis])
                return false;
        }
        return true;
    }

    void add(std::uint32_t first, std::uint32_t count)
    {
        Bounds box = boxes_[order_[first]];
        for (std::uint32_t i = first; i < first + count; ++i) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                box.low[axis] = std::min(box.low[axis], boxes_[order_[i]].low[axis]);
                box.high[axis] = std::max(box.high[axis], boxes_[order_[i]].high[axis]);
            }
        }
        const std::size_t at = nodes_.size();
        nodes_.push_back({box, 0, first, count <= leaf_size ? count : 0});
        if (count > leaf_size) {
            std::size_t axis = 0;
            for (std::size_t other = 1; other < 3; ++other) {
                if (box.high[other] - box.low[other] > box.high[axis] - box.low[axis])
                    axis = other;
            }
            const auto begin = order_.begin() + first;
            std::nth_element(begin, begin + count / 2, begin + count, [&](std::uint32_t a, std::uint32_t b) {
                return boxes_[a].low[axis] + boxes_[a].high[axis] <
                       boxes_[b].low[axis] + boxes_[b].high[axis];
            });
            add(first, count / 2);
            add(first + count / 2, count - count / 2);
        }
        nodes_[at].skip = static_cast<std::uint32_t>(nodes_.size());
    }

    const std::vector<Bounds>& boxes_; ///< the caller's, who keeps them
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

} // namespace phantom::mesh
