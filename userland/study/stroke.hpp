// SPDX-License-Identifier: GPL-2.0-or-later
// A hand's stroke over a scene: the path that the simulated device is driven along.
#pragma once

#include <optional>

#include "base/result.hpp"
#include "fdh/scene_tree.hpp"
#include "feeder/path.hpp"
#include "scene/scene.hpp"

namespace phantom::study {

struct StrokeOptions {
    double seconds = 12.0;
    double rate_hz = 1000.0; ///< rows per second
    /// How deep the tip presses in, straight and back, at a few places of the stroke; 0: it does not. Half
    /// the largest contact radius when not given.
    std::optional<double> depth_mm{};
    /// How high above the surface the sweeps are, negative below it; not given: now higher, now lower,
    /// between 0.1 and 0.8 of the largest contact radius.
    std::optional<double> height_mm{};
    double speed_limit_mm_s = 60.0;
};

/// From above (+z) down to the surface, over it in sweeps, pressing now and then, and away again. It walks on
/// the surface itself: the nearest triangle, found with the hulls, holds it at every step. Smooth in position
/// and speed, at rest at both ends. Fails where nothing of the scene is seen from above.
Result<feeder::Path> make_stroke(const scene::Scene& scene, const fdh::SceneTree<14>& tree,
                                 const StrokeOptions& options);

} // namespace phantom::study
