// SPDX-License-Identifier: GPL-2.0-or-later
// Sets in which something moves. mm, s, rad.
#pragma once

#include <functional>

#include "effects.hpp"

namespace phantom::test {

using Turn = std::array<double, 4>; ///< unit quaternion w x y z

/// By that angle about an axis of unit length.
inline Turn turn_about(const Place& axis, double angle)
{
    const double s = std::sin(angle / 2);
    return {std::cos(angle / 2), s * axis[0], s * axis[1], s * axis[2]};
}

inline Place turned(const Turn& q, const Place& x)
{
    const auto cross = [](const Place& a, const Place& b) {
        return Place{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    const Place v{q[1], q[2], q[3]}, t = cross(v, x), u = cross(v, t);
    return {x[0] + 2 * (q[0] * t[0] + u[0]), x[1] + 2 * (q[0] * t[1] + u[1]),
            x[2] + 2 * (q[0] * t[2] + u[2])};
}

/// Where a frame is, and how it moves.
struct Pose {
    Place at{};
    Turn turn{1, 0, 0, 0};
    Place velocity{}; ///< mm/s
    Place about{};    ///< rad/s

    [[nodiscard]] Place place(const Place& x) const
    {
        const Place y = turned(turn, x);
        return {y[0] + at[0], y[1] + at[1], y[2] + at[2]};
    }
};

/// The plane's first object becomes one that moves; its patches, so far in the scene, are now the frame's.
inline phantom_object& set_moving(Plane& plane, const Pose& pose, std::uint64_t time_ns,
                                  std::array<std::int64_t, 3> origin = {0, 0, 0})
{
    phantom_object& object = plane.objects[0];
    object.flags = PHANTOM_OBJECT_MOVES;
    plane.header.time_ns = time_ns;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        object.translation_nm[axis] = std::llround(pose.at[axis] * 1e6);
        object.velocity_nm_s[axis] = std::int32_t(std::lround(pose.velocity[axis] * 1e6));
        object.angular_velocity_urad_s[axis] = std::int32_t(std::lround(pose.about[axis] * 1e6));
        object.origin_nm[axis] = origin[axis];
        for (phantom_patch& patch : plane.patches)
            for (auto& vertex : patch.vertex_nm)
                vertex[axis] -= std::int32_t(origin[axis]);
    }
    for (std::size_t i = 0; i < 4; ++i)
        object.rotation_q30[i] = std::int32_t(std::lround(pose.turn[i] * PHANTOM_Q30_ONE));
    return object;
}

/// The plane's coverage is round that place.
inline void cover_round(Plane& plane, const Place& centre)
{
    for (std::size_t axis = 0; axis < 3; ++axis)
        plane.header.centre_nm[axis] =
            std::int32_t(std::llround(centre[axis] * 1e6) - plane.header.origin_nm[axis]);
}

/// A machine on a virtual clock, and a square plane of the frame's z = 0 that goes where `pose` says; a set
/// each `every` ticks, made that long before its tick.
class MovingTest : public MachineTest {
  protected:
    void TearDown() override
    {
        feeder.reset();
        MachineTest::TearDown();
    }

    void begin(const Place& tip, const Feel& what = {}, std::uint32_t hz = 1000)
    {
        feeder.reset();
        create({.rate_hz = hz});
        feeder.emplace(machine);
        period_ns = 1'000'000'000 / hz;
        feel = what;
        set_id = 0;
        ticks = 0;
        move(tip);
        submit();
        ASSERT_EQ(feeder->start_unlimited(), 0);
        now_ns = feeder->status().start_ns;
        submit();
        for (int i = 0; i < 30; ++i)
            tick(tip);
    }

    void move(const Place& tip)
    {
        at = tip;
        feeder->move(std::llround(tip[0] * 1e6), std::llround(tip[1] * 1e6), std::llround(tip[2] * 1e6));
    }

    /// In seconds from the first tick.
    [[nodiscard]] double time() const { return double(ticks) * double(period_ns) * 1e-9; }

    virtual Plane plane(std::uint64_t id)
    {
        Plane out(id, half_nm, 40'000'000);
        add_effects(out, feel);
        set_moving(out, pose(time()), now_ns);
        cover_round(out, at);
        return out;
    }

    void submit()
    {
        Plane next = plane(++set_id);
        ASSERT_EQ(feeder->submit(next), 0);
    }

    /// One tick with the tip there; its force, N.
    Place tick(const Place& tip)
    {
        move(tip);
        if (ticks % every == 0)
            submit();
        step();
        ++ticks;
        now_ns += period_ns;
        const phantom_status status = feeder->status();
        EXPECT_EQ(status.time_ns, now_ns);
        flags = status.flags;
        const auto& f = status.force_un;
        return {f[0] * 1e-6, f[1] * 1e-6, f[2] * 1e-6};
    }

    std::optional<File> feeder;
    Feel feel;
    std::function<Pose(double)> pose = [](double) { return Pose{}; };
    std::int32_t half_nm = 500'000'000;
    std::uint64_t set_id = 0, ticks = 0, every = 4;
    std::uint64_t period_ns = 1'000'000, now_ns = 0;
    std::uint32_t flags = 0;
    Place at{};
};

} // namespace phantom::test
