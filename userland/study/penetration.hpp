// SPDX-License-Identifier: GPL-2.0-or-later
// What a proxy does under the surface: the module's own code on a virtual clock, fed by real queries, along a
// path that rubs a bumpy sphere from inside, against the nearest point found by brute force.
#pragma once

#include <cstdint>
#include <string>

#include "base/result.hpp"
#include "fdh/scene_tree.hpp"
#include "scene/scene.hpp"
#include "study/bumpy_sphere.hpp"

namespace phantom::study {

struct PenetrationOptions {
    SpiralOptions path;
    std::string proxy = "constrained";
    std::uint32_t budget = 64;    ///< triangles in a set
    bool grow_budget = false;     ///< as the feeder does by default when a set does not cover enough
    std::uint32_t feed_every = 1; ///< ticks between sets. 1: the set knows the tip of its tick, as in a
                                  ///< trace; else it knows the tick before, as the feeder of a running device
    std::uint32_t check_every = 4; ///< ticks between comparisons
};

struct PenetrationResult {
    std::uint64_t ticks = 0;
    std::uint64_t under = 0;        ///< compared ticks with the tip under the surface
    std::uint64_t lost = 0;         ///< of these: no set covered tip and proxy, no force was computed
    std::uint64_t fell_through = 0; ///< of these: taken for outside
    std::uint64_t outside = 0;      ///< compared ticks with the tip over the surface
    std::uint64_t kept = 0;         ///< of these: taken for inside
    std::uint64_t stuck = 0;        ///< proxy farther from the tip than the nearest point by a mm and more
    std::uint32_t patches_max = 0;
    /// Force, N: k times the proxy's distance from the nearest point.
    double error_p50 = 0, error_p99 = 0, error_max = 0;
    /// Largest step of the force between two ticks, both in contact, N.
    double step_max = 0;
};

/// One object with the mesh, k = 0.5 N/mm, and R so small that 64 triangles cover it.
scene::Scene penetration_scene(mesh::Mesh mesh);

Result<PenetrationResult> run_penetration(const scene::Scene& scene, const fdh::SceneTree<14>& tree,
                                          const BruteForce& oracle, const PenetrationOptions& options);

} // namespace phantom::study
