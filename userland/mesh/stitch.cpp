// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/stitch.hpp"

#include <algorithm>

#include "mesh/box_tree.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

/// Of the mesh's diagonal.
constexpr double relative_tolerance = 1e-6;

/// A vertex moves at most this part of the shortest edge at it: no face turns over.
constexpr double part_of_edge = 0.25;

std::vector<HalfEdge> boundary_of(const EdgeIndex& edges)
{
    std::vector<HalfEdge> boundary;
    edges.for_each([&boundary](std::uint32_t, std::uint32_t, std::span<const HalfEdge> halves) {
        if (halves.size() == 1)
            boundary.push_back(halves[0]);
    });
    std::sort(boundary.begin(), boundary.end());
    return boundary;
}

/// Ends of the half-edges, ascending, each once.
std::vector<std::uint32_t> vertices_of(const Soup& soup, const std::vector<HalfEdge>& halves)
{
    std::vector<std::uint32_t> vertices;
    vertices.reserve(2 * halves.size());
    for (const HalfEdge half : halves) {
        vertices.push_back(from_vertex(soup.faces, half));
        vertices.push_back(to_vertex(soup.faces, half));
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

Bounds box_round(const Vec3& point, double reach)
{
    const Vec3 by = {reach, reach, reach};
    return {subtract(point, by), add(point, by)};
}

/// How far each of these vertices may move. `number`: of a vertex in the list, or no_neighbour.
std::vector<double> reaches_of(const Soup& soup, const std::vector<std::uint32_t>& number, std::size_t count,
                               double tolerance_mm)
{
    std::vector<double> reach(count, tolerance_mm);
    for (const Triple& face : soup.faces) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = face[i], b = face[(i + 1) % 3];
            if (number[a] == no_neighbour && number[b] == no_neighbour)
                continue;
            const double most = part_of_edge * distance(soup.vertices[a], soup.vertices[b]);
            for (const std::uint32_t v : {a, b}) {
                if (number[v] != no_neighbour)
                    reach[number[v]] = std::min(reach[number[v]], most);
            }
        }
    }
    return reach;
}

} // namespace

double stitch_tolerance_mm(const Soup& soup, double weld_mm)
{
    return std::max(weld_mm, relative_tolerance * bounds_of(soup.vertices).diagonal());
}

bool sew_cracks(Soup& soup, const std::vector<HalfEdge>& boundary, double tolerance_mm, Report& report)
{
    const std::vector<std::uint32_t> vertices = vertices_of(soup, boundary);
    std::vector<std::uint32_t> number(soup.vertices.size(), no_neighbour);
    std::vector<Bounds> points(vertices.size());
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
        number[vertices[i]] = i;
        points[i] = {soup.vertices[vertices[i]], soup.vertices[vertices[i]]};
    }
    const std::vector<double> reach = reaches_of(soup, number, vertices.size(), tolerance_mm);
    const BoxTree tree(points);
    std::vector<std::uint32_t> to(vertices.size());
    bool changed = false;
    double moved = 0;
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
        const Vec3& point = points[i].low;
        to[i] = i;
        tree.visit_meeting(box_round(point, reach[i]), [&](std::uint32_t other) {
            // onto a lower one that stays itself
            if (other < to[i] && to[other] == other &&
                distance(points[other].low, point) <= std::min(reach[i], reach[other]))
                to[i] = other;
        });
        if (to[i] == i)
            continue;
        changed = true;
        ++report.vertices_sewn;
        moved = std::max(moved, distance(points[to[i]].low, point));
    }
    report.moved_max_mm += moved;
    for (Triple& face : soup.faces) {
        if (!changed)
            break;
        for (std::uint32_t& v : face) {
            if (number[v] != no_neighbour)
                v = vertices[to[number[v]]];
        }
    }
    return changed;
}

bool stitch(Soup& soup, const EdgeIndex& edges, double tolerance_mm, Report& report)
{
    const std::vector<HalfEdge> boundary = boundary_of(edges);
    if (boundary.empty())
        return false;
    // one after the other: a crack that was sewn is no T-junction any more
    return sew_cracks(soup, boundary, tolerance_mm, report) ||
           cut_t_junctions(soup, boundary, tolerance_mm, report);
}

} // namespace phantom::mesh
