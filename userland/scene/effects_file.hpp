// SPDX-License-Identifier: GPL-2.0-or-later
// [material.NAME.EFFECT] of a scene file. Private to the scene unit.
#pragma once

#include <string>

#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace phantom::scene {

/// Sub-tables of [material.NAME], whose stiffness and radius are known. path: "material.NAME.".
void read_effects(TomlReader& reader, const std::string& path, Faults& faults, Material& material);

} // namespace phantom::scene
