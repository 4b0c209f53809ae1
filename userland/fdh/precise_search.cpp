// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/precise_search.hpp"
#include "fdh/region_hull.hpp"
#include "fdh/triangle_frame.hpp"

#include <algorithm>
#include <cmath>

namespace phantom::fdh {

namespace {

/// Lower bound of the squared distance to one child's hull: as HullDistance (search_kernels.hpp) has it, of
/// the axes and the cube's diagonals.
template <int K>
double hull_distance2(const Node<K>& node, int lane, const Point& p)
{
    constexpr auto directions = hull_directions<K>();
    double axes = 0, diagonal = 0;
    for (int k = 0; k < K / 2; k++) {
        const auto& d = directions[k];
        const double x = d[0] * p[0] + d[1] * p[1] + d[2] * p[2];
        const double e = std::max({node.low[k][lane] - x, x - node.high[k][lane], 0.0});
        if (k < 3)
            axes += e * e;
        else
            diagonal = std::max(diagonal, e * e / (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
    }
    return std::max(axes, diagonal);
}

template <int K>
class PreciseSearch {
  public:
    PreciseSearch(const TreeView<K>& tree, const Point& point, DistanceSink& sink, QueryCounts& counts)
        : tree_(tree), point_(point), sink_(sink), counts_(counts)
    {
    }

    /// Level -1: the leaves.
    void visit(int level, std::uint32_t index)
    {
        if (level < 0) {
            visit_leaf(tree_.leaves[index]);
            return;
        }
        counts_.nodes++;
        const Node<K>& node = tree_.nodes[tree_.levels.base[level] + index];
        struct Child {
            double bound;
            int lane;
        } near[lanes];
        int count = 0;
        for (int lane = 0; lane < lanes; lane++) {
            if (!(node.low[0][lane] <= node.high[0][lane])) // unused
                continue;
            const double bound = std::sqrt(hull_distance2(node, lane, point_)) * (1 - 0x1p-45);
            if (bound <= sink_.limit())
                near[count++] = {bound, lane};
        }
        std::sort(near, near + count, [](const Child& a, const Child& b) { return a.bound < b.bound; });
        for (int i = 0; i < count; i++)
            if (near[i].bound <= sink_.limit())
                visit(level - 1, index * lanes + static_cast<std::uint32_t>(near[i].lane));
    }

  private:
    void visit_leaf(const Leaf& leaf)
    {
        counts_.leaves++;
        const double point[3] = {point_[0], point_[1], point_[2]};
        for (int lane = 0; lane < lanes && leaf.triangle[lane] != no_triangle; lane++) {
            const double distance = std::sqrt(precise_distance2(leaf, lane, point));
            if (distance <= sink_.limit()) {
                counts_.triangles++;
                sink_.add(leaf.triangle[lane] & ~needle_flag, distance);
            }
        }
    }

    const TreeView<K>& tree_;
    const Point& point_;
    DistanceSink& sink_;
    QueryCounts& counts_;
};

} // namespace

double precise_distance2(const Leaf& leaf, int lane, const double (&point)[3])
{
    const double distance =
        TriangleFrame(corners_of(leaf, lane)).distance(Point{point[0], point[1], point[2]});
    return distance * distance;
}

template <int K>
void precise_search(const TreeView<K>& tree, const Point& steps, DistanceSink& sink, QueryCounts& counts)
{
    if (tree.levels.count > 0)
        PreciseSearch<K>(tree, steps, sink, counts).visit(tree.levels.count - 1, 0);
}

template void precise_search<6>(const TreeView<6>&, const Point&, DistanceSink&, QueryCounts&);
template void precise_search<14>(const TreeView<14>&, const Point&, DistanceSink&, QueryCounts&);
template void precise_search<18>(const TreeView<18>&, const Point&, DistanceSink&, QueryCounts&);
template void precise_search<26>(const TreeView<26>&, const Point&, DistanceSink&, QueryCounts&);

} // namespace phantom::fdh
