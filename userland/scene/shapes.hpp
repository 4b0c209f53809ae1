// SPDX-License-Identifier: GPL-2.0-or-later
// Shapes that a scene file may name instead of a mesh: triangulated at load.
#pragma once

#include "mesh/mesh.hpp"

namespace phantom::scene {

/// A sphere round the origin: an icosahedron refined until no point of a face is farther than
/// 0.1% of the radius below the sphere; 5,120 triangles whatever the radius. Radial normals.
mesh::Soup sphere_soup(double radius_mm);

/// A box round the origin, 12 triangles, no normals: the crease angle makes its edges sharp.
mesh::Soup box_soup(const mesh::Vec3& size_mm);

} // namespace phantom::scene
