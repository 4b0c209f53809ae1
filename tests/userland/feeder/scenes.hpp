// SPDX-License-Identifier: GPL-2.0-or-later
// Scenes made in memory, so that every vertex and normal is known.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "scene/scene.hpp"

namespace phantom::test {

using Vector = std::array<double, 3>;

/// Fills neighbours from shared edges.
inline void connect(mesh::Mesh& mesh)
{
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> owner;
    for (std::uint32_t face = 0; face < mesh.faces.size(); ++face)
        for (int edge = 0; edge < 3; ++edge)
            owner[{mesh.faces[face][edge], mesh.faces[face][(edge + 1) % 3]}] = face;
    std::vector<mesh::Triple> neighbours(mesh.faces.size(),
                                         {mesh::no_neighbour, mesh::no_neighbour, mesh::no_neighbour});
    for (std::uint32_t face = 0; face < mesh.faces.size(); ++face)
        for (int edge = 0; edge < 3; ++edge)
            if (auto it = owner.find({mesh.faces[face][(edge + 1) % 3], mesh.faces[face][edge]});
                it != owner.end())
                neighbours[face][edge] = it->second;
    mesh.neighbours = std::move(neighbours);
}

/// Latitude-longitude sphere round the origin with exact radial normals.
inline mesh::Mesh sphere(double radius_mm, int rings, int sectors)
{
    mesh::Soup soup;
    const auto add = [&](double polar, double turn) {
        const Vector n{std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar)};
        soup.normals.push_back(n);
        soup.vertices.push_back({radius_mm * n[0], radius_mm * n[1], radius_mm * n[2]});
        return static_cast<std::uint32_t>(soup.vertices.size() - 1);
    };
    const std::uint32_t north = add(0, 0), south = add(std::numbers::pi, 0);
    const auto at = [&](int ring, int sector) {
        return 2 + static_cast<std::uint32_t>((ring - 1) * sectors + sector % sectors);
    };
    for (int ring = 1; ring < rings; ++ring)
        for (int sector = 0; sector < sectors; ++sector)
            add(std::numbers::pi * ring / rings, 2 * std::numbers::pi * sector / sectors);
    for (int sector = 0; sector < sectors; ++sector) {
        soup.faces.push_back({north, at(1, sector), at(1, sector + 1)});
        soup.faces.push_back({south, at(rings - 1, sector + 1), at(rings - 1, sector)});
        for (int ring = 1; ring + 1 < rings; ++ring) {
            soup.faces.push_back({at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1)});
            soup.faces.push_back({at(ring, sector), at(ring + 1, sector + 1), at(ring, sector + 1)});
        }
    }
    mesh::Mesh mesh{std::move(soup.vertices), std::move(soup.faces), std::move(soup.normals), {}, {}};
    mesh.face_normals = mesh.faces;
    connect(mesh);
    return mesh;
}

/// Adds an object; numbers go on from the one before.
inline void add_object(scene::Scene& scene, mesh::Mesh mesh, const fdh::Pose& pose, std::uint32_t material)
{
    scene::Object object;
    object.name = "object" + std::to_string(scene.objects.size());
    if (!scene.objects.empty()) {
        const scene::Object& last = scene.objects.back();
        object.first_face = last.first_face + static_cast<std::uint32_t>(last.mesh.faces.size());
        object.first_vertex = last.first_vertex + static_cast<std::uint32_t>(last.mesh.vertices.size());
    }
    object.mesh = std::move(mesh);
    object.pose = pose;
    object.material = material;
    scene.objects.push_back(std::move(object));
}

/// One sphere of 50 mm, k = 1 N/mm, R = 3 mm.
inline scene::Scene sphere_scene()
{
    scene::Scene scene;
    scene.materials.push_back({"hard", 1.0, 3.0, {}});
    add_object(scene, sphere(50.0, 60, 120), {}, 0);
    return scene;
}

/// A quarter turn about z, moved: its rows are exact in double.
inline fdh::Pose quarter_turn(const Vector& translation)
{
    fdh::Pose pose;
    pose.rotation = {0, -1, 0, 1, 0, 0, 0, 0, 1};
    pose.translation = translation;
    return pose;
}

} // namespace phantom::test
