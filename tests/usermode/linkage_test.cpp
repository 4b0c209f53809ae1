// SPDX-License-Identifier: GPL-2.0-or-later
// The arm's kinematics against its equations in long double: sine and cosine, tip, Jacobian, inverse, bits.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

#include "arm_machine.h"

namespace {

using Real = long double;
using Vector = std::array<Real, 3>;

constexpr Real pi = 3.14159265358979323846264338327950288L;
constexpr Real base_mm = 80, upper_mm = 205, fore_mm = 245, capstan_mm = 10, counts_per_turn = 2000;
constexpr Real torque_constant = 0.0259L; // N m / A
constexpr Vector body_mm{160, 120, 120}, origin_mm{220, 0, 80};

Real angle(Real encoder, std::size_t joint)
{
    return encoder / counts_per_turn * capstan_mm / body_mm[joint] * 2 * pi;
}

Vector tip_mm(const Vector& a)
{
    const Real reach = upper_mm * std::sin(a[1]) + fore_mm * std::sin(a[2]);
    return {std::cos(a[0]) * reach - origin_mm[0], std::sin(a[0]) * reach - origin_mm[1],
            base_mm + upper_mm * std::cos(a[1]) - fore_mm * std::cos(a[2]) - origin_mm[2]};
}

Vector angles(const std::int32_t (&encoder)[3])
{
    return {angle(encoder[0], 0), angle(encoder[1], 1), angle(encoder[2], 2)};
}

/// The torques that the force asks for, by central differences of the tip, as motor currents in mA.
Vector currents_ma(const std::int32_t (&encoder)[3], const std::int32_t (&force_un)[3])
{
    constexpr Real step = 1e-6L;
    Vector current{};
    for (std::size_t joint = 0; joint < 3; ++joint) {
        Vector after = angles(encoder), before = after;
        after[joint] += step;
        before[joint] -= step;
        const Vector p = tip_mm(after), q = tip_mm(before);
        Real torque = 0; // N m
        for (std::size_t i = 0; i < 3; ++i)
            torque += (p[i] - q[i]) / (2 * step) * 1e-3L * Real(force_un[i]) * 1e-6L;
        current[joint] = torque * capstan_mm / body_mm[joint] / torque_constant * 1000;
    }
    return current;
}

/// Counts nearest to a tip, elbow up.
void reach(const Vector& tip, std::int32_t (&encoder)[3])
{
    const Real x = tip[0] + origin_mm[0], y = tip[1] + origin_mm[1];
    const Real height = tip[2] + origin_mm[2] - base_mm, out = std::hypot(x, y);
    const Real far = std::hypot(out, height);
    const Real b = std::atan2(out, height) -
                   std::acos((upper_mm * upper_mm + far * far - fore_mm * fore_mm) / (2 * upper_mm * far));
    const Vector a{std::atan2(y, x), b,
                   std::atan2(out - upper_mm * std::sin(b), upper_mm * std::cos(b) - height)};
    for (std::size_t i = 0; i < 3; ++i)
        encoder[i] = std::int32_t(std::lround(a[i] / (2 * pi) * body_mm[i] / capstan_mm * counts_per_turn));
}

void expect_pose(const std::int32_t (&encoder)[3])
{
    std::int32_t tip[3];
    arm_pose(encoder, tip);
    const Vector expected = tip_mm(angles(encoder));
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_LE(std::abs(Real(tip[i]) - expected[i] * 1e6L), 0.5001L) << encoder[0] << ' ' << encoder[1];
}

TEST(Linkage, SineAndCosineStayWithinTheirBound)
{
    // every count of an int16 encoder, on both kinds of joint
    Real worst = 0;
    for (const std::int64_t body : {160000, 120000})
        for (std::int64_t encoder = -32768; encoder <= 32767; ++encoder) {
            double sine, cosine;
            arm_sine_cosine(encoder * 10000, 2000 * body, &sine, &cosine);
            const Real a = Real(encoder * 10000) / Real(2000 * body) * 2 * pi;
            worst = std::max({worst, std::abs(sine - std::sin(a)), std::abs(cosine - std::cos(a))});
        }
    EXPECT_LT(worst, 4e-16L);
    RecordProperty("worst_e-18", int(worst * 1e18L));
}

TEST(Linkage, QuarterTurnsAreExact)
{
    const double expected[4][2] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
    for (std::int64_t quarter = -9; quarter <= 9; ++quarter) {
        double sine, cosine;
        arm_sine_cosine(quarter * 100, 400, &sine, &cosine);
        EXPECT_EQ(sine, expected[quarter & 3][0]) << quarter;
        EXPECT_EQ(cosine, expected[quarter & 3][1]) << quarter;
    }
}

TEST(Linkage, PoseIsTheEquationsToHalfANanometre)
{
    std::mt19937 random(1);
    std::uniform_int_distribution<std::int32_t> any(-32768, 32767);
    for (int i = 0; i < 20000; ++i)
        expect_pose({any(random), any(random), any(random)});
    const std::int32_t rest[3] = {0, 0, 6000};
    std::int32_t tip[3];
    arm_pose(rest, tip);
    EXPECT_EQ(tip[0], 25'000'000);
    EXPECT_EQ(tip[1], 0);
    EXPECT_EQ(tip[2], 205'000'000);
}

TEST(Linkage, CurrentsAreTheJacobiansTransposeTimesTheForce)
{
    std::mt19937 random(2);
    std::uniform_int_distribution<std::int32_t> any(-32768, 32767), newton(-10'000'000, 10'000'000);
    for (int i = 0; i < 20000; ++i) {
        const std::int32_t encoder[3] = {any(random), any(random), any(random)};
        const std::int32_t force[3] = {newton(random), newton(random), newton(random)};
        std::int32_t current[3];
        arm_drive(encoder, force, current);
        const Vector expected = currents_ma(encoder, force);
        for (std::size_t joint = 0; joint < 3; ++joint)
            EXPECT_LE(std::abs(Real(current[joint]) - expected[joint]), 0.5001L) << joint;
    }
}

TEST(Linkage, ReachingForATipGetsThereToTheEncodersResolution)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> within(-70, 70);
    for (int i = 0; i < 2000; ++i) {
        const Vector wanted{within(random), within(random), within(random)};
        std::int32_t encoder[3], tip[3];
        reach(wanted, encoder);
        arm_pose(encoder, tip);
        // half a count of each joint, at its largest radius
        const Real most = (320 * pi / 32000 + upper_mm * pi / 24000 + fore_mm * pi / 24000) * 1.0001L;
        const Real off =
            std::hypot(tip[0] / 1e6L - wanted[0], tip[1] / 1e6L - wanted[1], tip[2] / 1e6L - wanted[2]);
        EXPECT_LT(off, most);
    }
}

TEST(Linkage, WildestInputSaturates)
{
    for (const std::int32_t wild : {INT32_MAX, INT32_MIN + 1}) {
        const std::int32_t all[3] = {wild, wild, wild};
        std::int32_t tip[3], current[3];
        arm_pose(all, tip);
        for (const std::int32_t t : tip)
            EXPECT_LT(std::abs(std::int64_t(t)), 1'000'000'000);
        arm_drive(all, all, current);
    }
}

/// The same bits everywhere: what -O2, -O3, a sanitizer and the kernel's flags must agree on.
TEST(Linkage, BitsAreGolden)
{
    std::uint64_t hash = 14695981039346656037ull; // FNV-1a
    const auto add = [&hash](std::int32_t value) {
        for (int byte = 0; byte < 4; ++byte)
            hash = (hash ^ (std::uint32_t(value) >> (8 * byte) & 0xff)) * 1099511628211ull;
    };
    std::mt19937 random(4);
    for (int i = 0; i < 10000; ++i) {
        std::int32_t encoder[3], force[3], out[3];
        for (int k = 0; k < 3; ++k) {
            encoder[k] = std::int32_t(random() % 65536) - 32768;
            force[k] = std::int32_t(random() % 20000001) - 10000000;
        }
        arm_pose(encoder, out);
        std::for_each(out, out + 3, add);
        arm_drive(encoder, force, out);
        std::for_each(out, out + 3, add);
    }
    EXPECT_EQ(hash, 5022873648543785244u);
}

} // namespace
