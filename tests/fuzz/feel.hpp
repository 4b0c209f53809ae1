// SPDX-License-Identifier: GPL-2.0-or-later
// Effects of a set under construction, from one byte of each material: bits 1 to 3 name those of its surface
// (magnet, friction, texture), 4 to 6 those of space (constant, viscosity, guide), bit 7 asks for the most
// that the border lets pass. Pairs call for more: magnet and friction for an impact, friction and texture for
// a height map, constant and viscosity for a field, viscosity and guide for a ball as tip.
#pragma once

#include <cstdint>
#include <vector>

#include "phantom_abi.h"

namespace phantom::fuzz {

/// Of PHANTOM_EFFECTS_SURFACE but damping.
std::uint32_t surface_effects(std::uint8_t feel, std::uint32_t radius_nm);
std::uint32_t space_effects(std::uint8_t feel);

/// The tables of these materials, each with its byte, as they follow the materials.
std::vector<std::uint8_t> effect_tables(const std::vector<phantom_material>& materials,
                                        const std::vector<std::uint8_t>& feels, const __s64 (&origin_nm)[3]);

} // namespace phantom::fuzz
