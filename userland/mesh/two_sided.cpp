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
    Soup both{{}, mesh.faces.to_vector(), mesh.normals.to_vector(), mesh.face_normals.to_vector()};
    std::vector<Triple> neighbours = mesh.neighbours.to_vector();
    both.normals.reserve(2UL * normals);
    both.faces.reserve(2UL * count);
    both.face_normals.reserve(2UL * count);
    neighbours.reserve(2UL * count);
    for (std::uint32_t i = 0; i < normals; ++i)
        both.normals.push_back(scaled(both.normals[i], -1));
    for (std::uint32_t f = 0; f < count; ++f) {
        const Triple face = both.faces[f], corner = both.face_normals[f];
        both.faces.push_back({face[0], face[2], face[1]});
        both.face_normals.push_back({corner[0] + normals, corner[2] + normals, corner[1] + normals});
        Triple& front = neighbours[f];
        Triple back{};
        for (std::uint32_t edge = 0; edge < 3; ++edge) {
            // corner i to i + 1 of the face is corner 2 - i to 3 - i of its back
            back[2 - edge] = front[edge] == no_neighbour ? f : front[edge] + count;
            if (front[edge] == no_neighbour)
                front[edge] = f + count;
        }
        neighbours.push_back(back);
    }
    mesh.faces = std::move(both.faces);
    mesh.normals = std::move(both.normals);
    mesh.face_normals = std::move(both.face_normals);
    mesh.neighbours = std::move(neighbours);
    if (!mesh.face_groups.empty()) {
        std::vector<std::uint8_t> groups = mesh.face_groups.to_vector();
        groups.reserve(2UL * count);
        groups.insert(groups.end(), mesh.face_groups.begin(), mesh.face_groups.end());
        mesh.face_groups = std::move(groups);
    }
    return true;
}

} // namespace phantom::mesh
