// SPDX-License-Identifier: GPL-2.0-or-later
// Scenes that move and deform, from the feeder through the module's code on a virtual clock: the force of
// every tick against a formula.
#include <cmath>
#include <numbers>
#include <optional>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "feeder/feeder.hpp"
#include "feeder/moving_objects.hpp"
#include "feeder/path.hpp"
#include "scenes.hpp"

namespace phantom::test {
namespace {

using std::numbers::pi;

constexpr double ball_mm = 50, radius_mm = 3; ///< of sphere_scene(); k = 1 N/mm

/// A tip that stands still, 250 sets a second at 1 kHz unless said otherwise.
class Machine {
  public:
    Machine(const scene::Scene& scene, std::uint32_t rate_hz, std::uint32_t feed_every)
        : tree_(scene::build_tree<14>(scene)), rate_hz_(rate_hz), feed_every_(feed_every)
    {
        device::UsermodeOptions usermode;
        usermode.virtual_clock = true;
        usermode.rate_hz = rate_hz;
        device_.emplace(std::move(*device::Device::open_usermode(usermode)));
        check(
            device_->set_model(*device::model_from_words("projected", "bounded", "constrained", "float", 3)));
        feeder::FeederOptions options;
        options.rate_hz = static_cast<double>(rate_hz) / feed_every;
        feeder_.emplace(scene, tree_, *device_, options);
    }

    /// Starts with the scene at rest, lets the first set fade in, then everything begins to move.
    void begin(const Vector& tip)
    {
        check(device_->move_simulated_tip(feeder::to_nanometres(tip)));
        feed(tip, tip, false);
        phantom_start start{};
        start.flags = PHANTOM_START_LIMITS_OFF;
        start.stale_ms = 1000000;
        check(device_->start(start));
        check(device_->step(rate_hz_ / 20));
        last_ = device_->read_ticks()->back();
        feeder_->begin_motion();
        begin_ns_ = last_.time_ns;
    }

    phantom_tick tick(const Vector& tip)
    {
        check(device_->move_simulated_tip(feeder::to_nanometres(tip)));
        const bool inside = (last_.flags & PHANTOM_TICK_INSIDE) != 0;
        Vector proxy = tip;
        for (int axis = 0; axis < 3 && inside; ++axis)
            proxy[axis] = static_cast<double>(last_.proxy_nm[axis]) * 1e-6;
        if (ticks_++ % feed_every_ == 0)
            feed(tip, proxy, inside);
        check(device_->step(1));
        return last_ = device_->read_ticks()->back();
    }

    [[nodiscard]] double seconds() const { return 1e-9 * static_cast<double>(last_.time_ns - begin_ns_); }
    [[nodiscard]] Vector force() const
    {
        return {last_.force_un[0] * 1e-6, last_.force_un[1] * 1e-6, last_.force_un[2] * 1e-6};
    }
    feeder::Feeder& feeder() { return *feeder_; }
    device::Device& device() { return *device_; }

  private:
    static void check(const Status& status) { ASSERT_TRUE(status) << status.error().text(); }
    void feed(const Vector& tip, const Vector& proxy, bool inside)
    {
        const auto fed = feeder_->feed(tip, proxy, inside);
        ASSERT_TRUE(fed) << fed.error().text();
    }

    fdh::SceneTree<14> tree_;
    std::optional<device::Device> device_;
    std::optional<feeder::Feeder> feeder_;
    std::uint32_t rate_hz_, feed_every_, ticks_ = 0;
    phantom_tick last_{};
    std::uint64_t begin_ns_ = 0;
};

/// The same scene at rest, a set for every tick: what is felt there, seen from the object that moves.
class Rest {
  public:
    explicit Rest(scene::Scene scene) : scene_(at_rest(std::move(scene))), machine_(scene_, 1000, 1) {}

    /// In the world, of a tip there while the first object is at this place.
    Vector force(const Vector& tip, const scene::Placement& now)
    {
        const Vector resting = now.to_frame(tip) + now.centre_mm;
        if (!std::exchange(begun_, true))
            machine_.begin(resting);
        machine_.tick(resting);
        return now.to_world(machine_.force()) - now.centre_mm - now.offset_mm;
    }

  private:
    static scene::Scene at_rest(scene::Scene scene)
    {
        for (scene::Object& object : scene.objects)
            object.motion.reset();
        return scene;
    }
    scene::Scene scene_;
    Machine machine_;
    bool begun_ = false;
};

TEST(MovingScene, ForceOfABallThatSwingsIsThatOfItsPlaceNow)
{
    scene::Scene scene = sphere_scene();
    constexpr double amplitude = 3, frequency = 1.5;
    scene.objects[0].motion = scene::Motion{.kind = scene::Motion::Kind::oscillation,
                                            .axis = unit({1, 2, 2}),
                                            .frequency = frequency,
                                            .amplitude_mm = amplitude,
                                            .ramp_s = 0.3};
    Machine machine(scene, 1000, 4);
    const Vector tip = 51.0 * unit({1, 2, 2.5});
    machine.begin(tip);
    // A set is 5 ms old at most, and a straight line is half of a t^2 off; the next set takes that back in as
    // long. The ball's acceleration is (2 pi f)^2 A, in the ramp up to 1.5 / ramp 2 pi f A more.
    const double acceleration = 2 * pi * frequency * amplitude * (2 * pi * frequency + 1.5 / 0.3);
    const double bound = acceleration * 0.005 * 0.005;
    EXPECT_LT(bound, 0.011); // N, of 4
    Rest rest(scene);
    double worst = 0, least = 9, most = 0;
    Vector before = machine.force();
    double step = 0;
    for (int i = 0; i < 1000; ++i) {
        const phantom_tick tick = machine.tick(tip);
        ASSERT_FALSE(tick.flags & PHANTOM_TICK_UNCOVERED) << i;
        const scene::Placement now = scene.objects[0].motion->at(machine.seconds());
        const Vector force = machine.force();
        worst = std::max(worst, length(force - rest.force(tip, now)));
        step = std::max(step, length(force - before));
        before = force;
        least = std::min(least, length(force));
        most = std::max(most, length(force));
    }
    EXPECT_LT(worst, bound);
    // No step beyond what a tick's way gives, and twice the bound.
    EXPECT_LT(step, 2 * pi * frequency * amplitude * 0.001 + 0.5 * bound);
    EXPECT_LT(least, 0.01); // it leaves the tip
    EXPECT_GT(most, 4.5);   // and comes over it: 1.5 mm below the surface
}

TEST(MovingScene, ForceOfABallOnATurntableIsExact)
{
    scene::Scene scene = sphere_scene();
    scene.objects[0].pose = quarter_turn({10, 0, 0});
    scene.objects[0].motion = scene::Motion{.kind = scene::Motion::Kind::turntable,
                                            .axis = {0, 0, 1},
                                            .centre_mm = {9, 0, 0},
                                            .frequency = 2,
                                            .ramp_s = 0.2};
    Machine machine(scene, 3000, 12);
    const Vector tip = {9 + 51.5, 0, 3};
    machine.begin(tip);
    Rest rest(scene);
    double worst = 0, most = 0;
    for (int i = 0; i < 1500; ++i) {
        const phantom_tick tick = machine.tick(tip);
        ASSERT_FALSE(tick.flags & PHANTOM_TICK_UNCOVERED) << i;
        const scene::Placement now = scene.objects[0].motion->at(machine.seconds());
        const double error = length(machine.force() - rest.force(tip, now));
        most = std::max(most, length(machine.force()));
        if (machine.seconds() > 0.21)
            worst = std::max(worst, error);
    }
    // Nanometres and 2^-30 rad of rounding; the turn rate is constant, so nothing is off by extrapolation.
    EXPECT_LT(worst, 1e-4);
    EXPECT_GT(most, 2);
}

TEST(MovingScene, AFastBodyThatComesOverARestingTipPushesItAndIsNeverPassedThrough)
{
    scene::Scene scene = sphere_scene();
    // 30 mm at 4 Hz: 0.75 m/s; 5 mm below the surface at its highest.
    scene.objects[0].motion = scene::Motion{.kind = scene::Motion::Kind::oscillation,
                                            .axis = {0, 0, 1},
                                            .frequency = 4,
                                            .amplitude_mm = 30,
                                            .ramp_s = 0.5};
    Machine machine(scene, 1000, 4);
    const Vector tip = {1, 2, 75};
    machine.begin(tip);
    const double acceleration = 30 * std::pow(2 * pi * 4, 2);
    Rest rest(scene);
    int pushed = 0;
    for (int i = 0; i < 1000; ++i) {
        const phantom_tick tick = machine.tick(tip);
        ASSERT_FALSE(tick.flags & PHANTOM_TICK_UNCOVERED) << i;
        const scene::Placement now = scene.objects[0].motion->at(machine.seconds());
        const Vector wanted = rest.force(tip, now);
        EXPECT_LT(length(machine.force() - wanted), acceleration * 0.005 * 0.005 + 0.01) << i;
        pushed += wanted[2] > 3.5;
    }
    EXPECT_GT(pushed, 20);
    EXPECT_EQ(machine.device().status().faults, 0U);
}

/// Patches as the servo places them at the set's time.
Vector placed(const phantom_object& object, const __s32 (&vertex_nm)[3])
{
    const std::array<double, 4> q = {object.rotation_q30[0] / 0x1p30, object.rotation_q30[1] / 0x1p30,
                                     object.rotation_q30[2] / 0x1p30, object.rotation_q30[3] / 0x1p30};
    const auto r = scene::rotation_of(q);
    Vector out;
    for (int row = 0; row < 3; ++row) {
        out[row] = static_cast<double>(object.translation_nm[row]);
        for (int column = 0; column < 3; ++column)
            out[row] +=
                r[3 * row + column] * static_cast<double>(vertex_nm[column] + object.origin_nm[column]);
    }
    return 1e-6 * out;
}

TEST(MovingScene, PatchesOfASetAreWhereTheirFacesAre)
{
    scene::Scene scene = sphere_scene();
    scene.objects[0].pose = quarter_turn({100, -20, 30});
    scene.objects[0].motion = scene::Motion{.kind = scene::Motion::Kind::turntable,
                                            .axis = unit({1, 1, 3}),
                                            .centre_mm = {40, 0, 0},
                                            .frequency = 1,
                                            .ramp_s = 0.1};
    const auto tree = scene::build_tree<14>(scene);
    scene::LiveScene live(scene, tree);
    feeder::SetBuilder builder(live.scene());
    live.advance(0.77);
    const Vector centre = live.moment()->objects[0].placement->to_world({75, -20, 60});
    fdh::Nearest near;
    live.tree().nearest(centre, 50, 100, near);
    near.sort();
    device::PatchSet set;
    builder.build(near, centre, set, {.time_ns = 42, .moment = live.moment().get()});
    ASSERT_EQ(set.patches.size(), 50U);
    ASSERT_EQ(set.objects.size(), 1U);
    EXPECT_EQ(set.header.time_ns, 42U);
    const phantom_object& object = set.objects[0];
    EXPECT_EQ(object.flags, PHANTOM_OBJECT_MOVES);
    const fdh::Pose pose = live.moment()->pose(scene, 0);
    for (const phantom_patch& patch : set.patches)
        for (int corner = 0; corner < 3; ++corner) {
            const Vector& local = scene.objects[0].mesh.vertices[patch.vertex[corner]];
            EXPECT_LT(length(fdh::to_local(pose, placed(object, patch.vertex_nm[corner])) - local), 5e-6);
        }
    EXPECT_LE(set.header.radius_nm, near.coverage * 1e6 - 10);
}

TEST(MovingScene, WhatMovesAndMayComeNearIsNamedWithoutPatches)
{
    scene::Scene scene = sphere_scene();
    add_object(scene, sphere(5, 40, 80), {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 200}}, 0);
    const scene::Motion swing{
        .kind = scene::Motion::Kind::oscillation, .axis = {0, 0, 1}, .frequency = 4, .amplitude_mm = 130};
    scene.objects[1].motion = swing;
    const auto tree = scene::build_tree<14>(scene);
    scene::LiveScene live(scene, tree);
    feeder::SetBuilder builder(live.scene());
    live.advance(3);
    fdh::Nearest near;
    const Vector centre = {50.5, 0, 0};
    live.tree().nearest(centre, 20, 100, near);
    near.sort();
    device::PatchSet set;
    const std::vector<std::uint32_t> named = {1};
    builder.build(near, centre, set, {.time_ns = 1, .moment = live.moment().get(), .near = named});
    ASSERT_EQ(set.objects.size(), 2U);
    EXPECT_EQ(set.objects[0].flags, 0U);
    EXPECT_EQ(set.objects[1].object, 1U);
    EXPECT_EQ(set.objects[1].flags, PHANTOM_OBJECT_MOVES);
    for (const phantom_patch& patch : set.patches)
        EXPECT_EQ(patch.object, 0U);
}

TEST(MovingObjects, WhatComesWithinReachBeforeTheNextRoundIsNear)
{
    scene::Scene scene = sphere_scene();
    add_object(scene, sphere(5, 20, 40), {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 100}}, 0);
    scene.objects[1].motion = scene::Motion{.kind = scene::Motion::Kind::oscillation,
                                            .axis = {0, 1, 0},
                                            .frequency = 3,
                                            .amplitude_mm = 100,
                                            .ramp_s = 0.2};
    scene::LiveScene live(scene, scene::build_tree<14>(scene));
    feeder::MovingObjects moving(scene);
    constexpr double delay_s = 0.004, reach_mm = 3;
    const Vector tip = {0, 40, 100};
    int near = 0, far = 0;
    for (double t = 0; t < 1.5; t += delay_s) {
        live.advance(t);
        moving.look({*live.moment(), tip, {}, delay_s}, reach_mm);
        bool comes = false;
        for (int part = 0; part <= 4; ++part) {
            const scene::Placement then = scene.objects[1].motion->at(t + 0.25 * part * delay_s);
            comes = comes || length(then.to_frame(tip) - Vector{0, 0, 100}) < 5 + reach_mm;
        }
        if (comes) {
            EXPECT_EQ(moving.near(), std::vector<std::uint32_t>{1}) << t;
            const double speed = length(live.moment()->objects[1].placement->velocity_mm_s);
            EXPECT_DOUBLE_EQ(moving.speed_mm_s(), speed);
            EXPECT_GE(moving.way_mm(), 0.999 * scene::way_margin * speed * delay_s);
        }
        near += !moving.near().empty();
        far += moving.near().empty();
    }
    EXPECT_GT(near, 30);
    EXPECT_GT(far, 200);
    EXPECT_TRUE(feeder::MovingObjects(sphere_scene()).none());
}

/// Over the pole 512 triangles, all that a set takes, cover 5 mm. What comes at 1.5 m/s is named although no
/// set has its triangles: the tip gets uncovered then, and nothing is passed through unnoticed.
TEST(MovingScene, WhatMayComeNearIsNamedWhereSetsCannotReachIt)
{
    scene::Scene scene = sphere_scene();
    add_object(scene, sphere(5, 20, 40), {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {30, 0, 60}}, 0);
    scene.objects[1].motion = scene::Motion{.kind = scene::Motion::Kind::oscillation,
                                            .axis = {1, 0, 0},
                                            .frequency = 8,
                                            .amplitude_mm = 30,
                                            .ramp_s = 0.1};
    struct Sets : device::Device::Listener {
        int named = 0, absent = 0;
        void started(const phantom_start&, std::uint64_t) override {}
        void submitting(const device::PatchSet& set) override
        {
            const auto moving = std::find_if(set.objects.begin(), set.objects.end(),
                                             [](const auto& object) { return object.flags != 0; });
            const auto number = static_cast<std::uint32_t>(moving - set.objects.begin());
            const bool with_patches =
                std::any_of(set.patches.begin(), set.patches.end(),
                            [number](const auto& patch) { return patch.object == number; });
            absent += moving == set.objects.end();
            named += moving != set.objects.end() && !with_patches;
        }
    } sets;
    Machine machine(scene, 1000, 4);
    machine.device().listen(&sets);
    const Vector tip = {0, 0, 51};
    machine.begin(tip);
    for (int i = 0; i < 1000; ++i)
        machine.tick(tip);
    machine.device().listen(nullptr);
    EXPECT_GT(sets.named, 5);
    EXPECT_GT(sets.absent, 100); // no byte where it is far away
}

TEST(MovingScene, MoreThanASetCanCarryCutItsCoverage)
{
    scene::Scene scene;
    scene.materials.push_back({"hard", 1.0, 3.0, {}});
    for (int i = 0; i < 5; ++i) {
        add_object(scene, sphere(4, 6, 8), {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {9.0 * i, 0, 0}}, 0);
        scene.objects.back().motion = scene::Motion{.frequency = 1};
    }
    const auto tree = scene::build_tree<14>(scene);
    scene::LiveScene live(scene, tree);
    feeder::SetBuilder builder(live.scene());
    live.advance(0);
    fdh::Nearest near;
    const Vector centre = {0, 6, 0};
    live.tree().nearest(centre, 900, 100, near);
    near.sort();
    device::PatchSet set;
    builder.build(near, centre, set, {.time_ns = 1, .moment = live.moment().get()});
    EXPECT_EQ(set.objects.size(), 3U);
    // To the fourth ball.
    EXPECT_NEAR(set.header.radius_nm * 1e-6, std::hypot(27, 6) - 4, 0.6);
}

TEST(MovingScene, AnObjectFarFromTheCentreOfItsMotionIsRefused)
{
    scene::Scene scene = sphere_scene();
    scene.file = "far.toml";
    for (const double x : {1700.0, 1760.0}) {
        scene.objects[0].motion = scene::Motion{.centre_mm = {x, 0, 0}, .frequency = 1};
        const Status status = feeder::check_reach(scene, {});
        EXPECT_EQ(status.ok(), x < 1710);
        if (!status) {
            EXPECT_EQ(
                status.error().text().substr(0, 86),
                "far.toml: object object0: reaches 1847 mm from the centre of its motion, a set 1800 mm");
        }
    }
}

/// A drum's head under a tip that stands still: 0.4 mm above it at rest.
TEST(DeformingScene, ForceFollowsTheHeadAndHasNoSteps)
{
    scene::Scene scene = sphere_scene();
    constexpr double amplitude = 1.2, frequency = 2, ramp = 0.4;
    scene.objects[0].deformation = scene::Deformation{.centre_mm = {0, 0, 50},
                                                      .radius_mm = 35,
                                                      .depth_mm = 60,
                                                      .amplitude_mm = amplitude,
                                                      .frequency_hz = frequency,
                                                      .ramp_s = ramp};
    constexpr std::uint32_t rate = 3000;
    Machine machine(scene, rate, 12);
    const Vector tip = {0, 0, 51.5};
    machine.begin(tip);
    const double speed = scene.objects[0].deformation->speed_max_mm_s();
    // A shape comes every 12 ms (three rounds) and fades in within 20: what is felt is up to that much late.
    const double late_mm = speed * 0.032;
    double step = 0, worst = 0;
    double before = machine.force()[2];
    EXPECT_NEAR(before, 1.5, 1e-4);
    for (std::uint32_t i = 0; i < rate; ++i) {
        const phantom_tick tick = machine.tick(tip);
        ASSERT_FALSE(tick.flags & PHANTOM_TICK_UNCOVERED) << i;
        const double force = machine.force()[2];
        step = std::max(step, std::abs(force - before));
        before = force;
        const double head = scene.objects[0].deformation->displacement_mm(machine.seconds());
        worst = std::max(worst, std::abs(force - (radius_mm - (1.5 - head))));
    }
    EXPECT_LT(worst, late_mm);
    EXPECT_GT(worst, 0.001 * late_mm);
    // A shape's whole rise, felt within the crossfade: 12 ms of way in 20 ms, twice where two overlap.
    EXPECT_LT(step, 2 * speed * 0.012 / (0.020 * rate));
    EXPECT_GT(machine.feeder().moment()->objects[0].revision, 70U);
}

TEST(DeformingScene, ATipBelowTheSurfaceStaysBelowItWhileItRises)
{
    scene::Scene scene = sphere_scene();
    scene.objects[0].deformation = scene::Deformation{
        .centre_mm = {0, 0, 50}, .radius_mm = 35, .depth_mm = 60, .amplitude_mm = 4, .frequency_hz = 3};
    Machine machine(scene, 1000, 4);
    // From 3.5 mm below the head to 4.5 mm above: in and out, three times a second.
    const Vector tip = {0.5, 0, 50.5};
    machine.begin(tip);
    int inside = 0;
    for (int i = 0; i < 1400; ++i) {
        const phantom_tick tick = machine.tick(tip);
        const double head = 50 + scene.objects[0].deformation->displacement_mm(machine.seconds());
        const double depth = head + radius_mm - tip[2];
        // As late as above, at 75 mm/s; and the sphere's curvature half a millimetre off its axis.
        EXPECT_NEAR(machine.force()[2], std::max(0.0, depth), 75 * 0.036 + 0.05) << i;
        inside += (tick.flags & PHANTOM_TICK_INSIDE) != 0;
    }
    EXPECT_GT(inside, 200);
}

TEST(MovingScene, IsTheSameEveryTimeOnAVirtualClock)
{
    scene::Scene scene = sphere_scene();
    scene.objects[0].motion = scene::Motion{.frequency = 1.3, .ramp_s = 0.1};
    scene.objects[0].deformation =
        scene::Deformation{.centre_mm = {0, 0, 50}, .radius_mm = 35, .amplitude_mm = 1, .frequency_hz = 2};
    const auto run = [&scene] {
        Machine machine(scene, 1000, 4);
        const Vector tip = {3, 1, 50.8};
        machine.begin(tip);
        std::vector<__s32> forces;
        for (int i = 0; i < 300; ++i)
            for (const __s32 component : machine.tick(tip).force_un)
                forces.push_back(component);
        return forces;
    };
    EXPECT_EQ(run(), run());
}

/// What a viewer does while the feeder's thread runs; ThreadSanitizer would see a race.
TEST(MovingScene, OthersMayLookAtItsMomentsWhileItIsFed)
{
    scene::Scene scene = sphere_scene();
    scene.objects[0].motion = scene::Motion{.frequency = 1, .ramp_s = 0.1};
    scene.objects[0].deformation =
        scene::Deformation{.centre_mm = {0, 0, 50}, .radius_mm = 35, .amplitude_mm = 1, .frequency_hz = 2};
    const auto tree = scene::build_tree<14>(scene);
    auto device = device::Device::open_usermode({});
    ASSERT_TRUE(device);
    feeder::Feeder feeder(scene, tree, *device, {.rate_hz = 1000});
    ASSERT_TRUE(feeder.feed({0, 0, 52}, {0, 0, 52}, false));
    feeder.begin_motion();
    std::jthread feeding([&feeder](const std::stop_token& stop) { (void)feeder.run(stop); });
    fdh::Nearest near;
    std::uint32_t revision = 0;
    while (revision < 5) {
        const auto moment = feeder.moment();
        ASSERT_TRUE(moment);
        revision = moment->objects[0].revision;
        double highest = 0;
        for (const Vector& vertex : moment->objects[0].vertices)
            highest = std::max(highest, moment->objects[0].placement->to_world(vertex)[2]);
        EXPECT_NEAR(highest, 50, 1.001);
        // The scene at rest is everyone's.
        tree.nearest({0, 0, 52}, 10, 50, near);
        EXPECT_GE(feeder.last().hits.size(), 64U);
    }
}

} // namespace
} // namespace phantom::test
