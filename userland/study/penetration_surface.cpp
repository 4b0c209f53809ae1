// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/penetration_surface.hpp"

#include <algorithm>
#include <utility>

namespace phantom::study {

namespace {

/// Vertices of the finest level that a coarser one is compared with.
constexpr std::size_t vertices_compared = 5000;

scene::Scene soft_scene(mesh::Mesh mesh)
{
    scene::Scene scene;
    scene.materials.push_back({"soft", soft_stiffness_n_mm, soft_radius_mm, {}});
    scene::Object object;
    object.name = "bumpy sphere";
    object.mesh = std::move(mesh);
    scene.objects.push_back(std::move(object));
    return scene;
}

double distance_mm(const mesh::Mesh& finest, const mesh::Mesh& level)
{
    const BruteForce surface(level);
    const std::size_t every = std::max<std::size_t>(1, finest.vertices.size() / vertices_compared);
    double farthest = 0;
    for (std::size_t vertex = 0; vertex < finest.vertices.size(); vertex += every)
        farthest = std::max(farthest, surface.nearest(finest.vertices[vertex]).distance_mm);
    return farthest;
}

} // namespace

Result<PenetrationSurface> PenetrationSurface::build(const std::vector<unsigned>& frequencies,
                                                     std::uint32_t budget)
{
    PenetrationSurface surface;
    surface.budget_ = budget;
    for (const unsigned frequency : frequencies) {
        Result<mesh::Mesh> mesh = bumpy_sphere(frequency);
        if (!mesh)
            return mesh.error();
        auto level = std::make_unique<SurfaceLevel>();
        level->frequency = frequency;
        level->scene = soft_scene(std::move(*mesh));
        level->tree = scene::build_tree<14>(level->scene);
        const mesh::Mesh& own = level->scene.objects[0].mesh;
        level->detail.reach_mm = feeder::measure_reach_mm(own, level->tree.tree(0), budget);
        if (!surface.levels_.empty())
            level->detail.error_mm = distance_mm(surface.finest().scene.objects[0].mesh, own);
        surface.levels_.push_back(std::move(level));
    }
    surface.oracle_ = std::make_unique<BruteForce>(surface.finest().scene.objects[0].mesh);
    return surface;
}

} // namespace phantom::study
