// SPDX-License-Identifier: GPL-2.0-or-later
// Every effect with a hand that presses, strokes and lifts off, at 10 kHz: what the servo does to the arm is
// never more than what the effect's potential falls by, and its force has no step.
//
//   W <= U(begin) - U(now) + sum K |dx|^2 / 2 + what may be given besides; where nothing is taken either, in
//   each tick by itself, to both sides |F - F before| <= K |dx| + B |dv| + J
//
// K is the largest stiffness that the effect states: a force that is held for a period does at most K |dx|^2
// / 2 more than one that follows the tip. B is its largest viscosity, J what it changes by in a period by
// itself.
#include <functional>

#include "arm.hpp"
#include "effect_laws.hpp"

namespace phantom::test {
namespace {

struct Law {
    Feel feel{};
    std::function<double(const Place&)> energy = contact_energy; ///< N mm
    double stiffness = 1;                                        ///< N/mm
    double viscous = 0;                                          ///< N s/mm
    double per_tick = 0;                                         ///< N
    bool conservative = false;                                   ///< nothing is taken either
    double lag = 0; ///< N mm, at a time, of a force that follows a filtered velocity
};

class BalanceLoop : public LoopTest {
  protected:
    static constexpr std::uint32_t hz = 10'000;

    /// Over and into the surface for that long; `given`: what may be done besides, after each tick, N mm.
    void stroke(
        const Law& law, double seconds, const std::function<double()>& given = [] { return 0.0; })
    {
        Arm of;
        of.at = {0, 0, 5};
        of.coulomb_n = of.step_mm = 0;
        begin(law.feel, of, hz);
        const double before = law.energy(arm.at);
        double sampled = 0;
        contacts = 0;
        for (double t = 0; t < seconds; t += period_s) {
            const Place from = arm.at, force_before = servo, speed_before = speed();
            hand.target = {6 * std::sin(two_pi * 0.7 * t), 4 * std::sin(two_pi * 1.1 * t + 1),
                           2 + 3 * std::cos(two_pi * 1.7 * t)};
            const double work_before = work_n_mm;
            tick();
            const double work_of_tick = work_n_mm - work_before;
            // this tick's force came from where the arm was; it is held on the way from there
            const double way = length(minus(arm.at, from)), came = length(minus(from, last_at));
            sampled += 0.5 * law.stiffness * way * way;
            last_at = from;
            contacts += from[2] < contact_radius_mm;
            if (law.conservative) { // in every single tick; the forces are rounded to uN, places to nm
                ASSERT_NEAR(work_of_tick, law.energy(from) - law.energy(arm.at),
                            0.5 * law.stiffness * way * way + 1e-5 * way)
                    << t << " s";
            }
            ASSERT_LE(work_n_mm, before - law.energy(arm.at) + sampled + given() + law.lag + 1e-4)
                << t << " s";
            if (t > 0.01) {
                ASSERT_LE(length(minus(servo, force_before)),
                          law.stiffness * came + law.viscous * length(minus(speed(), speed_before)) +
                              law.per_tick + 2e-5)
                    << t << " s";
            }
        }
        EXPECT_GT(contacts, 0.2 * seconds * hz) << "it touches";
        EXPECT_LT(contacts, 0.8 * seconds * hz) << "and lifts off";
    }

    /// As the servo filters it, mm/s.
    Place speed()
    {
        const auto status = feeder->status();
        return {status.velocity_nm_s[0] * 1e-6, status.velocity_nm_s[1] * 1e-6,
                status.velocity_nm_s[2] * 1e-6};
    }

    Place last_at{0, 0, 5};
    int contacts = 0;
};

TEST_F(BalanceLoop, ContactAlone)
{
    stroke({.conservative = true}, 2);
}

TEST_F(BalanceLoop, Damping)
{
    double least = 0;
    stroke({.feel = {.damping_mns_m = 4000}, .stiffness = 2, .viscous = 4e-3, .lag = 0.02}, 2, [&] {
        least = std::min(least, servo[2]);
        return 0.0;
    });
    EXPECT_EQ(least, 0) << "it never pulls";
    EXPECT_LT(work_n_mm, -0.2) << "it takes";
}

TEST_F(BalanceLoop, Magnet)
{
    const phantom_magnet magnet{500'000, 300'000};
    stroke({.feel = {.magnet = magnet},
            .energy = [&](const Place& at) { return magnet_energy(magnet, at); },
            .stiffness = 4 * 0.3 / 0.5,
            .conservative = true},
           2);
}

TEST_F(BalanceLoop, Friction)
{
    // 2 N/mm, and 0.8 of what the load changes by
    stroke({.feel = {.friction = friction(0.8, 0.3, 2, 20)}, .stiffness = 1 + 2 + 0.8}, 4);
    EXPECT_LT(work_n_mm, -3);
}

TEST_F(BalanceLoop, Texture)
{
    const phantom_texture ribs{{60'000, 40'000}, {{400'000, 0, 0}, {150'000, 300'000, 0}}};
    const double bend = 0.06 * two_pi * 0.4 * two_pi * 0.4 + 0.04 * two_pi * 0.336 * two_pi * 0.336;
    const double slope = 0.06 * two_pi * 0.4 + 0.04 * two_pi * 0.336;
    stroke({.feel = {.texture = ribs},
            .energy = [&](const Place& at) { return relief_energy(ribs, at); },
            .stiffness = 1.5 + slope * (1.5 + slope) + 1.5 * bend,
            .conservative = true},
           4);
}

TEST_F(BalanceLoop, HeightMap)
{
    HeightMap map{{8, 8, 1'000'000, 80'000}, {}};
    for (int i = 0; i < 64; ++i)
        map.height_nm.push_back(i * 7919 % 160'001 - 80'000);
    const double slope = 0.32, bend = 4 * 0.16;
    stroke({.feel = {.height_map = map},
            .energy =
                [&](const Place& at) {
                    return relief_energy(map, {0, 0, 1}, at);
                },
            .stiffness = 1.5 + slope * (1.5 + slope) + 1.5 * bend,
            .conservative = true},
           4);
}

TEST_F(BalanceLoop, Impact)
{
    const phantom_impact knock{3000, 5'000'000, 120, 30'000};
    const double w = two_pi * 120;
    double allowed = 0, most = 0;
    int quiet = 1000, hits = 0;
    // the fastest hit is below 100 mm/s
    stroke({.feel = {.impact = knock}, .per_tick = 3e-3 * 100 * (w / hz + 1.0 / 300 + 1.0 / 100)}, 4, [&] {
        if (last_at[2] < contact_radius_mm) {
            if (quiet >= 100) {
                const double v = -speed()[2];
                allowed += 3e-3 * v * v / w;
                most = std::max(most, v);
                ++hits;
            }
            quiet = 0;
        } else {
            ++quiet;
        }
        return allowed + 1e-3 * hits; // and a tick's work each
    });
    EXPECT_GT(hits, 5);
    EXPECT_LT(most, 100);
}

TEST_F(BalanceLoop, Constant)
{
    stroke({.feel = {.constant = phantom_constant{{100'000, -50'000, -200'000}, 0}},
            .energy =
                [](const Place& at) { return contact_energy(at) - 0.1 * at[0] + 0.05 * at[1] + 0.2 * at[2]; },
            .conservative = true},
           2);
}

TEST_F(BalanceLoop, Viscosity)
{
    stroke({.feel = {.viscosity = {{{0, 0, 0}, 4'000'000, 2'000'000, 2000, 1000}, {{0, 0, 0}, 0, 0, 500, 0}}},
            .stiffness = 1 + 1.5 / 2 * 2.6e-3 * 60,
            .viscous = 2.6e-3,
            .lag = 0.02},
           2);
    EXPECT_LT(work_n_mm, -1) << "it takes";
}

TEST_F(BalanceLoop, Guide)
{
    const phantom_guide guide{{1'000'000, 0, 4'000'000}, {0, 0, 0}, PHANTOM_GUIDE_POINT, 200, 600'000, 0, 0};
    stroke({.feel = {.guides = {guide}},
            .energy = [&](const Place& at) { return contact_energy(at) + guide_energy(guide, at); },
            .stiffness = 1.2,
            .conservative = true},
           2);
}

/// A spring of 0.05, 0.1 and 0.02 N/mm to (0, 0, 5).
TEST_F(BalanceLoop, Field)
{
    Field field{{{-20'000'000, -20'000'000, -20'000'000},
                 {10'000'000, 10'000'000, 10'000'000},
                 {5, 5, 6},
                 2'000'000,
                 0},
                {}};
    for (int z = 0; z < 6; ++z)
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 5; ++x)
                field.force_un.push_back(
                    {-50'000 * (10 * x - 20), -100'000 * (10 * y - 20), -20'000 * (10 * z - 25)});
    stroke({.feel = {.field = field},
            .energy =
                [](const Place& at) {
                    return contact_energy(at) + 0.5 * (0.05 * at[0] * at[0] + 0.1 * at[1] * at[1] +
                                                       0.02 * (at[2] - 5) * (at[2] - 5));
                },
            .stiffness = 1.1,
            .conservative = true},
           2);
}

/// A ball of 0.5 mm: the point's potential, 0.5 mm higher.
TEST_F(BalanceLoop, Tip)
{
    stroke({.feel = {.tip = phantom_tip{500'000, 0}},
            .energy =
                [](const Place& at) {
                    return contact_energy({at[0], at[1], at[2] - 0.5});
                },
            .conservative = true},
           2);
}

} // namespace
} // namespace phantom::test
