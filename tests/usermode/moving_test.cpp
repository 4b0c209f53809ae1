// SPDX-License-Identifier: GPL-2.0-or-later
// Objects that move (phantom_abi.h, MOVING OBJECTS): contact, coverage and memory in their frames.
#include <numbers>
#include <random>

#include "moving.hpp"

namespace phantom::test {
namespace {

constexpr double k = 1, radius = 3; // N/mm, mm

// ---- where it is

class Posed : public MachineTest {
  protected:
    /// A bowl of some faces round the frame's origin, and its vertices in the scene.
    static Plane bump(std::uint64_t id, const std::function<Place(const Place&)>& placed,
                      const std::function<Place(const Place&)>& turned_by)
    {
        Plane out(id);
        const phantom_patch proto = out.patches[0];
        out.patches.clear();
        constexpr int n = 4;
        const auto corner = [&](phantom_patch& patch, int c, int i, int j) {
            const Place x{double(i - n / 2) * 2, double(j - n / 2) * 2, 0};
            Place normal{x[0] * 0.05, x[1] * 0.05, 1};
            const double size = length(normal);
            for (double& part : normal)
                part /= size;
            const Place at = placed({x[0], x[1], -0.02 * (x[0] * x[0] + x[1] * x[1])}), m = turned_by(normal);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                patch.vertex_nm[c][axis] = std::int32_t(std::lround(at[axis] * 1e6));
                patch.normal_q30[c][axis] = std::int32_t(std::lround(m[axis] * PHANTOM_Q30_ONE));
            }
            patch.vertex[c] = std::uint32_t(i * (n + 1) + j);
        };
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) {
                for (int half = 0; half < 2; ++half) {
                    phantom_patch patch = proto;
                    corner(patch, 0, i, j);
                    corner(patch, 1, i + 1, j + half);
                    corner(patch, 2, i + (half ? 0 : 1), j + 1);
                    if (half) {
                        corner(patch, 1, i + 1, j + 1);
                        corner(patch, 2, i, j + 1);
                    }
                    patch.face = std::uint32_t(out.patches.size());
                    for (auto& neighbour : patch.neighbour)
                        neighbour = PHANTOM_PATCH_NONE;
                    out.patches.push_back(patch);
                }
            }
        }
        return out;
    }
    static void link(Plane& plane)
    {
        for (phantom_patch& a : plane.patches)
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t b = 0; b < plane.patches.size(); ++b)
                    for (std::size_t j = 0; j < 3; ++j)
                        if (plane.patches[b].vertex[j] == a.vertex[(i + 1) % 3] &&
                            plane.patches[b].vertex[(j + 1) % 3] == a.vertex[i])
                            a.neighbour[i] = std::uint32_t(b);
    }
    /// Forces and proxies along a path that goes in and slides below, frame coordinates.
    std::vector<phantom_tick> along(Plane& set, const Pose& pose)
    {
        create({});
        File feeder(machine);
        link(set);
        cover_round(set, pose.at);
        EXPECT_EQ(feeder.submit(set), 0);
        const auto go = [&](const Place& x) {
            const Place p = pose.place(x);
            feeder.move(std::llround(p[0] * 1e6), std::llround(p[1] * 1e6), std::llround(p[2] * 1e6));
        };
        go({0.3, 0.2, 6});
        EXPECT_EQ(feeder.start_unlimited(), 0);
        for (int i = 0; i < 400; ++i) {
            go({0.3 + 0.005 * i, 0.2 - 0.004 * i, 6 - 8 * std::sin(i * 0.02)});
            step();
        }
        return feeder.read();
    }
};

TEST_F(Posed, FeelsAsTheSameSurfaceThatRestsThere)
{
    std::mt19937 random{3};
    std::uniform_real_distribution<double> any(-1, 1);
    for (int i = 0; i < 6; ++i) {
        Pose pose;
        pose.at = {any(random) * 100, any(random) * 100, any(random) * 100};
        Place axis{any(random), any(random), any(random)};
        const double size = length(axis);
        for (double& part : axis)
            part /= size;
        if (i > 0) // the first is moved only
            pose.turn = turn_about(axis, 3 * any(random));
        Plane rests = bump(
            1, [&](const Place& x) { return pose.place(x); },
            [&](const Place& n) { return turned(pose.turn, n); });
        Plane moves = bump(
            1, [](const Place& x) { return x; }, [](const Place& n) { return n; });
        set_moving(moves, pose, 0, {3 * mm, -5 * mm, i * mm});
        const auto want = along(rests, pose), got = along(moves, pose);
        ASSERT_EQ(want.size(), got.size());
        int inside = 0, touched = 0;
        for (std::size_t t = 0; t < want.size(); ++t) {
            ASSERT_EQ(want[t].flags, got[t].flags) << t;
            ASSERT_EQ(want[t].contacts, got[t].contacts) << t;
            inside += (want[t].flags & PHANTOM_TICK_INSIDE) != 0;
            touched += want[t].contacts != 0;
            for (int a = 0; a < 3; ++a) {
                // vertices and tips are rounded to nm in both, directions over 2 mm
                ASSERT_NEAR(want[t].force_un[a], got[t].force_un[a], 25) << t;
                ASSERT_NEAR(want[t].proxy_nm[a], got[t].proxy_nm[a], 25) << t;
            }
        }
        EXPECT_GT(inside, 100);
        EXPECT_GT(touched, 150);
    }
}

class Moving : public MovingTest {};

TEST_F(Moving, TheModuleSaysThatItCan)
{
    File feeder_(machine);
    phantom_info info{};
    ASSERT_EQ(feeder_.ioctl(PHANTOM_GET_INFO, &info), 0);
    EXPECT_TRUE(info.features & PHANTOM_FEATURE_MOVING_OBJECTS);
}

TEST_F(Moving, TheSetsAgreeWithTheMotionBetweenThem)
{
    // 150 mm/s up under a tip that goes along, a metre from where it turns at 2 rev/s
    const double omega = 4 * std::numbers::pi;
    pose = [&](double t) {
        Pose out;
        out.at = {1000 - 1000 * std::cos(0), 0, 150 * t};
        out.turn = turn_about({0, 0, 1}, omega * t);
        out.velocity = {0, 0, 150};
        out.about = {0, 0, omega};
        return out;
    };
    half_nm = 900'000'000;
    begin({30, 0, 2});
    for (int i = 0; i < 2000; ++i) {
        const double t = time() + 1e-3; // of the tick to come
        const Place force = tick({30, 0, 150 * t + 2});
        ASSERT_NEAR(force[2], k * (radius - 2), 2e-5) << i;
        ASSERT_EQ(flags & PHANTOM_TICK_UNCOVERED, 0u);
        if (i == 1000)
            every = 40; // late sets
    }
    EXPECT_EQ(feeder->status().fades, 1u) << "the first, from nothing";
}

TEST_F(Moving, StatusSaysProxyAndNormalInTheScene)
{
    pose = [](double) {
        Pose out;
        out.at = {10, 20, 30};
        out.turn = turn_about({0, 1, 0}, std::numbers::pi / 2); // its z is the scene's x
        return out;
    };
    begin({12, 20, 30});
    EXPECT_NEAR(feeder->status().force_un[0], 1e6, 5);
    EXPECT_NEAR(feeder->status().normal_q30[0], PHANTOM_Q30_ONE, 200);
    for (int i = 0; i < 50; ++i)
        tick({12 - 0.1 * i, 20, 31});
    const phantom_status status = feeder->status();
    EXPECT_TRUE(status.flags & PHANTOM_TICK_INSIDE);
    EXPECT_NEAR(double(status.proxy_nm[0]), 10e6, 20);
    EXPECT_NEAR(double(status.proxy_nm[1]), 20e6, 20);
    EXPECT_NEAR(double(status.proxy_nm[2]), 31e6, 20);
    EXPECT_NEAR(status.force_un[0], 1e6 * (radius + 2.9), 30);
    EXPECT_EQ(status.contacts, 1u);
}

// ---- a surface that comes

class Piston : public MovingTest {
  protected:
    /// Comes up to a resting tip that it is sent through by 6 mm, and stops.
    void push(double speed_mm_s, std::uint32_t hz = 1000)
    {
        pose = [=](double t) {
            const double rise = std::clamp(speed_mm_s * (t - 0.1), 0.0, 20.0);
            Pose out;
            out.at = {0, 0, rise - 14};
            out.velocity = {0, 0, rise > 0 && rise < 20 ? speed_mm_s : 0};
            return out;
        };
        begin({1, 1, 0}, {}, hz);
        const int end = int((0.2 + 20 / speed_mm_s) * hz);
        for (int i = 0; i < end; ++i) {
            const Place force = tick({1, 1, 0});
            ASSERT_EQ(flags & PHANTOM_TICK_UNCOVERED, 0u) << i;
            const double height = -pose(time()).at[2];
            // where the motion begins and ends the servo is up to a set late
            const double late = 1e-3 * speed_mm_s * (every + 2) + 1e-4;
            if (height < radius - late) {
                ASSERT_NEAR(force[2], k * (radius - height), k * late) << i;
            }
            if (height < -late) {
                ASSERT_TRUE(flags & PHANTOM_TICK_INSIDE) << i << " fell through";
            }
        }
        EXPECT_NEAR(feeder->status().force_un[2], 1e6 * k * (radius + 6), 50);
        EXPECT_TRUE(flags & PHANTOM_TICK_INSIDE);
    }
};

TEST_F(Piston, PushesARestingTipAndDoesNotPassThroughIt)
{
    // up to the fastest that velocity_nm_s holds
    for (const double speed : {1.0, 50.0, 500.0, 2100.0})
        push(speed);
    push(2100, 10'000);
}

TEST_F(Piston, TakesTheTipAlongWhereItGoesAway)
{
    pose = [](double t) {
        Pose out;
        out.at = {0, 0, -100 * t};
        out.velocity = {0, 0, -100};
        return out;
    };
    begin({0, 0, -1});
    Place force{};
    for (int i = 0; i < 60; ++i)
        force = tick({0, 0, -1});
    EXPECT_EQ(force[2], 0) << "it has left";
    EXPECT_EQ(flags & PHANTOM_TICK_INSIDE, 0u);
}

// ---- from set to set

TEST_F(Moving, NoForceStepsWhereSetsCorrectAnOscillation)
{
    // +-5 mm at 2 Hz; a set each 4 ms, 1 ms old: the pose it corrects is off by a dt^2 / 2
    const double amplitude = 5, omega = 4 * std::numbers::pi;
    pose = [=](double t) {
        Pose out;
        out.at = {0, 0, amplitude * std::sin(omega * t)};
        out.velocity = {0, 0, amplitude * omega * std::cos(omega * t)};
        return out;
    };
    begin({0, 0, 7});
    double last = tick({0, 0, 7})[2], worst_step = 0, worst_error = 0;
    for (int i = 0; i < 3000; ++i) {
        const double force = tick({0, 0, 7})[2];
        const double height = 7 - pose(time()).at[2];
        worst_error = std::max(worst_error, std::abs(force - std::max(0.0, k * (radius - height))));
        worst_step = std::max(worst_step, std::abs(force - last));
        last = force;
    }
    const double acceleration = amplitude * omega * omega, dt = 5e-3, tick_s = 1e-3;
    // the surface's own way in a tick, what the extrapolation has got too fast, and the correction of a set
    const double off = k * acceleration * dt * dt / 2;
    EXPECT_LT(worst_step, k * (amplitude * omega * tick_s + acceleration * dt * tick_s) + off / 4);
    EXPECT_LT(worst_error, 2 * off + 1e-5);
    // a step of the whole correction would be that much
    EXPECT_LT(worst_step - k * amplitude * omega * tick_s, 0.5 * off);
}

TEST_F(Moving, AJumpForgetsTheContactAndFades)
{
    bool jumped = false;
    pose = [&](double) {
        Pose out;
        out.at = {0, 0, jumped ? 11.0 : 0};
        return out;
    };
    begin({0, 0, 1});
    EXPECT_NEAR(tick({0, 0, 1})[2], 2, 1e-5);
    jumped = true;
    double last = 2;
    for (int i = 0; i < 40; ++i) {
        const double force = tick({0, 0, 1})[2];
        ASSERT_LE(last - force, 2.0 / 20 + 1e-3);
        last = force;
    }
    EXPECT_EQ(last, 0) << "10 mm below a surface that never passed it";
    EXPECT_EQ(flags & PHANTOM_TICK_INSIDE, 0u);
}

TEST_F(Moving, WhatMovesByLessIsFelt)
{
    bool moved = false;
    pose = [&](double) {
        Pose out;
        out.at = {0, 0, moved ? 9.0 : 0};
        return out;
    };
    begin({0, 0, 1});
    moved = true;
    double last = 2;
    for (int i = 0; i < 40; ++i) {
        const double force = tick({0, 0, 1})[2];
        ASSERT_LE(force - last, 9.0 / 4 + 1e-3) << "in the time from set to set";
        last = force;
    }
    EXPECT_NEAR(last, k * (radius + 8), 1e-4);
    EXPECT_TRUE(flags & PHANTOM_TICK_INSIDE);
}

TEST_F(Moving, ItsOffsetIsGoneInTheTimeBetweenSetsOrAFade)
{
    bool moved = false;
    pose = [&](double) {
        Pose out;
        out.at = {0, 0, moved ? 1.0 : 0};
        return out;
    };
    for (const auto& [interval, length] : {std::pair{4u, 4u}, std::pair{10u, 10u}, std::pair{60u, 20u}}) {
        moved = false;
        every = interval;
        begin({0, 0, 2});
        while (ticks % every)
            tick({0, 0, 2});
        moved = true;
        for (unsigned i = 0; i <= length + 5; ++i)
            EXPECT_NEAR(tick({0, 0, 2})[2], 1 + std::min(1.0, double(i) / length), 1e-5)
                << interval << ' ' << i;
    }
}

TEST_F(Moving, OneThatLeavesTheSetFadesAndIsKnownAgain)
{
    bool there = true;
    begin({0, 0, 3.5});
    for (int i = 0; i < 90; ++i)
        tick({0, 0, 3.5 - 0.05 * i}); // to 0.95 mm below
    ASSERT_TRUE(flags & PHANTOM_TICK_INSIDE);
    every = 1'000'000;
    const auto send = [&] {
        Plane next = plane(++set_id);
        if (!there) {
            next.patches.clear();
            next.objects.clear();
        }
        ASSERT_EQ(feeder->submit(next), 0);
    };
    for (const auto& [away, kept] : {std::pair{40, true}, std::pair{99, true}, std::pair{130, false}}) {
        there = false;
        send();
        double last = feeder->status().force_un[2] * 1e-6;
        for (int i = 0; i < away; ++i) {
            const double force = tick({0, 0, -0.95})[2];
            ASSERT_LE(last - force, (k * radius + 0.95) / 20 + 1e-3);
            ASSERT_EQ(flags & PHANTOM_TICK_INSIDE, 0u);
            last = force;
        }
        EXPECT_EQ(last, 0);
        there = true;
        send();
        for (int i = 0; i < 30; ++i)
            last = tick({0, 0, -0.95})[2];
        EXPECT_EQ((flags & PHANTOM_TICK_INSIDE) != 0, kept) << away;
        EXPECT_NEAR(last, kept ? radius + 0.95 : 0, 1e-4) << away;
    }
}

TEST_F(Moving, ItsContactGoesWithItsNumberNotWithItsPlaceInTheSet)
{
    begin({0, 0, 3.5});
    for (int i = 0; i < 90; ++i)
        tick({0, 0, 3.5 - 0.05 * i});
    every = 1'000'000;
    std::mt19937 random{5};
    for (int i = 0; i < 60; ++i) {
        Plane next = plane(++set_id);
        // others come, go and stand before or behind it
        next.objects[0].object = 0;
        std::vector<phantom_object> all(next.objects);
        for (std::uint32_t other = 1; other <= random() % PHANTOM_MOVING_MAX; ++other) {
            phantom_object object = next.objects[0];
            object.object = other * 10 + random() % 3;
            all.push_back(object);
        }
        std::shuffle(all.begin(), all.end(), random);
        std::uint32_t mine = 0;
        while (all[mine].object != 0)
            ++mine;
        next.objects = all;
        for (phantom_patch& patch : next.patches)
            patch.object = mine;
        ASSERT_EQ(feeder->submit(next), 0);
        ASSERT_NEAR(tick({0, 0, -0.95})[2], radius + 0.95, 2e-3) << i;
        ASSERT_TRUE(flags & PHANTOM_TICK_INSIDE) << i;
    }
}

TEST_F(Moving, ARestingObjectThatBeginsToMoveFadesOver)
{
    begin({0, 0, 1});
    const double full = k * 2;
    for (const bool moves : {false, true, false}) {
        double last = feeder->status().force_un[2] * 1e-6;
        EXPECT_NEAR(last, full, 1e-5);
        every = 1'000'000;
        for (int i = 0; i < 30; ++i) {
            if (i % 4 == 0) {
                Plane next = plane(++set_id);
                if (!moves) {
                    next.objects[0] = {};
                    next.objects[0].rotation_q30[0] = PHANTOM_Q30_ONE;
                }
                ASSERT_EQ(feeder->submit(next), 0);
            }
            const double force = tick({0, 0, 1})[2];
            ASSERT_LE(std::abs(force - last), full / 20 + 1e-3) << i;
            last = force;
        }
        EXPECT_NEAR(last, full, 1e-5);
    }
}

// ---- coverage

TEST_F(Moving, ATipThatASurfaceCarriesOutOfItsCoverageIsUncovered)
{
    // the plane slides below a resting tip at 1 m/s: 40 mm of coverage last for 37 ms
    pose = [](double t) {
        Pose out;
        out.at = {1000 * t, 0, 0};
        out.velocity = {1000, 0, 0};
        return out;
    };
    begin({0, 0, 2});
    submit();
    every = 1'000'000;
    int covered = 0;
    for (int i = 0; i < 60; ++i) {
        tick({0, 0, 2});
        covered += !(flags & PHANTOM_TICK_UNCOVERED);
    }
    EXPECT_NEAR(covered, 37, 1);
    EXPECT_TRUE(flags & PHANTOM_TICK_UNCOVERED);
    EXPECT_EQ(feeder->status().force_un[2], 0) << "it has faded";
    // without patches near the tip the frame still says what it does not know
    half_nm = 1000;
    submit();
    tick({0, 0, 2});
    EXPECT_FALSE(flags & PHANTOM_TICK_UNCOVERED);
    for (int i = 0; i < 60; ++i)
        tick({0, 0, 2});
    EXPECT_TRUE(flags & PHANTOM_TICK_UNCOVERED);
}

TEST_F(Moving, ASetIsAskedForWhenItsSlackRunsOut)
{
    pose = [](double t) {
        Pose out;
        out.at = {500 * t, 0, 0};
        out.velocity = {500, 0, 0};
        return out;
    };
    begin({0, 0, 2});
    submit();
    every = 1'000'000;
    tick({0, 0, 2});
    int asked = -1;
    for (int i = 0; i < 70 && asked < 0; ++i) {
        tick({0, 0, 2});
        if (feeder->poll(POLLPRI) & POLLPRI)
            asked = i;
    }
    EXPECT_NEAR(asked, (40 - 3) / 2 / 0.5, 4) << "half of 37 mm at 500 mm/s";
}

TEST_F(Moving, AFrameFarAwayCoversNothing)
{
    begin({0, 0, 2});
    pose = [](double) {
        Pose out;
        out.at = {4001, 0, 0};
        return out;
    };
    half_nm = 1000;
    for (int i = 0; i < 8; ++i)
        tick({0, 0, 2});
    EXPECT_TRUE(flags & PHANTOM_TICK_UNCOVERED);
}

// ---- effects

TEST_F(Moving, DampingKnowsTheVelocityAgainstTheSurface)
{
    const double up = 100; // mm/s
    pose = [=](double t) {
        Pose out;
        out.at = {0, 0, up * t};
        out.velocity = {0, 0, up};
        return out;
    };
    for (const bool along : {true, false}) {
        begin({0, 0, 2});
        double last = 0;
        Plane damped = plane(++set_id);
        damped.materials[0].effects = damped.header.effects = PHANTOM_EFFECT_DAMPING;
        damped.materials[0].damping_mns_m = 2000; // 2e-3 N per mm/s
        every = 1'000'000;
        ASSERT_EQ(feeder->submit(damped), 0);
        const double from = up * time();
        for (int i = 1; i <= 25; ++i)
            last = tick({0, 0, 2 + from + (along ? up * i * 1e-3 : 0)})[2];
        // along: nothing to damp. Else the plane comes at 100 mm/s and has come 2.5 mm
        EXPECT_NEAR(last, along ? 1.0 : 1 + 2.5 + 0.2, along ? 3e-3 : 5e-3);
    }
}

} // namespace
} // namespace phantom::test
