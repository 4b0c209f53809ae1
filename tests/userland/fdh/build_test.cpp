// SPDX-License-Identifier: GPL-2.0-or-later
// Building: hard inputs, refused inputs, memory, threads.
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "fdh/layout.hpp"
#include "oracle.hpp"

namespace phantom::fdh::test {

namespace {

std::string refusal(const Mesh& mesh)
{
    try {
        TriangleTree<14>::build(mesh.view());
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "accepted";
}

} // namespace

TEST(BuildTest, EmptyMeshFindsNothingAndCoversTheRadius)
{
    const auto tree = TriangleTree<14>::build({});
    EXPECT_EQ(tree.triangles(), 0u);
    Nearest found;
    tree.nearest({1, 2, 3}, 64, 10, found);
    EXPECT_TRUE(found.hits.empty());
    EXPECT_EQ(found.coverage, 10);
    std::vector<Hit> hits;
    tree.within({1, 2, 3}, 10, hits);
    EXPECT_TRUE(hits.empty());
}

TEST(BuildTest, ManyIdenticalTrianglesEndAndTieByNumber)
{
    Mesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles.assign(100000, {0, 1, 2});
    const auto tree = TriangleTree<14>::build(mesh.view());
    Nearest found;
    tree.nearest({0.25, 0.25, 2}, 64, infinity, found);
    found.sort();
    ASSERT_EQ(found.hits.size(), 64u);
    for (std::uint32_t i = 0; i < 64; i++) {
        EXPECT_EQ(found.hits[i].triangle, i);
        EXPECT_NEAR(found.hits[i].distance, 2, tree.accuracy({0.25, 0.25, 2}, 2));
    }
    EXPECT_LE(found.coverage, 2);
}

// More at distance 0 than are wanted, and others farther away.
TEST(BuildTest, MoreInOnePlaceThanWantedTieByNumber)
{
    Mesh mesh = flat_grid(16);
    const auto others = static_cast<std::uint32_t>(mesh.triangles.size());
    for (int i = 0; i < 100; i++)
        mesh.triangles.push_back(mesh.triangles[200]);
    const auto tree = TriangleTree<14>::build(mesh.view());
    const auto& t = mesh.triangles[200];
    Point p{};
    for (std::uint32_t vertex : t)
        for (std::size_t axis = 0; axis < 3; axis++)
            p[axis] += mesh.vertices[vertex][axis] * (vertex == t[0] ? 0.5 : 0.25);
    Nearest found;
    for (double radius : {infinity, 4.0}) {
        tree.nearest(p, 64, radius, found);
        found.sort();
        ASSERT_EQ(found.hits.size(), 64u);
        EXPECT_EQ(found.hits[0].triangle, 200u);
        for (std::uint32_t i = 0; i < 63; i++) {
            EXPECT_EQ(found.hits[i + 1].triangle, others + i);
            EXPECT_EQ(found.hits[i + 1].distance, 0);
        }
        EXPECT_EQ(found.coverage, 0);
    }
}

// A pole of a sphere of meridians: all its triangles are at distance 0, as many again at other distances.
TEST(BuildTest, ThePoleOfAFanTiesByNumber)
{
    constexpr std::uint32_t count = 96;
    Mesh mesh;
    const auto ring = [&](int i, double radius, double z) {
        const double angle = 2 * std::numbers::pi * i / count;
        return Point{radius * std::cos(angle), radius * std::sin(angle), z};
    };
    for (int i = 0; i < static_cast<int>(count); i++)
        mesh.add({0, 0, 10}, ring(i, 1, 9.5), ring(i + 1, 1, 9.5));
    for (int i = 0; i < static_cast<int>(count); i++)
        mesh.add(ring(i, 1, 9.5), ring(i, 2, 8), ring(i + 1, 2, 8 + 0.01 * i));
    const auto tree = TriangleTree<14>::build(mesh.view());
    Nearest found;
    for (std::uint32_t wanted = 1; wanted < count; wanted++) {
        tree.nearest({0, 0, 10}, wanted, infinity, found);
        found.sort();
        ASSERT_EQ(found.hits.size(), wanted);
        for (std::uint32_t i = 0; i < wanted; i++) {
            ASSERT_EQ(found.hits[i].triangle, i) << "of " << wanted;
            ASSERT_LE(found.hits[i].distance, tree.accuracy({0, 0, 10}, 0));
        }
        ASSERT_EQ(found.coverage, 0);
    }
}

TEST(BuildTest, ManyIdenticalPointsEnd)
{
    Mesh mesh;
    mesh.vertices = {{3, 4, 0}};
    mesh.triangles.assign(100000, {0, 0, 0});
    const auto tree = TriangleTree<14>::build(mesh.view());
    Nearest found;
    tree.nearest({0, 0, 0}, 10, infinity, found);
    found.sort();
    ASSERT_EQ(found.hits.size(), 10u);
    EXPECT_NEAR(found.hits[9].distance, 5, tree.accuracy({0, 0, 0}, 5));
}

// Each triangle half as far as the one before: the heuristic splits off one or two at a time.
TEST(BuildTest, GeometricSeriesStaysWithinTheSearchStack)
{
    Mesh mesh;
    for (int repeat = 0; repeat < 200; repeat++)
        for (int i = 0; i < 100; i++) {
            const double x = std::ldexp(1.0, -i), y = std::ldexp(1.0, -repeat / 2);
            mesh.add({x, y, 0}, {x * 1.01, y, 0}, {x, y * 1.01, x});
        }
    const auto tree = TriangleTree<26>::build(mesh.view());
    Nearest found;
    for (int i = 0; i < 60; i += 5) {
        const Point p = {std::ldexp(1.0, -i), std::ldexp(1.1, -i / 2), 0};
        tree.nearest(p, 64, infinity, found);
        expect_nearest(true_distances(mesh, p), found, 64, infinity, accuracy_of(tree, p));
    }
}

// No box on a line has a surface; the heuristic must divide it all the same.
TEST(BuildTest, TrianglesOnALineAreDivided)
{
    Mesh mesh;
    for (int i = 0; i < 20000; i++)
        mesh.add({double(i), 0, 0}, {i + 0.3, 0, 0}, {i + 0.9, 0, 0});
    const auto tree = TriangleTree<14>::build(mesh.view());
    const Point p = {12345.2, 1, 0};
    Nearest found;
    tree.nearest(p, 8, 10, found);
    expect_nearest(true_distances(mesh, p), found, 8, 10, accuracy_of(tree, p));
    EXPECT_LE(found.counts.leaves, 4u) << "of 1250";
    EXPECT_LE(tree.bytes(), 48 * mesh.triangles.size());
}

TEST(BuildTest, ExtremeSizesKeepTheirShape)
{
    const Mesh unit = sphere(3, 1);
    for (double size : {1e-60, 1e-30, 1e30, 1e99}) {
        const Mesh mesh = scaled(unit, size, {0, 0, 0});
        const auto tree = TriangleTree<14>::build(mesh.view());
        Nearest found;
        const Point p = {0, 0, 2 * size};
        tree.nearest(p, 4, infinity, found);
        found.sort();
        ASSERT_EQ(found.hits.size(), 4u);
        EXPECT_NEAR(found.hits[0].distance, size, tree.accuracy(p, size));
        if (size > 1e-37) {
            EXPECT_LE(tree.accuracy(p, size), 1e-5 * size);
        }
    }
}

TEST(BuildTest, IndexOutOfRangeIsNamed)
{
    Mesh mesh = sphere(1, 1);
    mesh.triangles[5][1] = 4711;
    EXPECT_EQ(refusal(mesh), "fdh: triangle 5 refers to vertex 4711 of 18");
}

TEST(BuildTest, VertexThatIsNotFiniteOrTooFarIsNamed)
{
    for (double bad : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity, 1e101}) {
        Mesh mesh = sphere(1, 1);
        mesh.vertices[mesh.triangles[3][2]][1] = bad;
        EXPECT_NE(refusal(mesh).find("has a vertex that is not finite or too far away"), std::string::npos)
            << bad;
    }
}

TEST(BuildTest, UnusedVertexIsNotLookedAt)
{
    Mesh mesh = sphere(2, 1);
    mesh.vertices.push_back({infinity, 0, 1e9});
    EXPECT_EQ(refusal(mesh), "accepted");
}

TEST(BuildTest, ThreadsDoNotChangeTheTree)
{
    std::mt19937_64 random(13);
    const Mesh mesh = soup(40000, 100, random);
    const auto one = TriangleTree<14>::build(mesh.view(), {.threads = 1});
    const auto many = TriangleTree<14>::build(mesh.view(), {.threads = 7});
    EXPECT_EQ(one.bytes(), many.bytes());
    Nearest a, b;
    for (const Point& p : probes(sphere(2, 100), 30, random)) {
        one.nearest(p, 64, infinity, a);
        many.nearest(p, 64, infinity, b);
        EXPECT_EQ(a.counts.nodes, b.counts.nodes);
        EXPECT_EQ(a.counts.leaves, b.counts.leaves);
        ASSERT_EQ(a.hits.size(), b.hits.size());
        for (std::size_t i = 0; i < a.hits.size(); i++)
            EXPECT_EQ(a.hits[i].triangle, b.hits[i].triangle);
    }
}

TEST(BuildTest, MemoryPerTriangleIsBounded)
{
    const Mesh mesh = sphere(6, 1);
    const auto tree = TriangleTree<14>::build(mesh.view());
    EXPECT_LE(tree.bytes(), 48 * mesh.triangles.size());
}

// A query that visited everything would be right, and useless.
TEST(BuildTest, QueryVisitsFewLeaves)
{
    const Mesh mesh = sphere(6, 1);
    const auto tree = TriangleTree<14>::build(mesh.view());
    Nearest found;
    tree.nearest({0.5, 0.6, 0.7}, 64, infinity, found);
    EXPECT_LE(found.counts.leaves, 30u) << "of 2048";
    EXPECT_GE(found.counts.triangles, 64u);
}

/// Bytes of an image, with a place of their own.
struct Copy {
    explicit Copy(const TreeImage& of) : image(of)
    {
        nodes = aligned(of.nodes);
        leaves = aligned(of.leaves);
        image.nodes = {nodes.get(), of.nodes.size()};
        image.leaves = {leaves.get(), of.leaves.size()};
    }
    using Bytes = std::unique_ptr<std::byte, decltype(&std::free)>;
    static Bytes aligned(std::span<const std::byte> bytes)
    {
        const std::size_t whole = (bytes.size() + image_alignment - 1) / image_alignment * image_alignment;
        Bytes copy(static_cast<std::byte*>(std::aligned_alloc(image_alignment, whole)), &std::free);
        std::memcpy(copy.get(), bytes.data(), bytes.size());
        return copy;
    }
    TreeImage image;
    Bytes nodes{nullptr, &std::free}, leaves{nullptr, &std::free};
};

TEST(BuildTest, OpenedFromItsImageItAnswersTheSame)
{
    const Mesh mesh = sphere(3, 40);
    const auto built = TriangleTree<14>::build(mesh.view());
    auto copy = std::make_shared<Copy>(built.image());
    const TreeImage image = copy->image;
    const auto opened = TriangleTree<14>::open(image, std::move(copy)); // which lives on in it
    ASSERT_TRUE(opened);
    EXPECT_EQ(opened->triangles(), built.triangles());
    EXPECT_EQ(opened->hull(), built.hull());
    Nearest a, b;
    for (int i = 0; i < 100; i++) {
        const Point p = {std::sin(i) * 40, std::cos(1.3 * i) * 40, std::sin(2.1 * i) * 40};
        built.nearest(p, 16, 100, a);
        opened->nearest(p, 16, 100, b);
        EXPECT_EQ(a.coverage, b.coverage);
        ASSERT_EQ(a.hits.size(), b.hits.size());
        for (std::size_t h = 0; h < a.hits.size(); h++)
            EXPECT_EQ(a.hits[h].triangle, b.hits[h].triangle);
    }
}

TEST(BuildTest, AnImageThatIsNoneIsRefused)
{
    const auto tree = TriangleTree<14>::build(sphere(3, 40).view());
    const auto refused = [&](auto&& spoil) {
        Copy copy(tree.image());
        spoil(copy.image, reinterpret_cast<Node<14>*>(copy.nodes.get()),
              reinterpret_cast<Leaf*>(copy.leaves.get()));
        return !TriangleTree<14>::open(copy.image, nullptr);
    };
    using Nodes = Node<14>*;
    EXPECT_FALSE(refused([](TreeImage&, Nodes, Leaf*) {}));
    EXPECT_TRUE(refused([](TreeImage& i, Nodes, Leaf*) { i.nodes = i.nodes.first(i.nodes.size() - 1); }));
    EXPECT_TRUE(refused([](TreeImage& i, Nodes, Leaf*) { i.nodes = {}; }));
    EXPECT_TRUE(refused([](TreeImage& i, Nodes, Leaf*) { i.leaves = i.leaves.first(sizeof(Leaf)); }));
    EXPECT_TRUE(refused([](TreeImage& i, Nodes, Leaf*) { i.leaves = i.leaves.subspan(8); }));
    EXPECT_TRUE(refused([](TreeImage& i, Nodes, Leaf*) { i.step = std::nan(""); }));
    EXPECT_TRUE(refused([](TreeImage& i, Nodes, Leaf*) { i.longest_edge = std::nan(""); }));
    EXPECT_TRUE(refused([](TreeImage& i, Nodes, Leaf*) { i.triangles = 10; }));
    EXPECT_TRUE(refused([](TreeImage& i, Nodes, Leaf*) { i.triangles--; }));
    EXPECT_TRUE(refused([](TreeImage&, Nodes, Leaf* l) { l[3].triangle[0] = 1U << 20; }));
}

} // namespace phantom::fdh::test
