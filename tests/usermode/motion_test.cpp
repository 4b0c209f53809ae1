// SPDX-License-Identifier: GPL-2.0-or-later
// Poses of moving frames in fixed point (phantom_motion.h), against the motion in long double.
#include <random>

#include "machine.hpp"
#include "motion_probe.h"

namespace phantom::test {
namespace {

using Real = long double;
using Vector = std::array<Real, 3>;
using Quaternion = std::array<Real, 4>;
using Point = std::array<std::int64_t, 3>;

constexpr std::uint64_t ms = 1'000'000; // ns
constexpr Real accuracy_nm = 10;        // a metre from the frame's origin, as phantom_motion.h says
constexpr Real accuracy_nm_rad = 1;

Vector cross(const Vector& a, const Vector& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Real length(const Vector& a)
{
    return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

/// Of a turn by that vector, rad.
Quaternion turn(const Vector& by)
{
    const Real angle = length(by), scale = angle > 0 ? std::sin(angle / 2) / angle : 0.5L;
    return {std::cos(angle / 2), by[0] * scale, by[1] * scale, by[2] * scale};
}

Quaternion times(const Quaternion& a, const Quaternion& b)
{
    return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
            a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
            a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
            a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

Quaternion unit(Quaternion q)
{
    Real square = 0;
    for (const Real x : q)
        square += x * x;
    for (Real& x : q)
        x /= std::sqrt(square);
    return q;
}

Vector turned(const Quaternion& q, const Vector& x)
{
    const Vector v{q[1], q[2], q[3]}, t = cross(v, x), u = cross(v, t);
    return {x[0] + 2 * (q[0] * t[0] + u[0]), x[1] + 2 * (q[0] * t[1] + u[1]),
            x[2] + 2 * (q[0] * t[2] + u[2])};
}

/// A motion, as it is and as a set says it.
struct Mover {
    Vector translation{}; ///< nm
    Quaternion rotation{1, 0, 0, 0};
    Vector velocity{}; ///< nm/s
    Vector about{};    ///< rad/s

    [[nodiscard]] phantom_object object() const
    {
        phantom_object out{};
        out.flags = PHANTOM_OBJECT_MOVES;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            out.translation_nm[axis] = std::llround(translation[axis]);
            out.velocity_nm_s[axis] = std::int32_t(std::llround(velocity[axis]));
            out.angular_velocity_urad_s[axis] = std::int32_t(std::llround(about[axis] * 1e6L));
        }
        for (std::size_t i = 0; i < 4; ++i)
            out.rotation_q30[i] = std::int32_t(std::llround(rotation[i] * PHANTOM_Q30_ONE));
        return out;
    }
    /// Exactly what such an object says.
    static Mover of(const phantom_object& object)
    {
        Mover out;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            out.translation[axis] = object.translation_nm[axis];
            out.velocity[axis] = object.velocity_nm_s[axis];
            out.about[axis] = object.angular_velocity_urad_s[axis] * 1e-6L;
        }
        for (std::size_t i = 0; i < 4; ++i)
            out.rotation[i] = object.rotation_q30[i];
        out.rotation = unit(out.rotation);
        return out;
    }
    [[nodiscard]] Mover after(Real s) const
    {
        Mover out = *this;
        for (std::size_t axis = 0; axis < 3; ++axis)
            out.translation[axis] += velocity[axis] * s;
        out.rotation = times(turn({about[0] * s, about[1] * s, about[2] * s}), rotation);
        return out;
    }
    [[nodiscard]] Vector place(const Vector& x) const
    {
        const Vector out = turned(rotation, x);
        return {out[0] + translation[0], out[1] + translation[1], out[2] + translation[2]};
    }
};

Vector leave(const Point& x)
{
    Point out;
    motion_probe_leave(x.data(), out.data());
    return {Real(out[0]), Real(out[1]), Real(out[2])};
}

Real apart(const Vector& a, const Vector& b)
{
    return length({a[0] - b[0], a[1] - b[1], a[2] - b[2]});
}

class Motion : public ::testing::Test {
  protected:
    Real any(Real most) { return std::uniform_real_distribution<double>(-1, 1)(random) * most; }
    Vector vector(Real most) { return {any(most), any(most), any(most)}; }
    Mover mover(Real speed_nm_s, Real rad_s)
    {
        Mover out;
        out.translation = vector(1e9L);
        out.rotation = unit({any(1), any(1), any(1), any(1)});
        out.velocity = vector(speed_nm_s);
        out.about = vector(rad_s);
        return out;
    }
    /// A metre away from the frame's origin.
    Point metre()
    {
        Vector v = vector(1);
        const Real scale = 1e9L / length(v);
        return {std::llround(v[0] * scale), std::llround(v[1] * scale), std::llround(v[2] * scale)};
    }

    std::mt19937 random{1};
};

TEST_F(Motion, IsTheExactOneForAsLongAsASetIsBelieved)
{
    for (int i = 0; i < 20000; ++i) {
        const Real slow = std::pow(10.0L, -7 * (i % 8) / 7.0L); // from the fastest to a few urad/s
        const phantom_object object = mover(2e9L * slow, 57 * slow).object();
        const Mover exact = Mover::of(object);
        const std::uint64_t time_ns = 1000 * ms + std::uint64_t(any(900) * Real(ms));
        const Real dt = any(1);
        const std::int64_t dt_ns = std::llround(dt * 1e9L);
        motion_probe_begin(&object, time_ns);
        motion_probe_at(time_ns + std::uint64_t(dt_ns));
        const Point x = metre();
        const Vector want = exact.after(Real(dt_ns) * 1e-9L).place({Real(x[0]), Real(x[1]), Real(x[2])});
        const Real angle = length(exact.about) * std::abs(Real(dt_ns)) * 1e-9L;
        ASSERT_LT(apart(leave(x), want), accuracy_nm + accuracy_nm_rad * angle);
    }
}

TEST_F(Motion, TakesARotationThatIsNotQuiteOfUnitLength)
{
    for (const Real scale : {1 - 0.0009L, 1 + 0.0009L}) {
        Mover mover;
        for (Real& part : mover.rotation)
            part = scale / 2;
        const phantom_object object = mover.object();
        motion_probe_begin(&object, 0);
        const Point x = metre();
        const Vector want = Mover::of(object).place({Real(x[0]), Real(x[1]), Real(x[2])});
        EXPECT_LT(apart(leave(x), want), accuracy_nm) << "it neither shrinks nor grows";
    }
}

TEST_F(Motion, GoesOnForMinutesWithoutDrift)
{
    // a set every 4 ms, each with its rounded pose; a tick every ms
    const Mover start = mover(2e6L, 8);
    const Mover exact = Mover::of(start.object());
    phantom_object object = start.object();
    motion_probe_begin(&object, 0);
    Real worst = 0;
    const Point x = metre(),
                tip{object.translation_nm[0], object.translation_nm[1], object.translation_nm[2]};
    for (std::uint64_t t = 1; t <= 180'000; ++t) {
        if (t % 4 == 0) {
            // made a millisecond ago
            const std::uint64_t made = (t - 1) * ms;
            object = exact.after(Real(made) * 1e-9L).object();
            ASSERT_TRUE(motion_probe_next(&object, made, t * ms, 4 * ms, tip.data()));
        }
        motion_probe_at(t * ms);
        const Vector want = exact.after(Real(t * ms) * 1e-9L).place({Real(x[0]), Real(x[1]), Real(x[2])});
        worst = std::max(worst, apart(leave(x), want));
    }
    // and what the set's own rounding makes: 1 nm, 2^-31 in each of four, nothing of the velocities
    EXPECT_LT(worst, accuracy_nm + 3);
}

TEST_F(Motion, StopsWhereASetIsTooOld)
{
    const phantom_object object = mover(2e9L, 50).object();
    const Mover exact = Mover::of(object);
    const std::uint64_t time_ns = 5'000 * ms;
    const Point x = metre(),
                origin{object.translation_nm[0], object.translation_nm[1], object.translation_nm[2]};
    for (const int sign : {1, -1}) {
        const std::uint64_t last = time_ns + std::uint64_t(sign * std::int64_t{PHANTOM_MOTION_MAX_NS});
        motion_probe_begin(&object, time_ns);
        Point velocity{};
        motion_probe_at(last);
        motion_probe_velocity(origin.data(), velocity.data());
        EXPECT_NE(velocity, Point{});
        motion_probe_at(last + std::uint64_t(sign * std::int64_t{3000 * ms}));
        motion_probe_velocity(origin.data(), velocity.data());
        EXPECT_EQ(velocity, Point{}) << "it stands";
        EXPECT_LT(apart(leave(x), exact.after(sign).place({Real(x[0]), Real(x[1]), Real(x[2])})),
                  accuracy_nm);
    }
}

TEST_F(Motion, EnteringAndLeavingAreInverse)
{
    Real worst = 0;
    for (int i = 0; i < 2000; ++i) {
        const phantom_object object = mover(0, 50).object();
        motion_probe_begin(&object, 0);
        motion_probe_at(any(500) > 0 ? 77 * ms : 0);
        Point place, inner;
        for (std::size_t axis = 0; axis < 3; ++axis)
            place[axis] = object.translation_nm[axis] + std::llround(any(4e9L));
        ASSERT_TRUE(motion_probe_enter(place.data(), inner.data()));
        if (length({Real(inner[0]), Real(inner[1]), Real(inner[2])}) > 5e9L)
            continue; // beyond what contact asks for
        worst = std::max(worst, apart(leave(inner), {Real(place[0]), Real(place[1]), Real(place[2])}));
    }
    EXPECT_LT(worst, 2 * 5 * accuracy_nm); // there and back, 5 m
    const phantom_object object = mover(0, 0).object();
    motion_probe_begin(&object, 0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int sign : {1, -1}) {
            Point place{object.translation_nm[0], object.translation_nm[1], object.translation_nm[2]}, inner;
            place[axis] += sign * 4'000'000'000LL;
            EXPECT_TRUE(motion_probe_enter(place.data(), inner.data()));
            place[axis] += sign;
            EXPECT_FALSE(motion_probe_enter(place.data(), inner.data()));
        }
    }
}

TEST_F(Motion, VelocityIsTheSurfacesAtTheTip)
{
    for (int i = 0; i < 500; ++i) {
        const phantom_object object = mover(2e9L, 40).object();
        const Mover exact = Mover::of(object);
        const Point x = metre();
        const Real t = any(0.9L);
        motion_probe_begin(&object, 2000 * ms);
        motion_probe_at(2000 * ms + std::uint64_t(std::llround(t * 1e9L)));
        Point place, velocity;
        motion_probe_leave(x.data(), place.data());
        motion_probe_velocity(place.data(), velocity.data());
        const Vector at = exact.after(t).place({Real(x[0]), Real(x[1]), Real(x[2])});
        const Mover now = exact.after(t);
        const Vector round = cross(exact.about, {at[0] - now.translation[0], at[1] - now.translation[1],
                                                 at[2] - now.translation[2]});
        for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(double(velocity[axis]), double(exact.velocity[axis] + round[axis]), 2000);
    }
}

// ---- from set to set

TEST_F(Motion, TakesANewPoseOverFromWhereItIs)
{
    const Real largest_turn = 0.19L, length_ms = 20;
    for (int i = 0; i < 500; ++i) {
        const phantom_object object = mover(1e9L, 20).object();
        motion_probe_begin(&object, 0);
        const std::uint64_t now = 10 * ms;
        motion_probe_at(now);
        const Mover is = Mover::of(object).after(0.010L);
        // turned by up to 0.19 rad, and moved by up to 5 mm
        Mover shall = is;
        Vector by = vector(1);
        const Real scale = largest_turn * (i % 10) / 9 / length(by);
        for (Real& x : by)
            x *= scale;
        shall.rotation = times(turn(by), is.rotation);
        if (i % 3 == 0)
            for (Real& x : shall.rotation)
                x = -x; // the same rotation
        for (Real& x : shall.translation)
            x += any(5e6L);
        shall.velocity = shall.about = {};
        const Point tip{std::llround(is.translation[0]), std::llround(is.translation[1]),
                        std::llround(is.translation[2])};
        const Point x = metre();
        const Vector before = leave(x);
        const phantom_object next = shall.object();
        ASSERT_TRUE(motion_probe_next(&next, now, now, std::uint64_t(length_ms) * ms, tip.data()));
        motion_probe_at(now);
        const Vector at_begin = leave(x);
        ASSERT_LT(apart(before, at_begin), 2 * accuracy_nm) << "no step";
        // as straight as a turn allows, and never back
        Vector last = at_begin;
        const Vector end = shall.place({Real(x[0]), Real(x[1]), Real(x[2])});
        const Real most = 1.02L * apart(before, end) / length_ms + 20;
        for (std::uint64_t tick = 1; tick <= 20; ++tick) {
            motion_probe_at(now + tick * ms);
            const Vector at = leave(x);
            ASSERT_LT(apart(at, last), most) << "tick " << tick;
            last = at;
        }
        ASSERT_LT(apart(last, end), accuracy_nm);
        motion_probe_at(now + 500 * ms);
        ASSERT_LT(apart(leave(x), end), accuracy_nm);
    }
}

TEST_F(Motion, FarFromWhereItWasIsAJump)
{
    struct Case {
        Vector shift;
        Real turn;
        bool near;
    };
    const Case cases[] = {
        {{9.99e6L, 0, 0}, 0, true},    {{0, -10.01e6L, 0}, 0, false}, {{6e6L, 6e6L, 6e6L}, 0, false},
        {{5e6L, 5e6L, 5e6L}, 0, true}, {{0, 0, 0}, 0.1999L, true},    {{0, 0, 0}, 0.2001L, false},
        {{0, 0, 0}, 3.0L, false},      {{0, 0, 5e18L}, 0, false},
    };
    for (const Case& c : cases) {
        Mover is;
        is.rotation = turn({0.3L, -0.2L, 0.9L});
        phantom_object object = is.object();
        motion_probe_begin(&object, 0);
        Mover shall = is;
        shall.rotation = times(turn({0, c.turn, 0}), is.rotation);
        object = shall.object();
        for (std::size_t axis = 0; axis < 3; ++axis)
            object.translation_nm[axis] = std::clamp<std::int64_t>(
                std::llround(c.shift[axis]), -PHANTOM_POSITION_MAX_NM, PHANTOM_POSITION_MAX_NM);
        const Point tip{0, 0, 0};
        EXPECT_EQ(motion_probe_next(&object, 0, 0, 4 * ms, tip.data()), c.near)
            << double(c.shift[0]) << ' ' << double(c.turn);
        if (c.near)
            continue;
        motion_probe_at(0);
        Point at{1, 1, 1}, zero{};
        motion_probe_leave(zero.data(), at.data());
        EXPECT_EQ(at[2], object.translation_nm[2]) << "at once";
    }
}

} // namespace
} // namespace phantom::test
