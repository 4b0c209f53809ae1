// SPDX-License-Identifier: GPL-2.0-or-later
// One reader per file format; read() chooses. Each but the last checks what CGAL would trust, lets CGAL read,
// and finds the place when CGAL fails.
#pragma once

#include <string>

#include "base/result.hpp"
#include "mesh/soup.hpp"

namespace phantom::mesh {

/// `bytes` is the whole file and may be changed; `name` stands in errors.
Result<PolygonSoup> read_ply(std::string& bytes, const std::string& name);
Result<PolygonSoup> read_obj(std::string& bytes, const std::string& name);
Result<PolygonSoup> read_stl(std::string& bytes, const std::string& name);
Result<PolygonSoup> read_off(std::string& bytes, const std::string& name);

/// VTP, legacy VTK, 3DS, glTF: by the program fdhread, in a process of its own. `name` is the file.
Result<PolygonSoup> read_vtk(const std::string& name);

} // namespace phantom::mesh
