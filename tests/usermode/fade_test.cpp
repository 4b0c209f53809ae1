// SPDX-License-Identifier: GPL-2.0-or-later
// phantom_fade.h: properties of the blend, with forces of every size.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "fade_probe.h"
#include "phantom_abi.h"

namespace phantom::test {
namespace {

using Pull = std::array<std::int32_t, 3>;

double length(const Pull& f)
{
    return std::hypot(double(f[0]), double(f[1]), double(f[2]));
}

double apart(const Pull& a, const Pull& b)
{
    return std::hypot(double(a[0]) - b[0], double(a[1]) - b[1], double(a[2]) - b[2]);
}

struct Faded {
    Pull at_begin{}, later{};
};

Faded fade(const Pull& from, const Pull& target, const Pull& later, std::uint64_t elapsed_ns,
           std::uint64_t length_ns = PHANTOM_FADE_NS)
{
    Faded out;
    fade_probe(from.data(), target.data(), later.data(), length_ns, elapsed_ns, out.at_begin.data(),
               out.later.data());
    return out;
}

/// Rounding: s is known to a ns of 20 ms, a to 2^-28, and divisions drop less than a uN each.
double rounding(const Pull& f)
{
    return 4 + length(f) * 1.2e-7;
}

/// From nothing over uN to the limits of the border.
class Forces {
  public:
    Pull any()
    {
        const double size = std::pow(2.0, std::uniform_real_distribution<>(0, 31.5)(random));
        Pull f{};
        for (std::int32_t& axis : f)
            axis = static_cast<std::int32_t>(
                std::clamp(size * std::normal_distribution<>()(random), -2147483647.0, 2147483647.0));
        return f;
    }
    double part() { return std::uniform_real_distribution<>(0, 1)(random); }

    std::mt19937 random{5};
};

TEST(Fade, BeginsWhereTheForceIsAndEndsAtTheTarget)
{
    Forces forces;
    for (int i = 0; i < 20000; ++i) {
        const Pull from = forces.any(), target = forces.any(), later = forces.any();
        const std::uint64_t length = 1'000'000 + std::uint64_t(forces.part() * 9'999e6);
        const Faded out = fade(from, target, later, length, length);
        ASSERT_LE(apart(out.at_begin, from), rounding(target)) << i;
        ASSERT_EQ(out.later, later) << i;
    }
}

TEST(Fade, IsNeverLargerThanWhatIsLeftOfTheOldForceAndTheTarget)
{
    Forces forces;
    for (int i = 0; i < 20000; ++i) {
        const Pull from = forces.any(), target = forces.any(), later = forces.any();
        const double s = forces.part();
        const Faded out = fade(from, target, later, std::uint64_t((1 - s) * PHANTOM_FADE_NS));
        ASSERT_LE(length(out.later), length(later) + length(from) * s + rounding(from) + rounding(later))
            << i;
    }
}

TEST(Fade, OfAForceThatComesFromNothingIsAPartOfTheTarget)
{
    Forces forces;
    for (int i = 0; i < 20000; ++i) {
        const Pull target = forces.any(), later = forces.any();
        if (target == Pull{})
            continue; // nothing to fade to
        const double part = forces.part();
        const Faded out = fade({}, target, later, std::uint64_t(part * PHANTOM_FADE_NS));
        for (int axis = 0; axis < 3; ++axis)
            ASSERT_NEAR(out.later[axis], part * later[axis], rounding(later)) << i;
    }
}

/// The two shapes' forces are nearly the same, and go on to change alike: so does what comes out.
TEST(Fade, BetweenTwoForcesThatAreNearlyTheSameFollowsTheTarget)
{
    Forces forces;
    for (int i = 0; i < 20000; ++i) {
        const Pull target = forces.any(), later = forces.any();
        if (length(target) < 1e5)
            continue; // a uN is not little of it
        Pull from = target;
        for (std::int32_t& axis : from)
            axis = static_cast<std::int32_t>(axis * (1 - 0.02 * forces.part()));
        const Faded out = fade(from, target, later, std::uint64_t(forces.part() * PHANTOM_FADE_NS));
        // what they differ by: of the target along it, and as much aside
        ASSERT_LE(apart(out.later, later), 0.021 * (length(later) + length(target)) + rounding(later)) << i;
    }
}

TEST(Fade, StepsByThePartOfATickWhateverTheTarget)
{
    Forces forces;
    for (int i = 0; i < 5000; ++i) {
        const Pull from = forces.any(), target = forces.any();
        Pull last = fade(from, target, target, 0).later;
        for (std::uint64_t tick = 1; tick <= 20; ++tick) {
            const Pull now = fade(from, target, target, tick * PHANTOM_FADE_NS / 20).later;
            ASSERT_LE(apart(now, last), apart(from, target) / 20 + rounding(from) + rounding(target)) << i;
            last = now;
        }
    }
}

} // namespace
} // namespace phantom::test
