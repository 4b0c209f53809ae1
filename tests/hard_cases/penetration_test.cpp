// SPDX-License-Identifier: GPL-2.0-or-later
// The whole machine under a surface: real queries, sets of 64 triangles, the module on its virtual clock,
// against the nearest point by brute force. penetration_bench prints the large version.
#include <gtest/gtest.h>

#include "study/penetration.hpp"

namespace {

using namespace phantom;

/// The tightest curve of the bumps, and how deep the tip comes under them.
constexpr double bump_radius_mm = 12.9, depth_max_mm = 4.0;

class Penetration : public testing::Test {
  protected:
    static void SetUpTestSuite()
    {
        Result<study::PenetrationSurface> built = study::PenetrationSurface::build({50, 32, 20});
        ASSERT_TRUE(built) << built.error().text();
        surface_ = new study::PenetrationSurface(std::move(*built));
    }
    static void TearDownTestSuite()
    {
        delete surface_;
        surface_ = nullptr;
    }
    static study::PenetrationOptions rub(double speed_mm_s, double rate_hz)
    {
        study::PenetrationOptions options;
        options.path = {
            .speed_mm_s = speed_mm_s, .seconds = 0.5, .rate_hz = rate_hz, .lift_s = 0.25, .lifting_s = 0.05};
        options.check_every = static_cast<std::uint32_t>(rate_hz / 200);
        return options;
    }
    static study::PenetrationResult run(const study::PenetrationOptions& options)
    {
        const auto result = study::run_penetration(*surface_, options);
        EXPECT_TRUE(result) << result.error().text();
        return *result;
    }
    static void expect_held(const study::PenetrationResult& result)
    {
        EXPECT_GT(result.under, 50U);
        EXPECT_GT(result.outside, 10U);
        EXPECT_EQ(result.lost, 0U);
        EXPECT_EQ(result.fell_through, 0U);
        EXPECT_EQ(result.stuck, 0U);
        EXPECT_EQ(result.kept, 0U);
        EXPECT_LE(result.patches_max, 64U);
    }
    /// What the coarsest level that was used may be wrong by: it lies aside by its error, and its faces, flat
    /// and as long as an edge, turn the way to the nearest point by half of what the surface turns over them.
    static double error_allowed_n(const study::PenetrationResult& result)
    {
        std::size_t coarsest = 0;
        for (std::size_t level = 0; level < result.level_ticks.size(); ++level)
            coarsest = result.level_ticks[level] ? level : coarsest;
        const double edge_mm = 70.0 / surface_->frequencies()[coarsest];
        const double edge_finest_mm = 70.0 / surface_->frequencies()[0];
        return study::soft_stiffness_n_mm *
               (surface_->levels()->error_mm(coarsest) +
                depth_max_mm * (edge_mm + edge_finest_mm) / (2 * bump_radius_mm));
    }

    static study::PenetrationSurface* surface_;
};

study::PenetrationSurface* Penetration::surface_ = nullptr;

TEST_F(Penetration, OfABumpySphereIsHeldAtTheNearestPointAtEverySpeedAndRate)
{
    for (const auto& [speed_mm_s, rate_hz] : {std::pair{20.0, 1000.0},
                                              {100.0, 1000.0},
                                              {500.0, 1000.0},
                                              {20.0, 3000.0},
                                              {500.0, 3000.0},
                                              {100.0, 10000.0}}) {
        SCOPED_TRACE(testing::Message() << speed_mm_s << " mm/s at " << rate_hz << " Hz");
        const study::PenetrationResult result = run(rub(speed_mm_s, rate_hz));
        expect_held(result);
        EXPECT_LE(result.error_p99, 0.001);
        EXPECT_EQ(result.level_ticks[0], result.under) << "the finest level alone";
    }
}

TEST_F(Penetration, WithLateSetsIsHeldOnTheLevelThatTheSpeedAllows)
{
    for (const double speed_mm_s : {20.0, 100.0, 500.0}) {
        for (const std::uint32_t every : {1U, 3U, 10U}) {
            SCOPED_TRACE(testing::Message() << speed_mm_s << " mm/s, a set every " << every << " ms");
            study::PenetrationOptions options = rub(speed_mm_s, 1000);
            options.timely = false;
            options.feed_every = every;
            const study::PenetrationResult result = run(options);
            expect_held(result);
            EXPECT_LE(result.error_p99, error_allowed_n(result));
            if (speed_mm_s * every <= 20) {
                EXPECT_LE(result.error_p99, 0.001) << "slow: the finest level";
            } else if (speed_mm_s * every >= 5000) {
                EXPECT_EQ(result.level_ticks[0], 0U) << "fast: no set of the finest level lasts";
            }
        }
    }
}

/// A hand that hurries and lingers: the levels change in mid-contact, and the proxy goes along.
TEST_F(Penetration, AtASpeedThatComesAndGoesChangesLevelsWithoutAStep)
{
    for (const double rate_hz : {1000.0, 3000.0}) {
        study::PenetrationOptions options = rub(250, rate_hz);
        options.path.swing = 0.95;
        options.path.seconds = 1.6;
        options.path.lift_s = 0.8;
        options.timely = false;
        options.feed_every = static_cast<std::uint32_t>(rate_hz / 200);
        const study::PenetrationResult result = run(options);
        expect_held(result);
        EXPECT_GE(result.level_changes, 5U);
        EXPECT_LE(result.error_p99, error_allowed_n(result));
        EXPECT_LE(result.step_max, 1000 / rate_hz) << "the slew limit, 1 N per ms";
    }
}

} // namespace
