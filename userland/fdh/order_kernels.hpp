// SPDX-License-Identifier: GPL-2.0-or-later
// The loops of the ordering, written once over the width of the vectors. Included only by kernels_<isa>.cpp;
// see the rules in search_kernels.hpp.
#pragma once

#include "fdh/order.hpp"
#include "fdh/simd.hpp"

namespace phantom::fdh {

template <Isa I>
struct Order {
    using S = Simd<I>;
    using V = typename S::Float;
    using Columns = Centres::Columns;

    static void copy(void* to, const void* from, std::size_t elements)
    {
        __builtin_memcpy(to, from, 4 * elements);
    }

    static std::size_t partition(const Columns& c, std::size_t begin, std::size_t end, int axis, float pivot,
                                 bool inclusive)
    {
        const float* key = c.axis[axis];
        const V p = S::set(pivot);
        std::size_t low = begin, high = begin; // the high ones wait in the spare columns
        std::size_t i = begin;
        for (; i + S::width <= end; i += S::width) {
            const V k = S::load(key + i);
            const unsigned all = (1ull << S::width) - 1;
            const unsigned goes_low = S::bits(inclusive ? S::less_equal(k, p) : S::less(k, p));
            const unsigned goes_high = all & ~goes_low;
            for (int a = 0; a < 3; a++) {
                const V x = S::load(c.axis[a] + i);
                S::compress(c.axis[a] + low, x, goes_low);
                S::compress(c.spare_axis[a] + high, x, goes_high);
            }
            // To the spare column first: the low ones may overwrite what is read.
            S::compress_masked(c.spare_number + high, c.number + i, ~0u, goes_high);
            S::compress_masked(c.number + low, c.number + i, ~0u, goes_low);
            low += S::count(goes_low);
            high += S::count(goes_high);
        }
        for (; i < end; i++) {
            const bool goes_low = inclusive ? key[i] <= pivot : key[i] < pivot;
            move(c, i, goes_low ? low++ : high++, goes_low);
        }
        for (int a = 0; a < 3; a++)
            copy(c.axis[a] + low, c.spare_axis[a] + begin, high - begin);
        copy(c.number + low, c.spare_number + begin, high - begin);
        return low;
    }

    static void move(const Columns& c, std::size_t from, std::size_t to, bool stays)
    {
        for (int a = 0; a < 3; a++)
            (stays ? c.axis : c.spare_axis)[a][to] = c.axis[a][from];
        (stays ? c.number : c.spare_number)[to] = c.number[from];
    }

    static void take_lowest(const Columns& c, std::size_t begin, std::size_t end, int axis, std::size_t count)
    {
        constexpr std::size_t few = OrderKernels::few;
        const std::size_t size = end - begin;
        float key[few], below[few]; // how many are lower than each
        copy(key, c.axis[axis] + begin, size);
        for (std::size_t i = size; i < few; i++)
            key[i] = __builtin_inff();
        for (std::size_t j = 0; j < size; j += S::width) {
            const V k = S::load(key + j);
            V lower = S::set(0);
            for (std::size_t i = 0; i < size; i++)
                lower = lower + S::select(S::less(S::set(key[i]), k), S::set(1), S::set(0));
            S::store(below + j, lower);
        }
        // Of those that share the last place, as many as are left.
        const auto wanted = static_cast<float>(count);
        float last = 0;
        for (std::size_t i = 0; i < size; i++)
            last = below[i] < wanted && below[i] > last ? below[i] : last;
        std::size_t left = count - static_cast<std::size_t>(last);
        std::size_t low = begin, high = begin;
        for (std::size_t i = 0; i < size; i++) {
            const bool shares = below[i] == last;
            const bool goes_low = below[i] < last || (shares && left > 0);
            left -= shares && left > 0;
            move(c, begin + i, goes_low ? low++ : high++, goes_low);
        }
        for (int a = 0; a < 3; a++)
            copy(c.axis[a] + low, c.spare_axis[a] + begin, high - begin);
        copy(c.number + low, c.spare_number + begin, high - begin);
    }

    static void extent(const Columns& c, std::size_t begin, std::size_t end, float (&extent)[3])
    {
        for (int a = 0; a < 3; a++) {
            const float* x = c.axis[a];
            float low = x[begin], high = low;
            std::size_t i = begin;
            if (begin + S::width <= end) {
                V lows = S::load(x + begin), highs = lows;
                for (i += S::width; i + S::width <= end; i += S::width) {
                    lows = S::min(lows, S::load(x + i));
                    highs = S::max(highs, S::load(x + i));
                }
                float l[S::width], h[S::width];
                S::store(l, lows);
                S::store(h, highs);
                for (int lane = 0; lane < S::width; lane++) {
                    low = l[lane] < low ? l[lane] : low;
                    high = h[lane] > high ? h[lane] : high;
                }
            }
            for (; i < end; i++) {
                low = x[i] < low ? x[i] : low;
                high = x[i] > high ? x[i] : high;
            }
            extent[a] = high - low;
        }
    }
};

template <Isa I>
const OrderKernels& order_kernels_of()
{
    static constexpr OrderKernels table = {&Order<I>::partition, &Order<I>::take_lowest, &Order<I>::extent};
    return table;
}

} // namespace phantom::fdh
