// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "view/camera_angles.hpp"
#include "view/colour.hpp"
#include "view/options.hpp"
#include "view/scene_words.hpp"

namespace phantom::view {
namespace {

std::variant<Options, int> parse(std::vector<std::string> words)
{
    words.insert(words.begin(), "fdhview");
    std::vector<char*> argv;
    for (std::string& word : words)
        argv.push_back(word.data());
    return parse_options(static_cast<int>(argv.size()), argv.data());
}

TEST(Words, NumbersAreGroupedByThree)
{
    EXPECT_EQ(grouped(0), "0");
    EXPECT_EQ(grouped(999), "999");
    EXPECT_EQ(grouped(1000), "1,000");
    EXPECT_EQ(grouped(69666), "69,666");
    EXPECT_EQ(grouped(1002003), "1,002,003");
}

TEST(ColourMap, GetsLighterAllTheWay)
{
    // Relative luminance (ITU-R BT.709 weights): what remains of it in grey.
    double before = -1;
    for (int i = 0; i <= 256; ++i) {
        const Colour c = viridis(i / 256.0);
        const double now = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
        EXPECT_GT(now, before) << i;
        before = now;
    }
}

TEST(ColourMap, OutsideItsRangeAndForNanItStaysAtItsEnds)
{
    EXPECT_EQ(viridis(-3), viridis(0));
    EXPECT_EQ(viridis(7), viridis(1));
    EXPECT_EQ(viridis(std::numeric_limits<double>::quiet_NaN()), viridis(0));
}

TEST(Camera, LooksAtASpotFromOutsideAndAtASlant)
{
    for (const Vec3& normal : {Vec3{1, 0, 0}, Vec3{0, 0, -1}, Vec3{0, 1, 0}, Vec3{0.6, 0, 0.8}}) {
        const double cosine = dot(CameraAngles::facing(normal).direction(), normal);
        EXPECT_GT(cosine, 0.1);
        EXPECT_LT(cosine, 0.9);
    }
}

TEST(Options, SizeAndCameraAreTakenAsWritten)
{
    const auto parsed = parse({"a.ply", "--size", "640x480", "--camera", "-30,12.5,2", "--prepare", "none"});
    ASSERT_TRUE(std::holds_alternative<Options>(parsed));
    const auto& options = std::get<Options>(parsed);
    EXPECT_EQ(options.width, 640);
    EXPECT_EQ(options.height, 480);
    ASSERT_TRUE(options.camera.has_value());
    EXPECT_DOUBLE_EQ(options.camera->azimuth_deg, -30);
    EXPECT_DOUBLE_EQ(options.camera->elevation_deg, 12.5);
    EXPECT_DOUBLE_EQ(options.camera->zoom, 2);
    EXPECT_FALSE(options.load.prepare.full);
    EXPECT_FALSE(options.offscreen());
}

TEST(Options, WrongUseIsStatus2)
{
    for (const std::vector<std::string>& words : {std::vector<std::string>{},
                                                  {"a.ply", "--size", "640"},
                                                  {"a.ply", "--size", "0x480"},
                                                  {"a.ply", "--size", "640x480x3"},
                                                  {"a.ply", "--camera", "1,2"},
                                                  {"a.ply", "--camera", "1,95,1"},
                                                  {"a.ply", "--camera", "1,nan,1"},
                                                  {"a.ply", "--rate", "50"},
                                                  {"a.ply", "--nonsense"},
                                                  {"a.ply", "--at-row", "3"},
                                                  {"a.ply", "--fit", "-1"}}) {
        const auto parsed = parse(words);
        ASSERT_TRUE(std::holds_alternative<int>(parsed)) << testing::PrintToString(words);
        EXPECT_EQ(std::get<int>(parsed), 2);
    }
}

TEST(Options, HelpIsStatus0)
{
    const auto parsed = parse({"--help"});
    ASSERT_TRUE(std::holds_alternative<int>(parsed));
    EXPECT_EQ(std::get<int>(parsed), 0);
}

} // namespace
} // namespace phantom::view
