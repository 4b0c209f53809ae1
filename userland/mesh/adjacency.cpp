// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/edge_index.hpp"
#include "mesh/steps.hpp"

namespace phantom::mesh {

std::vector<Triple> neighbours_of(const Soup& soup, const EdgeIndex& edges, Report& report)
{
    std::vector<Triple> neighbours(soup.faces.size(), Triple{no_neighbour, no_neighbour, no_neighbour});
    report.boundary_edges = report.nonmanifold_edges = report.unorientable_edges = 0;
    edges.for_each([&](std::uint32_t low, std::uint32_t high, std::span<const HalfEdge> halves) {
        if (low == high)
            return; // a degenerate face that `--prepare none` keeps
        if (halves.size() == 1) {
            ++report.boundary_edges;
            return;
        }
        if (halves.size() > 2) {
            ++report.nonmanifold_edges;
            return;
        }
        const HalfEdge a = halves[0], b = halves[1];
        if (from_vertex(soup.faces, a) == from_vertex(soup.faces, b) || a / 3 == b / 3) {
            ++report.unorientable_edges;
            return;
        }
        neighbours[a / 3][a % 3] = b / 3;
        neighbours[b / 3][b % 3] = a / 3;
    });
    report.watertight = !soup.faces.empty() && report.boundary_edges == 0 && report.nonmanifold_edges == 0 &&
                        report.unorientable_edges == 0;
    return neighbours;
}

} // namespace phantom::mesh
