// SPDX-License-Identifier: GPL-2.0-or-later
// Effects of surfaces against their laws: magnet, friction, texture.
#include <random>

#include "effect_laws.hpp"

namespace phantom::test {
namespace {

class Friction : public EffectTest {};
class Magnet : public EffectTest {};
class Texture : public EffectTest {};

// ---- friction: N = 1 N at z = 2 mm

TEST_F(Friction, SticksAsASpringBreaksAwayAtStaticAndSlidesAtDynamic)
{
    for (const std::uint32_t arith : {PHANTOM_ARITH_FLOAT, PHANTOM_ARITH_FIXED, PHANTOM_ARITH_DOUBLE}) {
        feel({.friction = friction(0.6, 0.4, 2)}, {0, 0, 2}, {}, arith);
        double most = 0;
        for (int um = 1; um <= 290; ++um) {
            const Place f = force({um * 1e-3, 0, 2});
            ASSERT_NEAR(f[0], -2 * um * 1e-3, 1e-5) << um;
            ASSERT_NEAR(f[1], 0, 1e-6);
            ASSERT_NEAR(f[2], 1, 1e-5);
        }
        for (int um = 291; um <= 1000; ++um) {
            const Place f = force({um * 1e-3, 0, 2});
            most = std::max(most, -f[0]);
        }
        EXPECT_NEAR(most, 0.6, 2e-3) << "static";
        EXPECT_NEAR(force({1.001, 0, 2})[0], -0.4, 1e-5) << "dynamic";
        EXPECT_NEAR(force({1.0, 0, 2})[0], -0.4 + 2e-3, 1e-5) << "back: the spring lets go first";
        force({0.8, 0, 2}); // all let go: it has stuck again
        most = 0;
        for (int um = 800; um <= 1500; ++um)
            most = std::max(most, -force({um * 1e-3, 0, 2})[0]);
        EXPECT_NEAR(most, 0.6, 3e-3) << "static again";
        force({1.4, 0, 2}); // half let go: half of the way back to static
        most = 0;
        for (int um = 1400; um <= 2000; ++um)
            most = std::max(most, -force({um * 1e-3, 0, 2})[0]);
        EXPECT_NEAR(most, 0.5, 3e-3);
    }
}

TEST_F(Friction, NeverChangesFasterThanItsSpring)
{
    feel({.friction = friction(1.0, 0.2, 2)});
    Place before = force({0, 0, 2});
    std::mt19937 random(3);
    Place at{0, 0, 2};
    for (int i = 0; i < 20'000; ++i) {
        // mostly onwards, now and then back
        const double way = 1e-3 * (random() % 8 ? 1 : -6) * double(random() % 5);
        at[0] += way;
        const Place f = force(at);
        ASSERT_LE(std::abs(f[0] - before[0]), 2 * std::abs(way) + 2e-5) << i;
        before = f;
    }
}

TEST_F(Friction, AtRestNothingMoves)
{
    feel({.friction = friction(0.6, 0.4, 2)});
    for (const double x : {0.1, 0.29, 0.301, 0.35, 5.0}) { // sticking, about to break away, breaking, sliding
        const Place f = force({x, 0.1, 2});
        for (int i = 0; i < 3000; ++i)
            ASSERT_EQ(force({x, 0.1, 2}), f) << x << ", tick " << i;
    }
}

TEST_F(Friction, AtRestNothingMovesWhereverItSlidTo)
{
    std::mt19937 random(6);
    std::uniform_real_distribution<double> any(-1, 1);
    for (const std::uint32_t arith : {PHANTOM_ARITH_FLOAT, PHANTOM_ARITH_FIXED, PHANTOM_ARITH_DOUBLE}) {
        for (const double stiffness : {0.5, 100.0}) { // a nm of the spring is 0.5 nN or 0.1 uN
            feel({.friction = friction(0.7, 0.43, stiffness, 30)}, {0, 0, 2}, {}, arith, {0, 400'000'000, 0});
            for (int place = 0; place < 60; ++place) {
                const Place at{40 * any(random), 40 * any(random), 1.5 + any(random)};
                for (int i = 0; i < 25; ++i) // until the filtered velocity has died away
                    force(at);
                const Place f = force(at);
                for (int i = 0; i < 60; ++i)
                    ASSERT_EQ(force(at), f) << place << ", tick " << i << ", arithmetic " << arith;
            }
        }
    }
}

TEST_F(Friction, AFlickeringEncoderDoesNotMakeItCreep)
{
    feel({.friction = friction(0.6, 0.4, 2)});
    work({0, 0, 2}, {0.25, 0, 2}, 250); // half a newton held
    const Place held = force({0.25, 0, 2});
    for (int i = 0; i < 5000; ++i)
        force({0.25 + (i % 2 ? 0.03 : -0.03), i % 3 ? 0.03 : 0.0, 2.0 + (i % 5 ? 0.01 : 0.0)});
    const Place after = force({0.25, 0, 2});
    EXPECT_NEAR(after[0], held[0], 0.03) << "moves of 0.03 mm slip once at most";
    for (int i = 0; i < 5000; ++i)
        force({0.25 + (i % 2 ? 0.03 : -0.03), i % 3 ? 0.03 : 0.0, 2.0 + (i % 5 ? 0.01 : 0.0)});
    EXPECT_EQ(force({0.25, 0, 2}), after) << "and then never again";
}

TEST_F(Friction, GivesNoEnergyOnAnyWayThatEndsWhereItBegan)
{
    feel({.friction = friction(0.8, 0.3, 5)});
    std::mt19937 random(7);
    std::uniform_real_distribution<double> anywhere(-1, 1);
    const Place home{0, 0, 2};
    double taken = 0;
    for (int loop = 0; loop < 20; ++loop) {
        Place at = home;
        double sum = 0;
        for (int i = 0; i < 5; ++i) {
            const Place next{anywhere(random), anywhere(random),
                             2}; // the normal force does no work at that height
            sum += work(at, next, 300);
            at = next;
        }
        sum += work(at, home, 300);
        taken -= sum;
        EXPECT_LE(sum, 0.5 * 0.8 * 0.8 / 5) << "no more than the spring held before";
    }
    EXPECT_GT(taken, 0.25 * 20 * 3) << "dynamic friction on some mm a loop";
}

TEST_F(Friction, FollowsTheCurveOfStribeck)
{
    feel({.friction = friction(0.8, 0.3, 5, 10)});
    double x = 0;
    for (const double v : {2.0, 5.0, 10.0, 20.0, 50.0, 10.0}) {
        for (int i = 0; i < 400; ++i)
            last = force({x += v * 1e-3, 0, 2});
        EXPECT_NEAR(-last[0], 0.3 + 0.5 / (1 + v * v / 100), 2e-3) << v << " mm/s";
    }
}

TEST_F(Friction, GoesOverToAnotherMaterialWithoutAStep)
{
    for (const double z : {2.0, -0.5}) { // from outside, and held by a proxy below
        feel({.friction = friction(0.8, 0.6, 5)}, {-3, 0.5, 2});
        Plane plane(++set_id, 500'000'000, 450'000'000);
        plane.materials.push_back(plane.materials[0]);
        for (phantom_material& material : plane.materials)
            material.effects = plane.header.effects = PHANTOM_EFFECT_FRICTION;
        plane.patches[1].material = 1; // where x < y
        plane.add_table(friction(0.8, 0.6, 5));
        plane.add_table(friction(0.2, 0.1, 5));
        ASSERT_EQ(feeder->submit(plane), 0);
        step(40);
        work({-3, 0.5, 2}, {-3, 0.5, z}, 200);
        for (const int way : {1, -1}) {
            Place before = force({-3.0 * way, 0.5, z});
            const double normal = before[2];
            double risen_at = 0; // where friction has risen to half of the normal force
            for (int um = -3000 * way + way; um * way <= 3000; um += way) {
                const Place f = force({um * 1e-3, 0.5, z});
                // and what the proxy lags behind at the edge, some um
                ASSERT_LE(length(minus(f, before)), 5 * 1e-3 + (z < 0 ? 2e-3 : 1e-5)) << um << " um at " << z;
                before = f;
                if (risen_at == 0 && um > 400 && std::abs(f[0]) > 0.5 * normal)
                    risen_at = um * 1e-3;
            }
            if (way > 0) { // from the border at x = 0.5 on it rises by a third of the spring
                EXPECT_NEAR(risen_at, 0.5 + 0.4 * normal / (5.0 / 3), 0.1 * normal) << z;
            }
            EXPECT_NEAR(std::abs(before[0]), (way > 0 ? 0.6 : 0.1) * normal, 2e-3 * normal)
                << way << ", " << z;
        }
    }
}

TEST_F(Friction, EndsWithTheContact)
{
    feel({.friction = friction(0.6, 0.4, 2)});
    EXPECT_NEAR(force({0.2, 0, 2})[0], -0.4, 1e-5);
    EXPECT_EQ(length(force({0.2, 0, 3.1})), 0);
    EXPECT_NEAR(force({0.2, 0, 2})[0], 0, 1e-6) << "a new stick point";
}

// ---- magnet: g = 0.5 mm, so the surface is felt from z = 2.5 mm on

TEST_F(Magnet, PullsInItsRangeAndPushesBelow)
{
    for (const std::uint32_t arith : {PHANTOM_ARITH_FLOAT, PHANTOM_ARITH_FIXED, PHANTOM_ARITH_DOUBLE}) {
        feel({.magnet = phantom_magnet{500'000, 300'000}}, {0, 0, 4}, {}, arith);
        for (double z = 3.2; z > 0.5; z -= 0.0137) {
            const double p = 3 - z;
            const double n = p < 0 ? 0 : p < 0.5 ? -4 * 0.3 * (p / 0.5) * (1 - p / 0.5) : p - 0.5;
            const Place f = force({0, 0, z});
            ASSERT_NEAR(f[2], n, 1e-5) << z;
            ASSERT_NEAR(std::hypot(f[0], f[1]), 0, 1e-6);
        }
    }
}

TEST_F(Magnet, TakesOutWhatItGave)
{
    feel({.magnet = phantom_magnet{500'000, 300'000}}, {0, 0, 4});
    const double in = work({0, 0, 4}, {0, 0, 2.5}, 4000);
    EXPECT_NEAR(in, 2.0 / 3 * 0.3 * 0.5, 1e-4);
    EXPECT_NEAR(in + work({0, 0, 2.5}, {0, 0, 4}, 4000), 0, 1e-5);
}

TEST_F(Magnet, PressesForFriction)
{
    feel({.magnet = phantom_magnet{500'000, 300'000}, .friction = friction(0.5, 0.5, 5)}, {0, 0, 1.5});
    work({0, 0, 1.5}, {2, 0, 1.5}, 200);
    EXPECT_NEAR(-last[0], 0.5 * 1.0, 1e-4) << "N = k (p - g)";
    work({2, 0, 1.5}, {2, 0, 2.8}, 200);
    work({2, 0, 2.8}, {3, 0, 2.8}, 200);
    EXPECT_NEAR(last[0], 0, 1e-6) << "nothing presses where it pulls";
}

// ---- texture

const phantom_texture ribs{{50'000, 20'000}, {{1'000'000, 0, 0}, {300'000, -900'000, 2'000'000}}};

TEST_F(Texture, IsTheGradientOfItsEnergy)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> x(-20, 20), z(0.3, 2.99);
    for (const std::uint32_t arith : {PHANTOM_ARITH_FLOAT, PHANTOM_ARITH_FIXED, PHANTOM_ARITH_DOUBLE}) {
        feel({.texture = ribs}, {0, 0, 2}, {}, arith, {7'777'777, -3'333'333, 1'000'000});
        for (int i = 0; i < 300; ++i) {
            const Place at{x(random), x(random), z(random)};
            place(at);
            step(60); // the velocity has died away: no band limit
            const Place f = force(at);
            for (int axis = 0; axis < 3; ++axis) {
                Place low = at, high = at;
                low[axis] -= 1e-4;
                high[axis] += 1e-4;
                const double slope = (relief_energy(ribs, low) - relief_energy(ribs, high)) / 2e-4;
                ASSERT_NEAR(f[axis], slope, 6e-5) << i << ", axis " << axis << ", arithmetic " << arith;
            }
        }
    }
}

TEST_F(Texture, WavesThatTheRateCannotCarryAreLeftOut)
{
    phantom_texture fine{{20'000, 0}, {{1'000'000, 0, 0}, {0, 0, 0}}}; // 1 mm, at 1 kHz
    const auto ripple = [&](double v) {
        feel({.texture = fine}, {-300, 0, 2});
        double least = 10, most = -10, x = -300;
        for (int i = 0; i < 600; ++i) {
            const Place f = force({x += v * 1e-3, 0, 2});
            if (i > 100) {
                least = std::min(least, f[2]);
                most = std::max(most, f[2]);
            }
        }
        return most - least;
    };
    const double whole = ripple(10.1);
    EXPECT_GT(whole, 0.03);
    EXPECT_NEAR(ripple(117), whole, 0.1 * whole) << "8 samples a wave and more";
    EXPECT_NEAR(ripple(187.5), 0.5 * whole, 0.1 * whole) << "half way";
    EXPECT_NEAR(ripple(251), 0, 1e-5) << "less than 4 samples a wave";
    EXPECT_NEAR(ripple(990), 0, 1e-5) << "it would alias to 10 Hz";
}

TEST_F(Texture, MakesNoEnergy)
{
    feel({.texture = ribs}, {0, 0, 2});
    double sum = work({0, 0, 2}, {3.3, 0, 1.5}, 4000);
    sum += work({3.3, 0, 1.5}, {1, 2.2, 2.8}, 4000);
    sum += work({1, 2.2, 2.8}, {0, 0, 2}, 4000);
    EXPECT_NEAR(sum, 0, 1e-4);
}

// ---- all of them

Feel everything()
{
    return {
        .magnet = phantom_magnet{300'000, 100'000},
        .friction = friction(0.6, 0.4, 2, 20),
        .texture = ribs,
        .height_map = HeightMap{{4, 4, 700'000, 30'000},
                                {30'000, 0, -9'000, 0, 5'000, 0, 7'000, 0, -30'000, 0, 0, 0, 9'000, 1, 2, 3}},
        .impact = phantom_impact{3000, 500'000, 60, 30'000},
        .constant = phantom_constant{{10'000, -20'000, 30'000}, 0},
        .viscosity = {{{5'000'000, 0, 0}, 30'000'000, 5'000'000, 2000, 3000}, {{0, 0, 0}, 0, 0, 500, 0}},
        .guides = {{{1'000'000, 2'000'000, 0}, {0, 0, 0}, PHANTOM_GUIDE_POINT, 50, 200'000, 0, 0},
                   {{0, 0, 0}, {PHANTOM_Q30_ONE, 0, 0}, PHANTOM_GUIDE_LINE, 80, 300'000, 20'000'000, 0},
                   {{0, 3'000'000, 0}, {0, PHANTOM_Q30_ONE, 0}, PHANTOM_GUIDE_PLANE, 30, 1'000'000, 0, 0}},
        .field = Field{{{-20'000'000, -20'000'000, -20'000'000},
                        {40'000'000, 40'000'000, 40'000'000},
                        {2, 2, 2},
                        5'000'000,
                        0},
                       {{100'000, 0, 0},
                        {0, 90'000, 0},
                        {0, 0, 0},
                        {0, 0, 50'000},
                        {-70'000, 0, 0},
                        {0, 0, 0},
                        {0, -40'000, 0},
                        {0, 0, 0}}},
        .tip = phantom_tip{400'000, 0}};
}

/// The same stroke: over, into and out of the surface.
Place stroke(int tick)
{
    return {0.013 * tick, 3 * std::sin(0.01 * tick), 2 - 1.8 * std::sin(0.007 * tick)};
}

class AllEffects : public EffectTest {};

TEST_F(AllEffects, HaveTheSameBitsInEveryInstructionSet)
{
    std::vector<Place> narrow;
    for (const std::uint32_t isa : {PHANTOM_ISA_SSE2, PHANTOM_ISA_AVX2, PHANTOM_ISA_AVX512}) {
        const bool has = isa == PHANTOM_ISA_SSE2 ||
                         (isa == PHANTOM_ISA_AVX2
                              ? __builtin_cpu_supports("avx2")
                              : __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"));
        if (!has)
            continue;
        feel(everything(), {0, 0, 2}, {.isa = isa});
        std::vector<Place> forces;
        for (int i = 0; i < 3000; ++i)
            forces.push_back(force(stroke(i)));
        if (narrow.empty())
            narrow = forces;
        EXPECT_EQ(forces, narrow) << isa;
    }
}

TEST_F(AllEffects, AreTheSameInFixedPoint)
{
    std::vector<Place> exact;
    feel(everything(), {0, 0, 2}, {}, PHANTOM_ARITH_DOUBLE);
    for (int i = 0; i < 3000; ++i)
        exact.push_back(force(stroke(i)));
    for (const std::uint32_t arith : {PHANTOM_ARITH_FLOAT, PHANTOM_ARITH_FIXED}) {
        feel(everything(), {0, 0, 2}, {}, arith);
        for (int i = 0; i < 3000; ++i)
            ASSERT_LT(length(minus(force(stroke(i)), exact[std::size_t(i)])), 2e-4) << i << ", " << arith;
    }
}

TEST_F(AllEffects, DoNotMindWhichSetTellsThem)
{
    std::vector<Place> still;
    feel(everything());
    for (int i = 0; i < 2000; ++i)
        still.push_back(force(stroke(i)));
    feel(everything());
    for (int i = 0; i < 2000; ++i) {
        if (i % 7 == 0)
            submit(everything(), {i * 12'347, -i * 7'771, i * 991});
        ASSERT_LT(length(minus(force(stroke(i)), still[std::size_t(i)])), 1e-4) << i;
        ASSERT_FALSE(flags & PHANTOM_TICK_FADING) << "the same feel";
    }
}

TEST_F(AllEffects, FadeInAndOut)
{
    const Place at{0.4, 0.3, 2};
    feel({}, at);
    Place before = force(at);
    for (const Feel& next : {everything(), Feel{}, Feel{.constant = phantom_constant{{500'000, 0, 0}, 0}},
                             Feel{.constant = phantom_constant{{-500'000, 0, 0}, 0}}}) {
        submit(next);
        double most = 0;
        Place f{};
        const Place begin = before;
        for (int i = 0; i < 25; ++i) {
            f = force(at);
            most = std::max(most, length(minus(f, before)));
            before = f;
        }
        const double whole = length(minus(f, begin));
        EXPECT_GT(whole, 0.03);
        EXPECT_LE(most, 0.2 * whole) << "spread over 20 ms";
        EXPECT_FALSE(flags & PHANTOM_TICK_FADING);
    }
}

} // namespace
} // namespace phantom::test
