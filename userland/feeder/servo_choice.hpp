// SPDX-License-Identifier: GPL-2.0-or-later
// What the servo shall run: the command line's words over the scene's over the defaults.
#pragma once

#include <cstdint>

#include "base/result.hpp"
#include "phantom_abi.h"
#include "scene/scene.hpp"

namespace phantom::feeder {

inline constexpr std::uint32_t default_rate_hz = 1000;
inline constexpr int default_newton_steps = 2;

/// Defaults: projected, 2 of its steps, bounded, float; proxy constrained where `features`
/// (phantom_info) offers it, else paper. Fails for an unknown word, listing the known ones.
Result<phantom_model> choose_model(const scene::ServoSettings& asked, const scene::ServoSettings& scene,
                                   std::uint64_t features);

/// `now` with the words that `asked` has; without any of them it stays what it is.
Result<phantom_model> change_model_words(const phantom_model& now, const scene::ServoSettings& asked);

/// Fails outside PHANTOM_RATE_MIN_HZ ... PHANTOM_RATE_MAX_HZ.
Result<std::uint32_t> choose_rate(const scene::ServoSettings& asked, const scene::ServoSettings& scene);

/// The scene's [device] limits and [servo] crossfade where `asked` has a zero.
phantom_start choose_start(const phantom_start& asked, const scene::DeviceSettings& scene,
                           const scene::ServoSettings& servo);

} // namespace phantom::feeder
