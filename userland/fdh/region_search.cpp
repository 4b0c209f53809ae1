// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/region_search.hpp"

#include <algorithm>

#include "fdh/region_hull.hpp"
#include "fdh/triangle_box.hpp"
#include "fdh/triangle_frame.hpp"

namespace phantom::fdh {

namespace {

/// Calls visit(triangle number, corners [steps]) for what may be near: in a leaf, triangles whose boxes are.
/// The tree is not empty.
template <int K, class Visit>
void for_near_triangles(const TreeView<K>& tree, const RegionHull<K>& region, const RegionHull<6>& box,
                        const Visit& visit)
{
    struct Waiting {
        int level; ///< -1: a leaf
        std::uint32_t index;
    };
    Waiting stack[most_levels * (lanes - 1) + 1];
    int top = 0;
    stack[top++] = {tree.levels.count - 1, 0};
    while (top > 0) {
        const auto [level, index] = stack[--top];
        if (level >= 0) {
            const Node<K>& node = tree.nodes[tree.levels.base[level] + index];
            for (unsigned mask = region.near({node.low, node.high}); mask; mask &= mask - 1)
                stack[top++] = {level - 1, index * lanes + static_cast<unsigned>(__builtin_ctz(mask))};
            continue;
        }
        const Leaf& leaf = tree.leaves[index];
        const LeafBoxes boxes(leaf);
        for (unsigned mask = box.near(boxes.intervals()); mask; mask &= mask - 1) {
            const int lane = __builtin_ctz(mask);
            if (leaf.triangle[lane] != no_triangle)
                visit(leaf.triangle[lane] & ~needle_flag, corners_of(leaf, lane));
        }
    }
}

/// The part of a segment [steps] within `reach` of the root's box, or a little more: what is left has
/// coordinates that floats tell apart. False if nothing is.
template <int K>
bool clip_to_tree(const TreeView<K>& tree, double reach, Segment& segment)
{
    double enter = 0, leave = 1;
    const Segment whole = segment;
    const Point way = minus(whole.to, whole.from);
    for (int axis = 0; axis < 3; axis++) {
        const auto& lows = tree.nodes[0].low[axis];
        const auto& highs = tree.nodes[0].high[axis];
        const double a = whole.from[axis], room = reach + 0x1p-46 * (std::abs(a) + std::abs(way[axis]));
        const double low = *std::min_element(lows, lows + lanes) - room,
                     high = *std::max_element(highs, highs + lanes) + room;
        if (way[axis] == 0) {
            if (a < low || a > high)
                return false;
            continue;
        }
        const double s = (low - a) / way[axis], t = (high - a) / way[axis];
        enter = std::max(enter, std::min(s, t));
        leave = std::min(leave, std::max(s, t));
    }
    if (!(enter <= leave))
        return false;
    segment = {plus(whole.from, enter, way), leave < 1 ? plus(whole.from, leave, way) : whole.to};
    return true;
}

/// Rounding of a posed coordinate, relative.
constexpr double pose_rounding = 0x1p-50;

/// The box as seen from where the pose brings the tree's origin [mesh unit], widened by what the triangles'
/// vertices, and all that is computed, may be off by.
Box from_origin(const Box& box, const Grid& grid, const Pose& pose)
{
    constexpr double far = 8 * largest_coordinate; // infinite sides, so that products stay finite
    const bool unposed = pose.rotation == Pose{}.rotation;
    Box relative;
    for (int axis = 0; axis < 3; axis++) {
        const double* row = &pose.rotation[3 * axis];
        double origin = 0, magnitude = 0;
        for (int i = 0; i < 3; i++) {
            origin += row[i] * grid.origin[i];
            magnitude += std::abs(row[i] * grid.origin[i]);
        }
        const double slack = grid.vertex_error() + (unposed ? 0 : pose_rounding * magnitude);
        const double low = std::max(box.low[axis], -far) - pose.translation[axis] - origin;
        const double high = std::min(box.high[axis], far) - pose.translation[axis] - origin;
        relative.low[axis] = low - slack - Grid::arithmetic * std::abs(low);
        relative.high[axis] = high + slack + Grid::arithmetic * std::abs(high);
    }
    return relative;
}

/// The hull of that box in the tree's directions [steps].
template <int K>
Slabs<K> slabs_of_posed(const Box& relative, const Grid& grid, const Pose& pose)
{
    constexpr auto directions = hull_directions<K>();
    Slabs<K> slabs;
    for (int k = 0; k < K / 2; k++) {
        const auto& d = directions[k];
        double low = 0, high = 0, magnitude = 0;
        for (int axis = 0; axis < 3; axis++) {
            const double* row = &pose.rotation[3 * axis];
            const double c = row[0] * d[0] + row[1] * d[1] + row[2] * d[2];
            const double a = c * relative.low[axis], b = c * relative.high[axis];
            low += std::min(a, b);
            high += std::max(a, b);
            magnitude += std::max(std::abs(relative.low[axis]), std::abs(relative.high[axis]));
        }
        slabs[k] = {(low - pose_rounding * magnitude) * grid.steps_per_unit,
                    (high + pose_rounding * magnitude) * grid.steps_per_unit};
    }
    return slabs;
}

} // namespace

bool valid_segment(const Segment& segment, double radius)
{
    auto fits = [](const Point& p) {
        return std::abs(p[0]) <= largest_coordinate && std::abs(p[1]) <= largest_coordinate &&
               std::abs(p[2]) <= largest_coordinate;
    };
    return fits(segment.from) && fits(segment.to) && radius >= 0;
}

bool valid_box(const Box& box)
{
    return box.low[0] <= box.high[0] && box.low[1] <= box.high[1] && box.low[2] <= box.high[2];
}

template <int K>
void search_along(const TreeView<K>& tree, const Grid& grid, const Segment& segment, double radius,
                  std::uint32_t object, std::vector<Hit>& out)
{
    const Segment steps = {grid.to_steps(segment.from), grid.to_steps(segment.to)};
    const double limit = (radius + std::max(grid.distance_error(steps.from), grid.distance_error(steps.to))) *
                         grid.steps_per_unit;
    Segment clipped = steps;
    if (tree.levels.count == 0 || !clip_to_tree(tree, limit, clipped))
        return;
    for_near_triangles(tree, RegionHull<K>(clipped, limit), RegionHull<6>(clipped, limit),
                       [&](std::uint32_t triangle, const Corners& corners) {
                           const double distance = TriangleFrame(corners).distance(steps, limit);
                           if (distance <= limit)
                               out.push_back({object, triangle, distance * grid.step});
                       });
}

template <int K>
void search_box(const TreeView<K>& tree, const Grid& grid, const Pose& pose, const Box& box,
                std::uint32_t object, std::vector<Hit>& out)
{
    if (tree.levels.count == 0)
        return;
    const Box relative = from_origin(box, grid, pose);
    auto posed = [&](const Point& v) {
        Point w;
        for (int axis = 0; axis < 3; axis++) {
            const double* row = &pose.rotation[3 * axis];
            w[axis] = (row[0] * v[0] + row[1] * v[1] + row[2] * v[2]) * grid.step;
        }
        return w;
    };
    for_near_triangles(tree, RegionHull<K>(slabs_of_posed<K>(relative, grid, pose), 0),
                       RegionHull<6>(slabs_of_posed<6>(relative, grid, pose), 0),
                       [&](std::uint32_t triangle, const Corners& corners) {
                           const Corners there = {posed(corners[0]), posed(corners[1]), posed(corners[2])};
                           if (touches_box(there, relative.low, relative.high))
                               out.push_back({object, triangle, 0.0});
                       });
}

#define PHANTOM_FDH_REGIONS(K)                                                                               \
    template void search_along<K>(const TreeView<K>&, const Grid&, const Segment&, double, std::uint32_t,    \
                                  std::vector<Hit>&);                                                        \
    template void search_box<K>(const TreeView<K>&, const Grid&, const Pose&, const Box&, std::uint32_t,     \
                                std::vector<Hit>&);
PHANTOM_FDH_REGIONS(6)
PHANTOM_FDH_REGIONS(14)
PHANTOM_FDH_REGIONS(18)
PHANTOM_FDH_REGIONS(26)

} // namespace phantom::fdh
