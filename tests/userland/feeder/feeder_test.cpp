// SPDX-License-Identifier: GPL-2.0-or-later
// The feeder with the module's code on a virtual clock.
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "feeder/feeder.hpp"
#include "feeder/path.hpp"
#include "scenes.hpp"

namespace phantom::test {
namespace {

/// A machine, a feeder, and a tip that moves.
class Hand {
  public:
    Hand(const scene::Scene& scene, const feeder::FeederOptions& options)
        : all_(options.all), tree_(scene::build_tree<14>(scene))
    {
        device::UsermodeOptions usermode;
        usermode.virtual_clock = true;
        usermode.patches_max = options.all ? static_cast<std::uint32_t>(scene.triangles()) : 0;
        auto device = device::Device::open_usermode(usermode);
        if (!device)
            throw std::runtime_error(device.error().text());
        device_.emplace(std::move(*device));
        check(device_->set_model(*device::model_from_words("projected", "bounded", "paper", "float", 3)));
        feeder_.emplace(scene, tree_, *device_, options);
    }

    phantom_tick move(const Vector& tip)
    {
        check(device_->move_simulated_tip(feeder::to_nanometres(tip)));
        Vector proxy = tip;
        const bool inside = (last_.flags & PHANTOM_TICK_INSIDE) != 0;
        if (inside)
            for (int axis = 0; axis < 3; ++axis)
                proxy[axis] = static_cast<double>(last_.proxy_nm[axis]) * 1e-6;
        // A set with everything stays good.
        if (!all_ || !started_) {
            auto fed = feeder_->feed(tip, proxy, inside);
            if (!fed)
                throw std::runtime_error(fed.error().text());
            report = *fed;
        }
        if (!started_) {
            phantom_start start{};
            start.flags = PHANTOM_START_LIMITS_OFF;
            start.stale_ms = 1000000;
            check(device_->start(start));
            started_ = true;
        }
        check(device_->step(1));
        auto ticks = device_->read_ticks();
        if (!ticks || ticks->size() != 1)
            throw std::runtime_error("expected one record");
        return last_ = ticks->front();
    }

    feeder::FeedReport report;

  private:
    static void check(const Status& status)
    {
        if (!status)
            throw std::runtime_error(status.error().text());
    }
    bool all_;
    fdh::SceneTree<14> tree_;
    std::optional<device::Device> device_;
    std::optional<feeder::Feeder> feeder_;
    phantom_tick last_{};
    bool started_ = false;
};

/// Round the sphere of 50 mm, from outside its shell into it and up to half a millimetre below the surface.
Vector along_sphere(int i)
{
    const double turn = 0.002 * i, tilt = 0.4 + 0.001 * i;
    const double distance = 50.0 + 2.0 + 2.5 * std::cos(0.01 * i);
    return {distance * std::cos(turn) * std::sin(tilt), distance * std::sin(turn) * std::sin(tilt),
            distance * std::cos(tilt)};
}

TEST(Feeder, ForceWithABudgetEqualsTheWholeMeshs)
{
    const scene::Scene scene = sphere_scene();
    feeder::FeederOptions few, all;
    all.all = true;
    Hand selected(scene, few), whole(scene, all);
    int contacts = 0, inside = 0;
    for (int i = 0; i < 1500; ++i) {
        const Vector tip = along_sphere(i);
        const phantom_tick a = selected.move(tip), b = whole.move(tip);
        // float32 with an origin up to 50 mm away resolves 4 nm; k is 1 N/mm.
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(a.force_un[axis], b.force_un[axis], 100) << "tick " << i;
        EXPECT_EQ(a.flags & (PHANTOM_TICK_INSIDE | PHANTOM_TICK_UNCOVERED), b.flags & PHANTOM_TICK_INSIDE);
        EXPECT_LE(selected.report.patches, 512U);
        contacts += a.contacts > 0;
        inside += (a.flags & PHANTOM_TICK_INSIDE) != 0;
    }
    EXPECT_GT(contacts, 500);
    EXPECT_GT(inside, 50);
}

TEST(Feeder, ForceOutsideIsTheSpheresOwn)
{
    const scene::Scene scene = sphere_scene();
    Hand hand(scene, {});
    int checked = 0;
    for (int i = 0; i < 1500; ++i) {
        const Vector tip = along_sphere(i);
        const phantom_tick tick = hand.move(tip);
        const double distance = std::hypot(tip[0], tip[1], tip[2]);
        // A chord of the tessellation lies up to 0.07 mm below the sphere; radial normals keep the direction.
        if (distance < 50.0 || (tick.flags & PHANTOM_TICK_INSIDE))
            continue;
        ++checked;
        const double expected = std::max(0.0, 3.0 - (distance - 50.0));
        const Vector force{tick.force_un[0] * 1e-6, tick.force_un[1] * 1e-6, tick.force_un[2] * 1e-6};
        const double size = std::hypot(force[0], force[1], force[2]);
        EXPECT_NEAR(size, expected, 0.08) << "tick " << i;
        for (int axis = 0; size > 0.1 && axis < 3; ++axis)
            EXPECT_NEAR(force[axis] / size, tip[axis] / distance, 1e-5);
    }
    EXPECT_GT(checked, 500);
}

TEST(Feeder, TheBudgetGrowsUntilTheContactRadiusIsCovered)
{
    scene::Scene scene = sphere_scene();
    scene.materials[0].radius_mm = 8.0;
    feeder::FeederOptions options;
    options.budget = 16;
    Hand grows(scene, options);
    grows.move({0, 30, 43});
    EXPECT_GT(grows.report.patches, 16U);
    EXPECT_GE(grows.report.coverage_mm, 8.0);
    options.grow_budget = false;
    Hand stays(scene, options);
    stays.move({0, 30, 43});
    EXPECT_EQ(stays.report.patches, 16U);
    EXPECT_LT(stays.report.coverage_mm, 8.0);
}

TEST(Feeder, TheTipOfTheRoundBeforeIsCovered)
{
    const scene::Scene scene = sphere_scene();
    Hand hand(scene, {});
    hand.move({0, 0, 52});
    for (const double way : {0.5, 2.0, 8.0}) {
        Hand mover(scene, {});
        mover.move({0, 0, 52});
        mover.move({way, 0, 52});
        EXPECT_GE(mover.report.coverage_mm, way);
    }
}

TEST(Feeder, FarFromEverythingASetIsEmptyAndCoversTheSearchRadius)
{
    const scene::Scene scene = sphere_scene();
    Hand hand(scene, {});
    const phantom_tick tick = hand.move({0, 0, 500});
    EXPECT_EQ(hand.report.patches, 0U);
    EXPECT_NEAR(hand.report.coverage_mm, 50.0, 1e-5);
    EXPECT_EQ(tick.flags & PHANTOM_TICK_UNCOVERED, 0U);
    for (const __s32 force : tick.force_un)
        EXPECT_EQ(force, 0);
}

TEST(Feeder, AFallThroughTheSurfaceInOneTickIsSeen)
{
    const scene::Scene scene = sphere_scene();
    Hand hand(scene, {});
    hand.move({0.3, 0.2, 54});
    const phantom_tick tick = hand.move({0.3, 0.2, 46});
    EXPECT_NE(tick.flags & PHANTOM_TICK_INSIDE, 0U);
    EXPECT_NEAR(tick.force_un[2] * 1e-6, 3.0 + 4.0, 0.1);
}

} // namespace
} // namespace phantom::test
