// SPDX-License-Identifier: GPL-2.0-or-later
// Reading mesh files: PLY (ASCII, both endians), OBJ, STL (ASCII, binary), OFF; and through the program
// fdhread VTP, legacy VTK, 3DS and glTF. Coordinates stay doubles where the format has them.
#pragma once

#include <filesystem>

#include "base/result.hpp"
#include "mesh/mesh.hpp"

namespace phantom::mesh {

/// For messages, after "expected".
inline constexpr const char* mesh_extensions = ".ply, .obj, .stl, .off, .vtp, .vtk, .3ds, .gltf or .glb";

/// True for an extension (any case) that read() knows.
bool is_mesh_file(const std::filesystem::path& file);

/// True for glTF, whose coordinates are in metres (and whose y axis points up) by its specification.
bool is_in_metres(const std::filesystem::path& file);

/// Reads a whole file or nothing; memory is bounded by the file's size, whatever its header says. Polygons
/// are cut into triangles (polygon.hpp); vertices and faces in errors count from 0, lines from 1. Errors name
/// the file, the place (line, byte, vertex or face) and what was expected: missing file, directory, empty
/// file, unknown extension, truncated, not a number, beyond 1e9 file units, index out of range, no faces.
Result<Soup> read(const std::filesystem::path& file);

} // namespace phantom::mesh
