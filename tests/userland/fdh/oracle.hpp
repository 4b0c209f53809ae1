// SPDX-License-Identifier: GPL-2.0-or-later
// The truth about distances, by brute force over the mesh as it was given, and what every answer must
// satisfy.
#pragma once

#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "fdh/scene_tree.hpp"
#include "meshes.hpp"

namespace phantom::fdh::test {

/// Distance from a point to a triangle in long double, by another method than the library's: in the plane of
/// the triangle, with an orthonormal basis from its longest edge.
long double true_distance(const Point& p, const Point& a, const Point& b, const Point& c);
/// The same from the origin to a triangle in long double.
long double true_distance_from_origin(std::array<std::array<long double, 3>, 3> corner);

/// A triangle of a scene and its true distance.
struct Truth {
    std::uint32_t object, triangle;
    long double distance;
};

std::vector<Truth> true_distances(const Mesh& mesh, const Point& p);

/// Points that find the hard places of a mesh: near it, on its faces, edges and vertices, far away, in its
/// middle.
std::vector<Point> probes(const Mesh& mesh, std::size_t each, std::mt19937_64& random);

/// How far a reported distance of this size may be from the true one.
using Accuracy = std::function<double(double distance)>;

template <int K>
Accuracy accuracy_of(const TriangleTree<K>& tree, const Point& p)
{
    return [tree, p](double distance) { return tree.accuracy(p, distance); };
}

/// What query.hpp promises of "the N nearest", and that it gives as much as it can; `accuracy` bounds the
/// error of a distance.
void expect_nearest(std::vector<Truth> truth, const Nearest& found, std::size_t count, double radius,
                    const Accuracy& accuracy);
/// What tree.hpp promises of "all within".
void expect_within(const std::vector<Truth>& truth, const std::vector<Hit>& found, double radius,
                   const Accuracy& accuracy);

} // namespace phantom::fdh::test
