// SPDX-License-Identifier: GPL-2.0-or-later
// A device in the loop as a scene's [device] names it: only what is named is simulated. Without a hand the
// tip is where it is led; with one it is led by the hand's spring, and answers the servo's force.
#pragma once

#include <optional>

#include "scene/device_settings.hpp"
#include "study/arm.hpp"

namespace phantom::study {

class DeviceSimulation {
  public:
    /// At rest at that place.
    DeviceSimulation(const scene::DeviceSettings& device, const Vec3& at_mm);

    /// What the servo is told of the tip, when the path is at `led_mm`.
    [[nodiscard]] Vec3 read(const Vec3& led_mm) const;
    /// One period of the servo with this force, while the path goes from one place to the next.
    void pass(const Vec3& force_n, const Vec3& from_mm, const Vec3& to_mm, double period_s);

    /// Of arm and hand together with the hand's spring, N mm; 0 without a hand.
    [[nodiscard]] double energy_n_mm() const;
    /// What the actuator has done to the arm so far, N mm.
    [[nodiscard]] double work_n_mm() const { return work_n_mm_; }

  private:
    Arm arm_;
    std::optional<Hand> hand_;
    Actuator actuator_;
    double work_n_mm_ = 0;
};

} // namespace phantom::study
