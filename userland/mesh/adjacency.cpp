// SPDX-License-Identifier: GPL-2.0-or-later
#include <optional>
#include <utility>

#include "mesh/edge_index.hpp"
#include "mesh/edge_pairs.hpp"
#include "mesh/groups.hpp"
#include "mesh/steps.hpp"

namespace phantom::mesh {

std::vector<Triple> neighbours_of(const Soup& soup, const EdgeIndex& edges, Report& report, bool pair_more)
{
    std::vector<Triple> neighbours(soup.faces.size(), Triple{no_neighbour, no_neighbour, no_neighbour});
    const auto join = [&neighbours](HalfEdge a, HalfEdge b) {
        neighbours[a / 3][a % 3] = b / 3;
        neighbours[b / 3][b % 3] = a / 3;
    };
    std::optional<EdgePairs> more; // made where the first edge needs it
    std::vector<std::pair<HalfEdge, HalfEdge>> pairs;
    std::uint64_t left_over = 0; // faces without a neighbour at edges of more than two
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
            pairs.clear();
            if (pair_more) {
                if (!more)
                    more.emplace(soup.vertices, soup.faces, edges);
                more->pair(halves, pairs);
            }
            for (const auto& [a, b] : pairs)
                join(a, b);
            left_over += halves.size() - 2 * pairs.size();
            return;
        }
        const HalfEdge a = halves[0], b = halves[1];
        if (from_vertex(soup.faces, a) == from_vertex(soup.faces, b) || a / 3 == b / 3) {
            ++report.unorientable_edges;
            return;
        }
        join(a, b);
    });
    report.boundary_edges += left_over;
    report.watertight = !soup.faces.empty() && report.boundary_edges == 0 && report.unorientable_edges == 0;
    return neighbours;
}

std::uint64_t count_components(const std::vector<Triple>& neighbours)
{
    Groups groups(neighbours.size());
    std::uint64_t count = neighbours.size();
    for (std::uint32_t f = 0; f < neighbours.size(); ++f) {
        for (const std::uint32_t other : neighbours[f]) {
            if (other == no_neighbour || other < f || groups.first(f) == groups.first(other))
                continue;
            groups.join(f, other);
            --count;
        }
    }
    return count;
}

} // namespace phantom::mesh
