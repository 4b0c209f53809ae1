// SPDX-License-Identifier: GPL-2.0-or-later
// What a servo tick costs on this machine, with sets of a given scene.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "base/result.hpp"
#include "base/vector.hpp"
#include "device/device.hpp"
#include "fdh/scene_tree.hpp"
#include "phantom_abi.h"
#include "scene/scene.hpp"
#include "study/distribution.hpp"

namespace phantom::study {

/// Points half a contact radius above the middles of faces spread over the scene. Repeatable.
std::vector<Vec3> points_near_surface(const scene::Scene& scene, std::size_t count, std::uint64_t seed);

/// Positions round a point, a small step apart.
std::vector<Vec3> wander(const Vec3& around, std::mt19937_64& random);

/// One tick at each of the positions, on a virtual clock; adds the ns of each.
Status time_whole_ticks(device::Device& device, const std::vector<Vec3>& tips, std::vector<double>& samples);

/// What a tick may be computed with here (PHANTOM_ISA_...): float32, the best first, and FIXED.
std::vector<std::uint32_t> tick_sections();

/// User mode on a virtual clock, with that model in the arithmetic of one of tick_sections().
Result<device::Device> open_to_measure(phantom_model model, std::uint32_t isa);

struct TickCost {
    std::uint32_t isa = PHANTOM_ISA_NONE;
    std::uint32_t patches = 0; ///< in the sets, at most
    double contacts = 0;       ///< per tick, on average
    Distribution float_ns;     ///< the section alone: contact, proxy, effects
    Distribution stacked_ns;   ///< the same where as many patches lie over one another, all in contact
    std::size_t set_bytes = 0; ///< of as many patches, with what a tick writes
    Distribution tick_ns;      ///< the whole tick, stepped from outside on a virtual clock
    Distribution prepare_us;   ///< converting one set, all its float sections
};

/// Sets of `budget` triangles round points near the surface; in each the tip moves by small steps in
/// contact. isa: one of tick_sections(), else it fails.
Result<TickCost> measure_tick(const scene::Scene& scene, const fdh::SceneTree<14>& tree, phantom_model model,
                              std::uint32_t isa, std::uint32_t budget);

} // namespace phantom::study
