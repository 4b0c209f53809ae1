// SPDX-License-Identifier: GPL-2.0-or-later
// The search itself, written once over the width of the vectors. Included only by kernels_<isa>.cpp, each
// compiled for its instruction set; calls no inline function of the standard library, because the linker
// might pick the copy compiled here for a processor that cannot run it.
#pragma once

#include <cstddef>

#include "fdh/lane_math.hpp"
#include "fdh/search.hpp"

namespace phantom::fdh {

/// Squared distance from a point to each of `width` triangles, in float.
///
/// The nearest point lies in the face's interior if the point's foot is on the inner side of all three walls
/// (planes through an edge, parallel to the normal n); otherwise on one of the edges. Whole-number edges are
/// at least one step long or zero, so max(.., 1) divides by zero never and alters nothing.
///
/// Error, with u = 2^-24, d the distance and E the longest edge. The point relative to a vertex (X) and to
/// the second (X - U) is known to 2 u (d + E). On an edge: the parameter is off by 4 u |X| / |U|, which moves
/// the foot along the edge and the distance by its square, and the difference from the foot by 3 u (d + E).
/// On the face: the computed normal is turned by at most t = 3 u / sin(U, V), which alters the height by
/// t |X|, and n X is summed to 3 u |X|. The foot's coordinates are differences of products that nearly cancel
/// for small sines: a foot on the wrong side of a wall is so by no more than 14 u |X| / sin(U, V), where the
/// distances to face and edge differ by less than that. The builder puts the vertex opposite the longest
/// edge first, where the sine is largest; where it is still below needle_sine = 1/4, the triangle has
/// needle_flag. Together below 64 u (d + E) = float_error (d + E).
template <Isa I>
struct TriangleDistance : LaneMath<I> {
    using S = Simd<I>;
    using V = typename S::Float;
    using typename LaneMath<I>::Vector;
    using LaneMath<I>::dot, LaneMath<I>::minus, LaneMath<I>::plus, LaneMath<I>::cross, LaneMath<I>::load;

    /// The query point in every lane.
    struct Point {
        Vector whole, fraction;
    };

    /// To the segment from 0 to e; p relative to its start, pe = p·e, ee = e².
    static V to_segment(const Vector& p, const Vector& e, V pe, V ee)
    {
        const V t = S::min(S::max(pe / S::max(ee, S::set(1)), S::set(0)), S::set(1));
        const Vector r = {p.x - t * e.x, p.y - t * e.y, p.z - t * e.z};
        return dot(r, r);
    }

    static V squared(const Leaf& leaf, int lane, const Point& point)
    {
        const V zero = S::set(0), one = S::set(1);
        const Vector u = load(leaf.edge1, lane), v = load(leaf.edge2, lane), w = minus(v, u);
        const Vector p = plus(minus(point.whole, load(leaf.vertex, lane)), point.fraction), q = minus(p, u);
        const V uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), pu = dot(p, u), pv = dot(p, v);
        const V edges = S::min(to_segment(q, w, dot(q, w), dot(w, w)),
                               S::min(to_segment(p, u, pu, uu), to_segment(p, v, pv, vv)));
        const Vector n = cross(u, v);
        const V nn = dot(n, n), height = dot(n, p);
        const V plane = height / S::max(nn, one) * height;
        // The foot's barycentric coordinates times n²: n·(u×p) and n·(p×v), by Lagrange's identity, and what
        // is left of n². Inside all three walls the smallest is not negative.
        const V third = uu * pv - uv * pu, second = vv * pu - uv * pv;
        const V walls = S::min(S::min(third, second), nn - third - second);
        return S::select(S::both(S::less_equal(zero, walls), S::less_equal(one, nn)), plane, edges);
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

    static V excess2(const Node<K>& node, const SearchPoint<K>& point, int k, int lane)
    {
        const V p = S::set(point.projected[k]);
        const V e =
            S::max(S::max(S::load(node.low[k] + lane) - p, p - S::load(node.high[k] + lane)), S::set(0));
        return e * e;
    }

    static V squared(const Node<K>& node, const SearchPoint<K>& point, int lane)
    {
        auto e2 = [&](int k) { return excess2(node, point, k, lane); };
        const V x = e2(0), y = e2(1), z = e2(2);
        V bound = x + y + z;
        if constexpr (K == 14 || K == 26) {
            const V a = e2(3), b = e2(4), c = e2(5), d = e2(6);
            const V largest = S::max(S::max(a, b), S::max(c, d));
            bound = S::max(bound, S::max(largest * S::set(1.0f / 3), ((a + b) + (c + d)) * S::set(0.25f)));
        }
        if constexpr (K == 18 || K == 26) {
            constexpr int first = K == 18 ? 3 : 7;
            const V half = S::set(0.5f);
            bound = S::max(bound, (e2(first) + e2(first + 1)) * half + z);
            bound = S::max(bound, (e2(first + 2) + e2(first + 3)) * half + y);
            bound = S::max(bound, (e2(first + 4) + e2(first + 5)) * half + x);
        }
        return bound;
    }
};

/// The `keep` nearest of an array of candidates, exactly and with ties to the lower number.
template <Isa I>
struct Selection {
    using S = Simd<I>;
    using V = typename S::Float;

    static void count_up_to(const Candidates& c, const float (&value)[4], std::uint32_t (&count)[4])
    {
        const V v[4] = {S::set(value[0]), S::set(value[1]), S::set(value[2]), S::set(value[3])};
        unsigned sum[4] = {};
        for (std::size_t i = 0; i < c.size; i += S::width) {
            const V d2 = S::load(c.distance2 + i);
            for (int k = 0; k < 4; k++)
                sum[k] += S::count(S::bits(S::less_equal(d2, v[k])));
        }
        for (int k = 0; k < 4; k++)
            count[k] = sum[k];
    }

    static std::uint32_t as_bits(float f)
    {
        std::uint32_t b;
        __builtin_memcpy(&b, &f, sizeof b);
        return b;
    }
    static float as_float(std::uint32_t b)
    {
        float f;
        __builtin_memcpy(&f, &b, sizeof f);
        return f;
    }

    /// The keep-th smallest value.
    ///
    /// Brackets it, then looks at what is in the bracket. Squared distances round a point on a surface are
    /// about evenly spread, so four guesses round the expected place leave a few; if they do not, the next
    /// four cut the bracket's bits in five, so that there are never more than thirty rounds. Not negative:
    /// bits are in the order of values.
    static float threshold(const Candidates& c)
    {
        float low = -1, high = largest(c);     // below and not below the answer
        std::size_t below = 0, above = c.size; // how many do not exceed these
        for (unsigned round = 0; above - below > few; round++) {
            const std::uint32_t first = low < 0 ? 0 : as_bits(low), last = as_bits(high);
            if (last - first <= 1) // many equal ones
                return low < 0 && zeros(c) >= c.keep ? 0 : high;
            float guess[4];
            std::uint32_t count[4];
            if (round % 2 == 0) {
                const float start = as_float(first);
                const float apart = (high - start) / static_cast<float>(above - below + 1);
                const float expected = start + apart * (static_cast<float>(c.keep - below) + 0.5f);
                for (int i = 0; i < 4; i++)
                    guess[i] = expected + apart * spread[i];
            } else {
                for (unsigned i = 0; i < 4; i++)
                    guess[i] = as_float(first + (last - first) / 5 * (i + 1) + 1);
            }
            count_up_to(c, guess, count);
            for (int i = 0; i < 4; i++)
                if (count[i] < c.keep && guess[i] > low) {
                    low = guess[i];
                    below = count[i];
                } else if (count[i] >= c.keep && guess[i] < high) {
                    high = guess[i];
                    above = count[i];
                }
        }
        return smallest_between(c, low, high, c.keep - below);
    }
    static std::size_t zeros(const Candidates& c)
    {
        std::size_t count = 0;
        for (std::size_t i = 0; i < c.size; i++)
            count += c.distance2[i] == 0;
        return count;
    }
    static constexpr std::size_t few = 16;
    static constexpr float spread[4] = {-6, -2, 2, 6};

    /// Of the at most `few` values above `low` and up to `high`, the nth smallest, n from 1.
    static float smallest_between(const Candidates& c, float low, float high, std::size_t n)
    {
        float found[few + S::width];
        std::size_t size = 0;
        const V l = S::set(low), h = S::set(high);
        for (std::size_t i = 0; i < c.size; i += S::width) {
            const V d2 = S::load(c.distance2 + i);
            const unsigned mask = S::bits(S::both(S::less(l, d2), S::less_equal(d2, h)));
            S::compress(found + size, d2, mask);
            size += S::count(mask);
        }
        insertion_sort(found, size);
        return found[n - 1];
    }

    template <class T>
    static void insertion_sort(T* values, std::size_t size)
    {
        for (std::size_t i = 1; i < size; i++) {
            const T value = values[i];
            std::size_t place = i;
            for (; place > 0 && value < values[place - 1]; place--)
                values[place] = values[place - 1];
            values[place] = value;
        }
    }

    static void select(Candidates& c)
    {
        if (c.size < c.keep)
            return;
        if (c.size > c.keep)
            drop(c);
        c.limit2 = farthest_last(c);
    }

    static void drop(Candidates& c)
    {
        for (std::size_t i = 0; i < Candidates::slack; i++) // what fills up the last vector is not counted
            c.distance2[c.size + i] = __builtin_inff();
        const float limit = threshold(c);
        const V v = S::set(limit);
        std::size_t size = 0;
        for (std::size_t i = 0; i < c.size; i += S::width) {
            const V d2 = S::load(c.distance2 + i);
            const unsigned mask = S::bits(S::less_equal(d2, v));
            S::compress(c.distance2 + size, d2, mask);
            S::compress_masked(c.triangle + size, c.triangle + i, ~0u, mask);
            size += S::count(mask);
        }
        c.size = size;
        if (size > c.keep)
            drop_ties(c, limit);
    }

    /// Of the candidates' squared distances.
    static float largest(const Candidates& c)
    {
        V most = S::set(0);
        std::size_t i = 0;
        for (; i + S::width <= c.size; i += S::width)
            most = S::max(most, S::load(c.distance2 + i));
        float lane[S::width], result = 0;
        S::store(lane, most);
        for (float x : lane)
            result = x > result ? x : result;
        for (; i < c.size; i++)
            result = c.distance2[i] > result ? c.distance2[i] : result;
        return result;
    }

    /// Puts the farthest, of several the one of the highest number, last. Returns its squared distance.
    static float farthest_last(Candidates& c)
    {
        const float farthest = largest(c);
        const V v = S::set(farthest);
        const std::size_t last = c.size - 1;
        std::size_t place = c.size; // none yet
        for (std::size_t i = 0; i < c.size; i += S::width)
            for (unsigned mask = S::bits(S::less_equal(v, S::load(c.distance2 + i))); mask;
                 mask &= mask - 1) {
                const std::size_t at = i + static_cast<unsigned>(__builtin_ctz(mask));
                if (at <= last && (place > last || c.triangle[at] > c.triangle[place]))
                    place = at;
            }
        const std::uint32_t number = c.triangle[place];
        c.distance2[place] = c.distance2[last];
        c.triangle[place] = c.triangle[last];
        c.distance2[last] = farthest;
        c.triangle[last] = number;
        return farthest;
    }

    /// More than `keep` are left because several are exactly at the limit: those of the highest numbers go.
    static void drop_ties(Candidates& c, float limit)
    {
        std::uint32_t tied[few];
        std::size_t count = 0;
        for (std::size_t i = 0; i < c.size; i++)
            if (c.distance2[i] == limit && count++ < few)
                tied[count - 1] = c.triangle[i];
        const std::size_t kept = count - (c.size - c.keep);
        std::uint32_t last; // the highest number kept of them
        if (count <= few) {
            insertion_sort(tied, count);
            last = tied[kept - 1];
        } else {
            last = nth_of_many(c, limit, kept);
        }
        std::size_t size = 0;
        for (std::size_t i = 0; i < c.size; i++) {
            c.distance2[size] = c.distance2[i];
            c.triangle[size] = c.triangle[i];
            size += c.distance2[size] < limit || c.triangle[size] <= last;
        }
        c.size = size;
    }

    /// The number up to which exactly n of those at the limit are, by bisection.
    static std::uint32_t nth_of_many(const Candidates& c, float limit, std::size_t n)
    {
        std::uint32_t first = 0, last = ~0u;
        while (first < last) {
            const std::uint32_t middle = first + (last - first) / 2;
            std::size_t count = 0;
            for (std::size_t i = 0; i < c.size; i++)
                count += c.distance2[i] == limit && c.triangle[i] <= middle;
            if (count >= n)
                last = middle;
            else
                first = middle + 1;
        }
        return last;
    }
};

/// One query. Goes down level by level with all hulls that are near at once: no stack, no branch per child,
/// and the memory of a whole level is asked for before the first of it is needed.
template <Isa I, int K>
class Search {
  public:
    static void run(const TreeView<K>& tree, const SearchPoint<K>& point, Candidates& out)
    {
        Search search(tree, point, out, nullptr);
        search.expand_root();
    }

    static void scan(const Leaf* leaves, std::size_t count, const SearchPoint<K>& point, Candidates& out)
    {
        Search search({nullptr, leaves, {}}, point, out, nullptr);
        out.counts.leaves += count;
        for (std::size_t i = 0; i < count; i++)
            search.visit(leaves[i]);
    }

    static void gather(const TreeView<K>& tree, const SearchPoint<K>& point, float limit2, Gathered& out)
    {
        Candidates none; // but its limit
        none.limit2 = limit2;
        none.keep = static_cast<std::size_t>(-1);
        Search search(tree, point, none, &out);
        search.expand_root();
    }

  private:
    using S = Simd<I>;
    using V = typename S::Float;
    using Distance = TriangleDistance<I>;

    /// Nodes whose children are tested together.
    static constexpr unsigned batch = 32;
    /// Where more children than this are near, and only the nearest triangles are wanted, the nearest
    /// child goes first: what it finds may rule out the others.
    static constexpr unsigned few_nodes = 6, few_leaves = 12;
    /// As many leaves, about, as surely hold the 64 nearest.
    static constexpr unsigned first_leaves = 6;

    struct Near {
        std::uint32_t index[(batch + 1) * lanes];
        float bound2[(batch + 1) * lanes];
    };

    Search(const TreeView<K>& tree, const SearchPoint<K>& point, Candidates& out, Gathered* gathered)
        : tree_(tree), point_(point), out_(out), gathered_(gathered)
    {
        for (int i = 0; i < 3; i++) {
            V* const fields[2][3] = {{&at_.whole.x, &at_.whole.y, &at_.whole.z},
                                     {&at_.fraction.x, &at_.fraction.y, &at_.fraction.z}};
            *fields[0][i] = S::set(point.whole[i]);
            *fields[1][i] = S::set(point.fraction[i]);
        }
        narrow();
    }

    /// After out_.limit2 has changed.
    void narrow()
    {
        const float reach = __builtin_sqrtf(out_.limit2) * (1 + 0x1p-18f) + point_.hull_slack;
        hull_limit2_ = reach * reach;
    }

    /// Whether finding something can make the limit smaller.
    [[nodiscard]] bool narrows() const { return out_.keep < static_cast<std::size_t>(-1); }

    void expand_root()
    {
        const std::uint32_t root = 0;
        expand(tree_.levels.count - 1, &root, 1);
    }

    /// All that is near below some nodes of a level.
    void expand(int level, const std::uint32_t* nodes, unsigned count)
    {
        Near near;
        for (unsigned first = 0; first < count; first += batch) {
            const unsigned last = count - first < batch ? count : first + batch;
            const unsigned found = test(level, nodes + first, last - first, near);
            if (level == 0)
                visit_leaves(near, found);
            else
                descend(level - 1, near, found);
        }
    }

    /// The children of some nodes that are near.
    unsigned test(int level, const std::uint32_t* nodes, unsigned count, Near& near)
    {
        const Node<K>* all = tree_.nodes + tree_.levels.base[level];
        out_.counts.nodes += count;
        unsigned found = 0;
        const V limit = S::set(hull_limit2_);
        for (unsigned i = 0; i < count; i++) {
            const Node<K>& node = all[nodes[i]];
            for (int lane = 0; lane < lanes; lane += S::width) {
                const V bound2 = HullDistance<I, K>::squared(node, point_, lane);
                const unsigned mask = S::bits(S::less(bound2, limit));
                S::compress(near.bound2 + found, bound2, mask);
                S::compress_index(near.index + found, nodes[i] * lanes + static_cast<unsigned>(lane), mask);
                found += S::count(mask);
            }
        }
        return found;
    }

    static void prefetch(const void* address, unsigned bytes)
    {
        for (unsigned offset = 0; offset < bytes; offset += 64)
            __builtin_prefetch(static_cast<const char*>(address) + offset);
    }

    void descend(int level, Near& near, unsigned found)
    {
        if (point_.prefetch) {
            const Node<K>* all = tree_.nodes + tree_.levels.base[level];
            for (unsigned i = 0; i < found && i < 2 * few_nodes; i++)
                prefetch(all + near.index[i], sizeof(Node<K>));
        }
        while (found > few_nodes && narrows()) {
            unsigned nearest = 0;
            for (unsigned i = 1; i < found; i++)
                nearest = near.bound2[i] < near.bound2[nearest] ? i : nearest;
            const std::uint32_t index = near.index[nearest];
            near.bound2[nearest] = near.bound2[--found];
            near.index[nearest] = near.index[found];
            expand(level, &index, 1);
            narrow_to_kept();
            found = keep_within(near, found, hull_limit2_);
        }
        if (found)
            expand(level, near.index, found);
    }

    /// Forgets those whose bounds are not below the limit.
    static unsigned keep_within(Near& near, unsigned found, float limit2)
    {
        unsigned kept = 0;
        for (unsigned i = 0; i < found; i++) {
            const std::uint32_t index = near.index[i];
            const float bound2 = near.bound2[i];
            near.index[kept] = index;
            near.bound2[kept] = bound2;
            kept += bound2 < limit2;
        }
        return kept;
    }

    /// Near ones first where there are many: in waves, each about twice as far as the one before.
    void visit_leaves(Near& near, unsigned found)
    {
        if (found <= few_leaves || !narrows()) {
            visit(near.index, found);
            return;
        }
        float wave = first_wave(near, found);
        for (;;) {
            unsigned later = 0;
            std::uint32_t now[(batch + 1) * lanes];
            unsigned count = 0;
            for (unsigned i = 0; i < found; i++) {
                const std::uint32_t index = near.index[i];
                const float bound2 = near.bound2[i];
                now[count] = index;
                count += bound2 <= wave;
                near.index[later] = index;
                near.bound2[later] = bound2;
                later += bound2 > wave;
            }
            visit(now, count);
            narrow_to_kept();
            found = keep_within(near, later, hull_limit2_);
            if (found == 0)
                return;
            float nearest = near.bound2[0];
            for (unsigned i = 1; i < found; i++)
                nearest = near.bound2[i] < nearest ? near.bound2[i] : nearest;
            wave = wave + wave > nearest ? wave + wave : nearest + nearest;
        }
    }

    /// A bound that about first_leaves leaves do not exceed, at least one.
    [[nodiscard]] static float first_wave(const Near& near, unsigned found)
    {
        float low = near.bound2[0], high = low;
        for (unsigned i = 1; i < found; i++) {
            low = near.bound2[i] < low ? near.bound2[i] : low;
            high = near.bound2[i] > high ? near.bound2[i] : high;
        }
        float wave = high;
        for (int guess = 0; guess < 8; guess++) {
            const float middle = low + (wave - low) * 0.5f;
            unsigned count = 0;
            for (unsigned i = 0; i < found; i++)
                count += near.bound2[i] <= middle;
            if (count < first_leaves)
                break;
            wave = middle;
        }
        return wave;
    }

    void visit(const std::uint32_t* leaves, unsigned count)
    {
        if (point_.prefetch && count <= 2 * few_leaves)
            for (unsigned i = 0; i < count; i++)
                prefetch(&tree_.leaves[leaves[i]], sizeof(Leaf));
        out_.counts.leaves += count;
        if (gathered_)
            for (unsigned i = 0; i < count; i++)
                gather(tree_.leaves[leaves[i]]);
        else
            for (unsigned i = 0; i < count; i++)
                visit(tree_.leaves[leaves[i]]);
    }

    void visit(const Leaf& leaf)
    {
        if (out_.size + lanes + Candidates::slack > out_.capacity)
            make_room();
        const std::size_t before = out_.size;
        const V limit = S::set(out_.limit2);
        for (int lane = 0; lane < lanes; lane += S::width) {
            const V d2 = squared(leaf, lane);
            const unsigned mask = S::bits(S::less_equal(d2, limit));
            S::compress(out_.distance2 + out_.size, d2, mask);
            S::compress_masked(out_.triangle + out_.size, leaf.triangle + lane, ~needle_flag, mask);
            out_.size += S::count(mask);
        }
        out_.counts.triangles += out_.size - before;
    }

    void gather(const Leaf& leaf)
    {
        Gathered& to = *gathered_;
        if (to.size + lanes > Gathered::most) {
            to.complete = false;
            return;
        }
        const V limit = S::set(out_.limit2);
        for (int lane = 0; lane < lanes; lane += S::width) {
            const unsigned mask = S::bits(S::less_equal(squared(leaf, lane), limit));
            for (int axis = 0; axis < 3; axis++) {
                S::compress(to.field[axis] + to.size, S::load(leaf.vertex[axis] + lane), mask);
                S::compress(to.field[3 + axis] + to.size, S::load(leaf.edge1[axis] + lane), mask);
                S::compress(to.field[6 + axis] + to.size, S::load(leaf.edge2[axis] + lane), mask);
            }
            S::compress_masked(to.triangle + to.size, leaf.triangle + lane, ~0u, mask);
            to.size += S::count(mask);
        }
    }

    V squared(const Leaf& leaf, int lane)
    {
        const V d2 = Distance::squared(leaf, lane, at_);
        const unsigned needles = S::signs(leaf.triangle + lane);
        return needles ? measure_needles(leaf, lane, needles, d2) : d2;
    }

    [[gnu::noinline]] V measure_needles(const Leaf& leaf, int lane, unsigned needles, V computed)
    {
        float d2[S::width];
        S::store(d2, computed);
        for (; needles; needles &= needles - 1) {
            const int i = __builtin_ctz(needles);
            if (leaf.triangle[lane + i] != no_triangle)
                d2[i] = static_cast<float>(precise_distance2(leaf, lane + i, point_.exact));
        }
        return S::load(d2);
    }

    void narrow_to_kept()
    {
        if (out_.size >= out_.keep) {
            Selection<I>::select(out_);
            narrow();
        }
    }

    [[gnu::noinline]] void make_room()
    {
        narrow_to_kept();
        if (out_.size + lanes + Candidates::slack > out_.capacity)
            out_.full(out_);
    }

    const TreeView<K> tree_;
    const SearchPoint<K>& point_;
    Candidates& out_;
    Gathered* gathered_; ///< if not null, takes what is near in place of out_
    typename Distance::Point at_;
    float hull_limit2_ = 0;
};

template <Isa I>
struct Conversion {
    using S = Simd<I>;

    /// Overwrites the candidates with their distances.
    static void to_hits(Candidates& c, std::uint32_t object, double step, Hit* hits)
    {
        for (std::size_t i = 0; i < c.size; i += S::width)
            S::store(c.distance2 + i, S::sqrt(S::load(c.distance2 + i)));
        std::size_t i = 0;
#if defined(__SSE2__)
        static_assert(sizeof(Hit) == 16 && offsetof(Hit, triangle) == 4 && offsetof(Hit, distance) == 8);
        const __m128i objects = _mm_set1_epi32(static_cast<int>(object));
        const __m128d steps = _mm_set1_pd(step);
        for (; i + 2 <= c.size; i += 2) {
            const __m128i triangles = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(c.triangle + i));
            const __m128d who = _mm_castsi128_pd(_mm_unpacklo_epi32(objects, triangles));
            const __m128 two =
                _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(c.distance2 + i)));
            const __m128d far = _mm_mul_pd(_mm_cvtps_pd(two), steps);
            auto* to = reinterpret_cast<double*>(hits + i);
            _mm_storeu_pd(to, _mm_unpacklo_pd(who, far));
            _mm_storeu_pd(to + 2, _mm_unpackhi_pd(who, far));
        }
#endif
        for (; i < c.size; i++)
            hits[i] = {object, c.triangle[i], static_cast<double>(c.distance2[i]) * step};
    }
};

template <Isa I, int K>
const SearchKernels<K>& kernels_of()
{
    static constexpr SearchKernels<K> table = {&Search<I, K>::run, &Search<I, K>::scan, &Search<I, K>::gather,
                                               &Selection<I>::select, &Conversion<I>::to_hits};
    return table;
}

} // namespace phantom::fdh
