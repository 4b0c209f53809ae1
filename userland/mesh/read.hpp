// SPDX-License-Identifier: GPL-2.0-or-later
// Reading mesh files: PLY (ASCII, both endians), OBJ, STL (ASCII, binary), OFF. Coordinates stay doubles.
#pragma once

#include <filesystem>

#include "base/result.hpp"
#include "mesh/mesh.hpp"

namespace phantom::mesh {

/// True for an extension (any case) that read() knows.
bool is_mesh_file(const std::filesystem::path& file);

/// Reads a whole file or nothing; memory is bounded by the file's size, whatever its header says. Polygons
/// are fanned round their first corner; vertices and faces in errors count from 0, lines from 1. Errors name
/// the file, the place (line, byte, vertex or face) and what was expected: missing file, directory, empty
/// file, unknown extension, truncated, not a number, beyond 1e9 file units, index out of range, no faces.
Result<Soup> read(const std::filesystem::path& file);

} // namespace phantom::mesh
