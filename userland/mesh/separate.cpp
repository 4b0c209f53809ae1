// SPDX-License-Identifier: GPL-2.0-or-later
// Vertices where several fans of faces meet (two cones tip to tip, the ends of an edge of more than two
// faces): every fan gets one of its own, at the same place. After that the surface is a manifold.
#include <algorithm>
#include <utility>

#include "mesh/steps.hpp"

namespace phantom::mesh {

namespace {

std::uint32_t corner_of(const Triple& face, std::uint32_t vertex)
{
    return face[0] == vertex ? 0 : face[1] == vertex ? 1 : 2;
}

/// Calls visit(face) for the fan round the vertex that the face belongs to, the face itself included.
template <typename Visit>
void walk_fan(const Soup& soup, const std::vector<Triple>& neighbours, std::uint32_t face,
              std::uint32_t vertex, Visit&& visit)
{
    std::uint32_t at = face;
    do {
        visit(at);
        at = neighbours[at][(corner_of(soup.faces[at], vertex) + 2) % 3];
    } while (at != face && at != no_neighbour);
    if (at == face)
        return;
    // came to an end: the other way round
    for (at = neighbours[face][corner_of(soup.faces[face], vertex)]; at != no_neighbour;
         at = neighbours[at][corner_of(soup.faces[at], vertex)])
        visit(at);
}

/// Vertices with faces beyond the fan of their first one, ascending.
std::vector<std::uint32_t> crowded_vertices(const Soup& soup, const std::vector<Triple>& neighbours)
{
    std::vector<std::uint32_t> first(soup.vertices.size(), no_neighbour), left(soup.vertices.size(), 0);
    for (std::uint32_t f = 0; f < soup.faces.size(); ++f) {
        for (const std::uint32_t v : soup.faces[f]) {
            first[v] = std::min(first[v], f);
            ++left[v];
        }
    }
    std::vector<std::uint32_t> crowded;
    for (std::uint32_t v = 0; v < first.size(); ++v) {
        if (first[v] == no_neighbour)
            continue;
        walk_fan(soup, neighbours, first[v], v, [&](std::uint32_t) { --left[v]; });
        if (left[v] > 0)
            crowded.push_back(v);
    }
    return crowded;
}

} // namespace

void separate_fans(Soup& soup, const std::vector<Triple>& neighbours, Report& report)
{
    const std::vector<std::uint32_t> crowded = crowded_vertices(soup, neighbours);
    report.nonmanifold_vertices += crowded.size();
    if (crowded.empty())
        return;
    std::vector<bool> is_crowded(soup.vertices.size(), false);
    for (const std::uint32_t v : crowded)
        is_crowded[v] = true;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> uses; // vertex, face
    for (std::uint32_t f = 0; f < soup.faces.size(); ++f) {
        for (const std::uint32_t v : soup.faces[f]) {
            if (is_crowded[v])
                uses.emplace_back(v, f);
        }
    }
    std::sort(uses.begin(), uses.end());
    // Fans by vertex and by their lowest face, the first of a vertex keeps it: a second run does the same.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> moves; // face, corner; of one fan
    std::vector<std::uint32_t> seen;                            // faces round the vertex in hand
    for (std::size_t i = 0; i < uses.size(); ++i) {
        const auto [vertex, face] = uses[i];
        const bool first = i == 0 || uses[i - 1].first != vertex;
        if (first)
            seen.clear();
        if (std::find(seen.begin(), seen.end(), face) != seen.end())
            continue;
        moves.clear();
        walk_fan(soup, neighbours, face, vertex, [&, v = vertex](std::uint32_t at) {
            seen.push_back(at);
            moves.emplace_back(at, corner_of(soup.faces[at], v));
        });
        if (first)
            continue;
        const auto fresh = static_cast<std::uint32_t>(soup.vertices.size());
        soup.vertices.push_back(Vec3(soup.vertices[vertex]));
        ++report.vertices_separated;
        for (const auto& [at, corner] : moves)
            soup.faces[at][corner] = fresh;
    }
}

} // namespace phantom::mesh
