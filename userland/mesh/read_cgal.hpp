// SPDX-License-Identifier: GPL-2.0-or-later
// The four formats through CGAL::IO, behind a header without CGAL: only read_cgal.cpp pays for it.
//
// CGAL is chosen because coordinates stay doubles (OpenMesh passes each through float) and because a
// soup keeps every face (OpenMesh drops those that would be non-manifold). It says only "failed", trusts
// counts in headers and does not check indices: the readers of each format check before and after.
#pragma once

#include <istream>

#include "mesh/soup.hpp"

namespace phantom::mesh {

/// Each returns false when CGAL could not read on; the stream buffer then stands where it stopped. Silent on
/// stderr. May throw std::bad_alloc, std::length_error and CGAL's failures (std::logic_error).
bool cgal_read_ply(std::istream& stream, bool with_normals, PolygonSoup& out);
bool cgal_read_obj(std::istream& stream, PolygonSoup& out);
bool cgal_read_stl(std::istream& stream, PolygonSoup& out);
bool cgal_read_off(std::istream& stream, PolygonSoup& out);

} // namespace phantom::mesh
