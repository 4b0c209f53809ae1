// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/build.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include "fdh/large_memory.hpp"
#include "fdh/leaf.hpp"
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

struct Bounds {
    static constexpr double inf = std::numeric_limits<double>::infinity();
    Point low{inf, inf, inf}, high{-inf, -inf, -inf};

    void add(const Point& p)
    {
        for (std::size_t axis = 0; axis < 3; axis++) {
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    }
};

/// Which vertices triangles use, a byte each. False if one is not there.
bool mark_used(const MeshView& mesh, std::vector<unsigned char>& used, unsigned threads)
{
    used.assign(mesh.vertices.size(), 0);
    std::atomic<bool> all_there = true;
    parallel_for(0, mesh.triangles.size(), threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; i++)
            for (const std::uint32_t vertex : mesh.triangles[i]) {
                if (vertex >= used.size()) {
                    all_there = false;
                    return;
                }
                // Two threads may mark one vertex; they write the same.
                std::atomic_ref(used[vertex]).store(1, std::memory_order_relaxed);
            }
    });
    return all_there;
}

/// Box of the vertices that triangles use; throws at the first unusable triangle.
Bounds bounds(const MeshView& mesh, unsigned threads)
{
    std::vector<unsigned char> used;
    std::atomic<bool> good = mark_used(mesh, used, threads);
    Bounds all;
    std::mutex mutex;
    parallel_for(0, good ? used.size() : 0, threads, [&](std::size_t begin, std::size_t end) {
        Bounds part;
        for (std::size_t i = begin; i < end; i++) {
            if (!used[i])
                continue;
            part.add(mesh.vertices[i]);
            if (!usable(mesh.vertices[i])) {
                good = false;
                return;
            }
        }
        const std::lock_guard lock(mutex);
        all.add(part.low);
        all.add(part.high);
    });
    if (!good)
        for (std::size_t i = 0;; i++)
            if (!usable(mesh, mesh.triangles[i]))
                refuse(mesh, i);
    return all;
}

/// A vertex on the grid, as one vector register.
using GridVertex = std::array<float, 4>;

/// All vertices; what stands where no triangle looks is no matter.
LargeArray<GridVertex> grid_vertices(const MeshView& mesh, const Grid& grid, unsigned threads)
{
    auto vertices = large_array<GridVertex>(mesh.vertices.size());
    parallel_for(0, mesh.vertices.size(), threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; i++) {
            const auto v = grid.round(mesh.vertices[i]);
            vertices[i] = {v[0], v[1], v[2], 0};
        }
    });
    return vertices;
}

/// Of each triangle three times its centroid, in steps: the factor cancels.
Centres centres_of(std::span<const Triangle> triangles, const GridVertex* vertices, unsigned threads)
{
    Centres centres(triangles.size());
    parallel_for(0, centres.size(), threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; i++) {
            const GridVertex &a = vertices[triangles[i][0]], &b = vertices[triangles[i][1]],
                             &c = vertices[triangles[i][2]];
            for (int axis = 0; axis < 3; axis++) {
                const auto at = static_cast<std::size_t>(axis);
                centres.axis(axis)[i] = a[at] + b[at] + c[at];
            }
            centres.number()[i] = static_cast<std::uint32_t>(i);
        }
    });
    return centres;
}

/// Sums over the triangles of some leaves.
struct LeafSums {
    float longest_edge2 = 0; ///< [steps²]
    float area = 0;    ///< of the triangles, a step² more of each: a degenerate one is not free [steps²]
    float widths2 = 0; ///< squares of the leaves' mean widths [steps²]
};

/// Fills a leaf with triangles, lanes in their order. Returns its hull.
template <int K>
Hull<K> fill_leaf(Leaf& leaf, std::span<const std::uint32_t> numbers, std::span<const Triangle> triangles,
                  const GridVertex* vertices, const LeafKernels<K>& kernels, LeafSums& sums)
{
    alignas(64) LeafCorners corners;
    const std::size_t count = numbers.size();
    for (std::size_t lane = 0; lane < lanes; lane++) {
        const Triangle& t = triangles[numbers[lane < count ? lane : 0]];
        for (std::size_t i = 0; i < 3; i++) {
            const GridVertex& corner = vertices[t[i]];
            for (std::size_t axis = 0; axis < 3; axis++)
                corners[i][axis][lane] = corner[axis];
        }
    }
    MadeLeaf<K> made;
    kernels.make(corners, leaf, made);
    for (std::size_t lane = 0; lane < count; lane++) {
        leaf.triangle[lane] = numbers[lane] | (made.needles >> lane & 1 ? needle_flag : 0);
        sums.area += made.twice_area[lane] / 2 + 1;
    }
    for (std::size_t lane = count; lane < lanes; lane++) {
        for (int axis = 0; axis < 3; axis++) {
            leaf.vertex[axis][lane] = std::numeric_limits<float>::quiet_NaN();
            leaf.edge1[axis][lane] = leaf.edge2[axis][lane] = 0;
        }
        leaf.triangle[lane] = no_triangle;
    }
    sums.longest_edge2 = std::max(sums.longest_edge2, made.longest_edge2);
    Hull<K> hull;
    constexpr float exact = 16777216; // 2^24: beyond, floats are two apart
    for (int k = 0; k < K / 2; k++) {
        hull.low[k] = std::abs(made.low[k]) > exact ? made.low[k] - 2 : made.low[k];
        hull.high[k] = std::abs(made.high[k]) > exact ? made.high[k] + 2 : made.high[k];
    }
    float width = 0;
    for (int axis = 0; axis < 3; axis++)
        width += (hull.high[axis] - hull.low[axis] + 1) / 2;
    sums.widths2 += width * width;
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
        : nodes(large_array<Node<K>>(node_count)), leaves(large_array<Leaf>(leaf_count))
    {
    }
    LargeArray<Node<K>> nodes;
    LargeArray<Leaf> leaves;
};

/// Makes the tree of the triangles in the order that number(i) tells.
template <int K, class Number>
void fill(TreeData<K>& data, std::span<const Triangle> triangles, const GridVertex* vertices,
          const Number& number, unsigned threads, Isa isa)
{
    const LeafKernels<K>& kernels = leaf_kernels<K>(isa);
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
                set_child(node, static_cast<int>(lane),
                          fill_leaf<K>(leaves[l], {numbers, count}, triangles, vertices, kernels, parts[n]));
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
    double longest2 = 0, area = 0, widths2 = 0;
    for (const LeafSums& part : parts) {
        longest2 = std::max(longest2, double{part.longest_edge2});
        area += double{part.area};
        widths2 += double{part.widths2};
    }
    data.longest_edge = std::sqrt(longest2) * (1 + 0x1p-20);
    data.spread = widths2 / area;
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
    const Bounds box = bounds(mesh, threads);
    data.grid = Grid::over(box.low, box.high);
    const auto vertices = grid_vertices(mesh, data.grid, threads);
    Centres centres = centres_of(mesh.triangles, vertices.get(), threads);
    order_by_halves(centres, threads, isa);
    fill(
        data, mesh.triangles, vertices.get(), [&](std::size_t i) { return centres.number()[i]; }, threads,
        isa);
    return data;
}

template <int K>
TreeData<K> refit_tree(const TreeData<K>& old, const MeshView& mesh, unsigned threads, Isa isa)
{
    if (mesh.triangles.size() != old.triangles)
        throw std::invalid_argument("fdh: " + std::to_string(mesh.triangles.size()) +
                                    " triangles for a tree of " + std::to_string(old.triangles));
    TreeData<K> data;
    data.triangles = old.triangles;
    if (mesh.triangles.empty())
        return data;
    const Bounds box = bounds(mesh, threads);
    data.grid = Grid::over(box.low, box.high);
    const auto vertices = grid_vertices(mesh, data.grid, threads);
    fill(
        data, mesh.triangles, vertices.get(),
        [&](std::size_t i) { return old.leaves[i / lanes].triangle[i % lanes] & ~needle_flag; }, threads,
        isa);
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
    template TreeData<K> refit_tree<K>(const TreeData<K>&, const MeshView&, unsigned, Isa);                  \
    template bool consistent<K>(const TreeData<K>&);
PHANTOM_FDH_BUILD(6)
PHANTOM_FDH_BUILD(14)
PHANTOM_FDH_BUILD(18)
PHANTOM_FDH_BUILD(26)

} // namespace phantom::fdh
