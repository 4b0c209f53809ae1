// SPDX-License-Identifier: GPL-2.0-or-later
// The order among hits, against std::sort; and rounding to float, against the definition.
#include "fdh/ranking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "fdh/grid.hpp"

namespace phantom::fdh::test {

namespace {

/// Distances as queries find them: spread, in ties, all alike, crowded behind one that is far, zero.
std::vector<Hit> hits_of_kind(int kind, std::size_t count, std::mt19937_64& random)
{
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Hit> hits;
    for (std::size_t i = 0; i < count; i++) {
        double distance = std::sqrt(unit(random));
        if (kind == 1)
            distance = std::floor(8 * distance) / 8;
        else if (kind == 2)
            distance = 3.25;
        else if (kind == 3)
            distance = i == count / 2 ? 1e6 : distance * 1e-3;
        else if (kind == 4)
            distance = 0;
        else if (kind == 5)
            distance *= 1e-200; // the square underflows
        hits.push_back({static_cast<std::uint32_t>(random() % 3), static_cast<std::uint32_t>(i), distance});
    }
    std::shuffle(hits.begin(), hits.end(), random);
    return hits;
}

bool same(const Hit& a, const Hit& b)
{
    return a.object == b.object && a.triangle == b.triangle && a.distance == b.distance;
}

} // namespace

TEST(RankingTest, SortsAndSelectsAsComparisonDoes)
{
    std::mt19937_64 random(41);
    std::vector<Hit> sorted;
    for (int kind = 0; kind <= 5; kind++)
        for (std::size_t count : {1, 2, 23, 24, 25, 64, 65, 130, 1000})
            for (std::size_t wanted : {std::size_t(1), count / 2, count - 1, count}) {
                if (wanted == 0)
                    continue;
                SCOPED_TRACE(testing::Message() << "kind " << kind << ", " << wanted << " of " << count);
                auto hits = hits_of_kind(kind, count, random);
                auto expected = hits;
                std::sort(expected.begin(), expected.end(), nearer);

                sort_nearest(hits, wanted, sorted);
                ASSERT_EQ(sorted.size(), wanted);
                for (std::size_t i = 0; i < wanted; i++)
                    ASSERT_TRUE(same(sorted[i], expected[i])) << i;

                select_nearest(hits, wanted);
                ASSERT_TRUE(same(hits[wanted - 1], expected[wanted - 1]));
                std::sort(hits.begin(), hits.begin() + static_cast<std::ptrdiff_t>(wanted), nearer);
                for (std::size_t i = 0; i < wanted; i++)
                    ASSERT_TRUE(same(hits[i], expected[i])) << i;
            }
    sort_nearest({}, 5, sorted);
    EXPECT_TRUE(sorted.empty());
}

TEST(RoundingTest, DownAndUpEncloseAsTightlyAsFloatsCan)
{
    std::mt19937_64 random(43);
    std::normal_distribution<double> normal;
    std::vector<double> values = {0, 1, -1, 0.1, -0.1, 16777217, -16777217, 1e-300, -1e-300, 0x1p61, -0x1p61};
    for (int i = 0; i < 10000; i++)
        values.push_back(normal(random) * std::exp(10 * normal(random)));
    for (double x : values) {
        const float down = round_down(x), up = round_up(x);
        EXPECT_LE(down, x);
        EXPECT_GE(up, x);
        EXPECT_TRUE(down == up || std::nextafter(down, INFINITY) == up) << x;
    }
}

TEST(GridTest, RoundsToTheNearestWholeStep)
{
    const Grid grid = Grid::over({-60, 5e9, 0}, {60, 5e9 + 100, 1e-3});
    EXPECT_EQ(grid.step, 0x1p-17) << "64 / 2^23";
    std::mt19937_64 random(47);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 10000; i++) {
        const Point p = {-60 + 120 * unit(random), 5e9 + 100 * unit(random), 1e-3 * unit(random)};
        const Point steps = grid.to_steps(p);
        const auto rounded = grid.round(p);
        for (int axis = 0; axis < 3; axis++) {
            EXPECT_EQ(rounded[axis], std::nearbyint(steps[axis]));
            EXPECT_LE(std::abs(rounded[axis]), Grid::half_extent_steps);
        }
    }
}

} // namespace phantom::fdh::test
