// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>

#include "mesh/steps.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

/// A normal's length may differ from 1 by rounding only.
constexpr double unit_tolerance = 1e-9;

bool corners_sound(const Mesh& mesh, const Triple& face)
{
    for (const std::uint32_t v : face) {
        if (v >= mesh.vertices.size() || !is_finite(mesh.vertices[v]))
            return false;
    }
    return !has_no_area(mesh.vertices, face);
}

bool normals_sound(const Mesh& mesh, std::size_t f)
{
    const Vec3 outward = face_normal(mesh.vertices, mesh.faces[f]);
    for (const std::uint32_t number : mesh.face_normals[f]) {
        if (number >= mesh.normals.size())
            return false;
        const Vec3& normal = mesh.normals[number];
        if (!(std::abs(dot(normal, normal) - 1) < unit_tolerance) || !(dot(normal, outward) > 0))
            return false;
    }
    return true;
}

/// Each neighbour has the face for its own, over the same edge the other way round.
bool neighbours_sound(const Mesh& mesh, std::uint32_t f)
{
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t other = mesh.neighbours[f][i];
        if (other == no_neighbour)
            continue;
        if (other >= mesh.faces.size())
            return false;
        const std::uint32_t from = mesh.faces[f][i], to = mesh.faces[f][(i + 1) % 3];
        bool found = false;
        for (std::size_t j = 0; j < 3; ++j) {
            found = found || (mesh.faces[other][j] == to && mesh.faces[other][(j + 1) % 3] == from &&
                              mesh.neighbours[other][j] == f);
        }
        if (!found)
            return false;
    }
    return true;
}

} // namespace

std::uint64_t count_faults(const Mesh& mesh)
{
    if (mesh.face_normals.size() != mesh.faces.size() || mesh.neighbours.size() != mesh.faces.size())
        return mesh.faces.size();
    std::uint64_t faults = 0;
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
        faults +=
            !corners_sound(mesh, mesh.faces[f]) || !normals_sound(mesh, f) || !neighbours_sound(mesh, f);
    return faults;
}

} // namespace phantom::mesh
