// SPDX-License-Identifier: GPL-2.0-or-later
// Detail follows speed.
#include "feeder/level_choice.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scene/scene.hpp"

namespace {

using namespace phantom;
using feeder::LevelChoice;
using feeder::LevelDemand;

LevelChoice chain()
{
    return LevelChoice({{0.5, 0}, {1, 0.01}, {2, 0.02}, {4, 0.04}});
}

LevelDemand at_speed(double speed_mm_s, double delay_s = 0.01)
{
    return {.speed_mm_s = speed_mm_s, .delay_s = delay_s, .contact_radius_mm = 0.2};
}

TEST(LevelChoice, TakesTheFinestLevelThatLastsUntilTheNextSet)
{
    for (double speed = 0; speed < 400; speed += 0.7) {
        LevelChoice choice = chain(); // begins with the finest: hysteresis does not hold it back
        const std::size_t level = choice.choose(at_speed(speed));
        const double needed = 0.2 + LevelChoice::way_margin * speed * 0.01;
        EXPECT_DOUBLE_EQ(feeder::reach_needed_mm(at_speed(speed)), needed);
        EXPECT_TRUE(choice.level(level).reach_mm >= needed || level == 3) << speed;
        EXPECT_TRUE(level == 0 || choice.level(level - 1).reach_mm < needed) << speed;
    }
}

TEST(LevelChoice, OfADemandThatNoneMeetsIsTheCoarsest)
{
    LevelChoice choice = chain();
    EXPECT_EQ(choice.choose(at_speed(1e6)), 3U);
}

TEST(LevelChoice, CoarsensAtOnceAndRefinesWithAMargin)
{
    LevelChoice choice = chain();
    const double just_coarse = (1.0 - 0.2) / (LevelChoice::way_margin * 0.01) + 0.1; // 1 mm is not enough
    EXPECT_EQ(choice.choose(at_speed(just_coarse)), 2U);
    for (int i = 0; i < 100; ++i) // wavers round the limit: stays
        EXPECT_EQ(choice.choose(at_speed(just_coarse * (i % 2 ? 0.95 : 1.0))), 2U);
    for (unsigned i = 1; i < LevelChoice::finer_sets; ++i)
        EXPECT_EQ(choice.choose(at_speed(just_coarse * 0.7)), 2U) << "not yet";
    EXPECT_EQ(choice.choose(at_speed(just_coarse * 0.7)), 1U);
    EXPECT_EQ(choice.choose(at_speed(just_coarse * 0.95)), 1U);
}

TEST(LevelChoice, OfAHandThatTurnsRoundStaysCoarse)
{
    LevelChoice choice = chain();
    for (int tick = -100; tick <= 100; ++tick)
        EXPECT_EQ(choice.choose(at_speed(std::abs(tick) < 3 ? 0.0 : 200.0)), 3U) << tick;
}

TEST(LevelChoice, RefinesToWhatWouldHaveDoneAllTheTime)
{
    LevelChoice choice = chain();
    EXPECT_EQ(choice.choose(at_speed(200)), 3U);
    for (unsigned i = 1; i < LevelChoice::finer_sets; ++i)
        choice.choose(at_speed(i == 3 ? 40 : 0));
    EXPECT_EQ(choice.choose(at_speed(0)), 1U); // 0.8 mm at 40 mm/s
    for (unsigned i = 0; i < LevelChoice::finer_sets; ++i)
        choice.choose(at_speed(0));
    EXPECT_EQ(choice.current(), 0U);
}

/// What the formula promises, against the ball of a set: tip and a proxy as fast, on a flat surface.
TEST(LevelChoice, InsideTheSetOfThatReachHoldsTipAndProxyUntilTheNext)
{
    std::mt19937 random(4);
    std::uniform_real_distribution<double> any(0, 1);
    for (int i = 0; i < 10000; ++i) {
        const double depth = 5 * any(random), speed = 500 * any(random), delay = 0.01 * any(random);
        const double angle = 2 * M_PI * any(random); // of the motion: 0 is along the surface
        const double along = speed * std::cos(angle), dive = speed * std::sin(angle);
        const double reach = feeder::reach_needed_mm({.speed_mm_s = speed,
                                                      .delay_s = delay,
                                                      .contact_radius_mm = 0.2,
                                                      .depth_mm = depth,
                                                      .dive_mm_s = std::max(dive, 0.0)});
        const double covered = std::hypot(reach, depth / 2); // round the middle of tip and proxy
        const double tip = std::hypot(along * delay, depth / 2 + dive * delay);
        const double proxy = std::hypot(along * delay, depth / 2);
        EXPECT_LE(tip, covered + 1e-12);
        EXPECT_LE(proxy, covered + 1e-12);
    }
}

TEST(LevelChoice, ReachOfAFlatGridIsTheDiscOfItsBudget)
{
    // squares of 1 mm, two triangles each; the rim does not end the surface sooner than the budget
    mesh::Soup soup;
    constexpr unsigned side = 60;
    for (unsigned y = 0; y <= side; ++y)
        for (unsigned x = 0; x <= side; ++x)
            soup.vertices.push_back({double(x), double(y), 0});
    for (unsigned y = 0; y < side; ++y) {
        for (unsigned x = 0; x < side; ++x) {
            const unsigned v = y * (side + 1) + x;
            soup.faces.push_back({v, v + 1, v + side + 2});
            soup.faces.push_back({v, v + side + 2, v + side + 1});
        }
    }
    mesh::Mesh grid;
    grid.vertices = std::move(soup.vertices);
    grid.faces = std::move(soup.faces);
    scene::Scene scene;
    scene.materials.push_back({"any", 1, 1, {}});
    scene.objects.emplace_back();
    scene.objects[0].mesh = grid;
    const fdh::SceneTree<14> tree = scene::build_tree<14>(scene);
    const double reach = scene::measure_coverage(scene, tree, 64).p1_mm;
    EXPECT_LT(reach, std::sqrt(0.5 * 64 / M_PI)); // the disc of their area
    EXPECT_GT(reach, 0.6 * std::sqrt(0.5 * 64 / M_PI));
    EXPECT_GT(scene::measure_coverage(scene, tree, 256).p1_mm, 1.8 * reach);
}

} // namespace
