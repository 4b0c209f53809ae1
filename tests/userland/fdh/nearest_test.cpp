// SPDX-License-Identifier: GPL-2.0-or-later
// Queries of one tree against brute force.
#include <cmath>
#include <numeric>
#include <thread>

#include "fdh/vector.hpp"
#include "oracle.hpp"

namespace phantom::fdh::test {

namespace {

template <class K>
class NearestTest : public testing::Test {
  public:
    using Tree = TriangleTree<K::value>;

    /// Every probe, with and without a radius that cuts, few and many wanted.
    static void check(const Mesh& mesh, std::size_t each, std::uint64_t seed = 1)
    {
        std::mt19937_64 random(seed);
        const Tree tree = Tree::build(mesh.view());
        ASSERT_EQ(tree.triangles(), mesh.triangles.size());
        Nearest nearest;
        std::vector<Hit> within;
        for (const Point& p : probes(mesh, each, random)) {
            const auto truth = true_distances(mesh, p);
            const Accuracy accuracy = accuracy_of(tree, p);
            auto sorted = truth;
            std::sort(sorted.begin(), sorted.end(),
                      [](const Truth& a, const Truth& b) { return a.distance < b.distance; });
            const auto tenth =
                static_cast<double>(sorted[std::min<std::size_t>(10, sorted.size() - 1)].distance);
            for (std::size_t count : {1, 7, 64})
                for (double radius : {infinity, tenth}) {
                    SCOPED_TRACE(testing::Message() << "p = (" << p[0] << ", " << p[1] << ", " << p[2]
                                                    << "), count " << count << ", radius " << radius);
                    tree.nearest(p, count, radius, nearest);
                    expect_nearest(truth, nearest, count, radius, accuracy);
                    if (testing::Test::HasFailure())
                        return;
                }
            tree.within(p, tenth, within);
            expect_within(truth, within, tenth, accuracy);
        }
    }
};

using Hulls = testing::Types<std::integral_constant<int, 6>, std::integral_constant<int, 14>,
                             std::integral_constant<int, 18>, std::integral_constant<int, 26>>;
TYPED_TEST_SUITE(NearestTest, Hulls);

} // namespace

TYPED_TEST(NearestTest, SphereMatchesBruteForce)
{
    this->check(sphere(4, 60), 12);
}

TYPED_TEST(NearestTest, SoupOfFourDecadesMatchesBruteForce)
{
    std::mt19937_64 random(3);
    this->check(soup(2000, 100, random), 12);
}

TYPED_TEST(NearestTest, DegenerateFacesMatchBruteForce)
{
    std::mt19937_64 random(5);
    this->check(degenerate_faces(random), 40);
}

// As thin as a grid can hold: half a square step, millions of steps long. Points in line with them, beyond
// their tips, are inside two of their walls but for rounding.
TYPED_TEST(NearestTest, SliversHaveNoLongerTips)
{
    constexpr double corner = 8388604;                  // makes the grid's step 1
    constexpr double f[] = {2178309, 3524578, 5702887}; // Fibonacci numbers: f1 f1 - f0 f2 = 1
    const Point a = {0, 0, 0}, b = {f[1], f[0], 0}, c = {f[2], f[1], 0};
    Mesh mesh;
    mesh.add({-corner, -corner, -corner}, {-corner, -corner, -corner}, {-corner, -corner, -corner});
    mesh.add({corner, corner, corner}, {corner, corner, corner}, {corner, corner, corner});
    for (const auto& t : {Corners{a, b, c}, {b, c, a}, {c, a, b}, {a, c, b}, {b, a, c}, {c, b, a}})
        mesh.add(t[0], t[1], t[2]);
    const auto tree = TriangleTree<TypeParam::value>::build(mesh.view());
    std::mt19937_64 random(163);
    std::uniform_real_distribution<double> beyond(0, 0.4);
    std::vector<Hit> hits;
    for (int i = 0; i < 4000; i++) {
        const double t = i % 2 ? 1 + beyond(random) : -beyond(random);
        const Point p = {t * f[2], t * f[1], 0};
        const auto truth = static_cast<double>(true_distance(p, a, b, c));
        tree.within(p, 1e7, hits);
        ASSERT_GE(hits.size(), 6u);
        for (const Hit& hit : hits)
            if (hit.triangle >= 2) {
                ASSERT_NEAR(hit.distance, truth, tree.accuracy(p, truth)) << "t = " << t;
            }
    }
}

TYPED_TEST(NearestTest, TiesOnAFlatGridMatchBruteForce)
{
    this->check(flat_grid(20), 20);
}

TYPED_TEST(NearestTest, FewTrianglesMatchBruteForce)
{
    std::mt19937_64 random(7);
    for (std::size_t count = 1; count <= 20; count++)
        this->check(soup(count, 10, random), 3, count);
}

// A building's coordinates in a national grid, a detail of a tenth of a millimetre: 5e9 mm from the origin.
TYPED_TEST(NearestTest, FarFromTheOriginMatchesBruteForce)
{
    this->check(scaled(sphere(3, 60), 1, {5e9, -5e9, 4.9e9}), 10);
}

TYPED_TEST(NearestTest, TenMicrometresAcrossMatchesBruteForce)
{
    this->check(sphere(3, 0.005), 10);
}

TYPED_TEST(NearestTest, BunnyMatchesBruteForce)
{
    const auto mesh = bunny();
    if (!mesh)
        GTEST_SKIP() << "no bunny: package glmark2-data is not installed";
    this->check(scaled(*mesh, 60, {0, 0, 0}), 2);
}

TYPED_TEST(NearestTest, ExactTiesGoToTheLowestNumbers)
{
    // On a vertex of the grid, whose coordinates the tree holds exactly, six triangles are at distance 0.
    const Mesh mesh = flat_grid(16);
    const auto tree = TriangleTree<TypeParam::value>::build(mesh.view());
    Nearest found;
    tree.nearest({8, 8, 0}, 4, infinity, found);
    found.sort();
    std::vector<std::uint32_t> at_zero;
    for (const auto& t : true_distances(mesh, {8, 8, 0}))
        if (t.distance == 0)
            at_zero.push_back(t.triangle);
    ASSERT_EQ(at_zero.size(), 6u);
    ASSERT_EQ(found.hits.size(), 4u);
    for (std::size_t i = 0; i < 4; i++) {
        EXPECT_EQ(found.hits[i].triangle, at_zero[i]);
        EXPECT_EQ(found.hits[i].distance, 0);
    }
    EXPECT_EQ(found.coverage, 0) << "the fifth was left out at distance 0";
}

TYPED_TEST(NearestTest, CountBeyondTheMeshGivesAllAndCoversTheRadius)
{
    const Mesh mesh = sphere(2, 1);
    const auto tree = TriangleTree<TypeParam::value>::build(mesh.view());
    Nearest found;
    for (std::size_t count : {mesh.triangles.size(), mesh.triangles.size() + 1, std::size_t(1) << 40,
                              std::numeric_limits<std::size_t>::max()}) {
        tree.nearest({0.3, 0.2, 0.1}, count, infinity, found);
        EXPECT_EQ(found.hits.size(), mesh.triangles.size());
        EXPECT_EQ(found.coverage, infinity);
        tree.nearest({0.3, 0.2, 0.1}, count, 100, found);
        EXPECT_EQ(found.coverage, 100);
    }
}

TYPED_TEST(NearestTest, RadiusZeroFindsWhatTouches)
{
    const Mesh mesh = flat_grid(16);
    const auto tree = TriangleTree<TypeParam::value>::build(mesh.view());
    Nearest found;
    std::vector<Hit> hits;
    tree.nearest({8, 8, 0}, 64, 0, found);
    EXPECT_EQ(found.hits.size(), 6u);
    EXPECT_EQ(found.coverage, 0);
    tree.within({8, 8, 0}, 0, hits);
    EXPECT_EQ(hits.size(), 6u);
    tree.nearest({8, 8, 1}, 64, 0, found);
    EXPECT_TRUE(found.hits.empty());
}

TYPED_TEST(NearestTest, CountZeroCoversUpToTheNearest)
{
    const Mesh mesh = flat_grid(16);
    const auto tree = TriangleTree<TypeParam::value>::build(mesh.view());
    const Point p = {8.25, 8.5, 3};
    Nearest found;
    tree.nearest(p, 0, infinity, found);
    EXPECT_TRUE(found.hits.empty());
    EXPECT_LE(found.coverage, 3);
    EXPECT_GE(found.coverage, 3 - 2 * tree.accuracy(p, 3));
    tree.nearest(p, 0, 2, found);
    EXPECT_EQ(found.coverage, 2);
}

TYPED_TEST(NearestTest, InvalidQueriesFindNothingAndCoverNothing)
{
    const Mesh mesh = sphere(2, 1);
    const auto tree = TriangleTree<TypeParam::value>::build(mesh.view());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Nearest found;
    std::vector<Hit> hits;
    auto expect_nothing = [&](const Point& p, double radius) {
        found.hits.resize(3);
        found.coverage = 5;
        hits.resize(3);
        tree.nearest(p, 8, radius, found);
        tree.within(p, radius, hits);
        EXPECT_TRUE(found.hits.empty());
        EXPECT_EQ(found.coverage, 0);
        EXPECT_TRUE(hits.empty());
    };
    for (double bad : {nan, infinity, -infinity, 2 * largest_coordinate})
        for (int axis = 0; axis < 3; axis++) {
            Point p = {0, 0, 0};
            p[axis] = bad;
            expect_nothing(p, 10);
        }
    expect_nothing({0, 0, 0}, nan);
    expect_nothing({0, 0, 0}, -1);
}

TYPED_TEST(NearestTest, FarthestQueryPointStillAnswers)
{
    const Mesh mesh = sphere(2, 1);
    const auto tree = TriangleTree<TypeParam::value>::build(mesh.view());
    Nearest found;
    for (double far : {1e12, 1e30, 1e60, largest_coordinate}) {
        tree.nearest({far, 0, 0}, 5, infinity, found);
        found.sort();
        ASSERT_EQ(found.hits.size(), 5u);
        EXPECT_NEAR(found.hits[0].distance / far, 1, 1e-11);
        EXPECT_LE(found.coverage, found.hits[4].distance);
        EXPECT_GE(found.coverage, found.hits[0].distance * (1 - 1e-12) - 1);
    }
}

TYPED_TEST(NearestTest, WithinInfinityFindsEverything)
{
    const Mesh mesh = sphere(4, 1);
    const auto tree = TriangleTree<TypeParam::value>::build(mesh.view());
    std::vector<Hit> hits;
    tree.within({0.1, 0.2, 0.3}, infinity, hits);
    EXPECT_EQ(hits.size(), mesh.triangles.size());
}

// The bound must not be so wide that the checks above mean nothing.
TYPED_TEST(NearestTest, AccuracyIsFineAgainstTheMesh)
{
    const auto tree = TriangleTree<TypeParam::value>::build(sphere(3, 60).view());
    EXPECT_LE(tree.accuracy({0, 0, 60}, 1), 95e-6) << "on a sphere 120 mm across, of faces 20 mm wide";
    const auto fine = TriangleTree<TypeParam::value>::build(sphere(6, 60).view());
    EXPECT_LE(fine.accuracy({0, 0, 60}, 1), 22e-6) << "and of faces 2.5 mm wide";
    const auto distant =
        TriangleTree<TypeParam::value>::build(scaled(sphere(6, 60), 1, {5e9, 5e9, 5e9}).view());
    EXPECT_LE(distant.accuracy({5e9, 5e9, 5e9 + 60}, 1), 22e-6);
}

TYPED_TEST(NearestTest, ThreadsQueryOneTreeAtOnce)
{
    const Mesh mesh = sphere(5, 60);
    const auto tree = TriangleTree<TypeParam::value>::build(mesh.view());
    std::mt19937_64 random(11);
    const auto points = probes(mesh, 40, random);
    auto answers = [&](std::vector<Nearest>& out) {
        out.resize(points.size());
        for (std::size_t i = 0; i < points.size(); i++)
            tree.nearest(points[i], 64, infinity, out[i]);
    };
    std::vector<Nearest> alone, first, second;
    answers(alone);
    std::thread other([&] { answers(first); });
    answers(second);
    other.join();
    for (std::size_t i = 0; i < points.size(); i++)
        for (const auto* threaded : {&first[i], &second[i]}) {
            ASSERT_EQ(threaded->hits.size(), alone[i].hits.size());
            EXPECT_EQ(threaded->coverage, alone[i].coverage);
            for (std::size_t h = 0; h < alone[i].hits.size(); h++)
                EXPECT_EQ(threaded->hits[h].triangle, alone[i].hits[h].triangle);
        }
}

} // namespace phantom::fdh::test
