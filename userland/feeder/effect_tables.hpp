// SPDX-License-Identifier: GPL-2.0-or-later
// A material's effects as the module takes them. Private to the feeder.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.hpp"

namespace phantom::feeder {

/// PHANTOM_EFFECT_... that have a table and that the material names.
std::uint32_t table_effects(const scene::Material& material);

/// The tables of a set with these materials of the scene, in the order of the effects' bits.
std::vector<std::uint64_t> effect_tables(const scene::Scene& scene,
                                         const std::vector<std::uint32_t>& materials);

} // namespace phantom::feeder
