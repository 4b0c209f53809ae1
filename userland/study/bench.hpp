// SPDX-License-Identifier: GPL-2.0-or-later
// How fast the parts are on a scene and this machine.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "feeder/session.hpp"
#include "study/distribution.hpp"
#include "study/tick_cost.hpp"

namespace phantom::study {

struct BenchOptions {
    std::filesystem::path scene;
    scene::LoadOptions load;
    std::uint32_t budget = 64;
    std::size_t queries = 20000;
    std::function<void(double)> progress{};
};

/// One model and instruction set.
struct NamedTickCost {
    std::string model;
    TickCost cost;
};

struct BenchReport {
    std::uint64_t triangles = 0;
    std::uint64_t tree_bytes = 0;
    unsigned threads = 0;
    double build_one_mtri_s = 0, build_all_mtri_s = 0;
    Distribution walk_us, jump_us; ///< queries: along the surface; anywhere near it
    Distribution feed_us;          ///< query, set and its submission, along the surface
    std::vector<NamedTickCost> ticks;
    double read_prepare_ms = 0, build_ms = 0, first_force_ms = 0; ///< of a whole session, user mode
};

Result<BenchReport> run_bench(const BenchOptions& options);

} // namespace phantom::study
