// SPDX-License-Identifier: GPL-2.0-or-later
// Drives the simulated device along a path in real time.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "device/device.hpp"
#include "feeder/path.hpp"

namespace phantom::feeder {

/// Moves the tip once a period. A hand does not jump when the computer stalls: a late wake-up makes the path
/// later by what was lost, it skips nothing.
class PathPlayer {
  public:
    /// Both must outlive the player. Begins at once with the path's first row.
    PathPlayer(device::Device& device, const Path& path, std::uint32_t rate_hz);
    ~PathPlayer(); ///< stops where it is

    /// The last row was reached, or the device refused to move.
    [[nodiscard]] bool finished() const { return finished_; }
    /// By how much the path is late, in s.
    [[nodiscard]] double late_s() const { return late_s_; }

  private:
    void play(const std::stop_token& stop);

    device::Device& device_;
    const Path& path_;
    std::uint32_t rate_hz_;
    std::atomic<bool> finished_{false};
    std::atomic<double> late_s_{0.0};
    std::jthread thread_;
};

} // namespace phantom::feeder
