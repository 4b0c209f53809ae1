// SPDX-License-Identifier: GPL-2.0-or-later
// The order of the triangles in the leaves: halved again and again along the longest axis of their centres,
// at whole subtrees of sixteen, so that every leaf and every node is full.
//
// Halving by count instead of by surface area buys a tree without references, every lane in use, 44 bytes a
// triangle. It heeds no face's size: a large one among small ones makes its leaf's hull large.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fdh/isa.hpp"
#include "fdh/large_memory.hpp"

namespace phantom::fdh {

/// Places of things and their numbers, an array each; and as much room again.
class Centres {
  public:
    explicit Centres(std::size_t size);
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] float* axis(int i) { return columns_.axis[i]; }
    [[nodiscard]] std::uint32_t* number() { return columns_.number; }

    /// Plain pointers, for the kernels.
    struct Columns {
        float* axis[3];
        std::uint32_t* number;
        float* spare_axis[3];
        std::uint32_t* spare_number;
    };
    [[nodiscard]] const Columns& columns() const { return columns_; }

  private:
    std::size_t size_;
    LargeArray<float> memory_;
    Columns columns_{};
};

/// Reorders the centres (any finite values, in any unit). The same order for any number of threads and on any
/// instruction set.
void order_by_halves(Centres& centres, unsigned threads, Isa isa);

/// One unit per instruction set defines these.
struct OrderKernels {
    /// Moves the elements whose value on `axis` is below the pivot (or not above it, if `inclusive`) to the
    /// front of [begin, end), each part in its order; returns where the second begins.
    std::size_t (*partition)(const Centres::Columns& columns, std::size_t begin, std::size_t end, int axis,
                             float pivot, bool inclusive);
    /// Of at most `few` elements, the `count` lowest to the front, in their order; equal ones as they stand.
    void (*take_lowest)(const Centres::Columns& columns, std::size_t begin, std::size_t end, int axis,
                        std::size_t count);
    /// high - low per axis.
    void (*extent)(const Centres::Columns& columns, std::size_t begin, std::size_t end, float (&extent)[3]);
    static constexpr std::size_t few = 64;
};
template <Isa I>
const OrderKernels& order_kernels_of();

} // namespace phantom::fdh
