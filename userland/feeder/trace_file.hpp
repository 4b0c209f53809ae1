// SPDX-License-Identifier: GPL-2.0-or-later
// Traces: one row per servo tick, CSV, numbers with 9 significant digits.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "phantom_abi.h"

namespace phantom::feeder {

inline constexpr const char* trace_header =
    "time_s,x_mm,y_mm,z_mm,fx_N,fy_N,fz_N,contacts,inside,vx_mm,vy_mm,vz_mm,set_id,query_us,tick_ns";

struct TraceRow {
    double time_s = 0;
    std::array<double, 3> tip_mm{};
    std::array<double, 3> force_n{};
    std::uint32_t contacts = 0;
    bool inside = false;
    std::array<double, 3> proxy_mm{}; ///< = tip_mm outside
    std::uint64_t set_id = 0;         ///< 0: the force came from no set
    double query_us = 0;              ///< of the hull query before this tick; 0: none was made
    double tick_ns = 0;
    std::uint32_t flags = 0; ///< PHANTOM_TICK_...; not a column
};

/// A tick's record at a time. Times are not in it: query_us stays 0.
TraceRow trace_row(const phantom_tick& tick, double time_s);

/// Appends one line.
void append_trace_row(std::string& text, const TraceRow& row);

} // namespace phantom::feeder
