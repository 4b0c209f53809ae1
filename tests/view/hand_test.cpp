// SPDX-License-Identifier: GPL-2.0-or-later
// The hand against a wall: a half space z < 0 with a shell of R = 1 mm, whose force comes late.
#include "view/hand.hpp"

#include <algorithm>
#include <deque>

#include <gtest/gtest.h>

namespace phantom::view {
namespace {

constexpr double radius_mm = 1;

Vec3 wall_force(double stiffness_n_mm, const Vec3& tip_mm)
{
    return {0, 0, stiffness_n_mm * std::max(0.0, radius_mm - tip_mm[2])};
}

class HandOnWall : public testing::TestWithParam<double> {};

TEST_P(HandOnWall, RestsWhereSpringAndSurfaceBalanceAndNeverGoesDeeper)
{
    const double k = GetParam();
    HandSettings settings;
    settings.contact_n_mm = k;
    Hand hand(settings, {0, 0, 5});
    hand.set_target({0, 0, -2});
    // K (z - target) = k (R - z)
    const double spring = settings.spring_n_mm();
    const double rest_mm = (k * radius_mm + spring * -2) / (k + spring);

    constexpr double dt_s = 0.001;
    const auto delay = static_cast<std::size_t>(settings.longest_delay_s / dt_s);
    std::deque<Vec3> late(delay, Vec3{});
    double deepest_mm = 5;
    for (int i = 0; i < 3000; ++i) {
        const Vec3 tip = hand.step(dt_s, late.front());
        deepest_mm = std::min(deepest_mm, tip[2]);
        late.pop_front();
        late.push_back(wall_force(k, tip));
    }
    EXPECT_NEAR(hand.tip_mm()[2], rest_mm, 1e-6);
    // It arrives with speed while the force is late: that much deeper, and no oscillation.
    const double late_mm = settings.longest_delay_s * spring * (radius_mm + 2) / settings.damping_ns_mm();
    EXPECT_GE(deepest_mm, rest_mm - late_mm);
}

INSTANTIATE_TEST_SUITE_P(Stiffnesses, HandOnWall, testing::Values(0.05, 1.0, 20.0));

TEST(Hand, IsNeverFasterThanAHand)
{
    Hand hand({}, {0, 0, 0});
    hand.set_target({1000, 0, 0});
    for (int i = 0; i < 100; ++i) {
        const Vec3 before = hand.tip_mm();
        hand.step(0.001, {500, 0, 0});
        EXPECT_LE(length(hand.tip_mm() - before), HandSettings{}.max_speed_mm_s * 0.001 * (1 + 1e-12));
    }
}

TEST(Hand, WithoutForceItComesToTheTargetWithoutOvershoot)
{
    Hand hand({}, {0, 0, 0});
    hand.set_target({3, -4, 0});
    double left_mm = 5;
    for (int i = 0; i < 4000; ++i) {
        hand.step(0.001, {});
        const double now_mm = length(hand.target_mm() - hand.tip_mm());
        EXPECT_LE(now_mm, left_mm);
        left_mm = now_mm;
    }
    EXPECT_LT(left_mm, 1e-6);
}

} // namespace
} // namespace phantom::view
