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
    std::vector<ObjectPair> pairs;
    auto all = [&] {
        for (const Point& p : points) {
            scene.nearest(p, 64, 1e9, nearest);
            scene.tree(0).nearest(p, 512, 10, nearest);
            scene.within(p, 20, within);
            scene.along(p, points[0], 5, within);
            scene.in_box({p, {p[0] + 20, p[1] + 20, p[2] + 20}}, within);
            scene.pairs_near(0, 50, pairs);
            scene.pairs(50, pairs);
        }
    };
    allocations = 0;
    all();
    EXPECT_GT(allocations, 0u) << "the counter does not count";
    allocations = 0;
    all();
    EXPECT_EQ(allocations, 0u);
}

TEST(AllocationTest, ObjectsMoveWithoutAllocating)
{
    SceneTree<14> scene;
    const auto ball = TriangleTree<14>::build(sphere(1, 1).view(), {.threads = 1});
    for (int i = 0; i < 200; i++)
        scene.add(ball, {});
    scene.update();
    std::mt19937_64 random(61);
    std::uniform_real_distribution<double> place(-50, 50);
    std::size_t rebuilt = 0, refitted = 0;
    auto move = [&] {
        for (std::uint32_t i = 0; i < scene.objects(); i++)
            scene.set_pose(i, {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {place(random), place(random), place(random)}});
        rebuilt += scene.update();
        scene.set_pose(7, scene.pose(7));
        refitted += !scene.update();
    };
    for (int i = 0; i < 40; i++)
        move();
    allocations = rebuilt = refitted = 0;
    for (int i = 0; i < 20; i++)
        move();
    EXPECT_EQ(allocations, 0u);
    EXPECT_GT(refitted, 0u);
    EXPECT_GT(rebuilt, 0u);
}

} // namespace phantom::fdh::test
