// SPDX-License-Identifier: GPL-2.0-or-later
// Hulls contain what they must, here and in other frames.
#include <cmath>

#include "fdh/build.hpp"
#include "fdh/pose.hpp"
#include "oracle.hpp"
#include "poses.hpp"

namespace phantom::fdh::test {

namespace {

template <class K>
class HullTest : public testing::Test {
};
using Hulls = testing::Types<std::integral_constant<int, 6>, std::integral_constant<int, 14>,
                             std::integral_constant<int, 18>, std::integral_constant<int, 26>>;
TYPED_TEST_SUITE(HullTest, Hulls);

} // namespace

TYPED_TEST(HullTest, DirectionsAreDistinctAndReachK)
{
    constexpr auto directions = hull_directions<TypeParam::value>();
    ASSERT_EQ(directions.size() * 2, static_cast<std::size_t>(TypeParam::value));
    for (std::size_t i = 0; i < directions.size(); i++) {
        EXPECT_NE(directions[i], (std::array<int, 3>{0, 0, 0}));
        for (std::size_t j = 0; j < i; j++) {
            EXPECT_NE(directions[i], directions[j]);
            EXPECT_NE(directions[i],
                      (std::array<int, 3>{-directions[j][0], -directions[j][1], -directions[j][2]}));
        }
    }
}

TYPED_TEST(HullTest, ContainsEveryVertexAndIsTight)
{
    constexpr auto directions = hull_directions<TypeParam::value>();
    std::mt19937_64 random(17);
    for (const Point& shift : {Point{0, 0, 0}, Point{5e9, -5e9, 1e9}}) {
        const Mesh mesh = scaled(soup(500, 10, random), 1, shift);
        const auto tree = TriangleTree<TypeParam::value>::build(mesh.view());
        const auto hull = tree.hull();
        for (std::size_t k = 0; k < directions.size(); k++) {
            long double low = INFINITY, high = -INFINITY;
            for (const auto& v : mesh.vertices) {
                long double x = 0;
                for (int axis = 0; axis < 3; axis++)
                    x += static_cast<long double>(directions[k][axis]) * v[axis];
                low = std::min(low, x);
                high = std::max(high, x);
            }
            EXPECT_LE(hull[k][0], low);
            EXPECT_GE(hull[k][1], high);
            const double looseness = 4 * tree.accuracy(mesh.vertices[0], 0) + 1e-13 * std::abs(shift[0]);
            EXPECT_GE(hull[k][0], low - looseness);
            EXPECT_LE(hull[k][1], high + looseness);
        }
    }
}

// In whole steps, without slack: every lane of every node holds its leaf's corners, also where three
// coordinates add up to more than floats can tell apart.
TYPED_TEST(HullTest, EveryLaneContainsItsLeaf)
{
    constexpr int K = TypeParam::value;
    constexpr auto directions = hull_directions<K>();
    std::mt19937_64 random(18);
    std::uniform_real_distribution<double> unit(0, 1);
    Mesh mesh = soup(3000, 10, random);
    for (auto& v : mesh.vertices) // into the corners of a cube
        for (double& x : v)
            x = std::copysign(30 + 2 * unit(random), x);
    const auto data = build_tree<K>(mesh.view(), 1, Isa::best);
    const Levels levels = Levels::above(data.leaves.size());
    std::size_t leaves = 0;
    for (std::size_t n = 0; n < levels.size[0]; n++)
        for (int lane = 0; lane < lanes && leaves < data.leaves.size(); lane++) {
            const Node<K>& node = data.nodes[levels.base[0] + n];
            const Leaf& leaf = data.leaves[leaves++];
            for (int i = 0; i < lanes && leaf.triangle[i] != no_triangle; i++)
                for (std::uint32_t vertex : mesh.triangles[leaf.triangle[i] & ~needle_flag]) {
                    const auto corner = data.grid.round(mesh.vertices[vertex]);
                    for (int k = 0; k < K / 2; k++) {
                        const auto& d = directions[k];
                        const double x =
                            d[0] * double{corner[0]} + d[1] * double{corner[1]} + d[2] * double{corner[2]};
                        ASSERT_LE(node.low[k][lane], x);
                        ASSERT_GE(node.high[k][lane], x);
                    }
                }
        }
    EXPECT_EQ(leaves, data.leaves.size());
}

TYPED_TEST(HullTest, OfAnEmptyTreeIsEmpty)
{
    const auto hull = TriangleTree<TypeParam::value>::build({}).hull();
    for (const auto& [low, high] : hull) {
        EXPECT_EQ(low, std::numeric_limits<double>::infinity());
        EXPECT_EQ(high, -std::numeric_limits<double>::infinity());
    }
}

TYPED_TEST(HullTest, PosedHullContainsThePosedVertices)
{
    constexpr auto directions = hull_directions<TypeParam::value>();
    std::mt19937_64 random(19);
    const Mesh mesh = soup(100, 10, random);
    const auto hull = TriangleTree<TypeParam::value>::build(mesh.view()).hull();
    for (int i = 0; i < 200; i++) {
        const Pose pose = random_pose(i % 2 ? 50 : 5e9, random);
        const auto posed = posed_hull<TypeParam::value>(hull, pose);
        for (std::size_t k = 0; k < directions.size(); k++)
            for (const auto& v : mesh.vertices) {
                long double x = 0;
                for (int row = 0; row < 3; row++) {
                    long double w = pose.translation[row];
                    for (int axis = 0; axis < 3; axis++)
                        w += static_cast<long double>(pose.rotation[3 * row + axis]) * v[axis];
                    x += directions[k][row] * w;
                }
                ASSERT_LE(posed[k][0], x);
                ASSERT_GE(posed[k][1], x);
            }
    }
}

// The diagonals are worth their place only if they make rotated hulls smaller.
TEST(PosedHullTest, DiagonalsTightenARotatedHull)
{
    const Mesh mesh = sphere(4, 1);
    const double c = std::sqrt(0.5);
    const Pose turned = {{c, -c, 0, c, c, 0, 0, 0, 1}, {0, 0, 0}};
    const auto box = posed_hull<6>(TriangleTree<6>::build(mesh.view()).hull(), turned);
    const auto diagonal = posed_hull<18>(TriangleTree<18>::build(mesh.view()).hull(), turned);
    EXPECT_NEAR(box[0][1], std::sqrt(2.0), 1e-6);
    EXPECT_NEAR(diagonal[0][1], 1, 1e-3);
}

} // namespace phantom::fdh::test
