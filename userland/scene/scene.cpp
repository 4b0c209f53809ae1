// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/scene.hpp"

#include <algorithm>
#include <limits>

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
    constexpr double infinity = std::numeric_limits<double>::infinity();
    mesh::Bounds world{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (const Object& object : objects) {
        const auto& r = object.pose.rotation;
        const auto& t = object.pose.translation;
        for (const mesh::Vec3& v : object.mesh.vertices) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double* row = &r[3 * axis];
                const double x = row[0] * v[0] + row[1] * v[1] + row[2] * v[2] + t[axis];
                world.low[axis] = std::min(world.low[axis], x);
                world.high[axis] = std::max(world.high[axis], x);
            }
        }
    }
    return world.low[0] <= world.high[0] ? world : mesh::Bounds{};
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
