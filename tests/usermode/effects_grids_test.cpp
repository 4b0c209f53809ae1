// SPDX-License-Identifier: GPL-2.0-or-later
// Effects with samples, against their laws in double: height maps on planes that face anywhere, force fields.
#include <numeric>
#include <random>

#include "effect_laws.hpp"

namespace phantom::test {
namespace {

constexpr std::uint32_t ariths[] = {PHANTOM_ARITH_FLOAT, PHANTOM_ARITH_FIXED, PHANTOM_ARITH_DOUBLE};

// ---- height map

class HeightMapEffect : public EffectTest {
  protected:
    /// The plane through 0 that faces n, felt with that map; k = 1 N/mm, R = 3 mm.
    void feel_facing(const Place& n, const HeightMap& map, std::uint32_t arith,
                     std::array<std::int64_t, 3> origin = {0, 0, 0})
    {
        feel({}, {0, 0, 0}, {}, arith);
        Plane plane(++set_id, 60'000'000, 400'000'000, origin);
        const std::size_t least = std::abs(n[0]) < 0.7 ? 0 : 1;
        Place e{};
        e[least] = 1;
        const double lean = dot(e, n);
        for (std::size_t i = 0; i < 3; ++i)
            e[i] -= lean * n[i];
        const double size = length(e);
        const Place f{n[1] * e[2] - n[2] * e[1], n[2] * e[0] - n[0] * e[2], n[0] * e[1] - n[1] * e[0]};
        for (phantom_patch& patch : plane.patches) {
            for (int c = 0; c < 3; ++c) {
                const double a = double(patch.vertex_nm[c][0] + origin[0]) / size;
                const double b = double(patch.vertex_nm[c][1] + origin[1]) / size;
                for (std::size_t i = 0; i < 3; ++i) {
                    patch.vertex_nm[c][i] =
                        std::int32_t(std::llround(a * e[i] + b * f[i])) - std::int32_t(origin[i]);
                    patch.normal_q30[c][i] = std::int32_t(std::lround(n[i] * PHANTOM_Q30_ONE));
                }
            }
        }
        add_effects(plane, {.height_map = map});
        ASSERT_EQ(feeder->submit(plane), 0);
        step(30);
    }
};

/// Random heights, no steeper than allowed.
HeightMap bumps()
{
    HeightMap out{{8, 4, 500'000, 60'000}, std::vector<std::int32_t>(32)};
    std::mt19937 random(2);
    for (std::int32_t& height : out.height_nm)
        height = std::int32_t(random() % 120'001) - 60'000;
    return out;
}

TEST_F(HeightMapEffect, IsTheGradientOfItsEnergyHoweverTheSurfaceFaces)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> aside(-20, 20), above(0.3, 2.99);
    const HeightMap map = bumps();
    const double third = std::sqrt(1.0 / 3);
    for (const std::uint32_t arith : ariths) {
        for (const Place& n : {Place{0, 0, 1}, Place{1, 0, 0}, Place{0, -1, 0}, Place{third, -third, third},
                               Place{0.6, 0, 0.8}}) {
            feel_facing(n, map, arith, {7'777'777, -3'333'333, 1'000'000});
            for (int i = 0; i < 30; ++i) {
                Place at{aside(random), aside(random), aside(random)};
                const double lift = above(random) - dot(at, n);
                for (std::size_t axis = 0; axis < 3; ++axis)
                    at[axis] = std::round(1e6 * (at[axis] + lift * n[axis])) * 1e-6;
                place(at);
                step(60); // the velocity has died away: no band limit
                const Place f = force(at);
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    Place low = at, high = at;
                    low[axis] -= 1e-4;
                    high[axis] += 1e-4;
                    const double slope = (relief_energy(map, n, low) - relief_energy(map, n, high)) / 2e-4;
                    ASSERT_NEAR(f[axis], slope, 1e-4)
                        << i << ", axis " << axis << ", arithmetic " << arith << ", facing " << n[0];
                }
            }
        }
    }
}

TEST_F(HeightMapEffect, IsContinuousOverItsSamplesAndTiles)
{
    feel_facing({0, 0, 1}, bumps(), PHANTOM_ARITH_FLOAT);
    place({3.7, 0.3, 1.5});
    step(60);
    Place before = force({3.7, 0.3, 1.5});
    const double stiffest = 1.5 * 4 * 0.06 / 0.25 + 2; // of the relief, and of k twice
    for (int i = 1; i <= 1500; ++i) {
        const Place f = force({3.7 + 3e-4 * i, 0.3 + 1e-4 * i, 1.5});
        ASSERT_LE(length(minus(f, before)), stiffest * 3.2e-4 + 1e-5) << i;
        before = f;
    }
}

TEST_F(HeightMapEffect, MakesNoEnergy)
{
    feel_facing({0, 0, 1}, bumps(), PHANTOM_ARITH_FLOAT);
    double sum = work({0, 0, 2}, {3.3, 0, 1.5}, 4000);
    sum += work({3.3, 0, 1.5}, {1, 2.2, 2.8}, 4000);
    sum += work({1, 2.2, 2.8}, {0, 0, 2}, 4000);
    EXPECT_NEAR(sum, 0, 1e-4);
}

TEST_F(HeightMapEffect, IsLeftOutWhereTheRateCannotCarryIt)
{
    HeightMap ribs{{4, 4, 500'000, 50'000}, {}}; // 1 mm from crest to crest
    for (int i = 0; i < 16; ++i)
        ribs.height_nm.push_back(i % 2 ? 50'000 : -50'000);
    const auto ripple = [&](double v) {
        feel_facing({0, 0, 1}, ribs, PHANTOM_ARITH_FLOAT);
        double least = 10, most = -10, x = -50;
        for (int i = 0; i < 180; ++i) {
            const Place f = force({x += v * 1e-3, 0, 2});
            if (i > 80) {
                least = std::min(least, f[2]);
                most = std::max(most, f[2]);
            }
        }
        return most - least;
    };
    const double whole = ripple(30.1);
    EXPECT_GT(whole, 0.04);
    EXPECT_NEAR(ripple(117), whole, 0.1 * whole) << "8 samples a wave and more";
    EXPECT_NEAR(ripple(187.5), 0.5 * whole, 0.12 * whole) << "half way";
    EXPECT_NEAR(ripple(251), 0, 1e-5) << "less than 4 samples a wave";
    EXPECT_NEAR(ripple(490), 0, 1e-5) << "it would alias";
}

// ---- force field

class FieldEffect : public EffectTest {};

/// nodes[i] nodes of 2, 3 and 1.5 mm spacing from (-4, 1, 40) on, each with f(its place), border 1 mm.
template <class F>
Field field_of(std::array<std::uint32_t, 3> nodes, F&& f)
{
    Field out{{{-4'000'000, 1'000'000, 40'000'000}, {2'000'000, 3'000'000, 1'500'000}, {}, 1'000'000, 0}, {}};
    std::copy(nodes.begin(), nodes.end(), out.header.nodes);
    for (std::uint32_t z = 0; z < nodes[2]; ++z)
        for (std::uint32_t y = 0; y < nodes[1]; ++y)
            for (std::uint32_t x = 0; x < nodes[0]; ++x) {
                const Place force = f(Place{-4 + 2.0 * x, 1 + 3.0 * y, 40 + 1.5 * z});
                out.force_un.push_back({});
                for (std::size_t axis = 0; axis < 3; ++axis)
                    out.force_un.back()[axis] = std::int32_t(std::lround(force[axis] * 1e6));
            }
    return out;
}

TEST_F(FieldEffect, MeetsALinearFieldExactlyAndFadesAtItsBorder)
{
    const auto law = [](const Place& p) {
        return Place{0.1 * p[0] - 0.05 * p[1], 0.02 * p[2] - 1, 0.3 + 0.04 * p[0] - 0.01 * p[2]};
    };
    const std::array<std::uint32_t, 3> nodes{5, 3, 7}; // -4 ... 4, 1 ... 7, 40 ... 49
    const Place low{-4, 1, 40}, high{4, 7, 49};
    std::mt19937 random(3);
    for (const std::uint32_t arith : ariths) {
        feel({.field = field_of(nodes, law)}, {0, 0, 60}, {}, arith, {11'111'111, 0, -22'222'222});
        for (int i = 0; i < 400; ++i) {
            Place at;
            double part = 1;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                std::uniform_real_distribution<double> anywhere(low[axis] - 0.3, high[axis] + 0.3);
                at[axis] = anywhere(random);
                const double s = std::clamp(std::min(at[axis] - low[axis], high[axis] - at[axis]), 0.0, 1.0);
                part *= s * s * (3 - 2 * s);
            }
            const Place f = force(at), wanted = law(at);
            for (std::size_t axis = 0; axis < 3; ++axis)
                ASSERT_NEAR(f[axis], part * wanted[axis], 5e-6) << i << ", arithmetic " << arith;
        }
    }
}

TEST_F(FieldEffect, IsTrilinearInEachCell)
{
    std::mt19937 random(9);
    std::uniform_real_distribution<double> any(-1, 1);
    const Field field = field_of({4, 4, 4}, [&](const Place&) {
        return Place{any(random), any(random), any(random)};
    });
    feel({.field = field}, {0, 0, 60});
    for (int i = 0; i < 300; ++i) {
        const Place cell{1.5 + 0.5 * any(random), 1.5 + 0.5 * any(random), 1.5 + 0.5 * any(random)};
        const Place f = force({-4 + 2 * cell[0], 1 + 3 * cell[1], 40 + 1.5 * cell[2]});
        Place wanted{};
        for (std::size_t corner = 0; corner < 8; ++corner) {
            double weight = 1;
            for (std::size_t axis = 0; axis < 3; ++axis)
                weight *= corner >> axis & 1 ? cell[axis] - 1 : 2 - cell[axis];
            const std::size_t node =
                (1 + (corner & 1)) + 4 * (1 + (corner >> 1 & 1)) + 16 * (1 + (corner >> 2));
            for (std::size_t axis = 0; axis < 3; ++axis)
                wanted[axis] += weight * 1e-6 * field.force_un[node][axis];
        }
        ASSERT_LT(length(minus(f, wanted)), 1e-5) << i;
    }
}

TEST_F(FieldEffect, IsContinuousThroughEveryCellAndOutOfTheBox)
{
    std::mt19937 random(4);
    std::uniform_real_distribution<double> any(-1, 1);
    feel({.field = field_of({5, 4, 6},
                            [&](const Place&) {
                                return Place{any(random), any(random), any(random)};
                            })},
         {0, 0, 60});
    const Place from{-5, 0, 39}, to{5, 11, 48.5};
    Place before = force(from);
    for (int i = 1; i <= 9000; ++i) {
        const double t = i / 9000.0;
        const Place f = force({from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1]),
                               from[2] + t * (to[2] - from[2])});
        // 2 N over 1.5 mm, and 1.5 of sqrt(3) N over the border's mm, along each of three axes
        ASSERT_LE(length(minus(f, before)), (3 * 3.5 / 1.5 + 3 * 2.6) * 16 / 9000.0);
        before = f;
    }
    EXPECT_EQ(length(force(to)), 0);
}

TEST_F(FieldEffect, GivesItsCurlTimesTheAreaAndNoMore)
{
    const auto lap = [&] {
        double sum = work({-2, 3, 44}, {2, 3, 44}, 500);
        sum += work({2, 3, 44}, {2, 5, 44}, 500);
        sum += work({2, 5, 44}, {-2, 5, 44}, 500);
        return sum + work({-2, 5, 44}, {-2, 3, 44}, 500);
    };
    feel({.field = field_of({5, 3, 7},
                            [](const Place& p) {
                                return Place{-0.05 * p[1], 0.05 * p[0], 0};
                            })},
         {0, 0, 60});
    EXPECT_NEAR(lap(), 0.1 * 8, 1e-4) << "a whirl: curl 0.1 N/mm, 8 mm^2";
    feel({.field = field_of({5, 3, 7},
                            [](const Place& p) {
                                return Place{-0.1 * p[0], -0.2 * p[1], 0};
                            })},
         {0, 0, 60});
    EXPECT_NEAR(lap(), 0, 1e-4) << "a spring";
}

TEST_F(FieldEffect, ASetThatIsRefusedLeavesTheTablesOfTheOneInUse)
{
    const auto field = [](double newton) {
        return Feel{.field = field_of({5, 3, 7}, [=](const Place&) { return Place{newton, 0, 0}; })};
    };
    feel(field(0.5), {0, 4, 44});
    EXPECT_NEAR(force({0, 4, 44})[0], 0.5, 1e-5);
    Plane plane(++set_id);
    add_effects(plane, field(-0.5));
    plane.patches[0].object = 99;
    ASSERT_EQ(feeder->submit(plane), -EINVAL);
    EXPECT_NEAR(force({0, 4, 44})[0], 0.5, 1e-5);
}

} // namespace
} // namespace phantom::test
