// SPDX-License-Identifier: GPL-2.0-or-later
// [material.NAME.EFFECT] and [effect.NAME] of a scene file. Private to the scene unit.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace phantom::scene {

/// Sub-tables of [material.NAME], whose stiffness and radius are known. path: "material.NAME.".
/// scene: the file, where relative paths begin.
void read_surface_effects(TomlReader& reader, const std::string& path, const std::filesystem::path& scene,
                          Faults& faults, Material& material);

/// The table [effect] with its [effect.NAME]. Materials are read before: `fdhctl effect` knows both by name.
void read_space_effects(const toml::table& effects, const std::filesystem::path& scene, Faults& faults,
                        const std::vector<Material>& materials, std::vector<SpaceEffect>& out);

} // namespace phantom::scene
