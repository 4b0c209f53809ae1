// SPDX-License-Identifier: GPL-2.0-or-later
// Distances from a triangle to segments and triangles: against a search in long double that knows no cases,
// and where they are known.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "fdh/triangle_frame.hpp"
#include "oracle.hpp"
#include "poses.hpp"

namespace phantom::fdh::test {

namespace {

double magnitude(const Corners& t, const Segment& s)
{
    double most = 0;
    for (const Point& p : {t[0], t[1], t[2], s.from, s.to})
        for (const double x : p)
            most = std::max(most, std::abs(x));
    return most;
}

class Generator {
  public:
    explicit Generator(std::uint64_t seed) : random_(seed) {}

    double uniform(double low, double high)
    {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    /// Over many decades.
    double tiny() { return std::pow(10, uniform(-17, -1)); }
    Point anywhere(double reach = 1)
    {
        return {uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach)};
    }
    Point direction()
    {
        std::normal_distribution<double> normal;
        const Point d = {normal(random_), normal(random_), normal(random_)};
        return plus({0, 0, 0}, 1 / length(d), d);
    }
    /// A place in the triangle, often on its border or a corner.
    Point on(const Corners& t)
    {
        std::array<double, 3> b = {uniform(0, 1), uniform(0, 1), uniform(0, 1)};
        for (double& weight : b)
            if (uniform(0, 1) < 0.3)
                weight = 0;
        const double sum = b[0] + b[1] + b[2];
        if (sum == 0)
            return t[0];
        return plus(plus(t[0], b[1] / sum, minus(t[1], t[0])), b[2] / sum, minus(t[2], t[0]));
    }
    /// Proper ones, needles and caps of any thinness, segments, points.
    Corners triangle()
    {
        const Point a = anywhere(), b = anywhere();
        switch (std::uniform_int_distribution<int>(0, 5)(random_)) {
        case 0: // needle
            return {a, b, plus(a, tiny(), direction())};
        case 1: // cap
            return {a, plus(plus(a, uniform(0, 1), minus(b, a)), tiny(), direction()), b};
        case 2: // segment
            return {a, plus(a, uniform(0, 1), minus(b, a)), b};
        case 3: // point, or nearly
            return {a, a, uniform(0, 1) < 0.5 ? a : plus(a, tiny(), direction())};
        default:
            return {a, b, anywhere()};
        }
    }
    std::mt19937_64& random() { return random_; }

  private:
    std::mt19937_64 random_;
};

/// The triangle's normal direction, or any.
Point across(const Corners& t, Generator& generate)
{
    const Point n = cross(minus(t[1], t[0]), minus(t[2], t[0]));
    return length(n) > 0 ? plus({0, 0, 0}, 1 / length(n), n) : generate.direction();
}

/// Segments that find the hard places.
const std::vector<std::pair<const char*, std::function<Segment(const Corners&, Generator&)>>> segments = {
    {"anywhere",
     [](const Corners&, Generator& g) {
         return Segment{g.anywhere(2), g.anywhere(2)};
     }},
    {"through the triangle",
     [](const Corners& t, Generator& g) {
         const Point p = g.on(t), d = g.direction();
         return Segment{plus(p, -g.uniform(0, 2), d), plus(p, g.uniform(0, 2), d)};
     }},
    {"ending on it",
     [](const Corners& t, Generator& g) {
         return Segment{g.anywhere(), g.on(t)};
     }},
    {"a point",
     [](const Corners& t, Generator& g) {
         const Point p = plus(g.on(t), g.tiny(), g.direction());
         return Segment{p, p};
     }},
    {"nearly in its plane",
     [](const Corners& t, Generator& g) {
         const Point p = g.on(t), n = across(t, g), in_plane = minus(g.on(t), g.on(t));
         return Segment{plus(plus(p, -2, in_plane), g.tiny() * g.uniform(-1, 1), n),
                        plus(plus(p, 2, in_plane), g.tiny() * g.uniform(-1, 1), n)};
     }},
    {"nearly along an edge",
     [](const Corners& t, Generator& g) {
         const Point e = minus(t[1], t[0]);
         return Segment{plus(plus(t[0], g.uniform(-1, 1), e), g.tiny(), g.direction()),
                        plus(plus(t[0], g.uniform(0, 2), e), g.tiny(), g.direction())};
     }},
    {"beyond a tip",
     [](const Corners& t, Generator& g) {
         const Point p = plus(t[1], g.uniform(0, 2), minus(t[1], t[0]));
         return Segment{plus(p, g.tiny(), g.direction()), plus(p, g.tiny(), g.direction())};
     }},
};

} // namespace

TEST(TriangleFrameTest, SegmentsMatchASearchInLongDouble)
{
    Generator generate(67);
    for (const auto& [what, make] : segments)
        for (int i = 0; i < 700; i++) {
            const Corners t = generate.triangle();
            const Segment s = make(t, generate);
            const double bound = TriangleFrame::rounding * magnitude(t, s);
            const long double truth = true_distance(s, t);
            const TriangleFrame frame(t);
            ASSERT_NEAR(frame.distance(s, infinity), truth, bound) << what << ", " << i;
            ASSERT_NEAR(frame.distance(s.from), true_distance(s.from, t[0], t[1], t[2]), bound)
                << what << ", " << i;
        }
}

TEST(TriangleFrameTest, ALimitCutsOffOnlyWhatIsBeyondIt)
{
    Generator generate(71);
    std::size_t cut = 0;
    for (const auto& [what, make] : segments)
        for (int i = 0; i < 2000; i++) {
            const Corners t = generate.triangle();
            const Segment s = make(t, generate);
            const TriangleFrame frame(t);
            const double full = frame.distance(s, infinity), limit = generate.uniform(0, 1),
                         limited = frame.distance(s, limit);
            const double bound = TriangleFrame::rounding * magnitude(t, s);
            if (full <= limit - bound) {
                ASSERT_EQ(limited, full) << what;
            } else {
                ASSERT_GT(limited, limit - bound) << what;
                ASSERT_LE(limited, full + bound) << what;
            }
            cut += limited != full;
        }
    EXPECT_GT(cut, 1000u) << "the limit saves nothing";
}

// Whole numbers as large as a tree's grid has them, and triangles as thin as it can hold: an area of half a
// square step, 2^23 steps long. A point beyond the tip is in line with the edges to a part in 2^48.
TEST(TriangleFrameTest, TheThinnestTrianglesOfAGridHaveNoLongerTips)
{
    // Neighbours in the Stern-Brocot tree span an area of one; Fibonacci numbers are such.
    const double f[] = {1346269, 2178309, 3524578, 5702887};
    const Corners sliver = {Point{0, 0, 0}, Point{f[2], f[1], 0}, Point{f[3], f[2], 0}};
    ASSERT_EQ(std::abs(f[2] * f[2] - f[3] * f[1]), 1);
    std::mt19937_64 random(73);
    std::uniform_real_distribution<double> beyond(1, 1.4), off(-1, 1);
    for (int i = 0; i < 2000; i++) {
        const double t = beyond(random);
        const Point p = {t * f[3] + off(random), t * f[2] + off(random), 0.001 * off(random)};
        Corners turned = sliver;
        std::rotate(turned.begin(), turned.begin() + i % 3, turned.end());
        const double bound = TriangleFrame::rounding * 0x1p23;
        ASSERT_NEAR(TriangleFrame(turned).distance(p), true_distance(p, turned[0], turned[1], turned[2]),
                    bound);
        const Segment s = {p, plus(p, 0.01, {off(random), off(random), off(random)})};
        ASSERT_NEAR(TriangleFrame(turned).distance(s, infinity), true_distance(s, turned), bound);
    }
}

TEST(TriangleFrameTest, KnownDistancesAreExact)
{
    const TriangleFrame t({Point{0, 0, 0}, Point{4, 0, 0}, Point{0, 3, 0}});
    auto distance = [&](const Point& from, const Point& to) { return t.distance({from, to}, infinity); };
    EXPECT_EQ(distance({1, 1, -1}, {1, 1, 1}), 0) << "crosses";
    EXPECT_EQ(distance({1, 1, 5}, {1, 1, 2}), 2) << "ends above";
    EXPECT_EQ(distance({1, 1, 2}, {2, 1, 2}), 2) << "parallel above";
    EXPECT_EQ(distance({-5, 1, 2}, {5, 1, 2}), 2) << "parallel across";
    EXPECT_EQ(distance({-1, -1, 0}, {1, -1, 0}), 1) << "in the plane, beside";
    EXPECT_EQ(distance({-1, 1, 0}, {9, 1, 0}), 0) << "in the plane, across";
    EXPECT_EQ(distance({0.5, 0.5, 0}, {1, 1, 0}), 0) << "in the plane, inside";
    EXPECT_EQ(distance({2, 0, -1}, {2, 0, 1}), 0) << "crosses an edge";
    EXPECT_EQ(distance({4, 0, -1}, {4, 0, 1}), 0) << "crosses a corner";
    EXPECT_EQ(distance({2, 0, 0}, {2, -7, 0}), 0) << "starts on an edge";
    EXPECT_EQ(distance({-3, 0, 4}, {-3, 0, 4}), 5) << "a point beside a corner";
    EXPECT_EQ(distance({5, -3, 1}, {5, 3, 1}), std::sqrt(2.0)) << "passes a corner";
}

TEST(TriangleFrameTest, TrianglesMatchASearchInLongDouble)
{
    Generator generate(79);
    for (int i = 0; i < 400; i++) {
        const Corners a = generate.triangle();
        Corners b = generate.triangle();
        if (i % 2) // make them touch, or nearly
            for (Point& corner : b)
                corner = plus(plus(generate.on(a), 0.3, corner), i % 4 == 1 ? generate.tiny() : 0, corner);
        const long double truth = true_distance(a, b);
        const TriangleFrame p(a), q(b);
        const double bound = 4 * TriangleFrame::rounding;
        ASSERT_NEAR(p.distance(q, infinity), truth, bound) << i;
        ASSERT_NEAR(q.distance(p, infinity), truth, bound) << i;
    }
}

TEST(TriangleFrameTest, FarAwayAndHugeIsFinite)
{
    const TriangleFrame t({Point{-0x1p23, 3, 5}, Point{0x1p23, -0x1p23, 0}, Point{7, 0x1p23, 0x1p22}});
    for (const double far : {1e12, 1e60, 1e120, 1e145}) {
        EXPECT_NEAR(t.distance({{far, far, far}, {2 * far, far, far}}, infinity) / far, std::sqrt(3.0), 1e-5);
        EXPECT_LE(t.distance({{-far, -far, -far}, {far, far, far}}, infinity), 1e-14 * far);
    }
}

} // namespace phantom::fdh::test
