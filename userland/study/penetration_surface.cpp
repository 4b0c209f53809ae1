// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/penetration_surface.hpp"

#include <algorithm>
#include <utility>

#include "mesh/hausdorff.hpp"
#include "scene/coverage.hpp"

namespace phantom::study {

namespace {

/// Of the distance between two levels, each way.
constexpr std::size_t samples = 15000;

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

double distance_mm(const mesh::Mesh& a, const fdh::TriangleTree<14>& tree_a, const mesh::Mesh& b,
                   const fdh::TriangleTree<14>& tree_b)
{
    return std::max(mesh::one_sided_hausdorff_mm(a, b, tree_b, samples),
                    mesh::one_sided_hausdorff_mm(b, a, tree_a, samples));
}

} // namespace

Result<PenetrationSurface> PenetrationSurface::finest_of(unsigned frequency)
{
    Result<mesh::Mesh> mesh = bumpy_sphere(frequency);
    if (!mesh)
        return mesh.error();
    PenetrationSurface surface;
    surface.frequencies_.push_back(frequency);
    surface.scene_ = std::make_unique<scene::Scene>(soft_scene(std::move(*mesh)));
    surface.tree_ = scene::build_tree<14>(*surface.scene_);
    surface.oracle_ = std::make_unique<BruteForce>(surface.scene_->objects[0].mesh);
    return surface;
}

Result<PenetrationSurface> PenetrationSurface::build(const std::vector<unsigned>& frequencies,
                                                     std::uint32_t budget)
{
    Result<PenetrationSurface> surface = finest_of(frequencies.at(0));
    if (!surface)
        return surface;
    scene::Levels levels;
    levels.finest = scene::measure_coverage(*surface->scene_, surface->tree_, budget);
    for (std::size_t i = 1; i < frequencies.size(); ++i) {
        Result<mesh::Mesh> mesh = bumpy_sphere(frequencies[i]);
        if (!mesh)
            return mesh.error();
        scene::Level level;
        level.scene = soft_scene(std::move(*mesh));
        level.tree = scene::build_tree<14>(level.scene);
        level.coverage = scene::measure_coverage(level.scene, level.tree, budget);
        level.error_mm = distance_mm(surface->scene_->objects[0].mesh, surface->tree_.tree(0),
                                     level.scene.objects[0].mesh, level.tree.tree(0));
        levels.coarser.push_back(std::move(level));
        surface->frequencies_.push_back(frequencies[i]);
    }
    surface->levels_ = std::make_shared<const scene::Levels>(std::move(levels));
    return surface;
}

Result<PenetrationSurface> PenetrationSurface::simplified(unsigned frequency, double speed_mm_s,
                                                          double delay_s, std::uint32_t budget)
{
    Result<PenetrationSurface> surface = finest_of(frequency);
    if (!surface)
        return surface;
    surface->levels_ = std::make_shared<const scene::Levels>(scene::build_levels(
        *surface->scene_, surface->tree_, {.budget = budget, .speed_mm_s = speed_mm_s, .delay_s = delay_s}));
    return surface;
}

} // namespace phantom::study
