// SPDX-License-Identifier: GPL-2.0-or-later
// The keys motion and deform of an [[object]]. Private to the scene unit.
#pragma once

#include <optional>
#include <string>

#include "scene/deformation.hpp"
#include "scene/motion.hpp"
#include "scene/toml_reader.hpp"

namespace phantom::scene {

/// path: "object 1: ". Nothing where the key is absent or at fault. rest: where the object stands, which is a
/// turntable's centre if none is given.
std::optional<Motion> read_motion(TomlReader& object, const std::string& path, const Vec3& rest_mm,
                                  Faults& faults);
std::optional<Deformation> read_deformation(TomlReader& object, const std::string& path, Faults& faults);

} // namespace phantom::scene
