// SPDX-License-Identifier: GPL-2.0-or-later
// What the tip is and what it hits: a ball as tip, and the ring of an impact.
#include <random>

#include "effects.hpp"

namespace phantom::test {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr std::uint32_t ariths[] = {PHANTOM_ARITH_FLOAT, PHANTOM_ARITH_FIXED, PHANTOM_ARITH_DOUBLE};

// ---- tip

class Tip : public EffectTest {};

const phantom_tip ball{2'000'000, 0};

TEST_F(Tip, ABallFeelsTheSurfaceAtItsRadiusAsStiff)
{
    for (const std::uint32_t arith : ariths) {
        feel({.tip = ball}, {0, 0, 6}, {}, arith);
        for (double z = 6; z > -1; z -= 0.0171) { // R = 3 mm: from 5 mm on, and on below the plane
            const Place f = force({0.3, 0.1, z});
            ASSERT_NEAR(f[2], std::max(0.0, 5 - z), 2e-5) << z;
            ASSERT_NEAR(std::hypot(f[0], f[1]), 0, 1e-6);
        }
        EXPECT_TRUE(flags & PHANTOM_TICK_INSIDE) << "its centre is";
    }
}

TEST_F(Tip, IsTheSameBitsAsAContactRadiusThatMuchLarger)
{
    const auto stroke = [&](bool as_tip) {
        feel({}, {0, 0, 6});
        Plane plane(++set_id, 50'000'000, 45'000'000);
        // a ridge: the second face leans
        for (int c = 0; c < 3; ++c)
            plane.patches[1].vertex_nm[c][2] = plane.patches[1].vertex_nm[c][1] > 0 ? -10'000'000 : 0;
        if (as_tip)
            add_effects(plane, {.tip = ball});
        else
            plane.materials[0].radius_nm += ball.radius_nm;
        EXPECT_EQ(feeder->submit(plane), 0);
        step(40);
        std::vector<Place> out;
        for (int i = 0; i < 800; ++i)
            out.push_back(
                force({8 * std::sin(0.01 * i), 8 * std::cos(0.013 * i), 3 + 3.5 * std::cos(0.03 * i)}));
        return out;
    };
    EXPECT_EQ(stroke(true), stroke(false));
}

TEST_F(Tip, AsksForCoverageAsFarAsItReaches)
{
    const auto covered = [&](std::int32_t radius_nm, const Feel& what) {
        feel({}, {0, 0, 4});
        Plane plane(++set_id, 50'000'000, radius_nm);
        add_effects(plane, what);
        EXPECT_EQ(feeder->submit(plane), 0);
        force({0, 0, 4});
        return !(flags & PHANTOM_TICK_UNCOVERED);
    };
    EXPECT_TRUE(covered(9'000'000, {.tip = ball})) << "4 + 3 + 2";
    EXPECT_FALSE(covered(8'999'999, {.tip = ball}));
    EXPECT_TRUE(covered(8'999'999, {}));
    EXPECT_TRUE(covered(7'000'000, {}));
    EXPECT_FALSE(covered(6'999'999, {}));
}

TEST_F(Tip, ANewRadiusFadesIn)
{
    const Place at{0, 0, 4};
    feel({}, at);
    Place before = force(at);
    for (const Feel& next : {Feel{.tip = ball}, Feel{.tip = phantom_tip{3'000'000, 0}}, Feel{}}) {
        submit(next);
        for (int i = 0; i < 25; ++i) {
            const Place f = force(at);
            ASSERT_LE(length(minus(f, before)), 0.11) << i;
            before = f;
        }
        EXPECT_NEAR(before[2], next.tip ? next.tip->radius_nm * 1e-6 - 1 : 0, 1e-5);
    }
}

// ---- impact

class Impact : public EffectTest {
  protected:
    /// Comes down to that height at v mm/s, at a tick's steps; the tick in which contact begins is the last.
    void hit(double v, double from = 5)
    {
        double z = from + 0.00371;
        while (z > 3)
            last = force({0, 0, z -= v * 1e-3});
        depth = 3 - z;
        speed = -feeder->status().velocity_nm_s[2] * 1e-6;
    }
    Place held() { return force({0, 0, 3 - depth}); }

    double depth = 0, speed = 0;
};

constexpr phantom_impact knock{5000, 10'000'000, 80, 20'000}; // 5 N s/m, 80 Hz, 20 ms

TEST_F(Impact, RingsAsItsLawSays)
{
    for (const std::uint32_t arith : ariths) {
        for (const double v : {15.0, 90.0, 300.0}) {
            feel({.impact = knock}, {0, 0, 30}, {}, arith);
            hit(v, 30);
            EXPECT_NEAR(speed, v, 0.01 * v) << "the filter has settled";
            EXPECT_NEAR(last[2], depth, 2e-6) << "nothing yet where it begins";
            double largest = 0;
            for (int i = 1; i < 300; ++i) {
                const double t = i * 1e-3, ring = held()[2] - depth;
                std::printf("%d %f %f\n", i, ring,
                            5e-3 * speed * std::exp(-t / 0.02) * std::sin(2 * pi * 80 * t));
                ASSERT_NEAR(ring, 5e-3 * speed * std::exp(-t / 0.02) * std::sin(2 * pi * 80 * t),
                            2e-6 + 2e-4 * 5e-3 * speed)
                    << i << ", " << v << " mm/s, arithmetic " << arith;
                largest = std::max(largest, ring);
            }
            EXPECT_GT(largest, 0.7 * 5e-3 * v);
        }
    }
}

TEST_F(Impact, IsNoLargerThanItsForce)
{
    phantom_impact most = knock;
    most.force_un = 300'000;
    feel({.impact = most}, {0, 0, 30});
    hit(300, 30);
    double largest = 0;
    for (int i = 1; i < 20; ++i)
        largest = std::max(largest, held()[2] - depth);
    EXPECT_LT(largest, 0.3);
    EXPECT_GT(largest, 0.2);
}

/// What the ring alone does to a tip that goes with it, in the tangent of nothing else: a soft surface.
TEST_F(Impact, GivesNoMoreThanItSaysHoweverTheTipMoves)
{
    for (const double with : {0.0, 30.0, 100.0, 300.0}) { // mm/s
        feel({.impact = knock}, {0, 0, 30});
        hit(100, 30);
        double z = 3 - depth, given = 0, before = 0, largest_step = 0;
        const double most = 5e-3 * speed * speed / (2 * pi * 80);
        for (int i = 0; i < 200; ++i) {
            const double wish = with * 1e-3 * (before > 0 ? 1 : before < 0 ? -1 : 0);
            const double way = std::min(z + wish, 2.999) - z; // contact does not end
            z += way;
            const double ring = force({0, 0, z})[2] - (3 - z);
            given += before * way;
            largest_step = std::max(largest_step, std::abs(before * way));
            before = ring;
        }
        EXPECT_LE(given, most + largest_step) << with;
        if (with >= 100) {
            EXPECT_GT(given, 0.5 * most) << "the bound is met, else this shows nothing";
        }
    }
}

TEST_F(Impact, ChatterRingsOnce)
{
    feel({.impact = knock}, {0, 0, 30});
    hit(100, 30);
    for (int i = 0; i < 240; ++i) { // three ticks off, three on, coming down again each time
        const double z = i % 6 < 3 ? 3.05 : 2.95;
        const double ring = force({0, 0, z})[2] - std::max(0.0, 3 - z);
        if (i > 150) {
            ASSERT_LT(std::abs(ring), 1e-3) << "nothing is left of the first, and no other began: tick " << i;
        }
    }
    for (int i = 0; i < 9; ++i)
        force({0, 0, 3.2});
    force({0, 0, 2.9});
    EXPECT_NEAR(force({0, 0, 2.9})[2], 0.1, 1e-4) << "too early";
    for (int i = 0; i < 11; ++i)
        force({0, 0, 3.2});
    force({0, 0, 2.9});
    EXPECT_GT(std::abs(force({0, 0, 2.9})[2] - 0.1), 0.05) << "again";
}

TEST_F(Impact, FadesWhereContactEndsAndHasNoStep)
{
    feel({.impact = knock}, {0, 0, 30});
    hit(200, 30);
    const double most = 5e-3 * speed;
    const double per_tick = most * (2 * pi * 80e-3 + 1.0 / 20 + 1.0 / 10);
    double before = 0, largest = 0;
    for (int i = 0; i < 60; ++i) {
        const double z = i % 16 < 3 ? 2.99 : 3.01; // leaves, and comes back now and then
        const double ring = force({0, 0, z})[2] - std::max(0.0, 3 - z);
        ASSERT_LE(std::abs(ring - before), per_tick) << i;
        if (i == 13 || i == 14) {
            ASSERT_LT(std::abs(ring), 1e-6) << "over within 10 ms without contact";
        }
        largest = std::max(largest, std::abs(ring));
        before = ring;
    }
    EXPECT_GT(largest, 0.5 * most);
}

TEST_F(Impact, RingsOnOverEveryRevisionOfWhatWasHit)
{
    feel({.impact = knock}, {0, 0, 30});
    hit(90, 30);
    for (int i = 1; i < 80; ++i) {
        if (i <= 15) {
            Plane plane(++set_id, 500'000'000, 450'000'000);
            plane.objects[0].revision = std::uint32_t(i);
            plane.header.level_error_nm = 300'000; // the proxy is looked for that far from where it was
            add_effects(plane, {.impact = knock});
            ASSERT_EQ(feeder->submit(plane), 0);
        }
        const double ring = held()[2] - depth, t = i * 1e-3;
        if (i > 40) { // nothing fades any more
            ASSERT_NEAR(ring, 5e-3 * speed * std::exp(-t / 0.02) * std::sin(2 * pi * 80 * t), 1e-4) << i;
        }
    }
}

TEST_F(Impact, WhatTheRateCannotCarryIsLeftOut)
{
    for (const std::uint32_t hz : {125u, 250u, 500u, 1000u}) {
        phantom_impact high = knock;
        high.frequency_hz = hz;
        feel({.impact = high}, {0, 0, 30});
        hit(100, 30);
        double largest = 0;
        for (int i = 1; i < 20; ++i)
            largest = std::max(largest, std::abs(held()[2] - depth));
        if (hz == 125)
            EXPECT_GT(largest, 0.35);
        else
            EXPECT_LT(largest, 1e-6) << hz;
    }
}

TEST_F(Impact, ATipThatIsInContactHitsNothingHoweverItPresses)
{
    feel({.impact = knock}, {0, 0, 2.5}); // from the first tick on
    EXPECT_NEAR(force({0, 0, 2.5})[2], 0.5, 1e-5);
    for (int i = 1; i <= 60; ++i) { // at 30 mm/s
        const double z = 2.5 - 0.03 * i;
        ASSERT_NEAR(force({0, 0, z})[2], 3 - z, 1e-5) << i;
    }
}

} // namespace
} // namespace phantom::test
