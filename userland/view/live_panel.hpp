// SPDX-License-Identifier: GPL-2.0-or-later
// The words in the corner of the live view.
#pragma once

#include <string>

#include "feeder/feeder.hpp"
#include "phantom_abi.h"
#include "scene/scene.hpp"
#include "view/stage.hpp"

namespace phantom::view {

/// message: one more line for the person, may be empty. hints: tell the keys.
Panel live_panel(const scene::Scene& scene, const phantom_status& status, const feeder::FeedReport& fed,
                 bool switched_off, const std::string& message, bool hints);

} // namespace phantom::view
