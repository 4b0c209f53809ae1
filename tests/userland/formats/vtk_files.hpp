// SPDX-License-Identifier: GPL-2.0-or-later
// Small files of every format, written byte by byte: a tetrahedron with its corner at the origin.
#pragma once

#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace phantom::mesh::test {

/// Not a float: a reader that goes through float changes its bits.
inline constexpr double third = 1.0 / 3.0;

inline const std::vector<Vec3> tetrahedron_points{{0, 0, 0}, {third, 0, 0}, {0, third, 0}, {0, 0, third}};
inline const std::vector<Triple> tetrahedron_faces{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
/// A normal for every point.
inline const std::vector<Vec3> tetrahedron_normals{{-0.6, -0.8, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

std::string vtp_text(bool with_normals);
std::string vtk_text(bool with_normals);
/// Big-endian doubles, as the format wants.
std::string vtk_binary();
/// The four faces as one strip: corners 1 0 2 3 1 0.
std::string vtk_strip();
/// A cube of five tetrahedra: twelve triangles outside, four faces inside.
std::string vtk_grid();

/// A node at (10, 0, 0) of scale 2; in it one at (0, 1, 0), turned by 90 degrees about z, with the
/// tetrahedron (in float) and its normals. The bytes beside it: the file `bin` that it names.
std::string gltf_text(const std::string& bin);
std::string gltf_bytes();
std::string glb();
/// Where a point of the tetrahedron is then.
Vec3 in_gltf_scene(const Vec3& point);
Vec3 direction_in_gltf_scene(const Vec3& normal);

std::string max_3ds();

} // namespace phantom::mesh::test
