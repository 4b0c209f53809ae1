// SPDX-License-Identifier: GPL-2.0-or-later
// What each effect that a scene calls for costs on this machine: time of a tick, bytes of a set.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "fdh/scene_tree.hpp"
#include "phantom_abi.h"
#include "scene/scene.hpp"

namespace phantom::study {

struct EffectCost {
    std::string name;
    double tick_ns = 0;        ///< median of whole ticks; of an effect, what it adds to contact alone
    std::size_t set_bytes = 0; ///< of the largest set; of an effect, its tables
};

inline constexpr const char* contact_alone = "contact";

/// Contact alone first, then every effect called for with contact and nothing else. Sets, positions and the
/// virtual clock are those of measure_tick() (tick_cost.hpp).
Result<std::vector<EffectCost>> measure_effects(const scene::Scene& scene, const fdh::SceneTree<14>& tree,
                                                phantom_model model, std::uint32_t isa, std::uint32_t budget);

} // namespace phantom::study
