// SPDX-License-Identifier: GPL-2.0-or-later
// The last minute of a running device, for the chart.
#pragma once

#include <cstdint>
#include <deque>
#include <span>

#include "phantom_abi.h"
#include "view/touch.hpp"

namespace phantom::view {

/// What the status page says of this moment; time from start_ns on.
Touch touch_of(const phantom_status& status, std::uint64_t start_ns);

class History {
  public:
    /// Appends records of ticks; of each millisecond the strongest is kept, and the last minute.
    void append(std::span<const phantom_tick> ticks);

    [[nodiscard]] const std::deque<Touch>& samples() const { return samples_; }
    [[nodiscard]] double max_force_n() const { return max_force_n_; }
    [[nodiscard]] std::uint64_t ticks() const { return ticks_; }
    /// Time of the first record, ns; 0 before it.
    [[nodiscard]] std::uint64_t start_ns() const { return start_ns_; }

  private:
    std::deque<Touch> samples_;
    std::uint64_t start_ns_ = 0, ticks_ = 0;
    double max_force_n_ = 0; ///< since the beginning
};

} // namespace phantom::view
