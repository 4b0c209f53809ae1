// SPDX-License-Identifier: GPL-2.0-or-later
// Groups of faces of a PLY file, which the library that reads its faces passes over.
#pragma once

#include <string>

#include "mesh/face_groups.hpp"
#include "mesh/ply_layout.hpp"

namespace phantom::mesh {

/// Of the property material_index (or material_indices), a whole number: its digits. Else of red, green and
/// blue, uchar: "#rrggbb". A file without these is not walked over. The body has passed check_ply_body().
FaceGroups ply_face_groups(const PlyLayout& layout, const std::string& bytes);

} // namespace phantom::mesh
