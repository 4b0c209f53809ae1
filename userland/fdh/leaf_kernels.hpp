// SPDX-License-Identifier: GPL-2.0-or-later
// How a leaf is made of its triangles' corners, written once over the width of the vectors. Included only by
// kernels_<isa>.cpp; see the rules in search_kernels.hpp.
#pragma once

#include "fdh/lane_math.hpp"
#include "fdh/leaf.hpp"

namespace phantom::fdh {

template <Isa I, int K>
struct LeafMaker : LaneMath<I> {
    using S = Simd<I>;
    using V = typename S::Float;
    using typename LaneMath<I>::Vector;
    using LaneMath<I>::dot, LaneMath<I>::minus, LaneMath<I>::cross, LaneMath<I>::load;

    static V length2(const Vector& a) { return dot(a, a); }
    static void store(float (&field)[3][lanes], int lane, const Vector& v)
    {
        S::store(field[0] + lane, v.x);
        S::store(field[1] + lane, v.y);
        S::store(field[2] + lane, v.z);
    }
    using Mask = typename S::Mask;
    static Vector select(Mask m, const Vector& a, const Vector& b)
    {
        return {S::select(m, a.x, b.x), S::select(m, a.y, b.y), S::select(m, a.z, b.z)};
    }

    /// Whether the normal, computed in float, would be too far off (needle_flag). A degenerate triangle's
    /// computed normal is rounding error and as short as that.
    /// nn: length² of u × v.
    static unsigned needles(const Vector& u, const Vector& v, V nn)
    {
        const V sine2 = S::set(static_cast<float>(needle_sine * needle_sine));
        const Mask wide = S::both(S::less_equal(sine2 * length2(u) * length2(v), nn), S::less(S::set(0), nn));
        return ~S::bits(wide) & ((1u << S::width) - 1);
    }

    template <int Sign>
    static V signed_sum(V sum, V x)
    {
        return Sign > 0 ? sum + x : Sign < 0 ? sum - x : sum;
    }
    template <std::size_t Direction>
    static V project(const Vector& p)
    {
        constexpr auto d = hull_directions<K>()[Direction];
        return signed_sum<d[2]>(signed_sum<d[1]>(signed_sum<d[0]>(S::set(0), p.x), p.y), p.z);
    }

    template <std::size_t Direction>
    static void bound(const LeafCorners& corners, MadeLeaf<K>& made)
    {
        V low = S::set(__builtin_inff()), high = S::set(-__builtin_inff());
        for (int lane = 0; lane < lanes; lane += S::width)
            for (const auto& corner : corners) {
                const V x = project<Direction>(load(corner, lane));
                low = S::min(low, x);
                high = S::max(high, x);
            }
        made.low[Direction] = S::lowest(low);
        made.high[Direction] = S::highest(high);
    }
    template <std::size_t... Directions>
    static void bound_all(const LeafCorners& corners, MadeLeaf<K>& made, Indices<Directions...>)
    {
        (bound<Directions>(corners, made), ...);
    }

    static void make(const LeafCorners& corners, Leaf& leaf, MadeLeaf<K>& made)
    {
        made.needles = 0;
        V longest2 = S::set(0);
        for (int lane = 0; lane < lanes; lane += S::width) {
            const Vector a = load(corners[0], lane), b = load(corners[1], lane), c = load(corners[2], lane);
            const V across_a = length2(minus(c, b)), across_b = length2(minus(a, c)),
                    across_c = length2(minus(b, a));
            const V longest = S::max(across_a, S::max(across_b, across_c));
            const Mask is_a = S::less_equal(longest, across_a), is_b = S::less_equal(longest, across_b);
            // Turned so that the longest edge is opposite the first corner.
            const Vector first = select(is_a, a, select(is_b, b, c));
            const Vector second = select(is_a, b, select(is_b, c, a));
            const Vector third = select(is_a, c, select(is_b, a, b));
            const Vector u = minus(second, first), v = minus(third, first);
            store(leaf.vertex, lane, first);
            store(leaf.edge1, lane, u);
            store(leaf.edge2, lane, v);
            const V nn = length2(cross(u, v));
            made.needles |= needles(u, v, nn) << lane;
            longest2 = S::max(longest2, longest);
            S::store(made.twice_area + lane, S::sqrt(nn));
        }
        made.longest_edge2 = S::highest(longest2);
        bound_all(corners, made, typename Counted<K / 2>::Type{});
    }
};

template <Isa I, int K>
const LeafKernels<K>& leaf_kernels_of()
{
    static constexpr LeafKernels<K> table = {&LeafMaker<I, K>::make};
    return table;
}

} // namespace phantom::fdh
