// SPDX-License-Identifier: GPL-2.0-or-later
// Edges of more than two faces: which of them go on in which.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "mesh/edge_index.hpp"
#include "mesh/mesh.hpp"

namespace phantom::mesh {

/// Pairs the faces round edges of more than two. Half-edges of a pair run opposite ways; those left over have
/// no neighbour there.
///
/// Where faces take turns with the inside and the outside round the edge, those are a pair that have the
/// inside between them: solids that share an edge or a side stay closed each for itself. Where they do not,
/// that holds within every closed part (one that runs as often one way as the other over every edge); of what
/// is left those are a pair that are nearest to flat: a wall inside a solid, or a fin on it, does not part
/// the surface that it stands on.
class EdgePairs {
  public:
    /// Finds the parts that are closed: one walk over the mesh.
    EdgePairs(const std::vector<Vec3>& vertices, const std::vector<Triple>& faces, const EdgeIndex& edges);

    /// Appends the pairs of one edge. Deterministic, whatever the order of the faces, but for faces back to
    /// back.
    void pair(std::span<const HalfEdge> halves, std::vector<std::pair<HalfEdge, HalfEdge>>& out) const;

  private:
    /// A face as seen along the edge.
    struct Leaf {
        double angle; ///< about the edge from its lower to its higher vertex, by the right hand
        bool up;      ///< its half-edge runs from the lower vertex to the higher
        HalfEdge half;
        std::uint32_t component;
    };
    using Pairs = std::vector<std::pair<HalfEdge, HalfEdge>>;

    [[nodiscard]] std::vector<Leaf> leaves_round(std::span<const HalfEdge> halves) const;
    static bool take_turns(std::vector<Leaf>& leaves);
    static void pair_inside(const std::vector<Leaf>& leaves, Pairs& out);
    static void pair_flattest(const std::vector<Leaf>& leaves, Pairs& out);

    const std::vector<Vec3>& vertices_;
    const std::vector<Triple>& faces_;
    std::vector<std::uint32_t> component_; ///< of faces
    std::vector<bool> closed_;             ///< by component
};

} // namespace phantom::mesh
