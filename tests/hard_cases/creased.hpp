// SPDX-License-Identifier: GPL-2.0-or-later
// Meshes whose sharp edges keep the normals of their faces, with the fans that fill the gaps between them.
#pragma once

#include "mesh/mesh.hpp"
#include "meshes.hpp"

namespace phantom::hard {

/// Faces, then the fans of their creases, then the rims where the mesh is open: what the user side's
/// preparation makes of the shape.
std::vector<reference::Triangle> creased(const Shape& shape, double crease_deg, double stiffness,
                                         double radius, bool two_sided = false);

/// The same of vertices and faces as a file gives them, scaled to `fit_mm` along the longest side (0: as it
/// is). Throws std::invalid_argument where nothing is left of it.
std::vector<reference::Triangle> prepared(mesh::Soup soup, double fit_mm, double crease_deg, double stiffness,
                                          double radius, bool two_sided = false);

/// The rims where the triangles leave off, by their points: faces before R of one know their surface, and the
/// rims come last. All of one R.
std::vector<reference::Triangle> with_rims(std::vector<reference::Triangle> triangles);

} // namespace phantom::hard
