// SPDX-License-Identifier: GPL-2.0-or-later
// Levels that any mesh gets, touched: the feeder chooses, the servo fades from one to the other, on the
// virtual clock, against the nearest point of the finest mesh by brute force.
#include <cmath>

#include <gtest/gtest.h>

#include "feeder/feeder.hpp"
#include "study/penetration.hpp"

namespace phantom::test {
namespace {

class Touch : public testing::Test {
  protected:
    static void SetUpTestSuite()
    {
        auto built = study::PenetrationSurface::simplified(40, 500, 0.01);
        ASSERT_TRUE(built) << built.error().text();
        surface_ = new study::PenetrationSurface(std::move(*built));
    }
    static void TearDownTestSuite()
    {
        delete surface_;
        surface_ = nullptr;
    }
    static device::Device machine()
    {
        device::UsermodeOptions usermode;
        usermode.virtual_clock = true;
        auto device = device::Device::open_usermode(usermode);
        EXPECT_TRUE(device) << device.error().text();
        return std::move(*device);
    }
    static study::PenetrationSurface* surface_;
};

study::PenetrationSurface* Touch::surface_ = nullptr;

TEST_F(Touch, OfAHandThatHurriesAndLingersChangesLevelsAndNothingIsLost)
{
    ASSERT_GE(surface_->levels()->size(), 3U);
    study::PenetrationOptions options;
    options.path = {.speed_mm_s = 250, .swing = 0.95, .seconds = 1.6, .rate_hz = 1000, .lift_s = 0.8};
    options.timely = false;
    options.feed_every = 8;
    const auto result = study::run_penetration(*surface_, options);
    ASSERT_TRUE(result) << result.error().text();
    EXPECT_GT(result->under, 50U);
    EXPECT_EQ(result->lost, 0U);
    EXPECT_EQ(result->fell_through, 0U);
    EXPECT_EQ(result->stuck, 0U);
    EXPECT_GE(result->level_changes, 3U);
    std::size_t used = 0;
    for (const std::uint64_t ticks : result->level_ticks)
        used += ticks > 0;
    EXPECT_GE(used, 2U);
    EXPECT_LE(result->step_max, 1.0) << "the slew limit, 1 N per ms";
}

TEST_F(Touch, InNoHurryIsOnTheFinestLevelAndExact)
{
    study::PenetrationOptions options;
    options.path = {.speed_mm_s = 20, .seconds = 0.5, .rate_hz = 1000, .lift_s = 0.25, .lifting_s = 0.05};
    const auto finest = study::run_penetration(*surface_, options);
    ASSERT_TRUE(finest);
    EXPECT_LE(finest->error_p99, 0.001);
    EXPECT_EQ(finest->level_ticks[0], finest->under);
}

TEST_F(Touch, SetsSayTheirLevelAndItsError)
{
    device::Device device = machine();
    for (const std::uint32_t wanted : {0U, 1U, 99U}) {
        feeder::Feeder feeder(surface_->scene(), surface_->tree(), device, {.level = wanted});
        const std::array<double, 3> tip{50.2, 0, 0};
        ASSERT_TRUE(feeder.feed(tip, tip, false));
        EXPECT_EQ(feeder.last().level, 0U) << "before there are any";
        feeder.use(surface_->levels());
        ASSERT_TRUE(feeder.feed(tip, tip, false));
        const std::size_t level = std::min<std::size_t>(wanted, surface_->levels()->size() - 1);
        EXPECT_EQ(feeder.last().level, level);
        if (device.status().state == PHANTOM_STATE_IDLE) {
            phantom_start start{};
            start.flags = PHANTOM_START_LIMITS_OFF;
            ASSERT_TRUE(device.start(start));
        }
        ASSERT_TRUE(device.step(3));
        EXPECT_EQ(device.status().set_level, level);
        EXPECT_NEAR(device.status().set_level_error_nm * 1e-6, surface_->levels()->error_mm(level), 1e-6);
    }
}

TEST_F(Touch, AtRestIsOnTheFinestLevelThatCoversTheContactRadius)
{
    device::Device device = machine();
    feeder::Feeder feeder(surface_->scene(), surface_->tree(), device, {});
    feeder.use(surface_->levels());
    const std::array<double, 3> tip{50.2, 0, 0};
    for (int i = 0; i < 20; ++i)
        ASSERT_TRUE(feeder.feed(tip, tip, false));
    ASSERT_GT(surface_->levels()->finest.p1_mm, study::soft_radius_mm);
    EXPECT_EQ(feeder.last().level, 0U);
    const feeder::Feeder::Totals totals = feeder.totals();
    EXPECT_EQ(totals.level_sets.at(0), totals.sets);
}

} // namespace
} // namespace phantom::test
