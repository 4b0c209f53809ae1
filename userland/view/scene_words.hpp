// SPDX-License-Identifier: GPL-2.0-or-later
// A scene in words.
#pragma once

#include <string>

#include "scene/scene.hpp"

namespace phantom::view {

/// 69666 as "69,666".
std::string grouped(std::uint64_t number);

/// "69,666 triangles · 120 × 119 × 93 mm"
std::string scene_size_text(const scene::Scene& scene);

} // namespace phantom::view
