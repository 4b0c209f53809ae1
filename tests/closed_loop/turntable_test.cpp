// SPDX-License-Identifier: GPL-2.0-or-later
// What moves, with an arm and a hand in the loop: a turntable carries a resting tip, or slides below a held
// one.
#include <numbers>

#include "moving.hpp"
#include "study/arm.hpp"

namespace phantom::test {
namespace {

constexpr double turn_rad_s = 4 * std::numbers::pi; // 2 rev/s
constexpr double friction_n_mm = 1;                 // of the spring to the stick point

class Turntable : public MovingTest {
  protected:
    /// The disc turns about the scene's z; sets come at 250 Hz.
    void turn(const Feel& what, const study::Arm& of, const study::Hand& by, double rad_s = turn_rad_s,
              std::uint32_t hz = 1000)
    {
        pose = [=](double t) {
            Pose out;
            out.turn = turn_about({0, 0, 1}, rad_s * t);
            out.about = {0, 0, rad_s};
            return out;
        };
        every = hz / 250;
        arm = of;
        hand = by;
        actuator = {};
        begin(arm.read(), what, hz);
        servo = tick(arm.read());
        work_n_mm = 0;
    }
    void pass()
    {
        servo = tick(arm.read());
        work_n_mm += study::pass_period(arm, hand, actuator, servo, double(period_ns) * 1e-9, true);
    }
    /// Where the tip is on the disc.
    [[nodiscard]] Place on_disc() const
    {
        Turn back = pose(time()).turn;
        back[3] = -back[3];
        return turned(back, arm.at);
    }

    study::Arm arm;
    study::Hand hand;
    study::Actuator actuator;
    Place servo{};
    double work_n_mm = 0;
};

/// Pressed on with 1 N by a soft hand that would rather be beside the axis: the disc carries it round.
TEST_F(Turntable, CarriesARestingTipWithoutDriftOrBuzz)
{
    for (const double step_mm : {0.0, 0.055}) {
        for (const std::uint32_t hz : {1000u, 4000u}) {
            study::Arm resting;
            resting.at = {10, 0, 2};
            resting.step_mm = step_mm;
            study::Hand soft;
            soft.spring_n_mm = 0.02;
            soft.target = {5, 0, 2 - 50};
            turn({.friction = friction(0.8, 0.6, friction_n_mm)}, resting, soft, turn_rad_s, hz);
            for (double t = 0; t < 1; t += 1.0 / hz)
                pass();
            const int revolution = int(hz / 2);
            const Place start = on_disc();
            Place before = servo;
            double largest_step = 0, farthest = 0, turned_n_mm = work_n_mm;
            for (int i = 0; i < 20 * revolution; ++i) {
                pass();
                largest_step = std::max(largest_step, length(minus(servo, before)));
                farthest = std::max(farthest, length(minus(on_disc(), start)));
                before = servo;
            }
            const Place end = on_disc();
            turned_n_mm = work_n_mm - turned_n_mm;
            // that part of the hand's pull goes round, as seen from the disc: the spring gives way by it
            const double give = soft.spring_n_mm * 5 / friction_n_mm;
            EXPECT_LT(length(minus(end, start)), 0.01 + step_mm) << hz << " Hz, after 20 turns";
            EXPECT_LT(farthest, 2 * give + 2 * step_mm + 0.02) << hz;
            EXPECT_GT(farthest, give) << hz;
            EXPECT_NEAR(std::hypot(end[0], end[1]), 10, 0.5);
            // at most what the forces turn by in a tick, and an encoder's step in each spring
            const double turns = 0.4 * turn_rad_s / hz;
            EXPECT_LT(largest_step, turns + 2e-3 + 2 * step_mm * friction_n_mm)
                << hz << " Hz, step " << step_mm;
            // what the disc gives is what the arm's own friction takes on the way round
            const double way = 20 * 2 * std::numbers::pi * 10;
            const double taken =
                way * (arm.coulomb_n + (arm.viscous_ns_mm + hand.damper_ns_mm) * turn_rad_s * 10);
            EXPECT_NEAR(turned_n_mm, taken, 0.05 * taken) << hz << " Hz, step " << step_mm;
        }
    }
}

/// Held by the hand: the disc slides below it, and pulls with what friction gives.
TEST_F(Turntable, SlidesBelowAHeldTipWithoutChatter)
{
    study::Arm held;
    held.at = {10, 0, 2};
    held.step_mm = 0;
    study::Hand firm;
    firm.spring_n_mm = 1;
    firm.damper_ns_mm = 0.01;
    firm.target = {10, 0, 2 - 1};
    turn({.friction = friction(0.5, 0.5, friction_n_mm)}, held, firm);
    for (int i = 0; i < 1000; ++i)
        pass();
    double least = 1e9, most = 0, fastest = 0;
    for (int i = 0; i < 4000; ++i) {
        pass();
        const double across = std::hypot(servo[0], servo[1]);
        least = std::min(least, across / servo[2]);
        most = std::max(most, across / servo[2]);
        fastest = std::max(fastest, length(arm.velocity));
    }
    EXPECT_NEAR(least, 0.5, 2e-3);
    EXPECT_NEAR(most, 0.5, 2e-3);
    EXPECT_LT(fastest, 0.5) << "mm/s";
    EXPECT_GT(servo[1], 0.4) << "the way that the disc goes there";
    EXPECT_LT(arm.at[1], 1);
}

/// A disc that rocks about its axis, +-0.5 rad at 2 Hz: sets correct what its extrapolation overshoots.
class Rocking : public Turntable {
  protected:
    /// The largest step of the force in a tick, N, with a set each so many ticks.
    double largest_step(std::uint64_t ticks_a_set)
    {
        study::Arm resting;
        resting.at = {10, 0, 2};
        resting.step_mm = 0;
        study::Hand soft;
        soft.spring_n_mm = 0.02;
        soft.target = {10, 0, 2 - 50};
        turn({.friction = friction(0.8, 0.6, friction_n_mm)}, resting, soft, 0);
        every = ticks_a_set;
        const double from = time();
        pose = [=](double t) {
            const double phase = omega * (t - from), ramp = std::min(1.0, t - from); // from rest
            const double rate = ramp * omega * std::cos(phase) + (ramp < 1 ? std::sin(phase) : 0);
            Pose out;
            out.turn = turn_about({0, 0, 1}, ramp * swing_rad * std::sin(phase));
            out.about = {0, 0, swing_rad * rate};
            return out;
        };
        for (int i = 0; i < 2000; ++i)
            pass();
        const Place start = on_disc();
        Place before = servo;
        double largest = 0;
        for (int i = 0; i < 10'000; ++i) {
            pass();
            largest = std::max(largest, length(minus(servo, before)));
            before = servo;
        }
        EXPECT_LT(length(minus(on_disc(), start)), 0.02) << "it goes along, for 10 s";
        return largest;
    }

    static constexpr double swing_rad = 0.5, omega = turn_rad_s;
};

TEST_F(Rocking, FeelsNoStepFromSetToSet)
{
    const double smooth = largest_step(1), fed = largest_step(4);
    // 5 ms late, the disc is 10 mm from the axis by a dt^2 / 2 beside the pose of the set: 10 um
    const double correction = friction_n_mm * 10 * swing_rad * omega * omega * 5e-3 * 5e-3 / 2;
    EXPECT_LT(fed, smooth + correction / 4 + 1e-3) << "a quarter of it in each tick, not all in one";
}

} // namespace
} // namespace phantom::test
