// SPDX-License-Identifier: GPL-2.0-or-later
// Fans: what closes the gap between faces that disagree about the normals of a shared edge or vertex.
//
// Between a face and its offset along the vertex normals lies a shell (the contact model `projected`). Where
// two faces keep normals of their own at an edge, their shells part there; two triangles a, a, b and a, b, b
// with the normals of either side fill the gap (Kabelac 2001, fig. 1). Where three and more such
// edges meet in a vertex v, triangles v, v, v fanned over the vertex's normals fill the hole that is left.
// With them the shells of a closed mesh are closed, on convex and on concave edges alike: a shell that has
// folded over counts negative, and takes away what two faces' shells have too much.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "mesh/mesh.hpp"

namespace phantom::mesh {

/// A triangle without area. Counter-clockwise seen from outside, as a face's shell would be.
struct Fan {
    Triple corners;              ///< vertices; over an edge two of them are equal, over a vertex all three
    std::array<Vec3, 3> normals; ///< unit, per corner
    [[nodiscard]] bool over_vertex() const { return corners[0] == corners[1] && corners[1] == corners[2]; }
    bool operator==(const Fan&) const = default;
};

/// The fans of a mesh, each kept with one of the faces that it lies between: whoever is within some distance
/// of the fan is within that distance of its face.
struct Fans {
    SharedArray<Fan> fans; ///< by face
    /// Of face f: fans first[f] ... first[f + 1] - 1; empty when there is none.
    SharedArray<std::uint32_t> first;

    [[nodiscard]] std::span<const Fan> of(std::uint32_t face) const
    {
        if (first.empty())
            return {};
        return {fans.data() + first[face], first[face + 1] - first[face]};
    }
};

/// Between neighbours only: a boundary, and an edge of three and more faces, keep their gaps. Normals more
/// than 100 degrees apart get others between them, so that no fan is too wide to have a shell.
Fans make_fans(const Mesh& mesh);

} // namespace phantom::mesh
