// SPDX-License-Identifier: GPL-2.0-or-later
// What a proxy does under the surface: the module's own code on a virtual clock, fed by real queries, along a
// path that rubs a bumpy sphere from inside, against the nearest point found by brute force.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "study/bumpy_sphere.hpp"
#include "study/penetration_surface.hpp"

namespace phantom::study {

struct PenetrationOptions {
    SpiralOptions path;
    std::string proxy = "constrained";
    std::uint32_t feed_every = 1; ///< ticks between sets
    /// A set knows the tip of the tick that takes it, as in a trace. Else that of the tick before, and speed
    /// and delay choose the level of detail, as the feeder of a running device has to.
    bool timely = true;
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
    /// Of the sets that ticks under the surface used, by level.
    std::vector<std::uint64_t> level_ticks;
    std::uint64_t level_changes = 0; ///< sets of another level than the one before, under the surface
    std::uint32_t patches_max = 0;
    /// The force, sent, from k (R n + V - P) at the point V of the finest level nearest to the tip P, N.
    double error_p50 = 0, error_p99 = 0, error_max = 0;
    /// Largest step of the force between two ticks, both under the surface, N.
    double step_max = 0;
};

Result<PenetrationResult> run_penetration(const PenetrationSurface& surface,
                                          const PenetrationOptions& options);

} // namespace phantom::study
