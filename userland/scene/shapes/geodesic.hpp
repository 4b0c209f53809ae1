// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/mesh.hpp"

namespace phantom::scene {

/// Unit vectors and faces of an icosahedron whose faces are cut into frequency^2 each and projected onto the
/// unit sphere (a geodesic polyhedron of class I): 20 frequency^2 faces. No normals. With an even frequency
/// there are vertices on the x, y and z axes.
mesh::Soup geodesic_sphere(std::uint32_t frequency);

/// The largest distance of its faces from the sphere.
double geodesic_error(std::uint32_t frequency);

} // namespace phantom::scene
