// SPDX-License-Identifier: GPL-2.0-or-later
// Meshes to search: generated, or read from an OBJ file that may not be there.
#pragma once

#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "fdh/hull.hpp"

namespace phantom::fdh::test {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

struct Mesh {
    std::vector<Point> vertices;
    std::vector<Triangle> triangles;

    [[nodiscard]] MeshView view() const { return {vertices, triangles}; }
    void add(const Point& a, const Point& b, const Point& c);
};

/// Subdivided octahedron: 8 * 4^levels triangles.
Mesh sphere(int levels, double radius, const Point& centre = {0, 0, 0});
/// Two triangles to each square of a flat unit grid: whole-number coordinates, ties everywhere.
Mesh flat_grid(int side);
/// Triangles of random place, size (over four decades) and shape in a cube of the given half side.
Mesh soup(std::size_t count, double half_side, std::mt19937_64& random);
/// Needles, caps, segments, points, duplicates and a few proper triangles.
Mesh degenerate_faces(std::mt19937_64& random);
/// v and f lines only; polygons become fans. nullopt if it cannot be read.
std::optional<Mesh> read_obj(const std::string& path);
/// The Stanford bunny of the package glmark2-data.
std::optional<Mesh> bunny();

Mesh scaled(Mesh mesh, double factor, const Point& shift);

} // namespace phantom::fdh::test
