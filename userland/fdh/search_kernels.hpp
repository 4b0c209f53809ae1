// SPDX-License-Identifier: GPL-2.0-or-later
// The search itself, written once over the width of the vectors. Included only by search_<isa>.cpp, each
// compiled for its instruction set; calls no inline function of the standard library, because the linker
// might pick the copy compiled here for a processor that cannot run it.
#pragma once

#include "fdh/search.hpp"
#include "fdh/simd.hpp"

namespace phantom::fdh {

/// Squared distance from a point to each of `double_width` triangles.
///
/// The nearest point lies in the face's interior if the point's foot is on the inner side of all three walls
/// (planes through an edge, parallel to the normal n); otherwise on one of the edges. With edges and n exact,
/// a wall's sign is wrong only within rounding (2^-50 of the distance to the triangle) of the wall, where
/// both cases agree. Whole-number edges are at least one step long or zero, so max(.., 1) divides by zero
/// never and alters nothing: a zero edge is its end point, and n = 0 leaves the edges.
template <Isa I>
struct TriangleDistance {
    using S = Simd<I>;
    using V = typename S::Double;

    struct Vector {
        V x, y, z;
    };
    static V dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
    static Vector minus(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    static Vector cross(const Vector& a, const Vector& b)
    {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
    static Vector load(const float (&field)[3][lanes], int lane)
    {
        return {S::load_double(field[0] + lane), S::load_double(field[1] + lane),
                S::load_double(field[2] + lane)};
    }

    /// To the segment from 0 to e; p relative to its start.
    static V to_segment(const Vector& p, const Vector& e)
    {
        const V zero{}, one = zero + 1;
        const V t = S::min(S::max(dot(p, e) / S::max(dot(e, e), one), zero), one);
        const Vector r = {p.x - t * e.x, p.y - t * e.y, p.z - t * e.z};
        return dot(r, r);
    }

    static V squared(const Leaf& leaf, int lane, const Vector& point)
    {
        const V zero{}, one = zero + 1;
        const Vector u = load(leaf.edge1, lane), v = load(leaf.edge2, lane), w = minus(v, u);
        const Vector p = minus(point, load(leaf.vertex, lane)), q = minus(p, u);
        const V edges = S::min(to_segment(q, w), S::min(to_segment(p, u), to_segment(p, v)));
        const Vector n = cross(u, v);
        const V nn = dot(n, n), height = dot(n, p);
        const V plane = height / S::max(nn, one) * height;
        const auto inside = (dot(n, cross(u, p)) >= zero) & (dot(n, cross(p, v)) >= zero) &
                            (dot(n, cross(w, q)) >= zero) & (nn >= one);
        return inside ? plane : edges;
    }
};

/// Lower bounds of the squared distance from a point to hulls. With e_d the excess of the point beyond the
/// hull in direction d (unnormalised), w the vector to the nearest point of the hull, d·w >= e_d, so
///   axes            |w|² >= Σ e²
///   cube diagonals  |w|² >= e²/3 each, and Σ e² / 4, because Σ d dᵀ = 4 I
///   face diagonals  |w|² >= (e² + e'²)/2 + f² for the two in the plane of two axes and f of the third axis
/// and the largest holds.
template <Isa I, int K>
struct HullDistance {
    using S = Simd<I>;
    using V = typename S::Float;

    static V excess2(const Node<K>& node, const ProjectedPoint<K>& point, int k, int lane)
    {
        const V zero{};
        const V below = S::load(node.low[k] + lane) - point.high[k];
        const V above = point.low[k] - S::load(node.high[k] + lane);
        const V e = S::max(S::max(below, above), zero);
        return e * e;
    }

    static V squared(const Node<K>& node, const ProjectedPoint<K>& point, int lane)
    {
        auto e2 = [&](int k) { return excess2(node, point, k, lane); };
        const V x = e2(0), y = e2(1), z = e2(2);
        V bound = x + y + z;
        if constexpr (K == 14 || K == 26) {
            const V a = e2(3), b = e2(4), c = e2(5), d = e2(6);
            const V largest = S::max(S::max(a, b), S::max(c, d));
            bound = S::max(bound, S::max(largest * (1.0f / 3), ((a + b) + (c + d)) * 0.25f));
        }
        if constexpr (K == 18 || K == 26) {
            constexpr int first = K == 18 ? 3 : 7;
            bound = S::max(bound, (e2(first) + e2(first + 1)) * 0.5f + z);
            bound = S::max(bound, (e2(first + 2) + e2(first + 3)) * 0.5f + y);
            bound = S::max(bound, (e2(first + 4) + e2(first + 5)) * 0.5f + x);
        }
        return bound;
    }

    static void all(const Node<K>& node, const ProjectedPoint<K>& point, float (&distance2)[lanes])
    {
        for (int lane = 0; lane < lanes; lane += S::float_width) {
            const V d = squared(node, point, lane);
            __builtin_memcpy(distance2 + lane, &d, sizeof d);
        }
    }

    /// As `all`; returns the lanes nearer than the limit as bits.
    static unsigned nearer(const Node<K>& node, const ProjectedPoint<K>& point, float limit,
                           float (&distance2)[lanes])
    {
        unsigned result = 0;
        for (int lane = 0; lane < lanes; lane += S::float_width) {
            const V d = squared(node, point, lane);
            __builtin_memcpy(distance2 + lane, &d, sizeof d);
            result |= S::bits(d < limit) << lane;
        }
        return result;
    }
};

template <Isa I, int K>
struct Search {
    using S = Simd<I>;
    using Distance = TriangleDistance<I>;

    /// A child still to be visited.
    struct Waiting {
        float bound2; ///< of its hull [steps²]
        std::uint32_t child;
    };

    static void prefetch(const void* address, unsigned bytes)
    {
        for (unsigned offset = 0; offset < bytes; offset += 64)
            __builtin_prefetch(static_cast<const char*>(address) + offset);
    }

    /// Puts the children on the stack, farthest first, so that the nearest is visited next.
    static int push(Waiting* stack, int top, const Node<K>& node, unsigned mask, const float (&bound2)[lanes],
                    const Node<K>* nodes, const Leaf* leaves)
    {
        const int base = top;
        for (; mask; mask &= mask - 1) {
            const int lane = __builtin_ctz(mask);
            const Waiting entry{bound2[lane], node.child[lane]};
            if (entry.child & leaf_flag)
                prefetch(&leaves[entry.child & ~leaf_flag], sizeof(Leaf));
            else
                prefetch(&nodes[entry.child], sizeof(Node<K>));
            int place = top++;
            for (; place > base && stack[place - 1].bound2 < entry.bound2; place--)
                stack[place] = stack[place - 1];
            stack[place] = entry;
        }
        return top;
    }

    /// In steps, rounded up.
    static double squared_limit(const Sink& sink, const SearchQuery<K>& query)
    {
        const double limit = sink.limit / query.step;
        return limit * limit * (1 + 0x1p-50);
    }

    /// Tests a leaf's triangles; true if the sink's limit may have changed.
    static bool visit(const Leaf& leaf, const SearchQuery<K>& query, const typename Distance::Vector& point,
                      double limit2, Sink& sink)
    {
        using V = typename S::Double;
        const bool made_room = sink.size + lanes > sink.capacity;
        if (made_room)
            sink.full(sink);
        const auto before = sink.size;
        for (int lane = 0; lane < lanes; lane += S::double_width) {
            const V d2 = Distance::squared(leaf, lane, point);
            const unsigned mask = S::bits(d2 <= limit2);
            if (mask == 0)
                continue;
            const V distance = S::sqrt(d2) * query.step;
            // Every lane is written and the next hit overwrites those that are none: no branch to mispredict.
            for (int i = 0; i < S::double_width; i++) {
                Hit& hit = sink.hits[sink.size];
                hit.object = query.object;
                hit.triangle = leaf.triangle[lane + i];
                hit.distance = distance[i];
                sink.size += mask >> i & 1;
            }
        }
        sink.counts.triangles += sink.size - before;
        return made_room;
    }

    static void run(const Node<K>* nodes, const Leaf* leaves, const SearchQuery<K>& query, Sink& sink)
    {
        using V = typename S::Double;
        const V zero{};
        const auto& p = query.point;
        const typename Distance::Vector point = {zero + p[0], zero + p[1], zero + p[2]};
        double limit2 = squared_limit(sink, query);
        float hull_limit = search_limit(limit2);
        Waiting stack[stack_size];
        int top = 0;
        std::uint32_t current = 0;
        for (;;) {
            if (current & leaf_flag) {
                sink.counts.leaves++;
                if (visit(leaves[current & ~leaf_flag], query, point, limit2, sink)) {
                    limit2 = squared_limit(sink, query);
                    hull_limit = search_limit(limit2);
                }
            } else {
                sink.counts.nodes++;
                const Node<K>& node = nodes[current];
                float bound2[lanes];
                const unsigned mask = HullDistance<I, K>::nearer(node, query.projected, hull_limit, bound2);
                top = push(stack, top, node, mask, bound2, nodes, leaves);
            }
            do {
                if (top == 0)
                    return;
                top--;
            } while (!(stack[top].bound2 < hull_limit));
            current = stack[top].child;
        }
    }
};

template <Isa I, int K>
const SearchKernels<K>& kernels_of()
{
    static constexpr SearchKernels<K> table = {&Search<I, K>::run, &HullDistance<I, K>::all};
    return table;
}

} // namespace phantom::fdh

/// Instantiates the search for one instruction set.
#define PHANTOM_FDH_SEARCH(isa)                                                                              \
    namespace phantom::fdh {                                                                                 \
    template const SearchKernels<6>& kernels_of<isa, 6>();                                                   \
    template const SearchKernels<14>& kernels_of<isa, 14>();                                                 \
    template const SearchKernels<18>& kernels_of<isa, 18>();                                                 \
    template const SearchKernels<26>& kernels_of<isa, 26>();                                                 \
    }
