// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/build.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include "fdh/order.hpp"
#include "fdh/parallel.hpp"

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

/// Of each triangle three times its centroid, in steps: the factor cancels.
Centres centres_of(const MeshView& mesh, const Grid& grid, unsigned threads)
{
    Centres centres(mesh.triangles.size());
    parallel_for(0, centres.size(), threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; i++) {
            const auto& t = mesh.triangles[i];
            const Point &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
            for (int axis = 0; axis < 3; axis++) {
                const double o = grid.origin[axis];
                const double sum = (a[axis] - o) + (b[axis] - o) + (c[axis] - o);
                centres.axis(axis)[i] = static_cast<float>(sum * grid.steps_per_unit);
            }
            centres.number()[i] = static_cast<std::uint32_t>(i);
        }
    });
    return centres;
}

/// Sums over the triangles of some leaves.
struct LeafSums {
    float longest_edge2 = 0; ///< [steps²]
    float own_boxes = 0;     ///< half surfaces of the triangles' boxes [steps²]
    float leaf_boxes = 0;    ///< and of their leaves'
};

/// The corners of a leaf's triangles: [corner][axis][lane].
using Corners = float[3][3][lanes];

/// Half the surface of a box, a step thicker than it is: flat boxes, lines and points are not free.
float half_surface(float x, float y, float z)
{
    return (x + 1) * (y + z + 2) + (y + 1) * (z + 1);
}

/// Turns every triangle so that its longest edge is opposite its first corner. Returns that edge squared.
void longest_edge_last(Corners& corners, float (&longest2)[lanes])
{
    for (int lane = 0; lane < lanes; lane++) {
        float edge2[3] = {}; // opposite each corner
        for (int axis = 0; axis < 3; axis++) {
            const float a = corners[0][axis][lane], b = corners[1][axis][lane], c = corners[2][axis][lane];
            edge2[0] += (c - b) * (c - b);
            edge2[1] += (a - c) * (a - c);
            edge2[2] += (b - a) * (b - a);
        }
        const float larger = edge2[1] > edge2[2] ? edge2[1] : edge2[2];
        longest2[lane] = edge2[0] > larger ? edge2[0] : larger;
        const bool second = edge2[1] == longest2[lane] && edge2[0] < edge2[1];
        const bool third = edge2[0] < longest2[lane] && !second;
        for (int axis = 0; axis < 3; axis++) {
            const float a = corners[0][axis][lane], b = corners[1][axis][lane], c = corners[2][axis][lane];
            corners[0][axis][lane] = second ? b : third ? c : a;
            corners[1][axis][lane] = second ? c : third ? a : b;
            corners[2][axis][lane] = second ? a : third ? b : c;
        }
    }
}

/// Whether each triangle's normal, computed in float, would be too far off (needle_flag). A degenerate
/// triangle's computed normal is rounding error and as short as that.
void find_needles(const Leaf& leaf, bool (&needle)[lanes])
{
    for (int lane = 0; lane < lanes; lane++) {
        const float u[3] = {leaf.edge1[0][lane], leaf.edge1[1][lane], leaf.edge1[2][lane]};
        const float v[3] = {leaf.edge2[0][lane], leaf.edge2[1][lane], leaf.edge2[2][lane]};
        const float n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
        const float nn = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
        const float uu = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
        const float vv = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        constexpr auto sine2 = static_cast<float>(needle_sine * needle_sine);
        // Relative: the product of two squared lengths, up to 2^99, is a float.
        needle[lane] = !(nn >= sine2 * uu * vv) || nn == 0;
    }
}

/// Fills a leaf with triangles, lanes in their order.
void fill_leaf(Leaf& leaf, const std::uint32_t* numbers, int count, const MeshView& mesh, const Grid& grid,
               LeafSums& sums)
{
    alignas(64) Corners corners;
    for (int lane = 0; lane < lanes; lane++) {
        const auto& t = mesh.triangles[numbers[lane < count ? lane : 0]];
        for (std::size_t i = 0; i < 3; i++) {
            const auto corner = grid.round(mesh.vertices[t[i]]);
            for (std::size_t axis = 0; axis < 3; axis++)
                corners[i][axis][lane] = corner[axis];
        }
    }
    float longest2[lanes];
    bool needle[lanes];
    longest_edge_last(corners, longest2);
    float size[3][lanes];
    for (int axis = 0; axis < 3; axis++)
        for (int lane = 0; lane < lanes; lane++) {
            const float a = corners[0][axis][lane], b = corners[1][axis][lane], c = corners[2][axis][lane];
            leaf.vertex[axis][lane] = a;
            leaf.edge1[axis][lane] = b - a;
            leaf.edge2[axis][lane] = c - a;
            const float lower = a < b ? a : b, higher = a > b ? a : b;
            size[axis][lane] = (higher > c ? higher : c) - (lower < c ? lower : c);
        }
    find_needles(leaf, needle);
    for (int lane = 0; lane < count; lane++) {
        leaf.triangle[lane] = numbers[lane] | (needle[lane] ? needle_flag : 0);
        sums.longest_edge2 = std::max(sums.longest_edge2, longest2[lane]);
        sums.own_boxes += half_surface(size[0][lane], size[1][lane], size[2][lane]);
    }
    for (int lane = count; lane < lanes; lane++) {
        for (int axis = 0; axis < 3; axis++) {
            leaf.vertex[axis][lane] = std::numeric_limits<float>::quiet_NaN();
            leaf.edge1[axis][lane] = leaf.edge2[axis][lane] = 0;
        }
        leaf.triangle[lane] = no_triangle;
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
void set_child(Node<K>& node, int lane, const Hull<K>& hull)
{
    for (int k = 0; k < K / 2; k++) {
        node.low[k][lane] = hull.low[k];
        node.high[k][lane] = hull.high[k];
    }
}

template <int K>
Node<K> empty_node()
{
    Node<K> node;
    for (int lane = 0; lane < lanes; lane++)
        set_child(node, lane, Hull<K>::empty());
    return node;
}

namespace {

/// The arrays of a tree while they are filled. Not cleared: every byte is written, on the thread that fills
/// it, which is also how the pages come to be.
template <int K>
struct Storage {
    Storage(std::size_t node_count, std::size_t leaf_count)
        : nodes(static_cast<Node<K>*>(allocate(node_count * sizeof(Node<K>)))),
          leaves(static_cast<Leaf*>(allocate(leaf_count * sizeof(Leaf))))
    {
    }
    struct Release {
        void operator()(void* memory) const { ::operator delete (memory, std::align_val_t{64}); }
    };
    static void* allocate(std::size_t bytes) { return ::operator new (bytes, std::align_val_t{64}); }

    std::unique_ptr<Node<K>, Release> nodes;
    std::unique_ptr<Leaf, Release> leaves;
};

/// Makes the tree of the triangles in the order that number(i) tells.
template <int K, class Number>
void fill(TreeData<K>& data, const MeshView& mesh, const Number& number, unsigned threads)
{
    const std::size_t leaf_count = (data.triangles + lanes - 1) / lanes;
    const Levels levels = Levels::above(leaf_count);
    auto storage = std::make_shared<Storage<K>>(levels.nodes(), leaf_count);
    Node<K>* const nodes = storage->nodes.get();
    Leaf* const leaves = storage->leaves.get();
    std::vector<LeafSums> parts(levels.size[0]); // a node's each: the sum does not depend on the threads
    parallel_for(0, levels.size[0], threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; n++) {
            Node<K> node = empty_node<K>();
            for (std::size_t lane = 0; lane < lanes && n * lanes + lane < leaf_count; lane++) {
                const std::size_t l = n * lanes + lane, first = l * lanes;
                const std::size_t count = std::min<std::size_t>(lanes, data.triangles - first);
                std::uint32_t numbers[lanes];
                for (std::size_t i = 0; i < count; i++)
                    numbers[i] = number(first + i);
                fill_leaf(leaves[l], numbers, static_cast<int>(count), mesh, data.grid, parts[n]);
                const Hull<K> hull = hull_of<K>(leaves[l]);
                parts[n].leaf_boxes += half_surface(hull.high[0] - hull.low[0], hull.high[1] - hull.low[1],
                                                    hull.high[2] - hull.low[2]);
                set_child(node, static_cast<int>(lane), hull);
            }
            nodes[levels.base[0] + n] = node;
        }
    });
    for (int level = 1; level < levels.count; level++)
        parallel_for(0, levels.size[level], threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t n = begin; n < end; n++) {
                Node<K>& node = nodes[levels.base[level] + n];
                node = empty_node<K>();
                for (std::size_t i = 0; i < lanes && n * lanes + i < levels.size[level - 1]; i++)
                    set_child(node, static_cast<int>(i),
                              hull_of(nodes[levels.base[level - 1] + n * lanes + i]));
            }
        });
    data.nodes = {nodes, levels.nodes()};
    data.leaves = {leaves, leaf_count};
    double longest2 = 0, own = 0, leaf = 0;
    for (const LeafSums& part : parts) {
        longest2 = std::max(longest2, double{part.longest_edge2});
        own += double{part.own_boxes};
        leaf += double{part.leaf_boxes};
    }
    data.longest_edge = std::sqrt(longest2) * (1 + 0x1p-20);
    data.spread = leaf / own;
    data.storage = std::move(storage);
}

void check_count(const MeshView& mesh)
{
    if (mesh.triangles.size() >= most_triangles)
        throw std::invalid_argument("fdh: " + std::to_string(mesh.triangles.size()) +
                                    " triangles in one tree; it holds " + std::to_string(most_triangles - 1));
}

} // namespace

template <int K>
TreeData<K> build_tree(const MeshView& mesh, unsigned threads, Isa isa)
{
    check_count(mesh);
    TreeData<K> data;
    data.triangles = mesh.triangles.size();
    if (mesh.triangles.empty())
        return data;
    const auto [low, high] = bounds(mesh, threads);
    data.grid = Grid::over(low, high);
    Centres centres = centres_of(mesh, data.grid, threads);
    order_by_halves(centres, threads, isa);
    fill(
        data, mesh, [&](std::size_t i) { return centres.number()[i]; }, threads);
    return data;
}

template <int K>
TreeData<K> refit_tree(const TreeData<K>& old, const MeshView& mesh, unsigned threads)
{
    if (mesh.triangles.size() != old.triangles)
        throw std::invalid_argument("fdh: " + std::to_string(mesh.triangles.size()) +
                                    " triangles for a tree of " + std::to_string(old.triangles));
    TreeData<K> data;
    data.triangles = old.triangles;
    if (mesh.triangles.empty())
        return data;
    const auto [low, high] = bounds(mesh, threads);
    data.grid = Grid::over(low, high);
    fill(
        data, mesh, [&](std::size_t i) { return old.leaves[i / lanes].triangle[i % lanes] & ~needle_flag; },
        threads);
    return data;
}

template <int K>
bool consistent(const TreeData<K>& data)
{
    if (data.leaves.size() != (data.triangles + lanes - 1) / lanes ||
        data.nodes.size() != Levels::above(data.leaves.size()).nodes() || !(data.longest_edge >= 0))
        return false;
    for (std::size_t i = 0; i < data.leaves.size() * lanes; i++) {
        const std::uint32_t number = data.leaves[i / lanes].triangle[i % lanes];
        if (i < data.triangles ? (number & ~needle_flag) >= data.triangles : number != no_triangle)
            return false;
    }
    return true;
}

#define PHANTOM_FDH_BUILD(K)                                                                                 \
    template struct Hull<K>;                                                                                 \
    template Hull<K> hull_of<K>(const Node<K>&);                                                             \
    template void set_child<K>(Node<K>&, int, const Hull<K>&);                                               \
    template Node<K> empty_node<K>();                                                                        \
    template TreeData<K> build_tree<K>(const MeshView&, unsigned, Isa);                                      \
    template TreeData<K> refit_tree<K>(const TreeData<K>&, const MeshView&, unsigned);                       \
    template bool consistent<K>(const TreeData<K>&);
PHANTOM_FDH_BUILD(6)
PHANTOM_FDH_BUILD(14)
PHANTOM_FDH_BUILD(18)
PHANTOM_FDH_BUILD(26)

} // namespace phantom::fdh
