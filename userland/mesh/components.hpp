// SPDX-License-Identifier: GPL-2.0-or-later
// The parts of a soup that hang together over edges of exactly two faces.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/edge_index.hpp"
#include "mesh/mesh.hpp"

namespace phantom::mesh {

struct Components {
    std::vector<std::uint32_t> of_face;
    std::vector<std::uint64_t> size,
        turned;             ///< faces; of them those to turn so that all agree with the first
    std::vector<bool> turn; ///< per face: against the first face of its component

    [[nodiscard]] std::size_t count() const { return size.size(); }
};

/// Numbered in the order of their first faces.
Components components_of(const std::vector<Triple>& faces, const EdgeIndex& edges);

/// Per component: its boundary vanishes, on every edge its faces run as often one way as the other. That
/// holds for each of two cubes that share an edge, where no face has a unique neighbour.
std::vector<bool> closed_components(const std::vector<Triple>& faces, const EdgeIndex& edges,
                                    const Components& components);

/// Per component: lies inside an odd number of the other closed ones, so it bounds a cavity of a solid and
/// not a solid. A component that cuts another one is not inside it. O(n log n) as long as few lie in many.
std::vector<bool> cavities_of(const Soup& soup, const Components& components,
                              const std::vector<bool>& closed);

} // namespace phantom::mesh
