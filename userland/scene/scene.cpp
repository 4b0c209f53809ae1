// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/scene.hpp"

#include <algorithm>
#include <limits>

#include "scene/effect_parameters.hpp"

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

double Scene::tip_radius_mm() const
{
    for (const SpaceEffect& effect : effects)
        if (const auto* tip = std::get_if<BallTip>(&effect.law))
            return tip->radius_mm;
    return 0;
}

double Scene::max_radius_mm() const
{
    double radius = 0;
    for (const Object& object : objects)
        radius = std::max(radius, max_radius_mm(object));
    return radius;
}

double Scene::max_radius_mm(const Object& object) const
{
    if (object.group_materials.empty())
        return materials[object.material].radius_mm + tip_radius_mm();
    double radius = 0;
    for (const std::uint32_t material : object.group_materials)
        radius = std::max(radius, materials[material].radius_mm);
    return radius + tip_radius_mm();
}

bool Scene::uses(std::uint32_t material) const
{
    return std::any_of(objects.begin(), objects.end(), [material](const Object& object) {
        const std::vector<std::uint32_t>& groups = object.group_materials;
        return groups.empty() ? object.material == material
                              : std::find(groups.begin(), groups.end(), material) != groups.end();
    });
}

namespace {

struct SurfaceEffectName {
    const char* name;
    bool (*called_for)(const Material& material);
};

constexpr SurfaceEffectName surface_effect_names[] = {
    {"damping", [](const Material& material) { return material.damping_ns_m.has_value(); }},
    {"magnet", [](const Material& material) { return material.magnet.has_value(); }},
    {"friction", [](const Material& material) { return material.friction.has_value(); }},
    {"texture", [](const Material& material) { return material.texture.has_value(); }},
    {"height_map", [](const Material& material) { return material.height_map.has_value(); }},
    {"impact", [](const Material& material) { return material.impact.has_value(); }},
};

std::vector<std::string> effects_of(const Scene& scene, bool called_for)
{
    std::vector<std::string> out;
    for (const SurfaceEffectName& effect : surface_effect_names) {
        bool called = false;
        for (std::uint32_t material = 0; material < scene.materials.size(); ++material)
            called = called || (effect.called_for(scene.materials[material]) && scene.uses(material));
        if (called == called_for)
            out.emplace_back(effect.name);
    }
    for (const std::string_view kind : space_kinds) {
        const bool called = std::any_of(scene.effects.begin(), scene.effects.end(),
                                        [kind](const SpaceEffect& effect) { return effect.kind() == kind; });
        if (called == called_for)
            out.emplace_back(kind);
    }
    return out;
}

} // namespace

std::vector<std::string> Scene::effects_called_for() const
{
    return effects_of(*this, true);
}

std::vector<std::string> Scene::effects_not_called_for() const
{
    return effects_of(*this, false);
}

} // namespace phantom::scene
