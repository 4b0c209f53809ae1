// SPDX-License-Identifier: GPL-2.0-or-later
// What the readers of the four formats share: polygons as a file gives them, and the last checks.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "mesh/face_groups.hpp"
#include "mesh/mesh.hpp"

namespace phantom::mesh {

/// Coordinates beyond this many file units are taken for damage: the kernel border is nanometres
/// in 64 bits, and a double keeps a tenth of a micrometre at this size in mm.
inline constexpr double coordinate_max = 1e9;

/// Polygons in file order: polygon p has the corners corners[first[p]] ... corners[first[p + 1] - 1].
struct PolygonSoup {
    std::vector<Vec3> vertices;
    std::vector<std::uint32_t> corners;
    std::vector<std::size_t> first{0};
    std::vector<Vec3> normals;                 ///< as in the file, any length; empty when it gives none
    std::vector<std::uint32_t> corner_normals; ///< per corner; empty: the corner's vertex number

    std::vector<std::uint32_t> smoothing; ///< per polygon, see Soup; empty when the file has no groups
    FaceGroups groups;                    ///< of every polygon, or of none

    [[nodiscard]] std::size_t polygons() const { return first.size() - 1; }
};

/// Checks every value and index, cuts polygons into triangles (polygon.hpp), normalizes normals.
/// `name` is the file. Errors name the vertex or face, counted from 0 as the file's own indices are.
Result<Soup> triangles_of(PolygonSoup&& polygons, const std::string& name);

} // namespace phantom::mesh
