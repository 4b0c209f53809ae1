// SPDX-License-Identifier: GPL-2.0-or-later
// Every instruction set gives the bits of the scalar reference.
#include "fdh/isa.hpp"

#include <stdexcept>

#include "oracle.hpp"

namespace phantom::fdh::test {

namespace {

template <int K>
void expect_same_bits(Isa isa, const Mesh& mesh)
{
    const auto reference = TriangleTree<K>::build(mesh.view(), {.threads = 1, .isa = Isa::scalar});
    const auto tree = TriangleTree<K>::build(mesh.view(), {.threads = 1, .isa = isa});
    ASSERT_EQ(tree.isa(), isa);
    std::mt19937_64 random(23);
    Nearest expected, found;
    for (const Point& p : probes(mesh, 60, random))
        for (double radius : {infinity, 3.0}) {
            reference.nearest(p, 64, radius, expected);
            tree.nearest(p, 64, radius, found);
            ASSERT_EQ(found.hits.size(), expected.hits.size());
            ASSERT_EQ(found.coverage, expected.coverage);
            ASSERT_EQ(found.counts.nodes, expected.counts.nodes);
            ASSERT_EQ(found.counts.leaves, expected.counts.leaves);
            for (std::size_t i = 0; i < found.hits.size(); i++) {
                ASSERT_EQ(found.hits[i].triangle, expected.hits[i].triangle);
                ASSERT_EQ(found.hits[i].distance, expected.hits[i].distance);
            }
        }
}

class IsaTest : public testing::TestWithParam<Isa> {};

} // namespace

TEST_P(IsaTest, GivesTheBitsOfTheScalarReference)
{
    const Isa isa = GetParam();
    if (!isa_available(isa))
        GTEST_SKIP() << "this processor has no " << isa_name(isa);
    std::mt19937_64 random(29);
    for (const Mesh& mesh : {sphere(4, 60), soup(1500, 60, random), degenerate_faces(random)}) {
        expect_same_bits<6>(isa, mesh);
        expect_same_bits<14>(isa, mesh);
        expect_same_bits<18>(isa, mesh);
        expect_same_bits<26>(isa, mesh);
    }
}

INSTANTIATE_TEST_SUITE_P(All, IsaTest, testing::Values(Isa::sse2, Isa::avx2, Isa::avx512),
                         [](const auto& info) { return std::string(isa_name(info.param)); });

TEST(IsaTest, BestIsAvailableAndResolved)
{
    EXPECT_TRUE(isa_available(Isa::best));
    EXPECT_TRUE(isa_available(Isa::scalar));
    EXPECT_NE(resolve_isa(Isa::best), Isa::best);
    EXPECT_TRUE(isa_available(resolve_isa(Isa::best)));
    EXPECT_EQ(resolve_isa(Isa::scalar), Isa::scalar);
}

} // namespace phantom::fdh::test
