// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/fans.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

/// Normals nearer to one another than this are the same, radians: the gap at R is far below a nm.
constexpr double same_angle = 1e-7;

/// A fan's normals are at most this far apart, radians: its shortest interpolated normal is cos(half of it).
constexpr double arc_max = 100.0 / 180.0 * std::numbers::pi;

/// A sum of unit normals shorter than this, per normal, has no direction to speak of.
constexpr double cancelled = 0.1;

/// An edge of a face: from corner `edge` to the next one.
struct Edge {
    std::uint32_t face, edge;
};

std::uint32_t corner_of(const Triple& face, std::uint32_t vertex)
{
    return face[0] == vertex ? 0 : face[1] == vertex ? 1 : 2;
}

const Vec3& normal_at(const Mesh& mesh, std::uint32_t face, std::uint32_t vertex)
{
    return mesh.normals[mesh.face_normals[face][corner_of(mesh.faces[face], vertex)]];
}

/// From one unit normal to the other, `part` of the way round. Opposite ones go round by way of `outward`.
Vec3 between(const Vec3& from, const Vec3& to, double part, const Vec3& outward)
{
    const double angle = angle_between(from, to);
    if (angle > 0.999 * std::numbers::pi) {
        // the two halves of a blade that has no thickness
        return part < 0.5 ? between(from, outward, 2 * part, outward)
                          : between(outward, to, 2 * part - 1, outward);
    }
    if (angle < same_angle)
        return from;
    return normalized(add(scaled(from, std::sin((1 - part) * angle)), scaled(to, std::sin(part * angle))));
}

/// The normals at both ends of an edge, from its own face's side to its neighbour's.
struct Arcs {
    std::vector<Vec3> at_first, at_second; ///< at corners `edge` and `edge` + 1; as many each
};

/// Away from the middle of the face, in its plane.
Vec3 outward_of(const Mesh& mesh, const Edge& e)
{
    const Triple& face = mesh.faces[e.face];
    const Vec3& a = mesh.vertices[face[e.edge]];
    const Vec3& b = mesh.vertices[face[(e.edge + 1) % 3]];
    const Vec3& c = mesh.vertices[face[(e.edge + 2) % 3]];
    return normalized(cross(subtract(b, a), cross(subtract(b, a), subtract(c, a))));
}

/// The same bits from either side but for their order: always made from the lower face.
Arcs arcs_of(const Mesh& mesh, const Edge& e)
{
    const Triple& face = mesh.faces[e.face];
    const std::uint32_t other = mesh.neighbours[e.face][e.edge];
    const std::uint32_t a = face[e.edge], b = face[(e.edge + 1) % 3];
    if (other < e.face) {
        Arcs arcs = arcs_of(mesh, {other, corner_of(mesh.faces[other], b)});
        std::reverse(arcs.at_first.begin(), arcs.at_first.end());
        std::reverse(arcs.at_second.begin(), arcs.at_second.end());
        std::swap(arcs.at_first, arcs.at_second);
        return arcs;
    }
    const Vec3 &own_a = normal_at(mesh, e.face, a), &other_a = normal_at(mesh, other, a);
    const Vec3 &own_b = normal_at(mesh, e.face, b), &other_b = normal_at(mesh, other, b);
    const double widest = std::max(angle_between(own_a, other_a), angle_between(own_b, other_b));
    if (widest < same_angle)
        return {};
    const int parts = std::max(1, static_cast<int>(std::ceil(widest / arc_max)));
    const Vec3 outward = outward_of(mesh, e);
    Arcs arcs{{own_a}, {own_b}};
    for (int i = 1; i < parts; ++i) {
        const double part = static_cast<double>(i) / parts;
        arcs.at_first.push_back(between(own_a, other_a, part, outward));
        arcs.at_second.push_back(between(own_b, other_b, part, outward));
    }
    arcs.at_first.push_back(other_a);
    arcs.at_second.push_back(other_b);
    return arcs;
}

bool differ(const Vec3& a, const Vec3& b)
{
    return angle_between(a, b) >= same_angle;
}

/// Two triangles for each step from the face's normals to its neighbour's.
void add_edge_fans(const Mesh& mesh, const Edge& e, std::vector<Fan>& out)
{
    const Arcs arcs = arcs_of(mesh, e);
    const std::uint32_t a = mesh.faces[e.face][e.edge], b = mesh.faces[e.face][(e.edge + 1) % 3];
    for (std::size_t i = 0; i + 1 < arcs.at_first.size(); ++i) {
        const Vec3 &a0 = arcs.at_first[i], &a1 = arcs.at_first[i + 1];
        const Vec3 &b0 = arcs.at_second[i], &b1 = arcs.at_second[i + 1];
        // The face runs from a to b, so the fan beside it runs from b to a.
        if (differ(a0, a1))
            out.push_back({{b, a, a}, {b0, a0, a1}});
        if (differ(b0, b1))
            out.push_back({{b, a, b}, {b0, a1, b1}});
    }
}

/// What stands round a vertex.
struct Round {
    std::vector<Vec3> normals;
    Vec3 outward{0, 0, 0}; ///< away from the neighbouring vertices, summed
};

/// The normals round a vertex, counter-clockwise seen from outside, each once; the corner that is walked from
/// has to be the lowest face of its round. Empty where the round is open, or another face is lower.
Round round_of(const Mesh& mesh, std::uint32_t face, std::uint32_t vertex)
{
    Round round;
    std::vector<Vec3>& normals = round.normals;
    const auto append = [&normals](const Vec3& normal) {
        if (normals.empty() || differ(normals.back(), normal))
            normals.push_back(normal);
    };
    std::uint32_t at = face;
    do {
        // over the edge that comes in to the vertex
        const std::uint32_t in = (corner_of(mesh.faces[at], vertex) + 2) % 3;
        const std::uint32_t next = mesh.neighbours[at][in];
        if (next == no_neighbour || next < face)
            return {};
        append(normal_at(mesh, at, vertex));
        round.outward = add(round.outward,
                            normalized(subtract(mesh.vertices[vertex], mesh.vertices[mesh.faces[at][in]])));
        const Arcs arcs = arcs_of(mesh, {at, in});
        for (const Vec3& normal : arcs.at_second)
            append(normal);
        at = next;
    } while (at != face);
    while (normals.size() > 1 && !differ(normals.front(), normals.back()))
        normals.pop_back();
    return round;
}

/// A direction in the middle of the polygon: that of its summed normals, at a needle's tip (they cancel) that
/// of the needle. Zero where both cancel.
Vec3 middle_of(const Round& round)
{
    Vec3 sum{0, 0, 0};
    for (const Vec3& normal : round.normals)
        sum = add(sum, normal);
    const double least = cancelled * static_cast<double>(round.normals.size());
    if (length(sum) > least)
        return normalized(sum);
    return length(round.outward) > least ? normalized(round.outward) : Vec3{0, 0, 0};
}

/// Without one that has no shell: two of its normals are the same.
void add_corner_fan(std::uint32_t vertex, const Vec3& a, const Vec3& b, const Vec3& c, std::vector<Fan>& out)
{
    if (differ(a, b) && differ(b, c) && differ(c, a))
        out.push_back({{vertex, vertex, vertex}, {a, b, c}});
}

/// A polygon of directions becomes triangles: one if it is small, else round its middle.
void add_corner_fans(const Round& round, std::uint32_t vertex, std::vector<Fan>& out)
{
    const std::vector<Vec3>& normals = round.normals;
    if (normals.size() < 3)
        return;
    const std::size_t count = normals.size();
    double widest = 0;
    for (std::size_t i = 0; i < count; ++i)
        widest = std::max(widest, angle_between(normals[i], normals[(i + 1) % count]));
    const Vec3 middle = middle_of(round);
    if ((count == 3 && widest <= arc_max) || middle == Vec3{0, 0, 0}) {
        for (std::size_t i = 1; i + 1 < count; ++i)
            add_corner_fan(vertex, normals[0], normals[i], normals[i + 1], out);
        return;
    }
    for (std::size_t i = 0; i < count; ++i)
        add_corner_fan(vertex, middle, normals[i], normals[(i + 1) % count], out);
}

/// Whether a face has a crease at one of its edges at the vertex: most have none, and need no walk.
bool creased_at(const Mesh& mesh, std::uint32_t face, std::uint32_t corner)
{
    const std::uint32_t vertex = mesh.faces[face][corner];
    for (const std::uint32_t edge : {corner, (corner + 2) % 3}) {
        const std::uint32_t other = mesh.neighbours[face][edge];
        if (other == no_neighbour)
            continue;
        const std::uint32_t other_corner = corner_of(mesh.faces[other], vertex);
        // equal numbers are equal normals: the usual case, without arithmetic
        if (mesh.face_normals[face][corner] != mesh.face_normals[other][other_corner] &&
            differ(normal_at(mesh, face, vertex), normal_at(mesh, other, vertex)))
            return true;
    }
    return false;
}

bool degenerate(const Triple& face)
{
    return face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
}

} // namespace

Fans make_fans(const Mesh& mesh)
{
    const auto count = static_cast<std::uint32_t>(mesh.faces.size());
    // A corner fan is its lowest face's, which may have no crease there itself.
    std::vector<bool> creased(mesh.vertices.size(), false);
    bool any = false;
    for (std::uint32_t f = 0; f < count; ++f) {
        for (std::uint32_t i = 0; i < 3; ++i) {
            if (degenerate(mesh.faces[f]) || !creased_at(mesh, f, i))
                continue;
            creased[mesh.faces[f][i]] = true;
            any = true;
        }
    }
    if (!any)
        return {};
    std::vector<Fan> fans;
    std::vector<std::uint32_t> first;
    first.reserve(count + 1U);
    for (std::uint32_t f = 0; f < count; ++f) {
        first.push_back(static_cast<std::uint32_t>(fans.size()));
        if (degenerate(mesh.faces[f]))
            continue;
        for (std::uint32_t i = 0; i < 3; ++i) {
            const std::uint32_t a = mesh.faces[f][i], b = mesh.faces[f][(i + 1) % 3];
            const std::uint32_t other = mesh.neighbours[f][i];
            if (other != no_neighbour && f < other && (creased[a] || creased[b]))
                add_edge_fans(mesh, {f, i}, fans);
            if (creased[a])
                add_corner_fans(round_of(mesh, f, a), a, fans);
        }
    }
    first.push_back(static_cast<std::uint32_t>(fans.size()));
    return {std::move(fans), std::move(first)};
}

} // namespace phantom::mesh
