// SPDX-License-Identifier: GPL-2.0-or-later
// What `fdhctl load` learns from the servo's records: totals, and a trace file if one is wanted.
#pragma once

#include <cstdint>
#include <optional>

#include "base/output_file.hpp"
#include "feeder/session.hpp"

namespace phantom::fdhctl {

class TouchRecord {
  public:
    struct Totals {
        std::uint64_t ticks = 0, contact_ticks = 0, inside_ticks = 0, uncovered_ticks = 0;
        std::uint64_t lost = 0; ///< records that were not read in time, or periods that the servo missed
        double force_max_n = 0;
    };

    /// trace: its file, or nothing.
    explicit TouchRecord(std::optional<OutputFile> trace) : trace_(std::move(trace)) {}

    Status begin();
    /// Reads what the servo recorded since the last call.
    Status collect(feeder::Session& session);
    Status commit();
    [[nodiscard]] const Totals& totals() const { return totals_; }

  private:
    void count(const phantom_tick& tick);

    std::optional<OutputFile> trace_;
    Totals totals_;
    std::uint64_t first_ns_ = 0;
    std::uint64_t last_tick_ = 0;
    std::uint64_t last_set_ = 0;
};

} // namespace phantom::fdhctl
