// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/build.hpp"

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <string>
#include <utility>

#include "fdh/parallel.hpp"
#include "fdh/split.hpp"

namespace phantom::fdh {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

bool usable(const Point& p)
{
    return std::abs(p[0]) <= largest_coordinate && std::abs(p[1]) <= largest_coordinate &&
           std::abs(p[2]) <= largest_coordinate; // false for NaN
}

bool usable(const MeshView& mesh, const Triangle& triangle)
{
    return std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t vertex) {
        return vertex < mesh.vertices.size() && usable(mesh.vertices[vertex]);
    });
}

[[noreturn]] void refuse(const MeshView& mesh, std::size_t index)
{
    const std::string where = "fdh: triangle " + std::to_string(index) + " ";
    for (std::uint32_t vertex : mesh.triangles[index])
        if (vertex >= mesh.vertices.size())
            throw std::invalid_argument(where + "refers to vertex " + std::to_string(vertex) + " of " +
                                        std::to_string(mesh.vertices.size()));
    throw std::invalid_argument(where + "has a vertex that is not finite or too far away to compute with");
}

/// Box of the vertices that triangles use; throws at the first unusable triangle.
std::array<Point, 2> bounds(const MeshView& mesh, unsigned threads)
{
    constexpr double inf = std::numeric_limits<double>::infinity();
    std::atomic<std::size_t> first_bad = mesh.triangles.size();
    std::array<std::atomic<double>, 6> extremes;
    for (auto& extreme : extremes)
        extreme = inf;
    auto lower = [](auto& shared, auto value) {
        auto seen = shared.load();
        while (value < seen && !shared.compare_exchange_weak(seen, value)) {
        }
    };
    parallel_for(0, mesh.triangles.size(), threads, [&](std::size_t begin, std::size_t end) {
        double local[6] = {inf, inf, inf, inf, inf, inf}; // lows, negated highs
        for (std::size_t i = begin; i < end; i++) {
            if (!usable(mesh, mesh.triangles[i])) {
                lower(first_bad, i);
                return;
            }
            for (std::uint32_t vertex : mesh.triangles[i])
                for (int axis = 0; axis < 3; axis++) {
                    local[axis] = std::min(local[axis], mesh.vertices[vertex][axis]);
                    local[3 + axis] = std::min(local[3 + axis], -mesh.vertices[vertex][axis]);
                }
        }
        for (int i = 0; i < 6; i++)
            lower(extremes[i], local[i]);
    });
    if (first_bad < mesh.triangles.size())
        refuse(mesh, first_bad);
    return {Point{extremes[0], extremes[1], extremes[2]}, Point{-extremes[3], -extremes[4], -extremes[5]}};
}

std::vector<PrimitiveBox> boxes_of(const MeshView& mesh, const Grid& grid, unsigned threads)
{
    std::vector<PrimitiveBox> boxes(mesh.triangles.size());
    parallel_for(0, boxes.size(), threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; i++) {
            const auto& t = mesh.triangles[i];
            const auto a = grid.round(mesh.vertices[t[0]]), b = grid.round(mesh.vertices[t[1]]),
                       c = grid.round(mesh.vertices[t[2]]);
            PrimitiveBox& box = boxes[i];
            for (int axis = 0; axis < 3; axis++) {
                box.low[axis] = std::min({a[axis], b[axis], c[axis]});
                box.high[axis] = std::max({a[axis], b[axis], c[axis]});
            }
            box.index = static_cast<std::uint32_t>(i);
            box.unused = 0;
        }
    });
    return boxes;
}

void fill_leaf(Leaf& leaf, std::span<const PrimitiveBox> members, const MeshView& mesh, const Grid& grid)
{
    for (std::size_t lane = 0; lane < lanes; lane++) {
        if (lane >= members.size()) {
            for (int axis = 0; axis < 3; axis++) {
                leaf.vertex[axis][lane] = std::numeric_limits<float>::quiet_NaN();
                leaf.edge1[axis][lane] = leaf.edge2[axis][lane] = 0;
            }
            leaf.triangle[lane] = no_triangle;
            continue;
        }
        const auto& t = mesh.triangles[members[lane].index];
        const auto a = grid.round(mesh.vertices[t[0]]), b = grid.round(mesh.vertices[t[1]]),
                   c = grid.round(mesh.vertices[t[2]]);
        for (int axis = 0; axis < 3; axis++) {
            leaf.vertex[axis][lane] = a[axis];
            leaf.edge1[axis][lane] = b[axis] - a[axis];
            leaf.edge2[axis][lane] = c[axis] - a[axis];
        }
        leaf.triangle[lane] = members[lane].index;
    }
}

template <int Sign>
float signed_term(float x)
{
    return Sign > 0 ? x : Sign < 0 ? -x : 0.0f;
}

/// Low and high of a leaf's triangles in one direction. Its components are -1, 0 or 1, known to the compiler:
/// lane by lane this is additions and minima of whole vectors.
template <int K, std::size_t Direction>
void bound(Hull<K>& hull, const float (&corners)[3][3][lanes])
{
    constexpr auto d = hull_directions<K>()[Direction];
    float low[lanes], high[lanes];
    for (int lane = 0; lane < lanes; lane++) {
        float x[3];
        for (int i = 0; i < 3; i++)
            x[i] = signed_term<d[0]>(corners[i][0][lane]) + signed_term<d[1]>(corners[i][1][lane]) +
                   signed_term<d[2]>(corners[i][2][lane]);
        const float lower = x[0] < x[1] ? x[0] : x[1], higher = x[0] > x[1] ? x[0] : x[1];
        low[lane] = x[2] < lower ? x[2] : lower;
        high[lane] = x[2] > higher ? x[2] : higher;
    }
    for (int lane = 0; lane < lanes; lane++) { // NaN, of unused lanes, is neither less nor more
        hull.low[Direction] = low[lane] < hull.low[Direction] ? low[lane] : hull.low[Direction];
        hull.high[Direction] = high[lane] > hull.high[Direction] ? high[lane] : hull.high[Direction];
    }
}

template <int K, std::size_t... Directions>
void bound_all(Hull<K>& hull, const float (&corners)[3][3][lanes], std::index_sequence<Directions...>)
{
    (bound<K, Directions>(hull, corners), ...);
}

/// Hull of a leaf's triangles. Three coordinates may add up to more than 2^24 steps, where floats are two
/// apart and the sum is off by one at most: there it is widened by two.
template <int K>
Hull<K> hull_of(const Leaf& leaf)
{
    float corners[3][3][lanes]; // whole numbers up to 2^23: exact
    for (int axis = 0; axis < 3; axis++)
        for (int lane = 0; lane < lanes; lane++) {
            corners[0][axis][lane] = leaf.vertex[axis][lane];
            corners[1][axis][lane] = leaf.vertex[axis][lane] + leaf.edge1[axis][lane];
            corners[2][axis][lane] = leaf.vertex[axis][lane] + leaf.edge2[axis][lane];
        }
    Hull<K> hull = Hull<K>::empty();
    bound_all(hull, corners, std::make_index_sequence<K / 2>{});
    constexpr float exact = 16777216; // 2^24
    for (int k = 0; k < K / 2; k++) {
        if (std::abs(hull.low[k]) > exact)
            hull.low[k] -= 2;
        if (std::abs(hull.high[k]) > exact)
            hull.high[k] += 2;
    }
    return hull;
}

} // namespace

template <int K>
Hull<K> Hull<K>::empty()
{
    Hull hull;
    std::fill(std::begin(hull.low), std::end(hull.low), infinity);
    std::fill(std::begin(hull.high), std::end(hull.high), -infinity);
    return hull;
}

template <int K>
void Hull<K>::grow(const Hull& other)
{
    for (int k = 0; k < K / 2; k++) {
        low[k] = std::min(low[k], other.low[k]);
        high[k] = std::max(high[k], other.high[k]);
    }
}

template <int K>
Hull<K> hull_of(const Node<K>& node)
{
    Hull<K> hull;
    for (int k = 0; k < K / 2; k++) {
        hull.low[k] = *std::min_element(node.low[k], node.low[k] + lanes);
        hull.high[k] = *std::max_element(node.high[k], node.high[k] + lanes);
    }
    return hull;
}

template <int K>
void set_child(Node<K>& node, int lane, const Hull<K>& hull, std::uint32_t child)
{
    for (int k = 0; k < K / 2; k++) {
        node.low[k][lane] = hull.low[k];
        node.high[k][lane] = hull.high[k];
    }
    node.child[lane] = child;
}

template <int K>
Node<K> empty_node()
{
    Node<K> node;
    for (int lane = 0; lane < lanes; lane++)
        set_child(node, lane, Hull<K>::empty(), 0);
    return node;
}

template <int K>
TreeData<K> build_tree(const MeshView& mesh, unsigned threads)
{
    if (mesh.triangles.size() >= leaf_flag)
        throw std::invalid_argument("fdh: " + std::to_string(mesh.triangles.size()) +
                                    " triangles in one tree; it holds 2147483647");
    TreeData<K> data;
    data.triangles = mesh.triangles.size();
    if (mesh.triangles.empty())
        return data;
    const auto [low, high] = bounds(mesh, threads);
    data.grid = Grid::over(low, high);
    auto boxes = boxes_of(mesh, data.grid, threads);
    const Shape shape = split(boxes, lanes, threads);

    struct Storage {
        std::vector<Node<K>> nodes;
        std::vector<Leaf> leaves;
    };
    auto storage = std::make_shared<Storage>();
    std::vector<Node<K>>& nodes = storage->nodes;
    std::vector<Leaf>& leaves = storage->leaves;
    nodes.resize(shape.nodes.size());
    leaves.resize(shape.leaves);
    parallel_for(0, shape.nodes.size(), threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; n++) {
            nodes[n] = empty_node<K>();
            for (int i = 0; i < shape.nodes[n].count; i++) {
                const auto& child = shape.nodes[n].children[i];
                Hull<K> hull = Hull<K>::empty();
                if (child.reference & leaf_flag) {
                    Leaf& leaf = leaves[child.reference & ~leaf_flag];
                    fill_leaf(leaf, std::span(boxes).subspan(child.begin, child.end - child.begin), mesh,
                              data.grid);
                    hull = hull_of<K>(leaf);
                }
                set_child(nodes[n], i, hull, child.reference);
            }
        }
    });
    // Children stand behind their parents: from the back, each is complete when its parent asks.
    for (std::size_t n = shape.nodes.size(); n-- > 0;)
        for (int i = 0; i < shape.nodes[n].count; i++)
            if (const auto reference = shape.nodes[n].children[i].reference; !(reference & leaf_flag))
                set_child(nodes[n], i, hull_of(nodes[reference]), reference);
    data.nodes = nodes;
    data.leaves = leaves;
    data.storage = std::move(storage);
    return data;
}

template <int K>
bool consistent(const TreeData<K>& data)
{
    if (data.nodes.empty() != (data.triangles == 0))
        return false;
    for (std::size_t n = 0; n < data.nodes.size(); n++) {
        for (int lane = 0; lane < lanes; lane++) {
            if (data.nodes[n].low[0][lane] == infinity) // unused
                continue;
            const std::uint32_t child = data.nodes[n].child[lane];
            const std::size_t index = child & ~leaf_flag;
            if (child & leaf_flag ? index >= data.leaves.size() : index <= n || index >= data.nodes.size())
                return false;
        }
    }
    return std::all_of(data.leaves.begin(), data.leaves.end(), [&](const Leaf& leaf) {
        return std::all_of(leaf.triangle, leaf.triangle + lanes, [&](std::uint32_t triangle) {
            return triangle < data.triangles || triangle == no_triangle;
        });
    });
}

#define PHANTOM_FDH_BUILD(K)                                                                                 \
    template struct Hull<K>;                                                                                 \
    template Hull<K> hull_of<K>(const Node<K>&);                                                             \
    template void set_child<K>(Node<K>&, int, const Hull<K>&, std::uint32_t);                                \
    template Node<K> empty_node<K>();                                                                        \
    template TreeData<K> build_tree<K>(const MeshView&, unsigned);                                           \
    template bool consistent<K>(const TreeData<K>&);
PHANTOM_FDH_BUILD(6)
PHANTOM_FDH_BUILD(14)
PHANTOM_FDH_BUILD(18)
PHANTOM_FDH_BUILD(26)

} // namespace phantom::fdh
