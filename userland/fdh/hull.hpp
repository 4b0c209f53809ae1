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

/// Triangles that somebody else owns; must outlive every tree built on it only while building.
struct MeshView {
    std::span<const Point> vertices; ///< any unit; finite
    std::span<const Triangle> triangles;
};

} // namespace phantom::fdh
