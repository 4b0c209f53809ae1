// SPDX-License-Identifier: GPL-2.0-or-later
// Level one while objects move: refitted as long as its shape is good, built anew when it is not, and right
// either way.
#include <cmath>

#include "fdh/object_tree.hpp"
#include "fdh/scene_tree.hpp"
#include "oracle.hpp"
#include "poses.hpp"

namespace phantom::fdh::test {

namespace {

Pose at(const Point& translation)
{
    return {{1, 0, 0, 0, 1, 0, 0, 0, 1}, translation};
}

/// A square of objects, ten apart, each known by its place.
constexpr int side = 20;
Point place(int i)
{
    return {10.0 * (i % side), 10.0 * (i / side), 0};
}

SceneTree<14> square()
{
    SceneTree<14> scene;
    const auto ball = TriangleTree<14>::build(sphere(1, 1).view(), {.threads = 1});
    for (int i = 0; i < side * side; i++)
        scene.add(ball, at(place(i)));
    return scene;
}

/// Above an object's centre there is that object, though others may be nearer.
void expect_found_where_they_are(const SceneTree<14>& scene)
{
    std::vector<Hit> hits;
    for (std::uint32_t i = 0; i < scene.objects(); i += 7) {
        Point above = scene.pose(i).translation;
        above[2] += 2;
        scene.within(above, 1.5, hits);
        EXPECT_TRUE(std::any_of(hits.begin(), hits.end(), [&](const Hit& hit) { return hit.object == i; }))
            << i;
    }
}

} // namespace

TEST(MovingTest, ObjectsThatMoveTogetherKeepTheShape)
{
    SceneTree<14> scene = square();
    EXPECT_TRUE(scene.update());
    EXPECT_FALSE(scene.update());
    for (int step = 1; step <= 50; step++) {
        for (int i = 0; i < side * side; i++) {
            Point p = place(i);
            p[0] += 0.5 * step;
            p[2] += 0.2 * std::sin(i + step);
            scene.set_pose(static_cast<std::uint32_t>(i), at(p));
        }
        EXPECT_FALSE(scene.update()) << "step " << step;
    }
    expect_found_where_they_are(scene);
}

TEST(MovingTest, AShuffleTakesANewShapeAndThenKeepsIt)
{
    SceneTree<14> scene = square();
    scene.update();
    std::vector<int> places(side * side);
    for (int i = 0; i < side * side; i++)
        places[i] = i;
    std::mt19937_64 random(53);
    std::shuffle(places.begin(), places.end(), random);
    bool rebuilt = false;
    constexpr int steps = 40;
    for (int step = 1; step <= steps; step++) {
        for (int i = 0; i < side * side; i++) {
            const Point a = place(i), b = place(places[i]);
            const double t = double(step) / steps;
            scene.set_pose(static_cast<std::uint32_t>(i),
                           at({a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), 0}));
        }
        rebuilt |= scene.update();
        if (step % 10 == 0)
            expect_found_where_they_are(scene);
    }
    EXPECT_TRUE(rebuilt);
    EXPECT_FALSE(scene.update());
}

// Everything far from where the grid was laid: floats are too coarse there.
TEST(MovingTest, ASceneThatLeavesItsGridGetsANewOne)
{
    SceneTree<14> scene = square();
    scene.update();
    for (const double away : {1e6, 1e12, 1e3}) {
        for (int i = 0; i < side * side; i++) {
            Point p = place(i);
            p[1] += away;
            scene.set_pose(static_cast<std::uint32_t>(i), at(p));
        }
        EXPECT_TRUE(scene.update()) << away;
        Nearest found;
        Point above = scene.pose(11).translation;
        above[2] += 3;
        scene.nearest(above, 8, 8, found);
        ASSERT_FALSE(found.hits.empty());
        EXPECT_EQ(found.hits[0].object, 11u);
        EXPECT_LE(found.counts.leaves, 40u) << away;
    }
}

TEST(MovingTest, AnObjectGetsAnotherTree)
{
    SceneTree<14> scene;
    scene.add(TriangleTree<14>::build(sphere(1, 1).view()), at({0, 0, 0}));
    scene.add(TriangleTree<14>::build({}), at({50, 0, 0}));
    scene.update();
    std::vector<Hit> hits;
    scene.within({50, 0, 0}, 4, hits);
    EXPECT_TRUE(hits.empty());
    scene.set_tree(1, TriangleTree<14>::build(sphere(2, 3).view()));
    scene.update();
    scene.within({50, 0, 0}, 4, hits);
    EXPECT_EQ(hits.size(), 128u);
    scene.set_tree(1, TriangleTree<14>::build({}));
    scene.update();
    scene.within({50, 0, 0}, 100, hits);
    EXPECT_EQ(hits.size(), 32u) << "the first object's alone";
    EXPECT_THROW(scene.set_tree(2, TriangleTree<14>::build({})), std::out_of_range);
}

// The hierarchy itself: what is visited are all within the limit, and the cost is the documented sum.
TEST(MovingTest, HierarchyVisitsEveryHullWithinTheLimit)
{
    std::mt19937_64 random(59);
    std::uniform_real_distribution<double> coordinate(-100, 100), size(0, 10);
    std::vector<Slabs<26>> hulls(300);
    std::vector<std::uint32_t> all(hulls.size());
    auto place_anew = [&](std::uint32_t i) {
        hulls[i] = slabs_of<26>({coordinate(random), coordinate(random), coordinate(random)});
        for (auto& [low, high] : hulls[i])
            high += size(random);
        if (i % 50 == 0)
            hulls[i] = empty_slabs<26>();
    };
    ObjectTree<26> tree;
    for (int round = 0; round < 5; round++) {
        for (std::uint32_t i = 0; i < hulls.size(); i++) {
            all[i] = i;
            if (i % 5 >= static_cast<unsigned>(round))
                place_anew(i);
        }
        tree.update(hulls, all);
        for (int i = 0; i < 90; i++) {
            const double limit = i % 3 == 0 ? 0 : i % 3 == 1 ? 20 : 100;
            const auto query = slabs_of<26>({coordinate(random), coordinate(random), coordinate(random)});
            std::vector<int> visits(hulls.size());
            tree.visit(
                query, [&] { return limit; }, [&](std::uint32_t object) { visits[object]++; });
            for (std::uint32_t object = 0; object < hulls.size(); object++) {
                const double bound = distance_bound<26>(hulls[object], query);
                ASSERT_GE(visits[object], bound <= limit ? 1 : 0) << "missed at " << bound;
                ASSERT_LE(visits[object], bound <= limit + 1e-3 ? 1 : 0) << "visited at " << bound;
            }
        }
    }
}

TEST(MovingTest, CostIsTheNodesAreasOverTheObjects)
{
    // Two unit cubes, four apart: one node, a box of 5 x 1 x 1.
    std::vector<Slabs<6>> hulls = {Slabs<6>{{{0, 1}, {0, 1}, {0, 1}}}, Slabs<6>{{{4, 5}, {0, 1}, {0, 1}}}};
    ObjectTree<6> tree;
    const std::vector<std::uint32_t> both = {0, 1};
    EXPECT_TRUE(tree.update(hulls, both));
    EXPECT_NEAR(tree.cost(), 11.0 / 6, 1e-5);
    hulls[1] = {{{5, 6}, {0, 1}, {0, 1}}};
    EXPECT_FALSE(tree.update(hulls, both));
    EXPECT_NEAR(tree.cost(), 13.0 / 6, 1e-5);
    hulls[1] = {{{7, 8}, {0, 1}, {0, 1}}}; // 17/6 > 1.5 * 11/6
    EXPECT_TRUE(tree.update(hulls, both));
    hulls[1] = {{{1, 2}, {0, 1}, {0, 1}}};
    EXPECT_FALSE(tree.update(hulls, both));
    EXPECT_NEAR(tree.cost(), 5.0 / 6, 1e-5);
    hulls[1] = {{{4, 5}, {0, 1}, {0, 1}}}; // beyond 1.5 times the least since
    EXPECT_TRUE(tree.update(hulls, both));
}

} // namespace phantom::fdh::test
