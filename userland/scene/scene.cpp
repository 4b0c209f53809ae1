// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/scene.hpp"

#include <algorithm>

namespace phantom::scene {

std::uint64_t Scene::triangles() const
{
    std::uint64_t sum = 0;
    for (const Object& object : objects)
        sum += object.mesh.faces.size();
    return sum;
}

std::uint64_t Scene::patches() const
{
    std::uint64_t sum = triangles();
    for (const Object& object : objects)
        sum += object.fans.fans.size() + object.rims.edges.size();
    return sum;
}

mesh::Bounds Scene::bounds() const
{
    std::vector<mesh::Vec3> world;
    for (const Object& object : objects) {
        const auto& r = object.pose.rotation;
        const auto& t = object.pose.translation;
        for (const mesh::Vec3& v : object.mesh.vertices)
            world.push_back({r[0] * v[0] + r[1] * v[1] + r[2] * v[2] + t[0],
                             r[3] * v[0] + r[4] * v[1] + r[5] * v[2] + t[1],
                             r[6] * v[0] + r[7] * v[1] + r[8] * v[2] + t[2]});
    }
    return mesh::bounds_of(world);
}

double Scene::max_radius_mm() const
{
    double radius = 0;
    for (const Object& object : objects)
        radius = std::max(radius, materials[object.material].radius_mm);
    return radius;
}

// A material that no object has calls for nothing.
std::vector<std::string> Scene::effects_called_for() const
{
    const bool damping = std::any_of(materials.begin(), materials.end(), [](const Material& material) {
        return material.damping_ns_m.has_value();
    });
    return damping ? std::vector<std::string>{"damping"} : std::vector<std::string>{};
}

std::vector<std::string> Scene::effects_not_called_for() const
{
    return effects_called_for().empty() ? std::vector<std::string>{"damping"} : std::vector<std::string>{};
}

} // namespace phantom::scene
