// SPDX-License-Identifier: GPL-2.0-or-later
// All along a segment and all in a box: against brute force over every triangle, for every hull.
#include <cmath>

#include <gtest/gtest.h>

#include "fdh/scene_tree.hpp"
#include "oracle.hpp"
#include "poses.hpp"

namespace phantom::fdh::test {

namespace {

/// A mesh in its world, found under each kind of hull.
struct World {
    Mesh mesh; ///< in its own frame
    Pose pose;
    Mesh there; ///< in world coordinates
    SceneTree<6> six;
    SceneTree<14> fourteen;
    SceneTree<18> eighteen;
    SceneTree<26> twenty_six;

    explicit World(Mesh mesh_, const Pose& pose_ = {})
        : mesh(std::move(mesh_)), pose(pose_), there(posed(mesh, pose))
    {
        for_each([&](auto& scene) {
            using Tree = std::decay_t<decltype(scene.tree(0))>;
            scene.add(Tree::build({}), {}); // so that object numbers matter
            scene.add(Tree::build(mesh.view(), {.threads = 1}), pose);
            scene.update();
        });
    }
    template <class Body>
    void for_each(const Body& body)
    {
        body(six);
        body(fourteen);
        body(eighteen);
        body(twenty_six);
    }
    /// Largest error of a distance from p: the tree's, and that of world coordinates rounded here.
    template <class Scene>
    double accuracy(const Scene& scene, const Point& p, double distance) const
    {
        double reach = 0;
        for (const double x : pose.translation)
            reach = std::max(reach, std::abs(x));
        return scene.tree(1).accuracy(to_local(pose, p), distance) + 4e-16 * reach;
    }
};

/// How often each triangle was found; all hits must be of the object.
std::vector<int> count(const std::vector<Hit>& hits, std::size_t triangles, std::uint32_t object)
{
    std::vector<int> times(triangles);
    for (const Hit& hit : hits) {
        EXPECT_EQ(hit.object, object);
        times.at(hit.triangle)++;
    }
    return times;
}

/// Distance between a segment and a triangle, or a lower bound of it if that is beyond `cutoff`.
long double distance_or_more(const Segment& s, const Corners& t, double cutoff)
{
    // Spheres round the triangle and round pieces of the segment.
    constexpr int pieces = 32;
    const Point way = minus(s.to, s.from);
    double radius = 0, between = infinity;
    for (const Point& corner : t)
        radius = std::max(radius, length(minus(corner, t[0])));
    for (int i = 0; i < pieces; i++)
        between = std::min(between, length(minus(t[0], plus(s.from, (i + 0.5) / pieces, way))));
    between = between * (1 - 1e-12) - radius - 0.5 / pieces * length(way) * (1 + 1e-12);
    return between > cutoff ? between : true_distance(s, t);
}

void check_along(World& world, const Segment& s, double radius)
{
    SCOPED_TRACE(testing::Message() << "from " << s.from[0] << ' ' << s.from[1] << ' ' << s.from[2] << " to "
                                    << s.to[0] << ' ' << s.to[1] << ' ' << s.to[2] << " radius " << radius);
    double worst = 0;
    world.for_each([&](const auto& scene) {
        worst = std::max({worst, world.accuracy(scene, s.from, radius), world.accuracy(scene, s.to, radius)});
    });
    std::vector<long double> truth;
    for (std::size_t i = 0; i < world.there.triangles.size(); i++)
        truth.push_back(distance_or_more(s, corners(world.there, i), radius + 4 * worst));
    std::vector<Hit> hits(3);
    world.for_each([&](const auto& scene) {
        const double error =
            std::max(world.accuracy(scene, s.from, radius), world.accuracy(scene, s.to, radius));
        scene.along(s.from, s.to, radius, hits);
        const auto times = count(hits, truth.size(), 1);
        for (std::size_t i = 0; i < truth.size(); i++) {
            ASSERT_GE(times[i], truth[i] <= radius ? 1 : 0) << "triangle " << i << " missed at " << truth[i];
            ASSERT_LE(times[i], truth[i] <= radius + 2 * error ? 1 : 0)
                << "triangle " << i << " at " << truth[i];
        }
        for (const Hit& hit : hits)
            ASSERT_NEAR(hit.distance, truth[hit.triangle], error) << "triangle " << hit.triangle;
    });
}

/// Between a triangle and a box along an axis that separates them; not positive where they meet.
long double separation(const Corners& t, const Box& box)
{
    using Vector = std::array<long double, 3>;
    std::array<Vector, 13> axes = {Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{0, 0, 1}};
    std::size_t count = 3;
    auto cross_wide = [](const Vector& a, const Vector& b) {
        return Vector{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    std::array<Vector, 3> edges;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            edges[i][k] = static_cast<long double>(t[(i + 1) % 3][k]) - t[i][k];
    for (const Vector& e : edges)
        for (int k = 0; k < 3; k++)
            axes[count++] = cross_wide(axes[k], e);
    axes[count++] = cross_wide(edges[0], edges[1]);
    long double farthest = -INFINITY;
    for (const Vector& axis : axes) {
        const long double norm = std::sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
        if (norm == 0)
            continue;
        long double low = INFINITY, high = -INFINITY, box_low = 0, box_high = 0;
        for (const Point& p : t) {
            const long double x = axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2];
            low = std::min(low, x);
            high = std::max(high, x);
        }
        for (int k = 0; k < 3; k++) {
            box_low += std::min(axis[k] * box.low[k], axis[k] * box.high[k]);
            box_high += std::max(axis[k] * box.low[k], axis[k] * box.high[k]);
        }
        farthest = std::max(farthest, std::max(low - box_high, box_low - high) / norm);
        if (farthest > 0)
            break;
    }
    return farthest;
}

void check_box(World& world, const Box& box)
{
    SCOPED_TRACE(testing::Message() << "box " << box.low[0] << ' ' << box.low[1] << ' ' << box.low[2]
                                    << " to " << box.high[0] << ' ' << box.high[1] << ' ' << box.high[2]);
    std::vector<long double> truth;
    for (std::size_t i = 0; i < world.there.triangles.size(); i++)
        truth.push_back(separation(corners(world.there, i), box));
    std::vector<Hit> hits(3);
    world.for_each([&](const auto& scene) {
        const double error = std::max(world.accuracy(scene, box.low, 0), world.accuracy(scene, box.high, 0));
        Box wider = box;
        for (int axis = 0; axis < 3; axis++) {
            wider.low[axis] -= 2 * error;
            wider.high[axis] += 2 * error;
        }
        scene.in_box(box, hits);
        const auto times = count(hits, truth.size(), 1);
        for (std::size_t i = 0; i < truth.size(); i++) {
            ASSERT_GE(times[i], truth[i] <= 0 ? 1 : 0) << "triangle " << i << " missed";
            if (times[i] > 0 && truth[i] > 0) {
                ASSERT_LE(separation(corners(world.there, i), wider), 0)
                    << "triangle " << i << " at " << truth[i];
            }
        }
    });
}

double size_of(const Mesh& mesh)
{
    double size = 0;
    for (const Point& v : mesh.vertices)
        size = std::max(size, length(minus(v, mesh.vertices[0])));
    return size;
}

/// From the hard places of the mesh: to nearby, across, and to another of them; boxes likewise.
void check(World world, std::size_t each, std::uint64_t seed)
{
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    const double size = size_of(world.there);
    // Of a large mesh a part will do: the search in long double takes its time.
    const double part = std::min(1.0, 1000.0 / static_cast<double>(world.mesh.triangles.size()));
    const auto points = probes(world.there, each, random);
    auto off = [&](const Point& p, double way) {
        return plus(p, way, {unit(random), unit(random), unit(random)});
    };
    for (std::size_t i = 0; i < points.size(); i++) {
        const Point& p = points[i];
        const Point to = i % 4 == 0   ? p
                         : i % 4 == 1 ? off(p, 0.02 * size)
                         : i % 4 == 2 ? off(p, size)
                                      : points[(i * 5) % points.size()];
        const double radius = i % 3 == 0 ? 0 : size * part * (i % 3 == 1 ? 0.01 : 0.2);
        check_along(world, {p, to}, radius);
        Box box;
        for (int axis = 0; axis < 3; axis++) {
            const double way = i % 3 == 0 ? 0 : unit(random) * size * (i % 3 == 1 ? 0.05 : 0.7);
            box.low[axis] = std::min(p[axis], p[axis] + way);
            box.high[axis] = std::max(p[axis], p[axis] + way);
        }
        check_box(world, box);
        if (testing::Test::HasFatalFailure())
            return;
    }
}

} // namespace

TEST(RegionTest, SphereMatchesBruteForce)
{
    check(World(sphere(3, 60)), 6, 97);
}

TEST(RegionTest, SoupMatchesBruteForce)
{
    std::mt19937_64 random(101);
    check(World(soup(500, 100, random)), 6, 103);
}

TEST(RegionTest, DegenerateFacesMatchBruteForce)
{
    std::mt19937_64 random(107);
    check(World(degenerate_faces(random)), 4, 109);
}

TEST(RegionTest, TouchingExactlyOnAFlatGridMatchesBruteForce)
{
    World world(flat_grid(12));
    for (const double x : {0.0, 3.0, 5.5, 12.0}) {
        check_along(world, {{x, 2, 0}, {x, 5, 0}}, 0);
        check_along(world, {{x, x, -1}, {x, x, 1}}, 0);
        check_along(world, {{x, 4, 1}, {x, 4, 1}}, 1);
        check_along(world, {{-2, x, 2}, {14, x, 2}}, 2);
        check_box(world, {{x, 2, 0}, {x, 2, 0}});
        check_box(world, {{x, 2, -1}, {x + 2, 4, 0}});
        check_box(world, {{x, -3, -1}, {x + 1, 0, 5}});
    }
    check(std::move(world), 5, 113);
}

// What is included beyond the radius, or outside the box, is no farther than promised, and what is within by
// a hair is there.
TEST(RegionTest, BoundsAreAsTightAsPromised)
{
    World world(flat_grid(12));
    std::vector<Hit> hits;
    world.for_each([&](const auto& scene) {
        const auto& tree = scene.tree(1); // without level one, which knows the hull
        const Point from = {5, 6, 2}, to = {7, 6.5, 2};
        tree.along(from, to, 2 - 2.01 * tree.accuracy(from, 2), hits);
        EXPECT_TRUE(hits.empty());
        tree.along(from, to, 2, hits);
        EXPECT_FALSE(hits.empty());
        tree.in_box({{5, 6, 2.01 * tree.accuracy(from, 0)}, {7, 8, 9}}, hits);
        EXPECT_TRUE(hits.empty());
        tree.in_box({{5, 6, 0}, {7, 8, 9}}, hits);
        EXPECT_FALSE(hits.empty());
    });
}

TEST(RegionTest, PosedAndFarFromTheOriginMatchesBruteForce)
{
    std::mt19937_64 random(127);
    check(World(soup(200, 30, random), random_pose(50, random)), 5, 131);
    check(World(sphere(2, 60), turn({1, 2, 3}, 1, {5e9, -5e9, 4e9})), 4, 137);
    check(World(scaled(sphere(2, 60), 1, {5e9, -5e9, 4.9e9})), 4, 139);
}

TEST(RegionTest, TenMicrometresAcrossMatchesBruteForce)
{
    check(World(sphere(2, 0.005)), 5, 149);
}

TEST(RegionTest, BunnyMatchesBruteForce)
{
    const auto mesh = bunny();
    if (!mesh)
        GTEST_SKIP() << "no bunny: package glmark2-data is not installed";
    check(World(scaled(*mesh, 60, {0, 0, 0})), 1, 151);
}

TEST(RegionTest, EverythingIsInAnInfiniteBoxAndRadius)
{
    World world(sphere(2, 60), turn({1, 2, 3}, 1, {10, 20, 30}));
    std::vector<Hit> hits;
    world.for_each([&](const auto& scene) {
        scene.in_box({{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}}, hits);
        EXPECT_EQ(hits.size(), 128u);
        scene.in_box({{-infinity, -infinity, 30}, {infinity, infinity, infinity}}, hits);
        EXPECT_GT(hits.size(), 64u) << "half of it, and what crosses the plane";
        EXPECT_LT(hits.size(), 90u);
        scene.along({1, 2, 3}, {4, 5, 6}, infinity, hits);
        EXPECT_EQ(hits.size(), 128u);
        scene.along({largest_coordinate, 0, 0}, {-largest_coordinate, 0, 0}, 1, hits);
        EXPECT_EQ(hits.size(), 128u) << "from there, distances are no finer";
    });
}

TEST(RegionTest, InvalidRegionsAndEmptyTreesFindNothing)
{
    const double nan = std::nan("");
    const Mesh ball = sphere(1, 1);
    const auto tree = TriangleTree<14>::build(ball.view()), empty = TriangleTree<14>::build({});
    std::vector<Hit> hits;
    auto expect_nothing = [&](auto&& query) {
        hits.resize(3);
        query();
        EXPECT_TRUE(hits.empty());
    };
    expect_nothing([&] { tree.along({nan, 0, 0}, {0, 0, 0}, 9, hits); });
    expect_nothing([&] { tree.along({0, 0, 0}, {0, infinity, 0}, 9, hits); });
    expect_nothing([&] { tree.along({0, 0, 0}, {0, 1, 0}, -1, hits); });
    expect_nothing([&] { tree.along({0, 0, 0}, {0, 1, 0}, nan, hits); });
    expect_nothing([&] { tree.in_box({{0, 0, 1}, {9, 9, 0}}, hits); });
    expect_nothing([&] { tree.in_box({{0, nan, 0}, {9, 9, 9}}, hits); });
    expect_nothing([&] { empty.in_box({{-9, -9, -9}, {9, 9, 9}}, hits); });
    expect_nothing([&] { empty.along({0, 0, 0}, {0, 1, 0}, 9, hits); });
    tree.along({0, 0, 0}, {0, 1, 0}, 9, hits);
    EXPECT_EQ(hits.size(), 32u);
}

} // namespace phantom::fdh::test
