// SPDX-License-Identifier: GPL-2.0-or-later
#include "creased.hpp"

#include <stdexcept>

#include "mesh/fans.hpp"
#include "mesh/prepare.hpp"

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
    const auto add_triangle = [&](const mesh::Triple& corners, const std::array<Vec3, 3>& normals, bool fan) {
        reference::Triangle t;
        for (std::size_t i = 0; i < 3; ++i) {
            t.corner[i] = on_grid(mesh.vertices[corners[i]]);
            t.normal[i] = on_unit_grid(normals[i]);
            t.vertex[i] = corners[i];
        }
        t.stiffness = stiffness;
        t.radius = radius;
        t.fan = fan;
        out.push_back(t);
    };
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto& n = mesh.face_normals[f];
        add_triangle(mesh.faces[f], {mesh.normals[n[0]], mesh.normals[n[1]], mesh.normals[n[2]]}, false);
    }
    for (const mesh::Fan& fan : mesh::make_fans(mesh).fans)
        add_triangle(fan.corners, fan.normals, true);
    return out;
}

} // namespace phantom::hard
