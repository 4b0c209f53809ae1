// SPDX-License-Identifier: GPL-2.0-or-later
// A warm query allocates nothing: counted by the program's own operator new.
#include <cstdlib>
#include <new>

#include "oracle.hpp"

namespace {
thread_local std::size_t allocations = 0;
}

// Not inlined: the compiler would see malloc on one side of a pair and operator delete on the other, and
// warn.
[[gnu::noinline]] void* operator new(std::size_t size)
{
    allocations++;
    if (void* memory = std::malloc(size ? size : 1))
        return memory;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept
{
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept
{
    std::free(memory);
}

namespace phantom::fdh::test {

TEST(AllocationTest, WarmQueriesAllocateNothing)
{
    const Mesh mesh = sphere(5, 60);
    SceneTree<14> scene;
    scene.add(TriangleTree<14>::build(mesh.view()), {});
    scene.add(TriangleTree<14>::build(mesh.view()), {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {100, 0, 0}});
    scene.update();
    std::mt19937_64 random(31);
    const auto points = probes(mesh, 30, random);
    Nearest nearest;
    std::vector<Hit> within;
    auto all = [&] {
        for (const Point& p : points) {
            scene.nearest(p, 64, 1e9, nearest);
            scene.tree(0).nearest(p, 512, 10, nearest);
            scene.within(p, 20, within);
        }
    };
    allocations = 0;
    all();
    EXPECT_GT(allocations, 0u) << "the counter does not count";
    allocations = 0;
    all();
    EXPECT_EQ(allocations, 0u);
}

} // namespace phantom::fdh::test
