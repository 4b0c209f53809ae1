// SPDX-License-Identifier: GPL-2.0-or-later
// Object against object on level one: against the true distances between all their triangles.
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "fdh/scene_tree.hpp"
#include "poses.hpp"

namespace phantom::fdh::test {

namespace {

Mesh box(double x, double y, double z)
{
    Mesh mesh;
    auto corner = [&](int i) { return Point{i & 1 ? x : -x, i & 2 ? y : -y, i & 4 ? z : -z}; };
    constexpr int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                 {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& f : faces) {
        mesh.add(corner(f[0]), corner(f[1]), corner(f[2]));
        mesh.add(corner(f[0]), corner(f[2]), corner(f[3]));
    }
    return mesh;
}

template <int K>
struct PairScene {
    SceneTree<K> tree;
    std::vector<Mesh> meshes;

    void add(const Mesh& mesh, const Pose& pose)
    {
        tree.add(TriangleTree<K>::build(mesh.view(), {.threads = 1}), pose);
        meshes.push_back(mesh);
    }

    /// All pairs and their lower bounds, which are true; every shorter answer must be the part of it that the
    /// bounds say.
    void check(std::initializer_list<double> distances) const
    {
        std::vector<Mesh> world;
        for (std::uint32_t i = 0; i < meshes.size(); i++)
            world.push_back(posed(meshes[i], tree.pose(i)));
        std::vector<ObjectPair> all, found;
        tree.pairs(infinity, all);
        ASSERT_EQ(all.size(), meshes.size() * (meshes.size() - 1) / 2);
        for (const ObjectPair& pair : all) {
            const Mesh &a = world[pair.first], &b = world[pair.second];
            EXPECT_LE(pair.at_least, pair.at_least > 0 ? true_distance(a, b, infinity) : 0)
                << pair.first << " and " << pair.second;
        }
        for (const double distance : distances) {
            tree.pairs(distance, found);
            std::size_t next = 0;
            for (const ObjectPair& pair : all) {
                if (pair.at_least > distance)
                    continue;
                ASSERT_LT(next, found.size());
                EXPECT_EQ(found[next].first, pair.first);
                EXPECT_EQ(found[next].second, pair.second);
                EXPECT_EQ(found[next].at_least, pair.at_least);
                next++;
            }
            EXPECT_EQ(next, found.size());
            check_near(distance, all);
        }
    }

    /// pairs_near(i) is what pairs() has of i.
    void check_near(double distance, const std::vector<ObjectPair>& all) const
    {
        std::vector<ObjectPair> near;
        for (std::uint32_t i = 0; i < meshes.size(); i++) {
            tree.pairs_near(i, distance, near);
            std::size_t next = 0;
            for (const ObjectPair& pair : all) {
                if ((pair.first != i && pair.second != i) || pair.at_least > distance)
                    continue;
                ASSERT_LT(next, near.size());
                EXPECT_EQ(near[next].first, i);
                EXPECT_EQ(near[next].second, pair.first + pair.second - i);
                EXPECT_EQ(near[next].at_least, pair.at_least);
                next++;
            }
            EXPECT_EQ(next, near.size());
        }
    }
};

template <class K>
class PairsTest : public testing::Test {
};
using Hulls = testing::Types<std::integral_constant<int, 6>, std::integral_constant<int, 14>,
                             std::integral_constant<int, 18>, std::integral_constant<int, 26>>;
TYPED_TEST_SUITE(PairsTest, Hulls);

} // namespace

TYPED_TEST(PairsTest, NoneIsMissedWhileObjectsMove)
{
    std::mt19937_64 random(41);
    PairScene<TypeParam::value> scene;
    for (int i = 0; i < 9; i++)
        scene.add(soup(3, 8, random), random_pose(20, random));
    for (int round = 0; round < 2; round++) {
        scene.tree.update();
        scene.check({0, 0.5, 4, 15});
        for (std::uint32_t object = round; object < 9; object += 2)
            scene.tree.set_pose(object, random_pose(20, random));
    }
}

TYPED_TEST(PairsTest, PointsSegmentsAndNeedlesAreNotMissed)
{
    std::mt19937_64 random(43);
    const Mesh faces = degenerate_faces(random);
    PairScene<TypeParam::value> scene;
    for (std::size_t i = 0; i < 18; i++) {
        Mesh one;
        const Corners t = corners(faces, i);
        one.add(t[0], t[1], t[2]);
        scene.add(one, random_pose(30, random));
    }
    scene.tree.update();
    scene.check({0, 10, 40});
}

TYPED_TEST(PairsTest, FarFromTheOriginNoneIsMissed)
{
    std::mt19937_64 random(47);
    PairScene<TypeParam::value> scene;
    for (int i = 0; i < 10; i++) {
        Pose pose = random_pose(20, random);
        pose.translation[0] += 5e9;
        pose.translation[1] -= 4e9;
        scene.add(soup(3, 6, random), pose);
    }
    scene.add(soup(3, 6, random), {});
    scene.tree.update();
    scene.check({0, 3, 12});
}

// Where hulls touch exactly, the pair is there, and one that is a hair apart has a bound that says so.
TYPED_TEST(PairsTest, BoxesOnAGridAreBoundExactly)
{
    PairScene<TypeParam::value> scene;
    const Mesh cube = box(1, 1, 1);
    for (int i = 0; i < 5; i++)
        scene.add(cube, {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {i * (2 + 0.25 * i), 0, 0}});
    scene.tree.update();
    std::vector<ObjectPair> near;
    scene.tree.pairs_near(0, 3, near);
    ASSERT_EQ(near.size(), 2u);
    EXPECT_EQ(near[0].second, 1u);
    EXPECT_NEAR(near[0].at_least, 0.25, 1e-6);
    EXPECT_LE(near[0].at_least, 0.25);
    EXPECT_NEAR(near[1].at_least, 3, 1e-6);
    scene.tree.set_pose(1, {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {2, 0, 0}});
    scene.tree.update();
    scene.tree.pairs_near(0, 0, near);
    ASSERT_EQ(near.size(), 1u);
    EXPECT_EQ(near[0].at_least, 0);
}

// In world directions two long boxes side by side, turned by 30 degrees, overlap; in their own they do not.
TYPED_TEST(PairsTest, ObjectsAreSeenInTheirOwnFrames)
{
    PairScene<TypeParam::value> scene;
    const Mesh plank = box(50, 1, 20);
    const Pose turned = turn({0.2, 0.1, 1}, M_PI / 6, {0, 0, 0});
    Pose beside = turned;
    for (int axis = 0; axis < 3; axis++)
        beside.translation[axis] = 5 * turned.rotation[3 * axis + 1];
    scene.add(plank, turned);
    scene.add(plank, beside);
    scene.tree.update();
    std::vector<ObjectPair> pairs;
    scene.tree.pairs(2.9, pairs);
    EXPECT_TRUE(pairs.empty());
    scene.tree.pairs(3, pairs);
    ASSERT_EQ(pairs.size(), 1u);
    EXPECT_NEAR(pairs[0].at_least, 3, 1e-4);
}

TYPED_TEST(PairsTest, EmptyObjectsAndInvalidDistancesFindNothing)
{
    PairScene<TypeParam::value> scene;
    std::vector<ObjectPair> pairs(3);
    scene.tree.pairs(1, pairs);
    EXPECT_TRUE(pairs.empty());
    scene.add(sphere(1, 1), {});
    scene.add({}, {});
    scene.add(sphere(1, 1), {});
    scene.tree.update();
    scene.tree.pairs(infinity, pairs);
    ASSERT_EQ(pairs.size(), 1u);
    EXPECT_EQ(pairs[0].second, 2u);
    scene.tree.pairs_near(1, infinity, pairs);
    EXPECT_TRUE(pairs.empty());
    for (const double invalid : {-1.0, std::nan("")}) {
        scene.tree.pairs(infinity, pairs);
        scene.tree.pairs_near(0, invalid, pairs);
        EXPECT_TRUE(pairs.empty());
        scene.tree.pairs(infinity, pairs);
        scene.tree.pairs(invalid, pairs);
        EXPECT_TRUE(pairs.empty());
    }
    EXPECT_THROW(scene.tree.pairs_near(3, 1, pairs), std::out_of_range);
}

// A tool among a thousand objects in a row meets the few beside it.
TEST(PairsTest, TheToolMeetsItsNeighboursOnly)
{
    SceneTree<14> scene;
    const auto ball = TriangleTree<14>::build(sphere(2, 1).view(), {.threads = 1});
    for (int i = 0; i < 1000; i++)
        scene.add(ball, {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {10.0 * i, 0, 0}});
    const auto tool = scene.add(TriangleTree<14>::build(box(1, 1, 30).view()), {});
    std::vector<ObjectPair> pairs;
    for (int i = 1; i < 999; i += 90) {
        scene.set_pose(tool, turn({0, 1, 0}, 0.5 * M_PI, {10.0 * i, 0, 3.5}));
        scene.update();
        scene.pairs_near(tool, 2, pairs);
        ASSERT_GE(pairs.size(), 3u);
        EXPECT_LE(pairs.size(), 7u);
        for (const ObjectPair& pair : pairs) {
            EXPECT_NEAR(pair.second, i, 3);
            EXPECT_LE(pair.at_least, 2);
        }
    }
}

// Triangle by triangle, down from both trees.
TYPED_TEST(PairsTest, TrianglePairsMatchBruteForce)
{
    constexpr int K = TypeParam::value;
    std::mt19937_64 random(151);
    PairScene<K> scene;
    const Mesh faces = degenerate_faces(random);
    Mesh needles;
    for (std::size_t i = 0; i < 8; i++) {
        const Corners t = corners(faces, i);
        needles.add(t[0], t[1], t[2]);
    }
    scene.add(soup(16, 5, random), random_pose(1, random));
    scene.add(scaled(needles, 0.1, {0, 0, 0}), random_pose(1, random));
    scene.add(scaled(sphere(1, 3), 1, {30, 0, 0}), {{0, -1, 0, 1, 0, 0, 0, 0, 1}, {0, -28, 0}});
    scene.add(flat_grid(3), {});
    scene.add({}, {});
    scene.tree.update();
    std::vector<TrianglePair> found;
    std::size_t total = 0;
    for (std::uint32_t i = 0; i < 5; i++)
        for (std::uint32_t j = 0; j < 5; j++) {
            if (i == j || (i < j) == ((i + j) % 2 == 0)) // either order, by turns
                continue;
            const Mesh a = posed(scene.meshes[i], scene.tree.pose(i)),
                       b = posed(scene.meshes[j], scene.tree.pose(j));
            const double distance = (i + j) % 3 == 0 ? 0 : (i + j) % 3 == 1 ? 0.2 : 1;
            const double error =
                scene.tree.tree(i).accuracy({0, 0, 0}, 0) + scene.tree.tree(j).accuracy({0, 0, 0}, 0);
            scene.tree.triangle_pairs(i, j, distance, found);
            total += found.size();
            std::vector<double> given(a.triangles.size() * b.triangles.size(), -1);
            for (const TrianglePair& pair : found) {
                double& place = given.at(pair.first * b.triangles.size() + pair.second);
                EXPECT_EQ(place, -1) << "twice";
                place = pair.distance;
            }
            for (std::size_t s = 0; s < a.triangles.size(); s++)
                for (std::size_t t = 0; t < b.triangles.size(); t++) {
                    const double answer = given[s * b.triangles.size() + t];
                    if (answer < 0 && sphere_bound(corners(a, s), corners(b, t)) > distance)
                        continue;
                    const auto truth = static_cast<double>(true_distance(corners(a, s), corners(b, t)));
                    ASSERT_GE(truth, answer < 0 ? distance : 0) << "missed";
                    ASSERT_LE(truth, answer < 0 ? infinity : distance + 2 * error);
                    ASSERT_NEAR(answer < 0 ? truth : answer, truth, error);
                }
        }
    EXPECT_GT(total, 40u);
}

// Two that share a corner, each in a grid of its own that rounds it; and sheets that are a hair too far
// apart.
TYPED_TEST(PairsTest, TrianglePairsThatTouchAreFoundAndNoneBeyondTheBound)
{
    constexpr int K = TypeParam::value;
    std::mt19937_64 random(157);
    PairScene<K> scene;
    std::vector<TrianglePair> found;
    Mesh corner = soup(1, 10, random);
    for (std::uint32_t i = 0; i < 60; i++) {
        Mesh fan = soup(1, 10, random);
        fan.vertices[0] = corner.vertices[0];
        scene.add(fan, {});
    }
    scene.tree.update();
    for (std::uint32_t i = 1; i < 60; i++) {
        scene.tree.triangle_pairs(0, i, 0, found);
        EXPECT_EQ(found.size(), 1u) << i;
    }
    PairScene<K> sheets;
    sheets.add(flat_grid(6), {});
    sheets.add(flat_grid(5), {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.3, 0.2, 2}});
    sheets.tree.update();
    const double error =
        sheets.tree.tree(0).accuracy({0, 0, 0}, 0) + sheets.tree.tree(1).accuracy({0, 0, 0}, 0);
    sheets.tree.triangle_pairs(0, 1, 2 - 2.01 * error, found);
    EXPECT_TRUE(found.empty());
    sheets.tree.triangle_pairs(0, 1, 2, found);
    EXPECT_GT(found.size(), 50u);
}

TEST(PairsTest, TrianglePairsOfThousandsAreThoseThatTouch)
{
    // Two balls, side by side: a point of each touches the other.
    SceneTree<14> scene;
    const auto ball = TriangleTree<14>::build(sphere(5, 10).view());
    scene.add(ball, {});
    scene.add(ball, {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {20, 0, 0}});
    scene.update();
    std::vector<TrianglePair> found;
    scene.triangle_pairs(0, 1, 0, found);
    EXPECT_EQ(found.size(), 16u) << "four triangles at either point";
    for (const TrianglePair& pair : found)
        EXPECT_LE(pair.distance, 1e-5);
    scene.triangle_pairs(0, 1, -1, found);
    EXPECT_TRUE(found.empty());
    EXPECT_THROW(scene.triangle_pairs(0, 2, 1, found), std::out_of_range);
}

} // namespace phantom::fdh::test
