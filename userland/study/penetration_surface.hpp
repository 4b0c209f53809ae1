// SPDX-License-Identifier: GPL-2.0-or-later
// A bumpy sphere as scene and hierarchy, with coarser levels of detail.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/result.hpp"
#include "fdh/scene_tree.hpp"
#include "scene/levels.hpp"
#include "scene/scene.hpp"
#include "study/bumpy_sphere.hpp"

namespace phantom::study {

/// Of every level's material.
inline constexpr double soft_stiffness_n_mm = 0.5;
/// So small that 64 triangles of the finest sphere cover it.
inline constexpr double soft_radius_mm = 0.2;

class PenetrationSurface {
  public:
    /// The levels are the same surface at lower frequencies, from the finest down, at least one.
    static Result<PenetrationSurface> build(const std::vector<unsigned>& frequencies,
                                            std::uint32_t budget = 64);
    /// The levels are what any mesh gets (scene/levels.hpp), for a tip of that speed and sets that far apart.
    static Result<PenetrationSurface> simplified(unsigned frequency, double speed_mm_s, double delay_s,
                                                 std::uint32_t budget = 64);

    /// By level; only the finest when it is simplified.
    [[nodiscard]] const std::vector<unsigned>& frequencies() const { return frequencies_; }
    [[nodiscard]] const scene::Scene& scene() const { return *scene_; } ///< of the finest; one object
    [[nodiscard]] const fdh::SceneTree<14>& tree() const { return tree_; }
    /// Coverage for the surface's budget; errors against the finest.
    [[nodiscard]] const std::shared_ptr<const scene::Levels>& levels() const { return levels_; }
    [[nodiscard]] const BruteForce& oracle() const { return *oracle_; } ///< of the finest
    [[nodiscard]] std::uint32_t budget() const { return levels_->finest.budget; }

  private:
    static Result<PenetrationSurface> finest_of(unsigned frequency);

    std::vector<unsigned> frequencies_;
    std::unique_ptr<scene::Scene> scene_; ///< stays where it is when the surface is moved
    fdh::SceneTree<14> tree_;
    std::shared_ptr<const scene::Levels> levels_;
    std::unique_ptr<BruteForce> oracle_;
};

} // namespace phantom::study
