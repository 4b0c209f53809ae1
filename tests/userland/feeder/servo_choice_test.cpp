// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "device/device.hpp"
#include "feeder/servo_choice.hpp"

namespace phantom::test {
namespace {

TEST(ServoChoice, TheCommandLineGoesOverTheSceneOverTheDefaults)
{
    scene::ServoSettings asked, scene;
    scene.model = "paper";
    scene.steps = 1;
    asked.steps = 3;
    const auto model = feeder::choose_model(asked, scene, PHANTOM_FEATURE_PROXY_CONSTRAINED);
    ASSERT_TRUE(model.ok());
    EXPECT_EQ(model->model, __u32{PHANTOM_MODEL_PAPER});
    EXPECT_EQ(model->newton_steps, 3U);
    EXPECT_EQ(model->combine, __u32{PHANTOM_COMBINE_BOUNDED});
    EXPECT_EQ(model->proxy, __u32{PHANTOM_PROXY_CONSTRAINED});
}

TEST(ServoChoice, TheProxyIsThePapersWhereNoOtherIsOffered)
{
    const auto model = feeder::choose_model({}, {}, 0);
    ASSERT_TRUE(model.ok());
    EXPECT_EQ(model->model, __u32{PHANTOM_MODEL_PROJECTED});
    EXPECT_EQ(model->proxy, __u32{PHANTOM_PROXY_PAPER});
}

TEST(ServoChoice, AnUnknownWordListsTheKnownOnes)
{
    scene::ServoSettings scene;
    scene.combine = "sum";
    const auto model = feeder::choose_model({}, scene, 0);
    ASSERT_FALSE(model.ok());
    EXPECT_NE(model.error().text().find("paper, bounded"), std::string::npos);
}

TEST(ServoChoice, ARateOutsideTheModulesIsRefused)
{
    scene::ServoSettings settings;
    for (const double rate : {0.0, 999.0, 10001.0}) {
        settings.rate_hz = rate;
        EXPECT_FALSE(feeder::choose_rate(settings, {}).ok()) << rate;
    }
    settings.rate_hz = 3000;
    EXPECT_EQ(*feeder::choose_rate({}, settings), 3000U);
    EXPECT_EQ(*feeder::choose_rate({}, {}), 1000U);
}

TEST(ServoChoice, ChangingOneWordKeepsTheOthers)
{
    const auto now = device::model_from_words("paper", "paper", "off", "float", 0);
    ASSERT_TRUE(now.ok());
    scene::ServoSettings asked;
    asked.proxy = "paper";
    const auto model = feeder::change_model_words(*now, asked);
    ASSERT_TRUE(model.ok());
    EXPECT_EQ(model->model, now->model);
    EXPECT_EQ(model->combine, now->combine);
    EXPECT_EQ(model->proxy, __u32{PHANTOM_PROXY_PAPER});
    EXPECT_EQ(model->newton_steps, 0U);
}

TEST(ServoChoice, TheScenesLimitsFillWhatIsNotAsked)
{
    scene::DeviceSettings scene;
    scene.max_force_n = 2.5;
    scene.ramp_ms = 1e-9;
    phantom_start asked{};
    asked.slew_un_per_ms = 7;
    scene::ServoSettings servo;
    servo.crossfade_ms = 50;
    const phantom_start start = feeder::choose_start(asked, scene, servo);
    EXPECT_EQ(start.max_force_un, 2500000U);
    EXPECT_EQ(start.slew_un_per_ms, 7U);
    // Nothing rounds to zero: that would ask for the default.
    EXPECT_EQ(start.ramp_ms, 1U);
    EXPECT_EQ(start.crossfade_ms, 50U);
    asked.crossfade_ms = 7;
    EXPECT_EQ(feeder::choose_start(asked, scene, servo).crossfade_ms, 7U);
}

TEST(Histogram, PercentilesAreTheBucketsUpperEnds)
{
    phantom_histogram histogram{};
    EXPECT_EQ(device::percentile_ns(histogram, 0.5), 0.0);
    histogram.count[5] = 98;
    // 1000 ns = (8 + 7) 2^6 ... (9 + 7) 2^6: exponent 9, so bucket 8 (9 - 2) + 7.
    histogram.count[8 * 7 + 7] = 2;
    histogram.max_ns = 1000;
    EXPECT_EQ(device::total_count(histogram), 100U);
    EXPECT_EQ(device::percentile_ns(histogram, 0.5), 5.0);
    EXPECT_EQ(device::bucket_end_ns(8 * 7 + 7), 1024.0);
    EXPECT_EQ(device::percentile_ns(histogram, 0.99), 1000.0);
}

} // namespace
} // namespace phantom::test
