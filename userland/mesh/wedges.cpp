// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/wedges.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "mesh/edge_index.hpp"
#include "mesh/groups.hpp"
#include "mesh/steps.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

std::uint32_t corner_at(const Triple& face, std::uint32_t vertex)
{
    return face[0] == vertex ? 0 : face[1] == vertex ? 1 : 2;
}

/// Corners 3 f + i of the same wedge.
Groups join_corners(const Mesh& mesh, std::size_t faces, double crease_deg)
{
    const double crease_cosine = std::cos(crease_deg * std::numbers::pi / 180.0);
    const auto agree = [&](std::size_t f, std::uint32_t i, std::size_t g, std::uint32_t j) {
        const std::uint32_t a = mesh.face_normals[f][i], b = mesh.face_normals[g][j];
        return a == b || dot(mesh.normals[a], mesh.normals[b]) >= crease_cosine;
    };
    Groups corners(3 * faces);
    for (std::uint32_t f = 0; f < faces; ++f) {
        for (std::uint32_t i = 0; i < 3; ++i) {
            const std::uint32_t other = mesh.neighbours[f][i], next = (i + 1) % 3;
            if (other >= faces || other < f) // none, or not among these; each edge once
                continue;
            const std::uint32_t from = corner_at(mesh.faces[other], mesh.faces[f][i]);
            const std::uint32_t to = corner_at(mesh.faces[other], mesh.faces[f][next]);
            if (!agree(f, i, other, from) || !agree(f, next, other, to))
                continue;
            corners.join(3 * f + i, 3 * other + from);
            corners.join(3 * f + next, 3 * other + to);
        }
    }
    return corners;
}

} // namespace

Wedges wedges_of(const Mesh& mesh, std::size_t faces, double crease_deg)
{
    Wedges out;
    out.vertices.assign(mesh.vertices.begin(), mesh.vertices.end());
    out.faces.assign(mesh.faces.begin(), mesh.faces.begin() + static_cast<std::ptrdiff_t>(faces));
    out.corners.resize(faces);
    if (!mesh.face_groups.empty())
        out.face_groups.assign(mesh.face_groups.begin(),
                               mesh.face_groups.begin() + static_cast<std::ptrdiff_t>(faces));
    out.group_names = mesh.group_names;
    Groups groups = join_corners(mesh, faces, crease_deg);
    std::vector<std::uint32_t> number(3 * faces, no_neighbour);
    for (std::uint32_t f = 0; f < faces; ++f) {
        for (std::uint32_t i = 0; i < 3; ++i) {
            std::uint32_t& wedge = number[groups.first(3 * f + i)];
            if (wedge == no_neighbour) {
                wedge = static_cast<std::uint32_t>(out.vertex_of.size());
                out.vertex_of.push_back(out.faces[f][i]);
            }
            out.corners[f][i] = wedge;
        }
    }
    return out;
}

Mesh mesh_of(const Wedges& wedges)
{
    Report report;
    Soup sides; // whose faces are neighbours over plain edges only
    sides.faces = wedges.corners;
    const std::vector<Triple> plain =
        neighbours_of(sides, EdgeIndex(sides.faces, wedges.vertex_of.size()), report);
    Soup soup;
    soup.vertices = wedges.vertices;
    soup.faces = wedges.faces;
    corner_normals(soup, plain, 180.0, report);
    Mesh mesh;
    mesh.neighbours = neighbours_of(soup, EdgeIndex(soup.faces, soup.vertices.size()), report);
    mesh.vertices = std::move(soup.vertices);
    mesh.faces = std::move(soup.faces);
    mesh.normals = std::move(soup.normals);
    mesh.face_normals = std::move(soup.face_normals);
    mesh.face_groups = wedges.face_groups;
    mesh.group_names = wedges.group_names;
    return mesh;
}

} // namespace phantom::mesh
