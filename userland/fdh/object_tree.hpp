// SPDX-License-Identifier: GPL-2.0-or-later
// Level one's hierarchy: eight-wide nodes over the hulls of objects in world directions. Objects move every
// millisecond, so it keeps its shape and refits its hulls while the shape is good, and takes a new one when
// it is not.
//
// How good a shape is: the half areas of the nodes' boxes added up, over those of the objects' boxes. By the
// surface area heuristic (Goldsmith & Salmon 1987) a query visits nodes in proportion to the former; the
// latter takes out what no shape could save, and the unit. A shape is given up when its cost exceeds the
// least it has had by the factor `tolerated_growth`.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fdh/grid.hpp"
#include "fdh/slabs.hpp"

namespace phantom::fdh {

template <int K>
class ObjectTree {
  public:
    static constexpr double tolerated_growth = 1.5;

    /// Takes in the hulls of all objects, by number; empty hulls take no part. `moved`: those that changed
    /// since the last call (all, if the number of objects has). O(moved log objects) and a sum over the
    /// nodes while the shape is kept, else O(objects log objects); allocates nothing as long as there are no
    /// more objects than before. Returns true if the shape is new.
    bool update(std::span<const Slabs<K>> hulls, std::span<const std::uint32_t> moved);

    /// What the shape costs, see above; 0 if there are no objects with an area.
    [[nodiscard]] double cost() const;
    [[nodiscard]] std::size_t bytes() const;

    /// Calls visit(object) for all whose hulls are within limit() of the query's hull, near ones first,
    /// roughly; some that are farther may be among them. limit() [mesh unit] may shrink while visit runs.
    template <class Limit, class Visit>
    void visit(const Slabs<K>& query, const Limit& limit, const Visit& visit) const;

  private:
    static constexpr int width = 8;
    /// Below this depth groups are halved by count, which ends after at most 32 more.
    static constexpr int balanced_depth = 16;
    static constexpr int stack_size = (width - 1) * (balanced_depth + 32) + width;
    static constexpr std::uint32_t object_flag = 0x80000000u;
    static constexpr std::uint32_t none = 0xffffffffu;

    /// Intervals in steps of grid_, rounded outward.
    struct Hull {
        float low[K / 2];
        float high[K / 2];
    };
    /// An unused lane is an empty hull: infinitely far from everything, and neutral in a union.
    struct alignas(32) Node {
        float low[K / 2][width];
        float high[K / 2][width];
        std::uint32_t child[width]; ///< a node, or an object with object_flag
        std::uint32_t parent;       ///< stands before its children; `none` of the root
        int lane;                   ///< in the parent
    };
    struct Place {
        std::uint32_t node = none;
        int lane = 0;
    };
    struct Item {
        Hull hull;
        std::uint32_t object;
    };
    using Group = std::span<Item>;

    [[nodiscard]] Hull in_steps(const Slabs<K>& slabs) const;
    [[nodiscard]] float limit_in_steps2(double limit) const;
    static void bounds(const Node& node, const Hull& query, float (&bound2)[width]);
    static void set_lane(Node& node, int lane, const Hull& hull);
    [[nodiscard]] static Hull union_of(const Node& node);
    [[nodiscard]] static double half_area(const Hull& hull);

    void rebuild(std::span<const Slabs<K>> hulls);
    std::uint32_t build(Group items, int depth, std::uint32_t parent, int parent_lane);
    static std::size_t split(Group items, bool by_count);
    /// False if the grid has become too coarse for where the objects are.
    bool refit(std::span<const Slabs<K>> hulls, std::span<const std::uint32_t> moved);

    Grid grid_;
    double origin_[K / 2] = {};          ///< the grid's, along each direction
    double origin_magnitude_ = 0;        ///< its coordinates' magnitudes added up
    std::vector<Node> nodes_;            ///< [0] is the root; empty if all hulls are
    std::vector<double> node_areas_;     ///< half areas of their boxes [steps²]
    std::vector<Place> places_;          ///< of each object
    std::vector<double> object_areas_;   ///< half areas [steps²]
    std::vector<unsigned char> changed_; ///< nodes whose lanes have changed; all 0 between calls
    std::vector<Item> items_;            ///< of a rebuild; kept for the next
    double least_cost_ = 0;              ///< since the last rebuild
};

template <int K>
template <class Limit, class Visit>
void ObjectTree<K>::visit(const Slabs<K>& query, const Limit& limit, const Visit& visit) const
{
    if (nodes_.empty())
        return;
    struct Waiting {
        float bound2;
        std::uint32_t child;
    };
    const Hull hull = in_steps(query);
    float limit2 = limit_in_steps2(limit());
    Waiting stack[stack_size];
    int top = 0;
    stack[top++] = {0, 0};
    while (top > 0) {
        const Waiting next = stack[--top];
        if (!(next.bound2 < limit2))
            continue;
        if (next.child & object_flag) {
            visit(next.child & ~object_flag);
            limit2 = limit_in_steps2(limit());
            continue;
        }
        const Node& node = nodes_[next.child];
        float bound2[width];
        bounds(node, hull, bound2);
        const int base = top;
        for (int lane = 0; lane < width; lane++) {
            if (!(bound2[lane] < limit2))
                continue;
            int place = top++;
            for (; place > base && stack[place - 1].bound2 < bound2[lane]; place--)
                stack[place] = stack[place - 1];
            stack[place] = {bound2[lane], node.child[lane]};
        }
    }
}

extern template class ObjectTree<6>;
extern template class ObjectTree<14>;
extern template class ObjectTree<18>;
extern template class ObjectTree<26>;

} // namespace phantom::fdh
