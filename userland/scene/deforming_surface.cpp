// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/deforming_surface.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "base/vector.hpp"

namespace phantom::scene {

namespace {

constexpr double fastest_revision_s = 0.01;
constexpr double triangles_per_s = 2e6;

fdh::TriangleTree<14> hulls_of(const Surface& surface)
{
    return surface.tree ? *surface.tree
                        : fdh::TriangleTree<14>::build({surface.mesh.vertices, surface.mesh.faces});
}

/// No box may be left by a rim that goes along.
mesh::Rims widened(mesh::Rims rims, const mesh::Vec3& by)
{
    std::vector<mesh::RimNode> nodes = rims.nodes.to_vector();
    for (mesh::RimNode& node : nodes) {
        node.low = node.low - by;
        node.high = node.high + by;
    }
    rims.nodes = std::move(nodes);
    return rims;
}

} // namespace

double revision_interval_s(std::size_t triangles)
{
    return std::max(fastest_revision_s, static_cast<double>(triangles) / triangles_per_s);
}

DeformingSurface::DeformingSurface(Surface rest, const Deformation& deformation)
    : rest_(std::move(rest)), axis_(deformation.axis), tree_(hulls_of(rest_))
{
    part_normals();
    for (const mesh::Vec3& vertex : rest_.mesh.vertices) {
        profile_.push_back(deformation.profile(vertex));
        gradient_.push_back(deformation.gradient(vertex));
    }
    rest_.rims = widened(std::move(rest_.rims), {deformation.amplitude_mm * std::abs(axis_[0]),
                                                 deformation.amplitude_mm * std::abs(axis_[1]),
                                                 deformation.amplitude_mm * std::abs(axis_[2])});
    rest_.tree = tree_.tree();
    now_ = rest_;
}

void DeformingSurface::part_normals()
{
    const mesh::Mesh& mesh = rest_.mesh;
    std::unordered_map<std::uint64_t, std::uint32_t> numbers;
    std::vector<mesh::Vec3> normals;
    std::vector<mesh::Triple> face_normals = mesh.face_normals.to_vector();
    for (std::size_t f = 0; f < face_normals.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t vertex = mesh.faces[f][i];
            std::uint32_t& normal = face_normals[f][i];
            const std::uint64_t key = static_cast<std::uint64_t>(vertex) << 32 | normal;
            const auto [at, added] = numbers.try_emplace(key, static_cast<std::uint32_t>(normals.size()));
            if (added) {
                normals.push_back(mesh.normals[normal]);
                normal_vertex_.push_back(vertex);
            }
            normal = at->second;
        }
    }
    rest_.mesh.normals = std::move(normals);
    rest_.mesh.face_normals = std::move(face_normals);
}

mesh::Vec3 DeformingSurface::turned(std::uint32_t vertex, const mesh::Vec3& normal, double s_mm) const
{
    const mesh::Vec3& gradient = gradient_[vertex];
    const double along = s_mm * dot(axis_, normal) / (1 + s_mm * dot(axis_, gradient));
    return unit_or(normal - along * gradient, normal);
}

const Surface& DeformingSurface::displaced(double s_mm)
{
    const mesh::Mesh& rest = rest_.mesh;
    std::vector<mesh::Vec3> vertices(rest.vertices.size()), normals(rest.normals.size());
    for (std::size_t v = 0; v < vertices.size(); ++v)
        vertices[v] = rest.vertices[v] + s_mm * profile_[v] * axis_;
    for (std::size_t n = 0; n < normals.size(); ++n)
        normals[n] = turned(normal_vertex_[n], rest.normals[n], s_mm);
    now_.mesh.vertices = std::move(vertices);
    now_.mesh.normals = std::move(normals);
    if (!rest_.fans.fans.empty()) {
        std::vector<mesh::Fan> fans = rest_.fans.fans.to_vector();
        for (mesh::Fan& fan : fans)
            for (std::size_t i = 0; i < 3; ++i)
                fan.normals[i] = turned(fan.corners[i], fan.normals[i], s_mm);
        now_.fans.fans = std::move(fans);
    }
    tree_.update({now_.mesh.vertices, now_.mesh.faces}, {.threads = 1});
    now_.tree = tree_.tree();
    return now_;
}

} // namespace phantom::scene
