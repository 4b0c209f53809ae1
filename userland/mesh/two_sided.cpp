// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/two_sided.hpp"

#include "mesh/vector.hpp"

namespace phantom::mesh {

bool make_two_sided(Mesh& mesh)
{
    const auto count = static_cast<std::uint32_t>(mesh.faces.size());
    const auto normals = static_cast<std::uint32_t>(mesh.normals.size());
    if (mesh.faces.size() >= no_neighbour / 2 || mesh.normals.size() >= no_neighbour / 2)
        return false;
    mesh.normals.reserve(2 * mesh.normals.size());
    for (std::uint32_t i = 0; i < normals; ++i)
        mesh.normals.push_back(scaled(mesh.normals[i], -1));
    for (std::uint32_t f = 0; f < count; ++f) {
        const Triple face = mesh.faces[f], corner = mesh.face_normals[f];
        mesh.faces.push_back({face[0], face[2], face[1]});
        mesh.face_normals.push_back({corner[0] + normals, corner[2] + normals, corner[1] + normals});
        Triple& front = mesh.neighbours[f];
        Triple back{};
        for (std::uint32_t edge = 0; edge < 3; ++edge) {
            // corner i to i + 1 of the face is corner 2 - i to 3 - i of its back
            back[2 - edge] = front[edge] == no_neighbour ? f : front[edge] + count;
            if (front[edge] == no_neighbour)
                front[edge] = f + count;
        }
        mesh.neighbours.push_back(back);
    }
    return true;
}

} // namespace phantom::mesh
