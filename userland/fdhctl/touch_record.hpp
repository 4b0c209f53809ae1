// SPDX-License-Identifier: GPL-2.0-or-later
// What is learnt from a servo's records while it runs: totals, and a file of the ticks if one is wanted.
#pragma once

#include <cstdint>
#include <optional>

#include "fdhctl/tick_file.hpp"

namespace phantom::fdhctl {

class TouchRecord {
  public:
    struct Totals {
        std::uint64_t ticks = 0, contact_ticks = 0, inside_ticks = 0, uncovered_ticks = 0;
        std::uint64_t lost = 0; ///< records that were not read in time, or periods that the servo missed
        double force_max_n = 0;
    };

    /// file: where the ticks go, or nothing.
    explicit TouchRecord(std::optional<TickFile> file) : file_(std::move(file)) {}

    /// As TickFile::begin().
    Status begin(device::Device& device, bool fed, const std::string& scene);
    /// Reads what the servo recorded since the last call.
    Status collect(device::Device& device, const TickFile::QueryTime& query_us);
    Status commit();
    [[nodiscard]] const Totals& totals() const { return totals_; }
    [[nodiscard]] std::string file_text() const { return file_ ? file_->text() : std::string(); }

  private:
    void count(const phantom_tick& tick);

    std::optional<TickFile> file_;
    Totals totals_;
    std::uint64_t last_tick_ = 0;
};

} // namespace phantom::fdhctl
