// SPDX-License-Identifier: GPL-2.0-or-later
// A walk's queries answer bit for bit as the tree does, and mostly without it.
#include "fdh/coherent.hpp"

#include <cmath>

#include "oracle.hpp"
#include "poses.hpp"

namespace phantom::fdh::test {

namespace {

void expect_same(Nearest expected, Nearest found)
{
    expected.sort();
    found.sort();
    ASSERT_EQ(found.hits.size(), expected.hits.size());
    EXPECT_EQ(found.coverage, expected.coverage);
    for (std::size_t i = 0; i < found.hits.size(); i++) {
        ASSERT_EQ(found.hits[i].object, expected.hits[i].object);
        ASSERT_EQ(found.hits[i].triangle, expected.hits[i].triangle);
        ASSERT_EQ(found.hits[i].distance, expected.hits[i].distance);
    }
}

/// Points along great circles of a sphere, in steps of different sizes, with jumps between.
std::vector<Point> walk(double radius, double step, std::size_t strokes, std::mt19937_64& random)
{
    std::normal_distribution<double> normal;
    std::vector<Point> points;
    for (std::size_t stroke = 0; stroke < strokes; stroke++) {
        const Pose turn = random_pose(0, random);
        for (int i = 0; i < 60; i++) {
            const double angle = i * step / radius, r = radius + 0.3 * step * normal(random);
            Point p{};
            for (std::size_t axis = 0; axis < 3; axis++)
                p[axis] = r * (std::cos(angle) * turn.rotation[3 * axis] +
                               std::sin(angle) * turn.rotation[3 * axis + 1]);
            points.push_back(p);
        }
    }
    return points;
}

template <class K>
class CoherentTest : public testing::Test {
};
using Hulls = testing::Types<std::integral_constant<int, 6>, std::integral_constant<int, 14>,
                             std::integral_constant<int, 18>, std::integral_constant<int, 26>>;
TYPED_TEST_SUITE(CoherentTest, Hulls);

} // namespace

TYPED_TEST(CoherentTest, AWalkGetsTheTreesAnswers)
{
    std::mt19937_64 random(41);
    for (const Mesh& mesh : {sphere(5, 60), soup(4000, 60, random), degenerate_faces(random)}) {
        const auto tree = TriangleTree<TypeParam::value>::build(mesh.view());
        for (double step : {0.02, 0.3, 3.0})
            for (double radius : {infinity, 5.0}) {
                CoherentQuery<TypeParam::value> query;
                Nearest expected, found;
                for (const Point& p : walk(60, step, 4, random)) {
                    tree.nearest(p, 64, radius, expected);
                    query.nearest(tree, p, 64, radius, found);
                    expect_same(expected, found);
                    if (testing::Test::HasFailure())
                        return;
                }
            }
    }
}

TEST(CoherentQueryTest, ASlowWalkIsMostlyAnsweredFromWhatIsAtHand)
{
    std::mt19937_64 random(43);
    const auto tree = TriangleTree<14>::build(sphere(6, 60).view());
    CoherentQuery<14> query;
    Nearest found;
    for (const Point& p : walk(60, 0.05, 10, random))
        query.nearest(tree, p, 64, infinity, found);
    const auto& counts = query.counts();
    EXPECT_EQ(counts.kept + counts.gathered + counts.searched, 600u);
    EXPECT_GT(counts.kept, 400u);
    EXPECT_GE(counts.searched, 10u) << "each stroke begins with a jump";
    EXPECT_LT(counts.searched, 40u);
}

TEST(CoherentQueryTest, JumpsAreAnsweredByTheTree)
{
    std::mt19937_64 random(47);
    const Mesh mesh = sphere(5, 60);
    const auto tree = TriangleTree<14>::build(mesh.view());
    CoherentQuery<14> query;
    Nearest expected, found;
    for (const Point& p : probes(mesh, 20, random)) {
        tree.nearest(p, 64, infinity, expected);
        query.nearest(tree, p, 64, infinity, found);
        expect_same(expected, found);
    }
    EXPECT_GT(query.counts().searched, query.counts().kept);
}

TEST(CoherentQueryTest, AnotherTreeAndOtherCountsAreNoticed)
{
    std::mt19937_64 random(53);
    const auto first = TriangleTree<14>::build(sphere(5, 60).view());
    const auto second = TriangleTree<14>::build(sphere(4, 60.5).view());
    CoherentQuery<14> query;
    Nearest expected, found;
    int i = 0;
    for (const Point& p : walk(60, 0.1, 2, random)) {
        const auto& tree = i / 7 % 2 ? first : second;
        const std::size_t count = i % 5 == 0 ? 200 : i % 5 == 1 ? 0 : 64;
        const double radius = i % 3 == 0 ? 2 : infinity;
        i++;
        tree.nearest(p, count, radius, expected);
        query.nearest(tree, p, count, radius, found);
        expect_same(expected, found);
    }
}

TEST(CoherentQueryTest, InvalidAndEmptyAreAnsweredAsByTheTree)
{
    const auto empty = TriangleTree<14>::build({});
    const auto tree = TriangleTree<14>::build(sphere(3, 60).view());
    CoherentQuery<14> query;
    Nearest found;
    query.nearest(tree, {0, 0, 60}, 8, 10, found);
    EXPECT_EQ(found.hits.size(), 8u);
    query.nearest(tree, {std::nan(""), 0, 0}, 8, 10, found);
    EXPECT_TRUE(found.hits.empty());
    EXPECT_EQ(found.coverage, 0);
    query.nearest(empty, {0, 0, 60}, 8, 10, found);
    EXPECT_TRUE(found.hits.empty());
    EXPECT_EQ(found.coverage, 10);
}

TEST(CoherentQueryTest, MovingObjectsGiveTheScenesAnswers)
{
    std::mt19937_64 random(59);
    SceneTree<14> scene;
    const auto ball = TriangleTree<14>::build(sphere(5, 20).view());
    for (int i = 0; i < 5; i++)
        scene.add(ball, random_pose(15, random));
    CoherentQuery<14> query;
    Nearest expected, found;
    for (const Point& p : walk(20, 0.05, 4, random)) {
        for (std::uint32_t object = 0; object < 3; object++) {
            Pose pose = scene.pose(object);
            pose.translation[object] += 0.01;
            scene.set_pose(object, pose);
        }
        scene.update();
        scene.nearest(p, 64, infinity, expected);
        query.nearest(scene, p, 64, infinity, found);
        expect_same(expected, found);
        if (testing::Test::HasFailure())
            return;
    }
    EXPECT_GT(query.counts().kept, query.counts().searched);
}

} // namespace phantom::fdh::test
