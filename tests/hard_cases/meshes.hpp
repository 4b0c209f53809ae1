// SPDX-License-Identifier: GPL-2.0-or-later
// Meshes for the hard cases. Every coordinate is a whole number of nm, so that the reference (mm,
// double) and the float sections (nm, integer) see the same mesh.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "reference.hpp"

namespace phantom::hard {

using reference::Vec3;

struct Shape {
    std::vector<Vec3> vertices; ///< mm, whole nm
    std::vector<Vec3> normals;  ///< unit, one per vertex
    std::vector<std::array<std::uint32_t, 3>> faces;

    /// The faces with that material.
    [[nodiscard]] std::vector<reference::Triangle> triangles(double stiffness, double radius) const;
};

Vec3 add(const Vec3& a, const Vec3& b);
Vec3 subtract(const Vec3& a, const Vec3& b);
Vec3 scale(double s, const Vec3& a);
double dot(const Vec3& a, const Vec3& b);
Vec3 cross(const Vec3& a, const Vec3& b);
double length(const Vec3& a);
Vec3 unit(const Vec3& a);
/// To whole nm.
Vec3 on_grid(const Vec3& mm);
/// To whole Q1.30, as the border carries unit vectors.
Vec3 on_unit_grid(const Vec3& n);

/// Angle-weighted vertex normals.
void smooth_normals(Shape& shape);

/// Octahedron, subdivided, then moved to radius(direction) along the direction; smooth normals.
Shape star(unsigned subdivisions, const std::function<double(const Vec3&)>& radius);
/// With exactly radial normals.
Shape sphere(unsigned subdivisions, double radius);
/// A height field z(x, y) over [-half, half]^2 with `cells`^2 cells; smooth normals.
Shape field(unsigned cells, double half, const std::function<double(double, double)>& z);
/// A closed box with eight vertices and smooth normals; a thin one is a plate.
Shape box(const Vec3& half);
/// A fan of `valence` triangles round the origin, its vertex `height` over the rim.
Shape fan(unsigned valence, double radius, double height);
/// The bunny of Debian's glmark2-data, fitted to `size` mm; empty if it is not installed.
Shape bunny(double size);

} // namespace phantom::hard
