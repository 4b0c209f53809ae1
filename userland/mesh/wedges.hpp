// SPDX-License-Identifier: GPL-2.0-or-later
// A mesh whose creases are in its topology: a wedge is a vertex as the faces on one side of the creases
// through it see it. Faces on two sides of a crease have the edge's vertices in common, but not both wedges.
#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace phantom::mesh {

struct Wedges {
    std::vector<Vec3> vertices;
    std::vector<Triple> faces;               ///< indices into vertices
    std::vector<Triple> corners;             ///< of the same faces, indices into vertex_of
    std::vector<std::uint32_t> vertex_of;    ///< per wedge
    std::vector<std::uint8_t> face_groups{}; ///< as a mesh has them
    std::vector<std::string> group_names{};
};

/// Of the first `faces` faces of a mesh. An edge is a crease where the normals that its two faces have at an
/// end of it differ by more than crease_deg, and where there is no neighbour.
Wedges wedges_of(const Mesh& mesh, std::size_t faces, double crease_deg);

/// Angle-weighted normals, one per wedge (but where it does not fit a face), and neighbours.
Mesh mesh_of(const Wedges& wedges);

} // namespace phantom::mesh
