// SPDX-License-Identifier: GPL-2.0-or-later
// The meshes that contenders are compared on.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"
#include "fdh/hull.hpp"

namespace phantom::peers {

/// Triangles that every contender gets. Coordinates [mm] are float32 values, so that a contender that
/// computes in float has the same mesh as one that computes in double.
struct Mesh {
    std::string name;
    std::vector<fdh::Point> vertices;
    std::vector<fdh::Triangle> triangles;
    std::vector<std::array<float, 4>> points; ///< the vertices as float, padded with 0
    double diagonal = 0;                      ///< of the box round all vertices

    [[nodiscard]] fdh::MeshView view() const { return {vertices, triangles}; }
    [[nodiscard]] std::array<fdh::Point, 3> corners(std::size_t triangle) const
    {
        const fdh::Triangle& t = triangles[triangle];
        return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
    }
};

/// A generated mesh or a file:
///   sphere-20k, sphere-200k, sphere-2M, sphere-20M   20 f^2 triangles on a sphere of radius 50 mm with bumps
///                                                    of several sizes, f = 32, 100, 316, 1000
///   sphere-F                                         the same for a number f from 1 to 2000
///   spot-200k, spot-F                                as many triangles; two fifths of them are a hundred
///   times
///                                                    smaller than the others and lie in one spot
///   bunny                                            the Stanford bunny of Debian's glmark2-data
///   FILE                                             anything mesh::read() reads, as it is
/// The error names what was asked for and what is there.
Result<Mesh> make_mesh(const std::string& name);

/// Every vertex moved by a smooth wave, by up to `amplitude` [mm]; for refits.
Mesh waved(const Mesh& mesh, double amplitude);

} // namespace phantom::peers
