// SPDX-License-Identifier: GPL-2.0-or-later
// [device] of a scene file. Private to the scene unit.
#pragma once

#include "scene/device_settings.hpp"
#include "scene/toml_reader.hpp"

namespace phantom::scene {

DeviceSettings read_device(const toml::table& table, Faults& faults);

} // namespace phantom::scene
