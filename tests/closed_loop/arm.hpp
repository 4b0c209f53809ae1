// SPDX-License-Identifier: GPL-2.0-or-later
// The servo with a hand and an arm in the loop. mm, N, s, kg.
#pragma once

#include <cstdint>

#include "effects.hpp"
#include "study/arm.hpp"

namespace phantom::test {

using study::Arm;
using study::Hand;

/// The loop: read, tick, force held for a period.
class LoopTest : public EffectTest {
  protected:
    void begin(const Feel& what, const Arm& of, std::uint32_t hz = 1000)
    {
        arm = of;
        actuator = {};
        hand.target = arm.at;
        hand.target_velocity = {};
        period_s = 1.0 / hz;
        work_n_mm = 0;
        feel(what, arm.read(), {.rate_hz = hz});
        step(hz / 40); // the force has faded in
        servo = force(arm.read());
    }

    /// One period.
    void tick()
    {
        servo = force(arm.read());
        work_n_mm += study::pass_period(arm, hand, actuator, servo, period_s, held);
    }
    void run(double seconds)
    {
        for (double t = 0; t < seconds; t += period_s)
            tick();
    }

    Arm arm;
    Hand hand;
    study::Actuator actuator;
    bool held = true;
    Place servo{};        ///< N, of the last tick
    double work_n_mm = 0; ///< what the servo has done to the arm
    double period_s = 1e-3;
};

} // namespace phantom::test
