// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/pair_search.hpp"

#include <algorithm>

#include "fdh/region_hull.hpp"
#include "fdh/triangle_frame.hpp"

namespace phantom::fdh {

namespace {

double magnitude(const Point& p)
{
    return std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]);
}

/// From the steps of the second tree to those of the first: x = matrix v + offset.
struct StepsToSteps {
    std::array<double, 9> matrix;
    Point offset;
    double rounding; ///< of the result, at most [steps]

    template <int K>
    StepsToSteps(const PosedTree<K>& first, const PosedTree<K>& second)
    {
        const Pose relative = relative_pose(first.pose, second.pose);
        const double scale = second.grid.step * first.grid.steps_per_unit; // a power of two
        for (int i = 0; i < 9; i++)
            matrix[i] = relative.rotation[i] * scale;
        const Point& o = second.grid.origin;
        for (int row = 0; row < 3; row++) {
            const double* r = &relative.rotation[3 * row];
            offset[row] = (r[0] * o[0] + r[1] * o[1] + r[2] * o[2] + relative.translation[row] -
                           first.grid.origin[row]) *
                          first.grid.steps_per_unit;
        }
        // What was added up to large and nearly equal sums, and what is computed from here on.
        const double posed = magnitude(first.pose.translation) + magnitude(second.pose.translation) +
                             magnitude(first.grid.origin) + magnitude(o);
        rounding = 0x1p-49 * posed * first.grid.steps_per_unit +
                   Grid::arithmetic * (magnitude(offset) + 3 * Grid::half_extent_steps * (1 + scale));
    }

    [[nodiscard]] Point operator()(const Point& v) const
    {
        Point x = offset;
        for (int row = 0; row < 3; row++)
            for (int axis = 0; axis < 3; axis++)
                x[row] += matrix[3 * row + axis] * v[axis];
        return x;
    }
};

template <int K>
class PairSearch {
  public:
    PairSearch(const PosedTree<K>& first, const PosedTree<K>& second, double distance,
               std::vector<TrianglePair>& out)
        : first_(first.tree), second_(second.tree), convert_(first, second), step_(first.grid.step), out_(out)
    {
        const double error = first.grid.vertex_error() + second.grid.vertex_error();
        limit_ = (distance + error) * first.grid.steps_per_unit + convert_.rounding;
    }

    void run()
    {
        // Each round pushes sixteen for one, and goes down one level of one of the trees.
        Waiting stack[2 * (most_levels + 1) * (lanes - 1) + 1];
        int top = 0;
        stack[top++] = {{first_.levels.count - 1, 0}, {second_.levels.count - 1, 0}};
        while (top > 0) {
            const auto [a, b] = stack[--top];
            if (a.level < 0 && b.level < 0) {
                compare(first_.leaves[a.index], second_.leaves[b.index]);
            } else if (a.level >= b.level) {
                const Node<K>& node = node_of(first_, a);
                const RegionHull<K> region(seen_from_first(b), limit_);
                for (unsigned mask = region.near({node.low, node.high}); mask; mask &= mask - 1)
                    stack[top++] = {child_of(a, __builtin_ctz(mask)), b};
            } else {
                const Slabs<K> hull = hull_of(first_, a);
                const Node<K>& node = node_of(second_, b);
                for (int lane = 0; lane < lanes; lane++) {
                    const Place child = child_of(b, lane);
                    if (node.low[0][lane] <= node.high[0][lane] && // used
                        distance_bound<K>(hull, seen_from_first(child)) <= limit_)
                        stack[top++] = {a, child};
                }
            }
        }
    }

  private:
    /// A node, or at level -1 a leaf.
    struct Place {
        int level;
        std::uint32_t index;
    };
    struct Waiting {
        Place first, second;
    };

    static const Node<K>& node_of(const TreeView<K>& tree, Place place)
    {
        return tree.nodes[tree.levels.base[place.level] + place.index];
    }
    static Place child_of(Place place, int lane)
    {
        return {place.level - 1, place.index * lanes + static_cast<std::uint32_t>(lane)};
    }

    /// As its parent has it; the root has none.
    static Slabs<K> hull_of(const TreeView<K>& tree, Place place)
    {
        Slabs<K> hull;
        if (place.level == tree.levels.count - 1) {
            const Node<K>& root = tree.nodes[0];
            for (int k = 0; k < K / 2; k++)
                hull[k] = {*std::min_element(root.low[k], root.low[k] + lanes),
                           *std::max_element(root.high[k], root.high[k] + lanes)};
            return hull;
        }
        const Node<K>& parent = node_of(tree, {place.level + 1, place.index / lanes});
        const auto lane = place.index % lanes;
        for (int k = 0; k < K / 2; k++)
            hull[k] = {parent.low[k][lane], parent.high[k][lane]};
        return hull;
    }

    /// The hull, in the first tree's directions and steps, of the box round a part of the second.
    [[nodiscard]] Slabs<K> seen_from_first(Place place) const
    {
        constexpr auto directions = hull_directions<K>();
        const Slabs<K> own = hull_of(second_, place);
        Point centre, half;
        for (int axis = 0; axis < 3; axis++) {
            centre[axis] = 0.5 * (own[axis][0] + own[axis][1]);
            half[axis] = 0.5 * (own[axis][1] - own[axis][0]);
        }
        const Point middle = convert_(centre);
        Slabs<K> slabs;
        for (int k = 0; k < K / 2; k++) {
            const auto& d = directions[k];
            const auto& m = convert_.matrix;
            double reach = 3 * convert_.rounding;
            for (int axis = 0; axis < 3; axis++)
                reach += std::abs(d[0] * m[axis] + d[1] * m[3 + axis] + d[2] * m[6 + axis]) * half[axis];
            const double at = d[0] * middle[0] + d[1] * middle[1] + d[2] * middle[2];
            slabs[k] = {at - reach, at + reach};
        }
        return slabs;
    }

    void compare(const Leaf& a, const Leaf& b)
    {
        const LeafBoxes boxes(a);
        for (int j = 0; j < lanes && b.triangle[j] != no_triangle; j++) {
            Corners corners = corners_of(b, j);
            Slabs<6> box = empty_slabs<6>();
            for (Point& corner : corners) {
                corner = convert_(corner);
                for (int axis = 0; axis < 3; axis++)
                    box[axis] = {std::min(box[axis][0], corner[axis]), std::max(box[axis][1], corner[axis])};
            }
            const RegionHull<6> region(box, limit_);
            unsigned mask = region.near(boxes.intervals());
            if (mask == 0)
                continue;
            const TriangleFrame frame(corners);
            for (; mask; mask &= mask - 1) {
                const int i = __builtin_ctz(mask);
                if (a.triangle[i] == no_triangle)
                    continue;
                const double distance = frame.distance(TriangleFrame(corners_of(a, i)), limit_);
                if (distance <= limit_)
                    out_.push_back(
                        {a.triangle[i] & ~needle_flag, b.triangle[j] & ~needle_flag, distance * step_});
            }
        }
    }

    const TreeView<K>&first_, &second_;
    StepsToSteps convert_;
    double step_;  ///< of the first [mesh unit]
    double limit_; ///< [steps of the first]
    std::vector<TrianglePair>& out_;
};

} // namespace

template <int K>
void search_pairs(const PosedTree<K>& first, const PosedTree<K>& second, double distance,
                  std::vector<TrianglePair>& out)
{
    if (first.tree.levels.count > 0 && second.tree.levels.count > 0)
        PairSearch<K>(first, second, distance, out).run();
}

template void search_pairs<6>(const PosedTree<6>&, const PosedTree<6>&, double, std::vector<TrianglePair>&);
template void search_pairs<14>(const PosedTree<14>&, const PosedTree<14>&, double,
                               std::vector<TrianglePair>&);
template void search_pairs<18>(const PosedTree<18>&, const PosedTree<18>&, double,
                               std::vector<TrianglePair>&);
template void search_pairs<26>(const PosedTree<26>&, const PosedTree<26>&, double,
                               std::vector<TrianglePair>&);

} // namespace phantom::fdh
