// SPDX-License-Identifier: GPL-2.0-or-later
// The module's code on a virtual clock: a path in, a row per tick out.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "feeder/feeder.hpp"
#include "feeder/path.hpp"
#include "feeder/trace_file.hpp"
#include "scene/scene.hpp"

namespace phantom::study {

struct TraceOptions {
    scene::ServoSettings servo; ///< word by word over the scene's [servo]
    feeder::FeederOptions feeder;
    std::uint32_t feed_every = 1; ///< a set before every K-th tick
    /// Of detail. A set knows the tip of its tick here, so the finest level does for any speed: they are for
    /// seeing what they cost.
    scene::LevelWish levels{.on = false};
    bool limits = false; ///< clamp, slew, ramp, speed, stall and age of sets as on a real device
    std::uint32_t isa = PHANTOM_ISA_NONE;
    std::function<void(double)> progress{};
};

struct TraceSummary {
    std::string model; ///< as chosen
    std::string isa;
    std::uint64_t ticks = 0, contact_ticks = 0, inside_ticks = 0;
    std::uint64_t uncovered_ticks = 0; ///< no set covered the tip: the force is not the mesh's
    std::uint64_t sets = 0, refused = 0, saturated = 0;
    std::uint32_t patches_max = 0;
    std::vector<std::uint64_t> level_sets; ///< sets of each level
    std::uint64_t level_changes = 0;
    std::vector<double> level_error_mm; ///< of each level from the mesh
    double force_max_n = 0, force_step_max_n = 0;
    double query_median_us = 0, tick_median_ns = 0;
    std::vector<std::string> simulated; ///< of the device: "encoder", "hand", ...
    std::string faults;                 ///< "none"
};

struct TraceRun {
    std::string csv; ///< header and one row per row of the path
    TraceSummary summary;
};

/// One tick per row of the path: the tip moves there, a set is fed for it, the servo ticks. Where the scene's
/// [device] names a hand, the path is where that wants to be, and the tip goes where arm and force let it.
Result<TraceRun> run_trace(const scene::Scene& scene, const feeder::Path& path, const TraceOptions& options);

} // namespace phantom::study
