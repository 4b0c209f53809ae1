// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/order.hpp"

#include <algorithm>

#include "fdh/layout.hpp"
#include "fdh/parallel.hpp"

namespace phantom::fdh {

namespace {

const OrderKernels& order_kernels(Isa isa)
{
    switch (resolve_isa(isa)) {
#ifdef PHANTOM_FDH_X86
    case Isa::sse2:
        return order_kernels_of<Isa::sse2>();
    case Isa::avx2:
        return order_kernels_of<Isa::avx2>();
    case Isa::avx512:
        return order_kernels_of<Isa::avx512>();
#endif
    default:
        return order_kernels_of<Isa::scalar>();
    }
}

class Halver {
  public:
    Halver(const Centres::Columns& columns, const OrderKernels& kernels)
        : columns_(columns), kernels_(kernels)
    {
    }

    void divide(std::size_t begin, std::size_t end, unsigned threads) const
    {
        const std::size_t size = end - begin;
        if (size <= lanes)
            return;
        std::size_t subtree = lanes; // the largest whole subtree that is less than all
        while (subtree * lanes < size)
            subtree *= lanes;
        const std::size_t middle = begin + (size + subtree - 1) / subtree / 2 * subtree;
        float extent[3];
        kernels_.extent(columns_, begin, end, extent);
        const int axis = extent[0] >= extent[1]   ? extent[0] >= extent[2] ? 0 : 2
                         : extent[1] >= extent[2] ? 1
                                                  : 2;
        if (extent[axis] > 0)
            select(begin, end, middle, axis);
        constexpr std::size_t worth_a_thread = 16384;
        if (threads > 1 && size > worth_a_thread) {
            fork_join([&] { divide(begin, middle, threads / 2); },
                      [&] { divide(middle, end, threads - threads / 2); });
        } else {
            divide(begin, middle, 1);
            divide(middle, end, 1);
        }
    }

  private:
    /// Quickselect (Hoare 1961): what is lower on the axis than what belongs at `target` before it.
    void select(std::size_t begin, std::size_t end, std::size_t target, int axis) const
    {
        while (begin < target && target < end) {
            if (end - begin <= OrderKernels::few) {
                kernels_.take_lowest(columns_, begin, end, axis, target - begin);
                return;
            }
            const float pivot = guess(begin, end, target, axis);
            const std::size_t middle = kernels_.partition(columns_, begin, end, axis, pivot, false);
            if (middle > target) {
                end = middle;
            } else if (middle > begin) {
                begin = middle;
            } else { // the pivot is the lowest value: off with all that equal it
                const std::size_t equal = kernels_.partition(columns_, begin, end, axis, pivot, true);
                if (target <= equal)
                    return;
                begin = equal;
            }
        }
    }

    /// From a sample, the value at the target's share of it.
    [[nodiscard]] float guess(std::size_t begin, std::size_t end, std::size_t target, int axis) const
    {
        constexpr std::size_t most = 65;
        const std::size_t size = end - begin;
        const std::size_t count = size > 4096 ? most : size > 512 ? 33 : 17;
        float sample[most];
        for (std::size_t i = 0; i < count; i++)
            sample[i] = columns_.axis[axis][begin + (size - 1) * i / (count - 1)];
        const std::size_t place = std::min(count - 1, (target - begin) * count / size);
        std::nth_element(sample, sample + place, sample + count);
        return sample[place];
    }

    const Centres::Columns& columns_;
    const OrderKernels& kernels_;
};

} // namespace

Centres::Centres(std::size_t size) : size_(size)
{
    constexpr std::size_t line = 64 / sizeof(float);
    const std::size_t column = (size + line) / line * line;
    memory_ = large_array<float>(8 * column);
    for (std::size_t i = 0; i < 3; i++) {
        columns_.axis[i] = memory_.get() + i * column;
        columns_.spare_axis[i] = memory_.get() + (4 + i) * column;
    }
    // Floats and numbers are of one size; each column is only ever one of them.
    columns_.number = reinterpret_cast<std::uint32_t*>(memory_.get() + 3 * column);
    columns_.spare_number = reinterpret_cast<std::uint32_t*>(memory_.get() + 7 * column);
}

void order_by_halves(Centres& centres, unsigned threads, Isa isa)
{
    Halver(centres.columns(), order_kernels(isa)).divide(0, centres.size(), threads);
}

} // namespace phantom::fdh
