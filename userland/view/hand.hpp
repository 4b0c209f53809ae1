// SPDX-License-Identifier: GPL-2.0-or-later
// The hand that holds the simulated arm: a spring pulls the tip to where the mouse points, the force of the
// servo pushes it back. So a press deeper gives more force, and the tip rests on the surface as a
// real one does, instead of standing inside it.
#pragma once

#include <numbers>

#include "base/vector.hpp"

namespace phantom::view {

struct HandSettings {
    double contact_n_mm = 1;        ///< stiffness of the surface, N/mm: all else follows from it
    double max_speed_mm_s = 250;    ///< a fast hand; the servo's overspeed fault is at 5 m/s
    double longest_delay_s = 0.005; ///< between a step and the force that answers it

    /// Spring of the hand, softer than the surface: of 7 mm that the mouse goes in, the tip goes 2.
    [[nodiscard]] double spring_n_mm() const { return 0.4 * contact_n_mm; }
    /// Damping, N*s/mm. The loop b x'(t) = -c x(t - T), c = contact + spring, neither oscillates nor
    /// overshoots while c T / b <= 1/e (the delay equation's real root); twice that b is taken.
    [[nodiscard]] double damping_ns_mm() const
    {
        return 2 * std::numbers::e * longest_delay_s * (contact_n_mm + spring_n_mm());
    }
};

class Hand {
  public:
    Hand(const HandSettings& settings, const Vec3& at_mm) : settings_(settings), tip_(at_mm), target_(at_mm)
    {
    }

    void set_target(const Vec3& target_mm) { target_ = target_mm; }
    [[nodiscard]] const Vec3& target_mm() const { return target_; }
    [[nodiscard]] const Vec3& tip_mm() const { return tip_; }

    /// Moves the tip by dt_s under the spring and the servo's force; returns where it is.
    const Vec3& step(double dt_s, const Vec3& force_n);

  private:
    HandSettings settings_;
    Vec3 tip_, target_;
};

} // namespace phantom::view
