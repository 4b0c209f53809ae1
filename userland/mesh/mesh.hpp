// SPDX-License-Identifier: GPL-2.0-or-later
// Triangle meshes as the rest of the user side sees them: plain arrays, doubles, millimetres.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/shared_array.hpp"

namespace phantom::mesh {

using Vec3 = std::array<double, 3>;
using Triple = std::array<std::uint32_t, 3>;

inline constexpr std::uint32_t no_neighbour = 0xffffffffU;

/// What a file gave, before anything was done to it: triangles in file order (polygons cut).
struct Soup {
    std::vector<Vec3> vertices;       ///< file units
    std::vector<Triple> faces;        ///< counter-clockwise, indices into vertices
    std::vector<Vec3> normals;        ///< unit normals the file gave; zero where they had no direction;
                                      ///< empty when it gave none
    std::vector<Triple> face_normals; ///< per face corner, indices into normals; empty with normals
    /// Per face: its smoothing group, 0 for none; empty when the file has none. Faces of one group meet
    /// smoothly however sharp their edge is, faces of two groups do not.
    std::vector<std::uint32_t> smoothing{};
    /// Per face: the group that the file put it into, an index into group_names (face_groups.hpp); both empty
    /// when it has none.
    std::vector<std::uint8_t> face_groups{};
    std::vector<std::string> group_names{}; ///< "" for faces without
    bool too_many_groups = false;           ///< the file has more than a mesh can: both are empty
    std::uint64_t polygons_crossed = 0;     ///< polygons that cross themselves: their triangles overlap
};

/// A mesh ready to be touched. Unit normals per corner, so that a crease can keep two. A copy shares its
/// arrays.
struct Mesh {
    SharedArray<Vec3> vertices;              ///< mm
    SharedArray<Triple> faces;               ///< counter-clockwise seen from outside
    SharedArray<Vec3> normals;               ///< unit; with `--prepare none` zero where there is no direction
    SharedArray<Triple> face_normals;        ///< per face corner, indices into normals
    SharedArray<Triple> neighbours;          ///< face over edge i (corner i to i+1), or no_neighbour
    SharedArray<std::uint8_t> face_groups{}; ///< per face, an index into group_names; empty without
    std::vector<std::string> group_names{};
};

struct Bounds {
    Vec3 low{}, high{};
    /// Length of the longest side.
    [[nodiscard]] double extent() const;
    [[nodiscard]] double diagonal() const;
};
Bounds bounds_of(std::span<const Vec3> vertices);

} // namespace phantom::mesh
