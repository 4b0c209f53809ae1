// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/hausdorff.hpp"

#include <gtest/gtest.h>

#include "surfaces.hpp"

namespace phantom::test {
namespace {

double from_to(const mesh::Mesh& a, const mesh::Mesh& b, std::size_t samples = 100000, unsigned threads = 0)
{
    const auto tree = fdh::TriangleTree<14>::build({b.vertices, b.faces});
    return mesh::one_sided_hausdorff_mm(a, b, tree, samples, threads);
}

mesh::Mesh flat(std::uint32_t cells, double height = 0)
{
    return prepared(sheet(cells, [height](double, double) { return height; }));
}

TEST(Hausdorff, OfParallelPlanesIsTheirDistance)
{
    EXPECT_NEAR(from_to(flat(3), flat(7, 0.25)), 0.25, 1e-9);
    EXPECT_NEAR(from_to(flat(7, 0.25), flat(3)), 0.25, 1e-9);
    EXPECT_NEAR(from_to(flat(3), flat(7)), 0, 1e-9);
}

TEST(Hausdorff, IsOneSided)
{
    // A peak of 5 mm over one vertex: it is 5 mm from the plane; the plane is nearer to the pyramid.
    const mesh::Mesh peak =
        prepared(sheet(10, [](double x, double y) { return x == 0 && y == 0 ? 5.0 : 0.0; }));
    EXPECT_NEAR(from_to(peak, flat(10)), 5, 1e-9);
    const double back = from_to(flat(10), peak, 1000000);
    EXPECT_LT(back, 4.9);
    EXPECT_GT(back, 4.0); // the plane's point under the peak, from the pyramid's steep sides
}

TEST(Hausdorff, SeesWhatLiesInsideOfAFace)
{
    // Two faces over a dent that no vertex of theirs is near to: found by samples inside them.
    const mesh::Mesh dent =
        prepared(sheet(50, [](double x, double y) { return -3 * std::exp(-(x * x + y * y) / 100); }));
    EXPECT_NEAR(from_to(flat(1), dent), 3, 0.1);
}

TEST(Hausdorff, IsNeverLargerThanBruteForceAndTheSameForAnyThreads)
{
    const mesh::Mesh fine = prepared(waves(30)), coarse = prepared(waves(9));
    double brute = 0;
    for (const mesh::Vec3& vertex : fine.vertices)
        brute = std::max(brute, distance_to(coarse, vertex));
    const double found = from_to(fine, coarse, 1000000, 1);
    EXPECT_GE(found, brute - 1e-9); // vertices are among the samples
    EXPECT_LT(found, 1.1 * brute);
    EXPECT_EQ(found, from_to(fine, coarse, 1000000, 2));
    EXPECT_LE(from_to(fine, coarse, 300), found) << "fewer samples see less";
    EXPECT_GT(from_to(fine, coarse, 300), 0.3 * found);
}

TEST(Hausdorff, OfNothingIsZeroAndFromNothingInfinite)
{
    EXPECT_EQ(from_to(mesh::Mesh{}, flat(1)), 0);
    EXPECT_TRUE(std::isinf(from_to(flat(1), mesh::Mesh{})));
}

} // namespace
} // namespace phantom::test
