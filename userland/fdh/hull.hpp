// SPDX-License-Identifier: GPL-2.0-or-later
// Fixed Direction Hulls (k-DOPs; Kabelac 2001 section 5, Klosowski et al. 1998): the convex hull of
// a shape with respect to K fixed half-space directions, K = 6, 14, 18 or 26.
//
// The hull library depends on nothing else in this project and on no mesh library.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>

namespace phantom::fdh {

using Point = std::array<double, 3>;
using Triangle = std::array<std::uint32_t, 3>;

/// Largest magnitude a coordinate may have. Building on a vertex beyond it fails; a query from a point
/// beyond it finds nothing and covers nothing.
inline constexpr double largest_coordinate = 1e100;

/// Along the axes, its surface included. A side may be infinite.
struct Box {
    Point low, high;
};

/// Triangles that somebody else owns; must outlive every tree built on it only while building.
struct MeshView {
    std::span<const Point> vertices; ///< any unit; finite, magnitude <= largest_coordinate
    std::span<const Triangle> triangles;
};

/// The K/2 directions of a hull, unnormalised; each bounds the shape from both sides.
///   6: the three axes
///  14: the axes, then the four diagonals of the cube
///  18: the axes, then the six diagonals of its faces (parallel to the lines through opposite edges' middles)
///  26: the axes, the four diagonals of the cube, the six diagonals of its faces
template <int K>
constexpr std::array<std::array<int, 3>, K / 2> hull_directions()
{
    static_assert(K == 6 || K == 14 || K == 18 || K == 26, "FDH6, FDH14, FDH18 or FDH26");
    constexpr int axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    constexpr int cube[4][3] = {{1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};
    constexpr int edge[6][3] = {{1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}};
    std::array<std::array<int, 3>, K / 2> directions{};
    int count = 0;
    auto append = [&](const int(&d)[3]) { directions[count++] = {d[0], d[1], d[2]}; };
    for (const auto& d : axes)
        append(d);
    if (K == 14 || K == 26)
        for (const auto& d : cube)
            append(d);
    if (K == 18 || K == 26)
        for (const auto& d : edge)
            append(d);
    return directions;
}

} // namespace phantom::fdh
