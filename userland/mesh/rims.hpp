// SPDX-License-Identifier: GPL-2.0-or-later
// Rims: the edges at which an open surface ends. The force of a contact fades over the last contact radius
// before the nearest rim of its own surface, so that a tip that slides off feels no step.
//
// An edge of a face is a rim when no other face goes on from there with the same outside: none runs along it
// the other way round. Edges are the same when their ends are the same points, whatever their numbers: a mesh
// that was not welded is as closed as its points are.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/mesh.hpp"

namespace phantom::mesh {

struct Rim {
    std::uint32_t from, to; ///< vertices, as the face runs
    std::uint32_t face;     ///< which ends there
    std::uint32_t surface;  ///< of that face; > 0
    bool operator==(const Rim&) const = default;
};

/// A box round some of the rims. In preorder: what follows a node up to `skip` lies in it.
struct RimNode {
    Vec3 low, high;
    std::uint32_t skip;         ///< the next node that does not lie in this one
    std::uint32_t first, count; ///< rims of a leaf; count 0 elsewhere
    bool operator==(const RimNode&) const = default;
};

struct Rims {
    SharedArray<Rim> edges;
    std::uint64_t loops = 0; ///< rims that hang together count as one
    /// Per face: the number of its surface, from 1 on, when a rim of it may come within the reach that they
    /// were made for; else 0. Empty when there is no rim.
    SharedArray<std::uint32_t> surface;
    SharedArray<RimNode> nodes; ///< over `edges`

    [[nodiscard]] std::uint32_t surface_of(std::uint32_t face) const
    {
        return surface.empty() ? 0 : surface[face];
    }
    struct Near {
        std::uint32_t rim; ///< index into edges
        double distance;
    };
    /// Appends the rims no farther than that from a point, ascending by index.
    void within(const Mesh& mesh, const Vec3& point, double distance, std::vector<Near>& out) const;
};

/// A surface is what hangs together over edges, by their points. reach: how far before a rim the force fades,
/// the contact radius in mm.
Rims make_rims(const Mesh& mesh, double reach_mm);

} // namespace phantom::mesh
