// SPDX-License-Identifier: GPL-2.0-or-later
// An arm and the hand that holds it: what is at the other end of the force. mm, N, s, kg.
#pragma once

#include <cmath>
#include <cstdint>

#include "effects.hpp"

namespace phantom::test {

/// The tip as a point mass; a PHANToM Omni's figures.
struct Arm {
    double mass_kg = 0.045;
    double viscous_ns_mm = 0.0003; ///< of the arm alone
    double coulomb_n = 0.05;       ///< its own dry friction; above K step / 2 an encoder makes no limit cycle
    double step_mm = 0.055;        ///< of the encoder; 0 = exact
    Place at{}, velocity{};        ///< mm, mm/s

    /// Under that force from outside, for that long.
    void move(const Place& pull_n, double dt)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
            velocity[axis] += 1e3 * (pull_n[axis] - viscous_ns_mm * velocity[axis]) / mass_kg * dt;
        const double speed = length(velocity), lost = 1e3 * coulomb_n / mass_kg * dt;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            velocity[axis] *= speed > lost ? 1 - lost / speed : 0;
            at[axis] += velocity[axis] * dt;
        }
    }

    /// Where the encoder says it is.
    [[nodiscard]] Place read() const
    {
        Place out = at;
        if (step_mm > 0)
            for (double& x : out)
                x = std::round(x / step_mm) * step_mm;
        return out;
    }
};

/// A spring and a damper from the tip to where the hand wants it.
struct Hand {
    double spring_n_mm = 0.3;
    double damper_ns_mm = 0.003;
    Place target{}, target_velocity{};

    [[nodiscard]] Place force(const Arm& arm) const
    {
        Place out;
        for (std::size_t axis = 0; axis < 3; ++axis)
            out[axis] = spring_n_mm * (target[axis] - arm.at[axis]) +
                        damper_ns_mm * (target_velocity[axis] - arm.velocity[axis]);
        return out;
    }
};

/// The loop: read, tick, force held for a period.
class LoopTest : public EffectTest {
  protected:
    void begin(const Feel& what, const Arm& of, std::uint32_t hz = 1000)
    {
        arm = of;
        hand.target = arm.at;
        hand.target_velocity = {};
        period_s = 1.0 / hz;
        work_n_mm = 0;
        feel(what, arm.read(), {.rate_hz = hz});
        servo = force(arm.read());
    }

    /// One period.
    void tick()
    {
        constexpr int parts = 20;
        const double dt = period_s / parts;
        const Place before = arm.at;
        servo = force(arm.read());
        for (int i = 0; i < parts; ++i) {
            Place pull = held ? hand.force(arm) : Place{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                pull[axis] += servo[axis];
                hand.target[axis] += hand.target_velocity[axis] * dt;
            }
            arm.move(pull, dt);
        }
        work_n_mm += dot(servo, minus(arm.at, before));
    }
    void run(double seconds)
    {
        for (double t = 0; t < seconds; t += period_s)
            tick();
    }

    Arm arm;
    Hand hand;
    bool held = true;
    Place servo{};        ///< N, of the last tick
    double work_n_mm = 0; ///< what the servo has done to the arm
    double period_s = 1e-3;
};

} // namespace phantom::test
