// SPDX-License-Identifier: GPL-2.0-or-later
// A bumpy sphere as scene and hierarchy, with its coarser levels of detail: the same surface at lower
// frequencies.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/result.hpp"
#include "fdh/scene_tree.hpp"
#include "feeder/level_choice.hpp"
#include "scene/scene.hpp"
#include "study/bumpy_sphere.hpp"

namespace phantom::study {

/// Of every level's material.
inline constexpr double soft_stiffness_n_mm = 0.5;
/// So small that 64 triangles of the finest sphere cover it.
inline constexpr double soft_radius_mm = 0.2;

struct SurfaceLevel {
    unsigned frequency = 0;
    scene::Scene scene; ///< one object
    fdh::SceneTree<14> tree;
    feeder::DetailLevel detail; ///< reach for the surface's budget; error against the finest, by its vertices
};

class PenetrationSurface {
  public:
    /// Frequencies from the finest down, at least one.
    static Result<PenetrationSurface> build(const std::vector<unsigned>& frequencies,
                                            std::uint32_t budget = 64);

    [[nodiscard]] const std::vector<std::unique_ptr<SurfaceLevel>>& levels() const { return levels_; }
    [[nodiscard]] const SurfaceLevel& finest() const { return *levels_.front(); }
    [[nodiscard]] const BruteForce& oracle() const { return *oracle_; } ///< of the finest
    [[nodiscard]] std::uint32_t budget() const { return budget_; }

  private:
    std::vector<std::unique_ptr<SurfaceLevel>> levels_;
    std::unique_ptr<BruteForce> oracle_;
    std::uint32_t budget_ = 0;
};

} // namespace phantom::study
