// SPDX-License-Identifier: GPL-2.0-or-later
// A trace: one row per servo tick, as `fdhctl trace` writes it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/result.hpp"
#include "view/touch.hpp"

namespace phantom::view {

/// The first line of a trace file, exactly.
inline constexpr const char* trace_header =
    "time_s,x_mm,y_mm,z_mm,fx_N,fy_N,fz_N,contacts,inside,vx_mm,vy_mm,vz_mm,set_id,query_us,tick_ns";

struct Trace {
    std::filesystem::path file;
    std::vector<Touch> rows; ///< at least one, times ascending

    /// Index of the first row with the largest |F|.
    [[nodiscard]] std::size_t strongest() const;
    [[nodiscard]] double max_force_n() const;
};

/// Reads a whole trace or nothing. Errors name file:line and what was expected: missing or empty
/// file, another header, a wrong number of fields, a field that is no finite number, contacts that are no
/// count, inside that is not 0 or 1, time that runs backward, no rows.
Result<Trace> read_trace(const std::filesystem::path& file);

} // namespace phantom::view
