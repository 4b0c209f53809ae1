// SPDX-License-Identifier: GPL-2.0-or-later
// Effects of free space against their laws: constant force, viscosity, guides.
#include <random>

#include "effects.hpp"

namespace phantom::test {
namespace {

class Space : public EffectTest {
  protected:
    /// A set without a triangle.
    void submit_empty(const Feel& what, std::int64_t radius_nm = 450'000'000)
    {
        Plane plane(++set_id);
        plane.patches.clear();
        plane.materials.clear();
        plane.objects.clear();
        plane.header.radius_nm = std::uint32_t(radius_nm);
        add_effects(plane, what);
        ASSERT_EQ(feeder->submit(plane), 0);
    }
};

constexpr std::uint32_t ariths[] = {PHANTOM_ARITH_FLOAT, PHANTOM_ARITH_FIXED, PHANTOM_ARITH_DOUBLE};

// ---- constant

TEST_F(Space, AConstantForceIsThereWithoutATriangle)
{
    for (const std::uint32_t arith : ariths) {
        feel({}, {0, 0, 50}, {}, arith);
        submit_empty({.constant = phantom_constant{{123'456, -200'000, 7}, 0}});
        step(30);
        const Place f = force({10, 20, -50});
        EXPECT_NEAR(f[0], 0.123456, 2e-6);
        EXPECT_NEAR(f[1], -0.2, 2e-6);
        EXPECT_NEAR(f[2], 7e-6, 2e-6);
    }
}

TEST_F(Space, ItIsAddedToContact)
{
    feel({.constant = phantom_constant{{500'000, 0, -100'000}, 0}});
    const Place f = force({0, 0, 2});
    EXPECT_NEAR(f[0], 0.5, 1e-5);
    EXPECT_NEAR(f[2], 0.9, 1e-5);
}

TEST_F(Space, WhereNoSetCoversTheTipItFades)
{
    feel({}, {0, 0, 50});
    submit_empty({.constant = phantom_constant{{500'000, 0, 0}, 0}}, 60'000'000);
    step(30);
    EXPECT_NEAR(force({0, 0, 59})[0], 0.5, 1e-5);
    double before = 0.5;
    for (int i = 0; i < 22; ++i) {
        const double now = force({0, 0, 61})[0];
        EXPECT_LE(before - now, 0.05) << i;
        before = now;
    }
    EXPECT_EQ(before, 0);
}

// ---- viscosity: the filtered velocity is the tip's own after 40 ticks of steady motion

TEST_F(Space, ViscosityAndDragOpposeTheMotion)
{
    for (const std::uint32_t arith : ariths) {
        feel({.viscosity = {{{0, 0, 0}, 0, 0, 3000, 4000}}}, {0, 0, 50}, {}, arith);
        Place at{0, 0, 50};
        for (int i = 0; i < 60; ++i) {
            at = {at[0] + 0.06, at[1] - 0.08, at[2]};
            last = force(at);
        }
        // 3 N s/m and 4 N s^2/m^2 at 0.1 m/s
        const double f = 3 * 0.1 + 4 * 0.01;
        EXPECT_NEAR(last[0], -0.6 * f, 1e-4);
        EXPECT_NEAR(last[1], 0.8 * f, 1e-4);
        EXPECT_NEAR(last[2], 0, 1e-4);
    }
}

TEST_F(Space, DragEndsAtTheMostThatIsStable)
{
    feel({.viscosity = {{{0, 0, 0}, 0, 0, 10'000, 1'000'000}, {{0, 0, 0}, 0, 0, 15'000, 0}}}, {-40, 0, 50});
    double x = -40;
    for (int i = 0; i < 60; ++i)
        last = force({x += 0.5, 0, 50});
    EXPECT_NEAR(last[0], -PHANTOM_VISCOSITY_MAX_MNS_M * 1e-3 * 0.5, 1e-3);
}

TEST_F(Space, ARegionHasASmoothBorder)
{
    for (const std::uint32_t arith : ariths) {
        feel({.viscosity = {{{5'000'000, 0, 50'000'000}, 20'000'000, 4'000'000, 10'000, 0}}}, {-60, 0, 50},
             {}, arith);
        double before = 0;
        for (double x = -60; x < 60; x += 0.02) { // 20 mm/s
            const double f = force({x, 0, 50})[0];
            const double inner = std::clamp((20 - std::abs(x - 5)) / 4, 0.0, 1.0);
            if (x > -59) {
                ASSERT_NEAR(f, -0.2 * inner * inner * (3 - 2 * inner), 1e-4) << x;
            }
            ASSERT_LE(std::abs(f - before), x > -59 ? 0.2 * 1.5 / 4 * 0.02 + 1e-4 : 1) << x;
            before = f;
        }
    }
}

// ---- guides

TEST_F(Space, AGuidePullsToItsPlace)
{
    const double s = 0.5, c = std::sqrt(0.75);
    const auto q30 = [](double v) { return std::int32_t(std::lround(v * PHANTOM_Q30_ONE)); };
    const Place direction{0, s, c}, point{3, -2, 40};
    std::mt19937 random(11);
    std::uniform_real_distribution<double> anywhere(-8, 8);
    for (const std::uint32_t arith : ariths) {
        for (const std::uint32_t kind : {PHANTOM_GUIDE_POINT, PHANTOM_GUIDE_LINE, PHANTOM_GUIDE_PLANE}) {
            phantom_guide guide{{3'000'000, -2'000'000, 40'000'000},
                                {0, q30(s), q30(c)},
                                kind,
                                200,
                                1'000'000,
                                12'000'000,
                                0};
            if (kind == PHANTOM_GUIDE_POINT)
                std::fill_n(guide.direction_q30, 3, 0);
            feel({.guides = {guide}}, point, {}, arith, {100'000'000, 0, 0});
            for (int i = 0; i < 200; ++i) {
                const Place tip{point[0] + anywhere(random), point[1] + anywhere(random),
                                point[2] + anywhere(random)};
                Place away = minus(tip, point);
                const double along = dot(away, direction);
                for (std::size_t axis = 0; axis < 3; ++axis)
                    away[axis] = kind == PHANTOM_GUIDE_LINE    ? away[axis] - along * direction[axis]
                                 : kind == PHANTOM_GUIDE_PLANE ? along * direction[axis]
                                                               : away[axis];
                const double e = length(away);
                const double pull = std::min(0.2 * e, 1.0) * std::clamp(4 * (1 - e / 12), 0.0, 1.0);
                const Place f = force(tip);
                for (std::size_t axis = 0; axis < 3; ++axis)
                    ASSERT_NEAR(f[axis], -pull * away[axis] / e, 1e-5) << kind << ", " << i;
            }
        }
    }
}

TEST_F(Space, AtItsPlaceAGuideIsStill)
{
    for (const std::uint32_t arith : ariths) {
        feel({.guides = {{{0, 0, 50'000'000}, {0, 0, 0}, PHANTOM_GUIDE_POINT, 100'000, 100'000'000, 0, 0}}},
             {0, 0, 50}, {}, arith);
        EXPECT_EQ(length(force({0, 0, 50})), 0);
        EXPECT_NEAR(force({1e-6, 0, 50})[0], -1e-4, 2e-6) << "1 nm beside it";
    }
}

TEST_F(Space, GuidesMakeNoEnergy)
{
    feel({.guides = {{{0, 0, 50'000'000}, {0, 0, 0}, PHANTOM_GUIDE_POINT, 300, 700'000, 9'000'000, 0},
                     {{1'000'000, 0, 0}, {0, 0, PHANTOM_Q30_ONE}, PHANTOM_GUIDE_LINE, 100, 400'000, 0, 0}}},
         {4, 0, 50});
    const Place corner[] = {{4, 0, 50}, {-9, 3, 47}, {2, 12, 55}, {4, 0, 50}};
    double sum = 0, there = 0;
    for (int i = 0; i < 3; ++i) {
        const double leg = work(corner[i], corner[i + 1], 3000);
        sum += leg;
        there += std::abs(leg);
    }
    EXPECT_GT(there, 1);
    EXPECT_NEAR(sum, 0, 1e-3);
}

} // namespace
} // namespace phantom::test
