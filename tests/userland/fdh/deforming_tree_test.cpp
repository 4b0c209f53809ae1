// SPDX-License-Identifier: GPL-2.0-or-later
// A tree that follows its mesh: what it answers, and when it is built anew.
#include "fdh/deforming_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "oracle.hpp"

namespace phantom::fdh::test {
namespace {

/// Triangles with corners of their own, each gone so far along a way of its own.
Mesh scattered(const Mesh& mesh, double distance)
{
    std::mt19937_64 random(7);
    std::normal_distribution<double> part;
    Mesh out;
    for (const auto& triangle : mesh.triangles) {
        const Point way = {part(random), part(random), part(random)};
        std::array<Point, 3> corners;
        for (int k = 0; k < 3; ++k)
            for (int axis = 0; axis < 3; ++axis)
                corners[k][axis] = mesh.vertices[triangle[k]][axis] + distance * way[axis];
        out.add(corners[0], corners[1], corners[2]);
    }
    return out;
}

TEST(DeformingTree, IsBuiltAnewWhereItsSpreadHasGrownAndNotBefore)
{
    const Mesh rest = scattered(sphere(4, 1.0), 0);
    DeformingTree<14> tree(TriangleTree<14>::build(rest.view()));
    // Comes and goes: never.
    for (int i = 0; i < 20; ++i) {
        Mesh swollen = rest;
        for (auto& v : swollen.vertices)
            v[2] *= 1 + 0.2 * std::sin(i);
        EXPECT_FALSE(tree.update(swollen.view()));
    }
    std::mt19937_64 random(5);
    int built = 0;
    for (double distance = 0; distance < 0.5; distance += 0.02) {
        const Mesh now = scattered(rest, distance);
        const double refitted = tree.tree().refitted(now.view()).spread();
        const bool anew = tree.update(now.view());
        built += anew;
        if (!anew) {
            EXPECT_EQ(tree.tree().spread(), refitted);
        }
        EXPECT_LE(tree.tree().spread(), refitted);
        const Point p = probes(now, 1, random).front();
        Nearest found;
        tree.tree().nearest(p, 16, 10, found);
        expect_nearest(true_distances(now, p), found, 16, 10, accuracy_of(tree.tree(), p));
    }
    EXPECT_GT(built, 0);
    EXPECT_LT(built, 12);
}

/// Leaves get long and thin, and no triangle leaves its neighbours.
TEST(DeformingTree, IsBuiltAnewWhereTheMeshIsDrawnOut)
{
    const Mesh rest = sphere(5, 1.0);
    DeformingTree<14> tree(TriangleTree<14>::build(rest.view()));
    const double fresh = tree.tree().spread();
    EXPECT_NEAR(tree.tree().refitted(scaled(rest, 7, {1, 2, 3}).view()).spread(), fresh, 0.01 * fresh);
    int built = 0;
    for (double longest = 1; longest < 30; longest *= 1.1) {
        Mesh drawn = rest;
        for (auto& v : drawn.vertices)
            v[1] *= longest;
        built += tree.update(drawn.view());
        const double anew = TriangleTree<14>::build(drawn.view()).spread();
        EXPECT_LE(tree.tree().spread(), 2 * anew) << longest;
    }
    EXPECT_GT(built, 1);
    EXPECT_LT(built, 12);
}

} // namespace
} // namespace phantom::fdh::test
