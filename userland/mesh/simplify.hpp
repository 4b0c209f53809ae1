// SPDX-License-Identifier: GPL-2.0-or-later
// Fewer triangles, on request, within bounds that are named. (Levels of detail, simplify_chain.hpp, are made
// by themselves and beside the mesh; this is for a mesh that shall be simpler for good.)
#pragma once

#include <cstddef>

#include "mesh/mesh.hpp"

namespace phantom::mesh {

struct SimplifyOptions {
    std::size_t faces = 0;  ///< stop at so many; 0: as far as the bounds allow
    double error_mm = 0;    ///< no point of either surface is farther from the other, by samples; 0: no bound
    double normal_deg = 60; ///< no face turns by more, and none over
    double aspect = 20;     ///< no face becomes longer than so many of its heights, unless it was
    double crease_deg = 60; ///< edges sharper than this are features
};

struct SimplifyResult {
    std::size_t faces_removed = 0;
    std::size_t faces_aside = 0; ///< that a half-edge mesh cannot hold: left as they are, with their vertices
    double error_mm = 0;         ///< measured: the larger of both one-sided Hausdorff distances
};

/// Collapses edges of a soup with normals at all corners, least quadric error first (OpenMesh's decimater,
/// with its bounds on the distance of what was there, on the turning of faces and on their shape). Features
/// are kept within error_mm (without it, within a twentieth of an edge): borders, edges sharper than
/// crease_deg, edges between two groups of faces, and edges at whose ends the normals of the two faces
/// differ. Vertices of the result are vertices of the soup, with their normals there; they come in the same
/// order, and so do faces. Smoothing groups are dropped: normals say more.
SimplifyResult simplify(Soup& soup, const SimplifyOptions& options);

} // namespace phantom::mesh
