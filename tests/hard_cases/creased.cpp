// SPDX-License-Identifier: GPL-2.0-or-later
#include "creased.hpp"

#include <stdexcept>

#include "mesh/fans.hpp"
#include "mesh/prepare.hpp"
#include "mesh/rims.hpp"

namespace phantom::hard {

std::vector<reference::Triangle> creased(const Shape& shape, double crease_deg, double stiffness,
                                         double radius, bool two_sided)
{
    mesh::Soup soup;
    soup.vertices = shape.vertices;
    soup.faces = shape.faces;
    return prepared(std::move(soup), 0, crease_deg, stiffness, radius, two_sided);
}

std::vector<reference::Triangle> prepared(mesh::Soup soup, double fit_mm, double crease_deg, double stiffness,
                                          double radius, bool two_sided)
{
    mesh::PrepareOptions options;
    options.fit_mm = fit_mm;
    options.crease_deg = crease_deg;
    options.two_sided = two_sided;
    const auto done = mesh::prepare(std::move(soup), options, "test");
    if (!done)
        throw std::invalid_argument(done.error().text());
    const mesh::Mesh& mesh = done->mesh;
    std::vector<reference::Triangle> out;
    const mesh::Fans fans = mesh::make_fans(mesh);
    const mesh::Rims rims = mesh::make_rims(mesh, radius);
    const auto add_triangle = [&](const mesh::Triple& corners, const std::array<Vec3, 3>& normals,
                                  std::uint32_t surface) -> reference::Triangle& {
        reference::Triangle t;
        for (std::size_t i = 0; i < 3; ++i) {
            t.corner[i] = on_grid(mesh.vertices[corners[i]]);
            t.normal[i] = on_unit_grid(normals[i]);
            t.vertex[i] = corners[i];
        }
        t.stiffness = stiffness;
        t.radius = radius;
        t.surface = surface;
        out.push_back(t);
        return out.back();
    };
    const auto faces = static_cast<std::uint32_t>(mesh.faces.size());
    for (std::uint32_t f = 0; f < faces; ++f) {
        const auto& n = mesh.face_normals[f];
        add_triangle(mesh.faces[f], {mesh.normals[n[0]], mesh.normals[n[1]], mesh.normals[n[2]]},
                     rims.surface_of(f));
    }
    for (std::uint32_t f = 0; f < faces; ++f)
        for (const mesh::Fan& fan : fans.of(f))
            add_triangle(fan.corners, fan.normals, rims.surface_of(f)).fan = true;
    const Vec3 any{0, 0, 1};
    for (const mesh::Rim& rim : rims.edges)
        add_triangle({rim.from, rim.to, rim.to}, {any, any, any}, rim.surface).rim = true;
    return out;
}

std::vector<reference::Triangle> with_rims(std::vector<reference::Triangle> triangles)
{
    mesh::Soup soup;
    for (const auto& t : triangles) {
        const auto first = static_cast<std::uint32_t>(soup.vertices.size());
        soup.vertices.insert(soup.vertices.end(), t.corner.begin(), t.corner.end());
        soup.faces.push_back({first, first + 1, first + 2});
    }
    const mesh::Triple alone{mesh::no_neighbour, mesh::no_neighbour, mesh::no_neighbour};
    mesh::Mesh mesh;
    mesh.neighbours = std::vector<mesh::Triple>(soup.faces.size(), alone);
    mesh.vertices = std::move(soup.vertices);
    mesh.faces = std::move(soup.faces);
    const mesh::Rims rims = mesh::make_rims(mesh, triangles[0].radius);
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
        triangles[f].surface = rims.surface_of(f);
    for (const mesh::Rim& rim : rims.edges) {
        reference::Triangle t = triangles[rim.face];
        t.corner = {mesh.vertices[rim.from], mesh.vertices[rim.to], mesh.vertices[rim.to]};
        t.surface = rim.surface;
        t.rim = true;
        triangles.push_back(t);
    }
    return triangles;
}

} // namespace phantom::hard
