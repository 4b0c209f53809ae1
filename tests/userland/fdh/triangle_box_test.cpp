// SPDX-License-Identifier: GPL-2.0-or-later
// Triangle against box: whole numbers, on which the separating axes are exact.
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "fdh/triangle_box.hpp"

namespace phantom::fdh::test {

namespace {

using Whole = std::array<long long, 3>;

/// No axis separates them: the box's normals, the triangle's, and the products of their edges. Coordinates
/// are scaled by 2^scale, and the box then widened by `wider` on every side. Exact below 2^14 before scaling.
bool meet_exactly(const std::array<Whole, 3>& t, const Whole& low, const Whole& high, int scale,
                  long long wider)
{
    using Wide = __int128;
    std::array<Whole, 16> axes{};
    int count = 0;
    std::array<Whole, 3> edges;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            edges[i][k] = t[(i + 1) % 3][k] - t[i][k];
    auto cross = [](const Whole& a, const Whole& b) {
        return Whole{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    axes[count++] = cross(edges[0], edges[1]);
    for (int k = 0; k < 3; k++) {
        Whole unit{};
        unit[k] = 1;
        axes[count++] = unit;
        for (const Whole& e : edges)
            axes[count++] = cross(unit, e);
    }
    for (int a = 0; a < count; a++) {
        Wide least = 0, most = 0, box_least = 0, box_most = 0;
        for (int i = 0; i < 3; i++) {
            Wide x = 0;
            for (int k = 0; k < 3; k++)
                x += (Wide(axes[a][k]) * t[i][k]) << scale;
            least = i == 0 ? x : std::min(least, x);
            most = i == 0 ? x : std::max(most, x);
        }
        for (int k = 0; k < 3; k++) {
            const Wide x = Wide(axes[a][k]) * ((Wide(low[k]) << scale) - wider);
            const Wide y = Wide(axes[a][k]) * ((Wide(high[k]) << scale) + wider);
            box_least += std::min(x, y);
            box_most += std::max(x, y);
        }
        if (least > box_most || most < box_least)
            return false;
    }
    return true;
}

Point real(const Whole& p)
{
    return {double(p[0]), double(p[1]), double(p[2])};
}

/// Random triangles and boxes of whole coordinates up to `reach`; thin ones and flat boxes among them. Boxes
/// are made smaller by `shrink` units of 2^-scale on every side: what touched a box comes as near as that to
/// it. Returns how many met and how many did not.
std::array<int, 2> compare(int reach, int rounds, std::uint64_t seed, int scale, int shrink)
{
    std::mt19937_64 random(seed);
    std::uniform_int_distribution<int> coordinate(-reach, reach), kind(0, 5);
    auto anywhere = [&] { return Whole{coordinate(random), coordinate(random), coordinate(random)}; };
    std::array<int, 2> counts{};
    const double unit = std::ldexp(1.0, -scale);
    const auto rounding = static_cast<long long>(std::ceil(box_rounding * reach / unit));
    for (int i = 0; i < rounds; i++) {
        std::array<Whole, 3> t = {anywhere(), anywhere(), anywhere()};
        switch (kind(random)) {
        case 0:
            t[1] = t[0];
            break;
        case 1:
            t[1] = t[2] = t[0];
            break;
        case 2: // a needle
            t[1] = t[0];
            t[1][i % 3]++;
            break;
        default:
            break;
        }
        Whole low = anywhere(), high = anywhere();
        if (i % 7 == 0)
            low[i % 3] = high[i % 3];
        Point box_low, box_high;
        bool inverted = false;
        for (int k = 0; k < 3; k++) {
            if (low[k] > high[k])
                std::swap(low[k], high[k]);
            box_low[k] = double(low[k]) + shrink * unit;
            box_high[k] = double(high[k]) - shrink * unit;
            inverted |= box_low[k] > box_high[k];
        }
        const bool found = touches_box({real(t[0]), real(t[1]), real(t[2])}, box_low, box_high);
        const bool meet = !inverted && meet_exactly(t, low, high, scale, -shrink);
        counts[meet]++;
        EXPECT_FALSE(meet && !found) << "missed, round " << i;
        EXPECT_FALSE(found && (inverted || !meet_exactly(t, low, high, scale, rounding - shrink)))
            << "farther than rounding, round " << i;
    }
    return counts;
}

} // namespace

// So coarse that corners, edges and faces touch exactly all the time; and then a hair less.
TEST(TriangleBoxTest, TouchingExactlyOnACoarseGrid)
{
    for (const int reach : {1, 2, 4})
        for (const int shrink : {0, 8}) {
            const auto [apart, met] = compare(reach, 20000, 83, 45, shrink);
            EXPECT_GT(apart, 400);
            EXPECT_GT(met, 400);
        }
}

TEST(TriangleBoxTest, WholeNumbersMatchSeparatingAxes)
{
    for (const int reach : {100, 8191}) {
        const auto [apart, met] = compare(reach, 40000, 89, 35, 0);
        EXPECT_GT(apart, 1000);
        EXPECT_GT(met, 1000);
    }
}

// The plane of the triangle, and nothing else, separates the first; an edge of it the second.
TEST(TriangleBoxTest, EverySeparatingAxisCounts)
{
    const Point low = {-1, -1, -1}, high = {1, 1, 1};
    EXPECT_TRUE(touches_box({Point{9, -3, -3}, Point{-3, 9, -3}, Point{-3, -3, 9}}, low, high)) << "corner";
    EXPECT_FALSE(touches_box({Point{9.001, -3, -3}, Point{-3, 9.001, -3}, Point{-3, -3, 9.001}}, low, high));
    EXPECT_TRUE(touches_box({Point{2, 0, 0}, Point{0, 2, 0}, Point{3, 3, 0}}, low, high)) << "edge";
    EXPECT_FALSE(touches_box({Point{2.001, 0, 0}, Point{0, 2.001, 0}, Point{3, 3, 0}}, low, high));
}

TEST(TriangleBoxTest, BoxOfNothingTouchesNothing)
{
    const Corners t = {Point{-9, -9, 0}, Point{9, -9, 0}, Point{0, 9, 0}};
    EXPECT_TRUE(touches_box(t, {0, 0, 0}, {0, 0, 0}));
    EXPECT_FALSE(touches_box(t, {1, 0, 0}, {0, 0, 0}));
    EXPECT_FALSE(touches_box(t, {0, 0, 1}, {0, 0, -1}));
}

} // namespace phantom::fdh::test
