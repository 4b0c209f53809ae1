// SPDX-License-Identifier: GPL-2.0-or-later
// The hand in a thread of its own, at about 1 kHz: pictures take too long to hold an arm between them.
#pragma once

#include <mutex>
#include <optional>
#include <thread>

#include "device/device.hpp"
#include "view/hand.hpp"

namespace phantom::view {

class HandThread {
  public:
    /// Holds the simulated device's arm from where its tip is. The device must outlive this.
    HandThread(device::Device& device, const HandSettings& settings, const Vec3& tip_mm);
    ~HandThread();

    void set_target(const Vec3& target_mm);
    [[nodiscard]] Vec3 target_mm() const;
    [[nodiscard]] Vec3 tip_mm() const;
    /// Why the arm could not be moved; the thread has ended then.
    [[nodiscard]] std::optional<Error> failure() const;

  private:
    void run(const std::stop_token& stop);

    device::Device& device_;
    mutable std::mutex mutex_; ///< protects hand_ and failure_
    Hand hand_;
    std::optional<Error> failure_;
    std::jthread thread_; ///< last: uses all of the above
};

} // namespace phantom::view
