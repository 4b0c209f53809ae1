// SPDX-License-Identifier: GPL-2.0-or-later
// Shapes that a scene file may name instead of a mesh: triangulated at load.
#pragma once

#include "mesh/mesh.hpp"

namespace phantom::scene {

/// A sphere round the origin: a refined icosahedron of 5,120 triangles whatever the radius, its faces at most
/// 0.12% of the radius below the sphere. Radial normals.
mesh::Soup sphere_soup(double radius_mm);

/// A box round the origin, 12 triangles, no normals: the crease angle makes its edges sharp.
mesh::Soup box_soup(const mesh::Vec3& size_mm);

} // namespace phantom::scene
