// SPDX-License-Identifier: GPL-2.0-or-later
// What is at the other end of the force: an actuator, an arm, and the hand that holds it. mm, N, s, kg.
//
//   command --> Actuator (delay, saturation, bandwidth) --> Arm (mass, friction, encoder) <--> Hand
//
// The tip is a point mass. The hand is a mass that moves with it, and a spring and a damper from it to where
// the hand wants to be (Hajian & Howe 1997; Kuchenbecker, Park & Niemeyer 2003). Every figure that is zero is
// not simulated. Depends on nothing but base/: the closed-loop tests use it beside the module alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>

#include "base/vector.hpp"

namespace phantom::study {

/// As it is, a PHANToM Omni's figures.
struct Arm {
    double mass_kg = 0.045;
    double viscous_ns_mm = 0.0003; ///< of the arm alone
    double coulomb_n = 0.05;       ///< its own dry friction; above K step / 2 an encoder makes no limit cycle
    double step_mm = 0.055;        ///< of the encoder; 0 = exact
    Vec3 at{}, velocity{};         ///< mm, mm/s

    /// Under that force from outside, for that long, with so much of the hand moving along. Velocity first,
    /// then position by the new velocity: the energy of a spring is kept.
    void move(const Vec3& pull_n, double dt, double along_kg = 0)
    {
        const double mass = mass_kg + along_kg;
        for (std::size_t axis = 0; axis < 3; ++axis)
            velocity[axis] += 1e3 * (pull_n[axis] - viscous_ns_mm * velocity[axis]) / mass * dt;
        const double speed = length(velocity), lost = 1e3 * coulomb_n / mass * dt;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            velocity[axis] *= speed > lost ? 1 - lost / speed : 0;
            at[axis] += velocity[axis] * dt;
        }
    }

    /// Where the encoder says it is.
    [[nodiscard]] Vec3 read() const { return stepped(at, step_mm); }

    static Vec3 stepped(Vec3 place, double step_mm)
    {
        if (step_mm > 0)
            for (double& x : place)
                x = std::round(x / step_mm) * step_mm;
        return place;
    }
};

struct Hand {
    double spring_n_mm = 0.3;
    double damper_ns_mm = 0.003;
    double mass_kg = 0;
    Vec3 target{}, target_velocity{};

    [[nodiscard]] Vec3 force(const Arm& arm) const
    {
        return spring_n_mm * (target - arm.at) + damper_ns_mm * (target_velocity - arm.velocity);
    }
};

/// What becomes of a commanded force on its way to the tip.
struct Actuator {
    double delay_s = 0;      ///< from the tick's position to its force
    double max_force_n = 0;  ///< saturation, direction kept; 0 = none
    double bandwidth_hz = 0; ///< of the amplifier, first order; 0 = none

    /// At the begin of a period that is computed in parts of dt.
    void command(const Vec3& force_n, double dt)
    {
        waiting_.push_back({part_ + std::llround(delay_s / dt), force_n});
    }
    /// What the tip feels during the next part.
    const Vec3& drive(double dt)
    {
        for (; !waiting_.empty() && waiting_.front().due <= part_; waiting_.pop_front())
            wanted_ = saturated(waiting_.front().force_n);
        ++part_;
        if (bandwidth_hz > 0)
            given_ = given_ - std::expm1(-two_pi * bandwidth_hz * dt) * (wanted_ - given_);
        else
            given_ = wanted_;
        return given_;
    }

  private:
    static constexpr double two_pi = 6.283185307179586;
    struct Command {
        std::int64_t due; ///< part
        Vec3 force_n;
    };

    [[nodiscard]] Vec3 saturated(const Vec3& force_n) const
    {
        const double size = length(force_n);
        return max_force_n > 0 && size > max_force_n ? max_force_n / size * force_n : force_n;
    }

    std::deque<Command> waiting_;
    std::int64_t part_ = 0; ///< so many were driven
    Vec3 wanted_{}, given_{};
};

/// In how many parts a period is computed: at least 20, and more for what is quick beside it.
inline int parts_of(const Arm& arm, const Hand& hand, double period_s)
{
    constexpr double least = 20, most = 20000, per_part = 0.2; // of the quickest time constant
    const double mass = 1e-3 * (arm.mass_kg + hand.mass_kg);   // N s^2 / mm
    const double quick =
        std::max(std::sqrt(hand.spring_n_mm / mass), (hand.damper_ns_mm + arm.viscous_ns_mm) / mass);
    return static_cast<int>(std::clamp(std::ceil(period_s * quick / per_part), least, most));
}

/// One period of the servo, whose force is held until the next. `held`: by the hand, whose target moves on.
/// Returns the work that the actuator does on the arm, N mm.
inline double pass_period(Arm& arm, Hand& hand, Actuator& actuator, const Vec3& command_n, double period_s,
                          bool held = true)
{
    const int parts = parts_of(arm, hand, period_s);
    const double dt = period_s / parts;
    double work = 0;
    actuator.command(command_n, dt);
    for (int i = 0; i < parts; ++i) {
        const Vec3 before = arm.at, given = actuator.drive(dt);
        const Vec3 pull = held ? hand.force(arm) + given : given;
        hand.target = hand.target + dt * hand.target_velocity;
        arm.move(pull, dt, held ? hand.mass_kg : 0);
        work += dot(given, arm.at - before);
    }
    return work;
}

} // namespace phantom::study
