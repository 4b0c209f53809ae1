// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/levels.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "mesh/simplify_chain.hpp"
#include "scene/cache.hpp"

namespace phantom::scene {

namespace {

using Clock = std::chrono::steady_clock;

/// One object alone, covered by its own triangles only.
Coverage coverage_alone(const Scene& scene, const Object& object, std::uint32_t budget)
{
    Scene alone;
    alone.materials = scene.materials;
    alone.objects.push_back(object);
    return measure_coverage(alone, build_tree<14>(alone), budget);
}

/// The object's chain, finest first, without the object itself.
std::vector<Surface> chain_of(const Scene& scene, const Object& object, const fdh::TriangleTree<14>& tree,
                              const LevelOptions& options)
{
    std::vector<Surface> out;
    const double radius_mm = scene.max_radius_mm(object);
    const double needed_mm = reach_needed_mm(radius_mm, options.speed_mm_s, options.delay_s);
    const auto enough = [&](const Surface& surface) {
        Object at = object;
        static_cast<Surface&>(at) = surface;
        return surface.mesh.faces.size() <= options.budget ||
               coverage_alone(scene, at, options.budget).p1_mm >= needed_mm;
    };
    Surface finest = static_cast<const Surface&>(object);
    finest.tree = tree;
    if (enough(finest))
        return out;
    std::optional<CacheKey> key;
    if (options.cache && object.cache_key) {
        key = derived_key(*object.cache_key,
                          fmt::format("levels {} {:a} {:a}", options.budget, needed_mm, options.edge_max_mm));
        if (auto kept = open_chain(*options.cache, *key))
            return std::move(*kept);
    }
    mesh::ChainOptions chain;
    chain.edge_max_mm = options.edge_max_mm;
    chain.threads = options.threads;
    chain.cancelled = options.cancelled;
    chain.enough = [&](const mesh::ChainLevel& level) {
        out.push_back({level.mesh, mesh::make_fans(level.mesh), mesh::make_rims(level.mesh, radius_mm),
                       level.error_mm, level.tree});
        return enough(out.back());
    };
    mesh::simplify_chain(object.mesh, tree, chain);
    const bool whole = !options.cancelled || !options.cancelled();
    // The next session builds it again if it cannot be kept: nobody waits for it.
    if (key && whole)
        (void)keep_chain(*options.cache, *key,
                         std::filesystem::absolute(object.file).string() + ", levels of detail", out);
    return out;
}

/// Every object at that place of its chain, or at its last.
Level level_of(const Scene& scene, const fdh::SceneTree<14>& tree,
               const std::vector<std::vector<Surface>>& chains, std::size_t number)
{
    Level level;
    level.scene = scene;
    std::uint32_t first_face = 0, first_vertex = 0;
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
        Object& object = level.scene.objects[i];
        const std::vector<Surface>& chain = chains[i];
        if (chain.empty()) {
            object.tree = tree.tree(i);
        } else {
            static_cast<Surface&>(object) = chain[std::min(number, chain.size()) - 1];
            level.error_mm = std::max(level.error_mm, object.error_mm);
        }
        object.first_face = first_face;
        object.first_vertex = first_vertex;
        first_face += static_cast<std::uint32_t>(object.mesh.faces.size());
        first_vertex += static_cast<std::uint32_t>(object.mesh.vertices.size());
    }
    level.tree = build_tree<14>(level.scene);
    return level;
}

} // namespace

std::optional<LevelWish> level_wish(const std::string& word)
{
    std::optional<LevelWish> wish;
    std::uint32_t number = 0;
    const char* last = word.data() + word.size();
    const auto [end, error] = std::from_chars(word.data(), last, number);
    const bool is_number = !word.empty() && error == std::errc() && end == last;
    if (word != "auto" && word != "off" && !is_number)
        return wish;
    wish.emplace();
    wish->on = word != "off";
    if (is_number)
        wish->fixed.emplace(number);
    return wish;
}

const Coverage& Levels::coverage(std::size_t level) const
{
    return level == 0 ? finest : coarser[level - 1].coverage;
}

double Levels::error_mm(std::size_t level) const
{
    return level == 0 ? 0.0 : coarser[level - 1].error_mm;
}

Levels build_levels(const Scene& scene, const fdh::SceneTree<14>& tree, const LevelOptions& options)
{
    const auto begin = Clock::now();
    Levels levels;
    levels.finest = measure_coverage(scene, tree, options.budget);
    std::vector<std::vector<Surface>> chains(scene.objects.size());
    std::size_t longest = 0;
    // What the whole covers is no more than what its objects do.
    if (levels.finest.p1_mm < reach_needed_mm(scene.max_radius_mm(), options.speed_mm_s, options.delay_s)) {
        for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
            // What deforms has no levels: they would have to deform alike.
            if (scene.objects[i].deformation)
                continue;
            chains[i] = chain_of(scene, scene.objects[i], tree.tree(i), options);
            longest = std::max(longest, chains[i].size());
        }
    }
    for (std::size_t number = 1; number <= longest; ++number) {
        Level level = level_of(scene, tree, chains, number);
        level.coverage = measure_coverage(level.scene, level.tree, options.budget);
        levels.coarser.push_back(std::move(level));
    }
    levels.build_ms = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    return levels;
}

} // namespace phantom::scene
