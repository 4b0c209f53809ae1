// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/precise_search.hpp"

#include <algorithm>
#include <cmath>

namespace phantom::fdh {

namespace {

Point minus(const Point& a, const Point& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
double dot(const Point& a, const Point& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Point cross(const Point& a, const Point& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Point lane_of(const float (&field)[3][lanes], int lane)
{
    return {field[0][lane], field[1][lane], field[2][lane]};
}

/// To the segment from 0 to e, whole numbers; p relative to its start.
double to_segment(const Point& p, const Point& e)
{
    const double t = std::clamp(dot(p, e) / std::max(dot(e, e), 1.0), 0.0, 1.0);
    const Point r = {p[0] - t * e[0], p[1] - t * e[1], p[2] - t * e[2]};
    return dot(r, r);
}

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
    const Point u = lane_of(leaf.edge1, lane), v = lane_of(leaf.edge2, lane), w = minus(v, u);
    const Point p = minus({point[0], point[1], point[2]}, lane_of(leaf.vertex, lane)), q = minus(p, u);
    const Point n = cross(u, v);
    const double nn = dot(n, n);
    if (nn >= 1 && dot(n, cross(u, p)) >= 0 && dot(n, cross(p, v)) >= 0 && dot(n, cross(w, q)) >= 0) {
        const double height = dot(n, p);
        return height / nn * height;
    }
    return std::min({to_segment(q, w), to_segment(p, u), to_segment(p, v)});
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
