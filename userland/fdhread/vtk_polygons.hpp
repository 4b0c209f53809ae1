// SPDX-License-Identifier: GPL-2.0-or-later
// Files through VTK's readers: polygons with doubles where the file has them, and its point normals.
#pragma once

#include <string>

#include "base/result.hpp"
#include "mesh/soup.hpp"

namespace phantom::fdhread {

/// By the extension: .vtp, .vtk (polygons, or the outer surface of an unstructured grid), .3ds, .gltf, .glb
/// (all meshes of the scene, its transforms applied). Errors have no place: the caller knows the file.
Result<mesh::PolygonSoup> read_polygons(const std::string& file);

} // namespace phantom::fdhread
