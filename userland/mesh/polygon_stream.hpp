// SPDX-License-Identifier: GPL-2.0-or-later
// Polygons on their way from fdhread, the program that reads what VTK reads, to whoever started it.
//
// A program of its own, because VTK's hundred shared libraries would make every start of fdhctl slower, and
// because its readers trust their files: a damaged one may end or hang the process that reads it.
//
// Native byte order; both ends are of the same build. "PHSOUP1\n", then the counts of vertices, normals,
// corners and polygons in 64 bits each, then the vertices and the normals (three doubles each), the corners
// (32 bits) and the ends of the polygons (64 bits, counted in corners). Or "PHERROR\n" and one line.
#pragma once

#include <cstdio>
#include <string>

#include "base/result.hpp"
#include "mesh/soup.hpp"

namespace phantom::mesh {

/// False when it cannot be written.
bool send_polygons(const PolygonSoup& polygons, std::FILE* to);
bool send_error(const std::string& what, std::FILE* to);

/// All that was sent. Errors: the sender's own, without a place; nothing, too little or too much sent.
Result<PolygonSoup> received_polygons(const std::string& bytes);

} // namespace phantom::mesh
