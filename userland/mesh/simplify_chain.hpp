// SPDX-License-Identifier: GPL-2.0-or-later
// A mesh at falling detail, for tips that are too fast for its triangles.
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "fdh/tree.hpp"
#include "mesh/mesh.hpp"

namespace phantom::mesh {

/// A simplification of a mesh: a prepared mesh of its own, in the same frame.
struct ChainLevel {
    Mesh mesh;
    fdh::TriangleTree<14> tree; ///< of the mesh
    /// No sample of the level is farther from the first mesh, and none of that farther from the level: the
    /// Hausdorff distance, mm, as hausdorff.hpp measures it with eight samples for each face of the mesh,
    /// 400,000 at most, a side.
    double error_mm = 0;
};

struct ChainOptions {
    double crease_deg = 20; ///< where the normals of an edge's two faces differ more, the edge is a crease
    double edge_max_mm = std::numeric_limits<double>::infinity(); ///< the chain ends before a longer edge
    unsigned levels_max = 16;
    unsigned threads = 0; ///< 0: all cores; the levels are the same for any number
    /// The chain ends with the first level for which this holds. Must not be empty.
    std::function<bool(const ChainLevel&)> enough;
    std::function<bool()> cancelled{}; ///< asked now and then; the chain then ends where it is
};

/// Levels from fine to coarse, by edge_collapse.hpp: the first with half of the triangles, or a quarter where
/// that costs no more error, every next one with twice the error of the one before, at least a quarter fewer
/// triangles and at most four times fewer. Vertices are vertices of the mesh, bit for bit; borders and
/// creases are kept within the error, a crease being where the mesh's normals say so. Normals are made anew.
/// A watertight mesh has watertight levels, and one with backs (two_sided.hpp) levels with backs. Empty where
/// nothing can be left out.
std::vector<ChainLevel> simplify_chain(const Mesh& mesh, const fdh::TriangleTree<14>& tree,
                                       const ChainOptions& options);

} // namespace phantom::mesh
