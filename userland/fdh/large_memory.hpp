// SPDX-License-Identifier: GPL-2.0-or-later
// Memory for large arrays: not cleared, in large pages where the system has them. A query at a new place
// misses the translation of addresses less often, and filling takes a fault every 2 MiB instead of every
// 4 KiB.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace phantom::fdh {

struct FreeMemory {
    void operator()(void* memory) const { std::free(memory); }
};
template <class T>
using LargeArray = std::unique_ptr<T[], FreeMemory>;

/// Room for `count` elements, aligned for every vector. Throws std::bad_alloc.
template <class T>
LargeArray<T> large_array(std::size_t count)
{
    static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= 64);
    constexpr std::size_t page = std::size_t{2} << 20, line = 64;
    const std::size_t bytes = count * sizeof(T), unit = bytes < page ? line : page;
    const std::size_t whole = (bytes + unit - 1) / unit * unit;
    void* memory = std::aligned_alloc(unit, whole > 0 ? whole : unit);
    if (!memory)
        throw std::bad_alloc();
#if defined(__linux__)
    if (unit == page)
        madvise(memory, whole, MADV_HUGEPAGE); // a wish: without it the pages are small
#endif
    return LargeArray<T>(static_cast<T*>(memory));
}

} // namespace phantom::fdh
