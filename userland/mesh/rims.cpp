// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/rims.hpp"

#include <algorithm>
#include <span>

#include "mesh/groups.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

constexpr std::uint32_t leaf_size = 4;

/// A set's corners are whole nm, and a distance is a sum with rounding of its own: a face that is farther
/// than the reach by no more than that counts as near.
constexpr double rounding_factor = 1 + 1e-9, rounding_mm = 1e-5;

/// An edge of a face over which it has no neighbour; its ends by the number of their point.
struct LooseEdge {
    std::uint32_t from_point, to_point;
    std::uint32_t face, edge;
    [[nodiscard]] std::uint32_t low() const { return std::min(from_point, to_point); }
    [[nodiscard]] std::uint32_t high() const { return std::max(from_point, to_point); }
};

/// One number for all vertices at the same point.
void number_points(const Mesh& mesh, std::vector<LooseEdge>& edges)
{
    std::vector<std::uint32_t> vertices;
    for (const LooseEdge& e : edges) {
        vertices.push_back(e.from_point);
        vertices.push_back(e.to_point);
    }
    const auto before = [&mesh](std::uint32_t a, std::uint32_t b) {
        return mesh.vertices[a] != mesh.vertices[b] ? mesh.vertices[a] < mesh.vertices[b] : a < b;
    };
    std::sort(vertices.begin(), vertices.end(), before);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    // The lowest vertex at a point comes first there: that is the point's number.
    const auto point_of = [&](std::uint32_t vertex) {
        return *std::lower_bound(
            vertices.begin(), vertices.end(), vertex,
            [&mesh](std::uint32_t at, std::uint32_t v) { return mesh.vertices[at] < mesh.vertices[v]; });
    };
    for (LooseEdge& e : edges) {
        e.from_point = point_of(e.from_point);
        e.to_point = point_of(e.to_point);
    }
}

/// Sorted, so that those between the same two points stand together.
std::vector<LooseEdge> loose_edges(const Mesh& mesh)
{
    std::vector<LooseEdge> edges;
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
        for (std::uint32_t i = 0; i < 3; ++i)
            if (mesh.neighbours[f][i] == no_neighbour)
                edges.push_back({mesh.faces[f][i], mesh.faces[f][(i + 1) % 3], f, i});
    number_points(mesh, edges);
    // a face of which two corners are one point has no area, and ends nothing
    std::erase_if(edges, [&mesh](const LooseEdge& e) {
        const Triple& face = mesh.faces[e.face];
        const Vec3 &a = mesh.vertices[face[0]], &b = mesh.vertices[face[1]], &c = mesh.vertices[face[2]];
        return a == b || b == c || c == a;
    });
    std::sort(edges.begin(), edges.end(), [](const LooseEdge& a, const LooseEdge& b) {
        return std::array{a.low(), a.high(), a.face, a.edge} < std::array{b.low(), b.high(), b.face, b.edge};
    });
    return edges;
}

/// Calls visit(span) for the loose edges between the same two points.
template <typename Visit>
void for_each_edge(const std::vector<LooseEdge>& edges, Visit&& visit)
{
    for (std::size_t begin = 0; begin < edges.size();) {
        std::size_t end = begin + 1;
        while (end < edges.size() && edges[end].low() == edges[begin].low() &&
               edges[end].high() == edges[begin].high())
            ++end;
        visit(std::span(edges).subspan(begin, end - begin));
        begin = end;
    }
}

/// Edges that no other goes along the other way round.
std::vector<LooseEdge> rim_edges(const std::vector<LooseEdge>& loose)
{
    std::vector<LooseEdge> rims;
    for_each_edge(loose, [&rims](std::span<const LooseEdge> edges) {
        const auto same_way = [&edges](const LooseEdge& e) {
            return e.from_point == edges.front().from_point;
        };
        if (std::all_of(edges.begin(), edges.end(), same_way))
            rims.insert(rims.end(), edges.begin(), edges.end());
    });
    return rims;
}

/// Per face, its surface: one more than the surface's lowest face.
std::vector<std::uint32_t> number_surfaces(const Mesh& mesh, const std::vector<LooseEdge>& loose)
{
    Groups groups(mesh.faces.size());
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
        for (const std::uint32_t neighbour : mesh.neighbours[f])
            if (neighbour != no_neighbour)
                groups.join(f, neighbour);
    for_each_edge(loose, [&groups](std::span<const LooseEdge> edges) {
        for (const LooseEdge& e : edges)
            groups.join(edges.front().face, e.face);
    });
    std::vector<std::uint32_t> surface(mesh.faces.size());
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
        surface[f] = groups.first(f) + 1;
    return surface;
}

std::uint64_t count_loops(const Mesh& mesh, const std::vector<LooseEdge>& rims)
{
    Groups groups(mesh.vertices.size());
    for (const LooseEdge& e : rims)
        groups.join(e.from_point, e.to_point);
    std::vector<std::uint32_t> loops;
    loops.reserve(rims.size());
    for (const LooseEdge& e : rims)
        loops.push_back(groups.first(e.from_point));
    std::sort(loops.begin(), loops.end());
    return static_cast<std::uint64_t>(std::unique(loops.begin(), loops.end()) - loops.begin());
}

Vec3 middle(const Mesh& mesh, const Rim& rim)
{
    return scaled(add(mesh.vertices[rim.from], mesh.vertices[rim.to]), 0.5);
}

struct RimTree {
    std::vector<Rim> edges;
    std::vector<RimNode> nodes;
};

/// Orders rims first ... first + count - 1 and appends the nodes over them.
void add_nodes(const Mesh& mesh, std::uint32_t first, std::uint32_t count, RimTree& out)
{
    RimNode node{mesh.vertices[out.edges[first].from], mesh.vertices[out.edges[first].from], 0, first, 0};
    for (std::uint32_t i = first; i < first + count; ++i) {
        for (const std::uint32_t vertex : {out.edges[i].from, out.edges[i].to}) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                node.low[axis] = std::min(node.low[axis], mesh.vertices[vertex][axis]);
                node.high[axis] = std::max(node.high[axis], mesh.vertices[vertex][axis]);
            }
        }
    }
    const std::size_t at = out.nodes.size();
    out.nodes.push_back(node);
    if (count <= leaf_size) {
        out.nodes[at].count = count;
    } else {
        const Vec3 size = subtract(node.high, node.low);
        const auto axis = static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
        const auto begin = out.edges.begin() + first;
        std::nth_element(begin, begin + count / 2, begin + count, [&](const Rim& a, const Rim& b) {
            return middle(mesh, a)[axis] < middle(mesh, b)[axis];
        });
        add_nodes(mesh, first, count / 2, out);
        add_nodes(mesh, first + count / 2, count - count / 2, out);
    }
    out.nodes[at].skip = static_cast<std::uint32_t>(out.nodes.size());
}

double distance_to_box(const RimNode& node, const Vec3& point)
{
    Vec3 away{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        away[axis] = point[axis] - std::clamp(point[axis], node.low[axis], node.high[axis]);
    return length(away);
}

double distance_to_segment(const Vec3& a, const Vec3& b, const Vec3& point)
{
    const Vec3 e = subtract(b, a), q = subtract(point, a);
    const double t = std::clamp(dot(e, q) / dot(e, e), 0.0, 1.0);
    return length(subtract(q, scaled(e, t)));
}

/// Visits the rims no farther than that from the point, with their distance, until visit() returns false.
template <typename Visit>
void visit_within(const Rims& rims, const Mesh& mesh, const Vec3& point, double distance, Visit&& visit)
{
    for (std::uint32_t at = 0; at < rims.nodes.size();) {
        const RimNode& node = rims.nodes[at];
        if (distance_to_box(node, point) > distance) {
            at = node.skip;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const Rim& rim = rims.edges[i];
            const double away = distance_to_segment(mesh.vertices[rim.from], mesh.vertices[rim.to], point);
            if (away <= distance && !visit(i, away))
                return;
        }
        ++at;
    }
}

/// Could a rim of its own surface be within reach of the face?
bool near_a_rim(const Rims& rims, const Mesh& mesh, std::uint32_t face, double reach_mm)
{
    std::array<Vec3, 3> x;
    for (std::size_t i = 0; i < 3; ++i)
        x[i] = mesh.vertices[mesh.faces[face][i]];
    const Vec3 centre = scaled(add(add(x[0], x[1]), x[2]), 1.0 / 3);
    const double extent = std::max({distance(x[0], centre), distance(x[1], centre), distance(x[2], centre)});
    bool near = false;
    visit_within(rims, mesh, centre, (reach_mm + extent) * rounding_factor + rounding_mm,
                 [&](std::uint32_t rim, double) {
                     near = rims.edges[rim].surface == rims.surface[face];
                     return !near;
                 });
    return near;
}

/// Faces that no rim concerns get surface 0.
std::vector<std::uint32_t> near_faces(const Mesh& mesh, double reach_mm, const Rims& rims)
{
    std::vector<std::uint32_t> surface = rims.surface.to_vector();
    // by number of surface; by face
    std::vector<bool> ends(mesh.faces.size() + 1, false), has_rim(mesh.faces.size(), false);
    for (const Rim& rim : rims.edges)
        ends[rim.surface] = has_rim[rim.face] = true;
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
        if (!has_rim[f] && (!ends[rims.surface[f]] || !near_a_rim(rims, mesh, f, reach_mm)))
            surface[f] = 0;
    return surface;
}

} // namespace

void Rims::within(const Mesh& mesh, const Vec3& point, double distance, std::vector<Near>& out) const
{
    visit_within(*this, mesh, point, distance, [&out](std::uint32_t rim, double away) {
        out.push_back({rim, away});
        return true;
    });
}

Rims make_rims(const Mesh& mesh, double reach_mm)
{
    Rims rims;
    const std::vector<LooseEdge> loose = loose_edges(mesh);
    const std::vector<LooseEdge> edges = rim_edges(loose);
    if (edges.empty())
        return rims;
    rims.loops = count_loops(mesh, edges);
    rims.surface = number_surfaces(mesh, loose);
    RimTree tree;
    for (const LooseEdge& e : edges)
        tree.edges.push_back(
            {mesh.faces[e.face][e.edge], mesh.faces[e.face][(e.edge + 1) % 3], e.face, rims.surface[e.face]});
    add_nodes(mesh, 0, static_cast<std::uint32_t>(tree.edges.size()), tree);
    rims.edges = std::move(tree.edges);
    rims.nodes = std::move(tree.nodes);
    rims.surface = near_faces(mesh, reach_mm, rims);
    return rims;
}

} // namespace phantom::mesh
