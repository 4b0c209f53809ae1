// SPDX-License-Identifier: GPL-2.0-or-later
// Fixed-point reals against __int128 and long double, and float64 in software against the FPU.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "fixed_probe.h"

namespace {

using Int128 = __int128;

constexpr std::int64_t limit = FIXED_PROBE_LIMIT;
constexpr std::int64_t one = std::int64_t{1} << FIXED_PROBE_BITS;
constexpr int samples = 200000;

std::int64_t saturated(Int128 value)
{
    return static_cast<std::int64_t>(std::clamp<Int128>(value, -limit, limit));
}

/// Any magnitude up to the limit is as likely as any other.
std::int64_t any_real(std::mt19937_64& random)
{
    const auto bits = static_cast<std::int64_t>(random() >> 3);
    const std::int64_t value = bits >> random() % 61;
    return random() % 2 ? value : -value;
}

/// A double whose exponent is within `range` of 0.
double any_double(std::mt19937_64& random, int range)
{
    const double mantissa = std::ldexp(static_cast<double>(random() >> 11), -53) + 1;
    const int exponent = static_cast<int>(random() % (2U * static_cast<unsigned>(range))) - range;
    return (random() % 2 ? 1 : -1) * std::ldexp(mantissa, exponent);
}

std::uint64_t bits(double a)
{
    return std::bit_cast<std::uint64_t>(a);
}

TEST(FixedNumber, ProductsAreRoundedDownAndSaturated)
{
    std::mt19937_64 random(1);
    for (int i = 0; i < samples; ++i) {
        const std::int64_t a = any_real(random), b = any_real(random), c = any_real(random),
                           d = any_real(random);
        const Int128 product = Int128{a} * b, difference = product - Int128{c} * d;
        const std::int64_t got = fixed_probe_mul(a, b);
        // the saturated one may be taken a hair early: at the limit itself
        ASSERT_EQ(got, saturated(product >> FIXED_PROBE_BITS)) << a << " * " << b;
        ASSERT_EQ(fixed_probe_mul_sub(a, b, c, d), saturated(difference >> FIXED_PROBE_BITS));
    }
    EXPECT_EQ(fixed_probe_mul(limit, limit), limit);
    EXPECT_EQ(fixed_probe_mul(-limit, limit), -limit);
    EXPECT_EQ(fixed_probe_mul(limit, one), limit);
    EXPECT_EQ(fixed_probe_mul(-limit, one), -limit);
}

TEST(FixedNumber, ProductsThatFitAreTheSameWithoutALookAtTheirSize)
{
    std::mt19937_64 random(8);
    const Int128 most = Int128{1} << 62;
    int fitting = 0;
    for (int i = 0; i < samples; ++i) {
        const std::int64_t a = any_real(random), b = any_real(random), c = any_real(random),
                           d = any_real(random);
        const Int128 product = Int128{a} * b >> FIXED_PROBE_BITS,
                     difference = (Int128{a} * b - Int128{c} * d) >> FIXED_PROBE_BITS;
        if (product > -most && product < most) {
            ASSERT_EQ(fixed_probe_mul_fitting(a, b), static_cast<std::int64_t>(product)) << a << " * " << b;
        }
        if (difference <= -most || difference >= most)
            continue;
        ASSERT_EQ(fixed_probe_mul_sub_fitting(a, b, c, d), static_cast<std::int64_t>(difference));
        ++fitting;
    }
    EXPECT_GT(fitting, samples / 4);
}

TEST(FixedNumber, ProductsOfSmallFactorsAreTheSameUpToTheirLimit)
{
    std::mt19937_64 random(11);
    const auto small = [&random] {
        const auto most = std::int64_t{1} << (FIXED_PROBE_BITS + 13);
        return random() % 16 == 0 ? (random() % 2 ? most - 1 : -most)
                                  : static_cast<std::int64_t>(random()) >> (63 - FIXED_PROBE_BITS - 13);
    };
    for (int i = 0; i < samples; ++i) {
        const std::int64_t a = small(), b = small(), c = small(), d = small(), e = small(), f = small();
        const Int128 ab = Int128{a} * b >> FIXED_PROBE_BITS, cd = Int128{c} * d >> FIXED_PROBE_BITS,
                     ef = Int128{e} * f >> FIXED_PROBE_BITS;
        ASSERT_EQ(fixed_probe_mul_small(a, b), static_cast<std::int64_t>(ab)) << a << " * " << b;
        if (saturated(2 * (ab + cd + ef)) == 2 * (ab + cd + ef)) {
            ASSERT_EQ(fixed_probe_mul_sum_small(a, b, c, d, e, f), static_cast<std::int64_t>(ab + cd + ef));
        }
    }
}

TEST(FixedNumber, QuotientsAreRoundedToZeroAndSaturatedNeverTrapped)
{
    std::mt19937_64 random(2);
    for (int i = 0; i < samples; ++i) {
        const std::int64_t a = any_real(random), b = any_real(random);
        if (b == 0)
            continue;
        ASSERT_EQ(fixed_probe_divide(a, b), saturated((Int128{a} << FIXED_PROBE_BITS) / b))
            << a << " / " << b;
    }
    EXPECT_EQ(fixed_probe_divide(one, 0), limit);
    EXPECT_EQ(fixed_probe_divide(-one, 0), -limit);
    EXPECT_EQ(fixed_probe_divide(0, 0), 0);
    EXPECT_EQ(fixed_probe_divide(limit, 1), limit);
    EXPECT_EQ(fixed_probe_divide(-limit, -1), limit);
    EXPECT_EQ(fixed_probe_divide(limit, -limit), -one);
}

TEST(FixedNumber, RootsAreWithinThreePartsInATrillion)
{
    std::mt19937_64 random(3);
    for (int i = 0; i < samples; ++i) {
        const std::int64_t a = std::abs(any_real(random));
        const long double exact = std::sqrt(static_cast<long double>(a)) * (1LL << FIXED_PROBE_BITS / 2);
        ASSERT_NEAR(fixed_probe_sqrt(a), exact, 1 + 3e-12L * exact) << a;
    }
    EXPECT_EQ(fixed_probe_sqrt(0), 0);
    EXPECT_EQ(fixed_probe_sqrt(-one), 0);
}

TEST(FixedNumber, LengthsAreAsPreciseForShortVectorsAsForLongOnes)
{
    std::mt19937_64 random(4);
    for (int i = 0; i < samples; ++i) {
        const int shift = static_cast<int>(random() % 40);
        const std::int64_t x = any_real(random) >> shift, y = any_real(random) >> shift,
                           z = any_real(random) >> shift;
        const long double exact =
            std::sqrt(static_cast<long double>(x) * x + static_cast<long double>(y) * y +
                      static_cast<long double>(z) * z);
        ASSERT_NEAR(fixed_probe_length(x, y, z), exact, 1 + 3e-12L * exact) << x << ' ' << y << ' ' << z;
    }
    EXPECT_EQ(fixed_probe_length(0, 0, 0), 0);
}

TEST(FixedNumber, DirectionsAreAsPreciseForShortVectorsAsForLongOnes)
{
    std::mt19937_64 random(9);
    for (int i = 0; i < samples; ++i) {
        const int shift = static_cast<int>(random() % 40);
        const std::array<std::int64_t, 3> v{any_real(random) >> shift, any_real(random) >> shift,
                                            any_real(random) >> shift};
        const long double length =
            std::sqrt(static_cast<long double>(v[0]) * v[0] + static_cast<long double>(v[1]) * v[1] +
                      static_cast<long double>(v[2]) * v[2]);
        std::array<std::int64_t, 3> unit = v;
        fixed_probe_unit(unit.data());
        for (std::size_t axis = 0; axis < 3; ++axis)
            ASSERT_NEAR(unit[axis], length > 0 ? v[axis] / length * one : 0, 2) << v[0] << ' ' << v[1];
    }
    std::array<std::int64_t, 3> none{};
    fixed_probe_unit(none.data());
    EXPECT_EQ(none, (std::array<std::int64_t, 3>{}));
}

TEST(FixedNumber, RootsOfRatiosAreWithinThreePartsInATrillion)
{
    std::mt19937_64 random(10);
    for (int i = 0; i < samples; ++i) {
        const std::int64_t a = std::abs(any_real(random)),
                           b = std::max<std::int64_t>(1, std::abs(any_real(random)));
        const long double exact = std::sqrt(static_cast<long double>(a) / b) * one;
        const long double most = limit;
        ASSERT_NEAR(fixed_probe_root_of_ratio(a, b), std::min(exact, most), 2 + 3e-12L * exact)
            << a << " / " << b;
    }
    EXPECT_EQ(fixed_probe_root_of_ratio(0, one), 0);
    EXPECT_EQ(fixed_probe_root_of_ratio(one, one), one - 1) << "rounded down";
}

TEST(FixedNumber, BroughtToOneTheyCompareAsTheyDid)
{
    std::mt19937_64 random(12);
    for (int i = 0; i < samples; ++i) {
        const int shift = static_cast<int>(random() % 40);
        std::array<std::int64_t, 3> v{};
        for (std::int64_t& a : v)
            a = std::abs(any_real(random)) >> shift;
        const std::int64_t largest = *std::max_element(v.begin(), v.end());
        if (largest == 0)
            continue;
        std::array<std::int64_t, 3> scaled = v;
        fixed_probe_bring_to_one(scaled.data());
        const std::int64_t one_of_them = *std::max_element(scaled.begin(), scaled.end());
        ASSERT_GE(one_of_them, one / 2 - 1);
        ASSERT_LE(one_of_them, one);
        for (std::size_t axis = 0; axis < 3; ++axis)
            ASSERT_NEAR(scaled[axis], static_cast<long double>(v[axis]) / largest * one_of_them, 2)
                << v[axis];
    }
    std::array<std::int64_t, 3> none{};
    fixed_probe_bring_to_one(none.data());
    EXPECT_EQ(none, (std::array<std::int64_t, 3>{}));
}

TEST(FixedNumber, NanometresComeBack)
{
    std::mt19937_64 random(5);
    for (int i = 0; i < samples; ++i) {
        const auto nm = static_cast<std::int64_t>(random() % 400000000) - 200000000;
        ASSERT_NEAR(static_cast<double>(fixed_probe_from_nm(nm)), static_cast<double>(nm) * 1e-6 * one,
                    1 + 1.1e-9 * std::abs(static_cast<double>(nm)) * 1e-6 * one);
        ASSERT_EQ(fixed_probe_to_nm(fixed_probe_from_nm(nm)), nm);
    }
    EXPECT_EQ(fixed_probe_to_nm(limit), 4000000000);
    EXPECT_EQ(fixed_probe_to_nm(-limit), -4000000000);
}

TEST(FixedNumber, TheBorderIsSaturatedAndCounted)
{
    std::uint32_t count = 0;
    EXPECT_EQ(fixed_probe_to_integer(one / 2, 1000000, &count), 500000);
    EXPECT_EQ(fixed_probe_to_integer(-3 * one, 1000000, &count), -3000000);
    EXPECT_EQ(count, 0U);
    EXPECT_EQ(fixed_probe_to_integer(2148 * one, 1000000, &count), std::numeric_limits<std::int32_t>::max());
    EXPECT_EQ(fixed_probe_to_integer(-limit, 1000000, &count), std::numeric_limits<std::int32_t>::min());
    EXPECT_EQ(count, 2U);
}

TEST(SoftwareDouble, HasTheBitsOfTheFpu)
{
    std::mt19937_64 random(6);
    for (int i = 0; i < samples; ++i) {
        // near exponents: that is where sums cancel
        const double a = any_double(random, 60), b = any_double(random, i % 3 ? 3 : 60);
        ASSERT_EQ(wide_probe_add(bits(a), bits(b)), bits(a + b)) << a << " + " << b;
        ASSERT_EQ(wide_probe_sub(bits(a), bits(b)), bits(a - b)) << a << " - " << b;
        ASSERT_EQ(wide_probe_mul(bits(a), bits(b)), bits(a * b)) << a << " * " << b;
        ASSERT_EQ(wide_probe_div(bits(a), bits(b)), bits(a / b)) << a << " / " << b;
        ASSERT_EQ(wide_probe_sqrt(bits(std::abs(a))), bits(std::sqrt(std::abs(a)))) << a;
        ASSERT_EQ(wide_probe_less(bits(a), bits(b)) != 0, a < b);
        const auto integer = static_cast<std::int64_t>(random()) >> random() % 64;
        ASSERT_EQ(wide_probe_from_integer(integer), bits(static_cast<double>(integer))) << integer;
    }
}

TEST(SoftwareDouble, CancelsToTheLastBitAndToNothing)
{
    const double a = 1.0, b = std::nextafter(1.0, 2.0);
    EXPECT_EQ(wide_probe_sub(bits(b), bits(a)), bits(b - a));
    EXPECT_EQ(wide_probe_sub(bits(a), bits(b)), bits(a - b));
    EXPECT_EQ(wide_probe_sub(bits(a), bits(a)), 0U);
    EXPECT_EQ(wide_probe_add(bits(a), 0), bits(a));
    EXPECT_EQ(wide_probe_add(0, bits(a)), bits(a));
    EXPECT_EQ(wide_probe_mul(0, bits(a)), 0U);
    EXPECT_EQ(wide_probe_div(0, bits(a)), 0U);
    EXPECT_EQ(wide_probe_div(bits(a), 0), bits(std::numeric_limits<double>::max()));
    EXPECT_EQ(wide_probe_mul(bits(1e300), bits(-1e300)), bits(-std::numeric_limits<double>::max()));
    EXPECT_EQ(wide_probe_mul(bits(1e-300), bits(1e-300)), 0U);
    EXPECT_EQ(wide_probe_sqrt(bits(-a)), 0U);
    EXPECT_FALSE(wide_probe_less(bits(-0.0), bits(0.0)));
}

TEST(SoftwareDouble, BecomesTheNearestReal)
{
    std::mt19937_64 random(7);
    for (int i = 0; i < samples; ++i) {
        const double a = any_double(random, 60);
        const double exact = std::ldexp(a, FIXED_PROBE_BITS);
        const std::int64_t got = wide_probe_to_real(bits(a));
        if (std::abs(exact) >= static_cast<double>(limit))
            ASSERT_EQ(got, exact < 0 ? -limit : limit) << a;
        else
            ASSERT_EQ(got, std::llround(exact)) << a;
    }
    EXPECT_EQ(wide_probe_to_real(0), 0);
}

} // namespace
