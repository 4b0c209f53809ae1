// SPDX-License-Identifier: GPL-2.0-or-later
// Level one: objects with poses, against brute force over all of them in world coordinates.
#include <cmath>
#include <stdexcept>

#include "oracle.hpp"
#include "poses.hpp"

namespace phantom::fdh::test {

namespace {

/// A scene and the same triangles in world coordinates.
template <int K>
struct Scene {
    SceneTree<K> tree;
    std::vector<Mesh> meshes;

    void add(const Mesh& mesh, const Pose& pose)
    {
        EXPECT_EQ(tree.add(TriangleTree<K>::build(mesh.view()), pose), meshes.size());
        meshes.push_back(mesh);
    }
    [[nodiscard]] Mesh world(std::uint32_t object) const { return posed(meshes[object], tree.pose(object)); }
    [[nodiscard]] std::vector<Truth> truth(const Point& p) const
    {
        std::vector<Truth> all;
        for (std::uint32_t object = 0; object < meshes.size(); object++)
            for (Truth t : true_distances(world(object), p)) {
                t.object = object;
                all.push_back(t);
            }
        return all;
    }
    /// Of the worst object, and the rounding of world coordinates to double here.
    [[nodiscard]] double accuracy(const Point& p, double distance) const
    {
        double worst = 0, reach = 0;
        for (std::uint32_t object = 0; object < meshes.size(); object++) {
            worst = std::max(worst, tree.tree(object).accuracy(to_local(tree.pose(object), p), distance));
            for (double x : tree.pose(object).translation)
                reach = std::max(reach, std::abs(x));
        }
        return worst + 4e-16 * reach;
    }

    void check(const Point& p)
    {
        const auto expected = truth(p);
        const Accuracy error = [&](double distance) { return accuracy(p, distance); };
        Nearest nearest;
        std::vector<Hit> within;
        for (std::size_t count : {1, 64, 300})
            for (double radius : {infinity, 15.0}) {
                SCOPED_TRACE(testing::Message() << "count " << count << " radius " << radius << " p " << p[0]
                                                << ' ' << p[1] << ' ' << p[2]);
                tree.nearest(p, count, radius, nearest);
                expect_nearest(expected, nearest, count, radius, error);
            }
        tree.within(p, 15, within);
        expect_within(expected, within, 15, error);
    }
};

template <class K>
class SceneTest : public testing::Test {
};
using Hulls = testing::Types<std::integral_constant<int, 6>, std::integral_constant<int, 14>,
                             std::integral_constant<int, 18>, std::integral_constant<int, 26>>;
TYPED_TEST_SUITE(SceneTest, Hulls);

} // namespace

TYPED_TEST(SceneTest, PosedObjectsMatchBruteForceAndFollowTheirPoses)
{
    std::mt19937_64 random(37);
    std::uniform_real_distribution<double> place(-40, 40), angle(0, 6);
    auto pose = [&] {
        return turn({place(random), place(random), place(random)}, angle(random),
                    {place(random), place(random), place(random)});
    };
    Scene<TypeParam::value> scene;
    for (int i = 0; i < 30; i++)
        scene.add(i % 3 ? sphere(1, 3) : soup(20, 5, random), pose());
    scene.tree.update();
    for (int round = 0; round < 3; round++) {
        for (int i = 0; i < 8; i++)
            scene.check({place(random), place(random), place(random)});
        scene.check(scene.world(3).vertices[0]);
        scene.check({1e6, -1e6, 2e5});
        for (std::uint32_t object = round; object < 30; object += 2)
            scene.tree.set_pose(object, pose());
        scene.tree.update();
    }
}

TYPED_TEST(SceneTest, ObjectsFarFromTheOriginMatchBruteForce)
{
    Scene<TypeParam::value> scene;
    for (int i = 0; i < 5; i++)
        scene.add(sphere(2, 10), turn({1, 2.0 * i, 3}, i, {5e9 + 25 * i, -5e9, 4e9}));
    scene.add(sphere(2, 10), {});
    scene.tree.update();
    for (int i = 0; i < 10; i++)
        scene.check({5e9 + 13 * i - 10, -5e9 + i, 4e9 + 9});
    scene.check({0, 0, 12});
}

TYPED_TEST(SceneTest, EmptyObjectsAndEmptyScenesFindNothing)
{
    SceneTree<TypeParam::value> scene;
    Nearest found;
    std::vector<Hit> hits;
    auto expect_nothing = [&] {
        scene.nearest({1, 2, 3}, 64, 10, found);
        EXPECT_TRUE(found.hits.empty());
        EXPECT_EQ(found.coverage, 10);
        scene.within({1, 2, 3}, 10, hits);
        EXPECT_TRUE(hits.empty());
    };
    scene.update();
    expect_nothing();
    scene.add(TriangleTree<TypeParam::value>::build({}), {});
    scene.update();
    expect_nothing();
    EXPECT_EQ(scene.objects(), 1u);
    scene.add(TriangleTree<TypeParam::value>::build(sphere(2, 1).view()), {});
    scene.update();
    scene.nearest({1, 2, 3}, 64, 10, found);
    EXPECT_EQ(found.hits.size(), 64u);
    EXPECT_EQ(found.hits[0].object, 1u);
    EXPECT_EQ(scene.triangles(), 128u);
}

TYPED_TEST(SceneTest, EqualObjectsTieByObjectThenTriangle)
{
    SceneTree<TypeParam::value> scene;
    const Mesh mesh = flat_grid(4);
    for (int i = 0; i < 20; i++)
        scene.add(TriangleTree<TypeParam::value>::build(mesh.view()), {});
    scene.update();
    Nearest found;
    scene.nearest({2, 2, 0}, 50, infinity, found); // six triangles of each at distance 0
    found.sort();
    ASSERT_EQ(found.hits.size(), 50u);
    for (std::size_t i = 0; i < 50; i++) {
        EXPECT_EQ(found.hits[i].object, i / 6);
        EXPECT_EQ(found.hits[i].distance, 0);
    }
    EXPECT_EQ(found.coverage, 0);
}

TYPED_TEST(SceneTest, InvalidQueriesFindNothingAndCoverNothing)
{
    SceneTree<TypeParam::value> scene;
    scene.add(TriangleTree<TypeParam::value>::build(sphere(2, 1).view()), {});
    scene.update();
    Nearest found;
    scene.nearest({std::nan(""), 0, 0}, 64, 10, found);
    EXPECT_TRUE(found.hits.empty());
    EXPECT_EQ(found.coverage, 0);
    std::vector<Hit> hits(3);
    scene.within({0, std::nan(""), 0}, 10, hits);
    EXPECT_TRUE(hits.empty());
}

TYPED_TEST(SceneTest, PoseThatIsNotFiniteIsRefused)
{
    SceneTree<TypeParam::value> scene;
    Pose bad;
    bad.translation[1] = std::nan("");
    EXPECT_THROW(scene.add(TriangleTree<TypeParam::value>::build({}), bad), std::invalid_argument);
    EXPECT_EQ(scene.objects(), 0u);
    scene.add(TriangleTree<TypeParam::value>::build({}), {});
    EXPECT_THROW(scene.set_pose(0, bad), std::invalid_argument);
    EXPECT_THROW(scene.set_pose(1, {}), std::out_of_range);
}

// A query near one object must not pay for a thousand others.
TEST(SceneTest, DistantObjectsAreNotVisited)
{
    SceneTree<14> scene;
    const Mesh mesh = sphere(2, 1);
    for (int i = 0; i < 1000; i++)
        scene.add(TriangleTree<14>::build(mesh.view(), {.threads = 1}),
                  {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {10.0 * i, 0, 0}});
    scene.update();
    Nearest found;
    scene.nearest({5000, 0, 1.5}, 64, 4, found);
    EXPECT_EQ(found.hits.size(), 64u);
    for (const auto& hit : found.hits)
        EXPECT_EQ(hit.object, 500u);
    EXPECT_LE(found.counts.leaves, 40u);
}

} // namespace phantom::fdh::test
