// SPDX-License-Identifier: GPL-2.0-or-later
// A tree that follows its mesh: what it answers, and when it is built anew.
#include "fdh/deforming_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "oracle.hpp"

namespace phantom::fdh::test {
namespace {

/// Turned about the z axis, the more the farther out: faces wind round each other.
Mesh wound(Mesh mesh, double turn)
{
    for (auto& v : mesh.vertices) {
        const double angle = turn * std::hypot(v[0], v[1]) + turn * v[2];
        v = {std::cos(angle) * v[0] - std::sin(angle) * v[1], std::sin(angle) * v[0] + std::cos(angle) * v[1],
             v[2]};
    }
    return mesh;
}

TEST(DeformingTree, IsBuiltAnewWhereItsSpreadHasGrownAndNotBefore)
{
    const Mesh rest = sphere(1.0, 40, 60);
    DeformingTree<14> tree(TriangleTree<14>::build(rest.view()));
    const double at_first = tree.tree().spread();
    // Comes and goes: never.
    for (int i = 0; i < 20; ++i) {
        Mesh swollen = rest;
        for (auto& v : swollen.vertices)
            v[2] *= 1 + 0.2 * std::sin(i);
        EXPECT_FALSE(tree.update(swollen.view()));
    }
    std::mt19937_64 random(5);
    int built = 0;
    for (double turn = 0; turn < 6; turn += 0.25) {
        const Mesh now = wound(rest, turn);
        const double refitted = tree.tree().refitted(now.view()).spread();
        const bool anew = tree.update(now.view());
        built += anew;
        if (!anew) {
            EXPECT_EQ(tree.tree().spread(), refitted);
        }
        EXPECT_LE(tree.tree().spread(), DeformingTree<14>::tolerated_growth * 4 * at_first);
        const Point p = probes(now, 1, random).front();
        Nearest found;
        tree.tree().nearest(p, 16, 10, found);
        expect_nearest(true_distances(now, p), found, 16, 10, accuracy_of(tree.tree(), p));
    }
    EXPECT_GT(built, 0);
    EXPECT_LT(built, 12);
}

} // namespace
} // namespace phantom::fdh::test
