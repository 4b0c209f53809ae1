// SPDX-License-Identifier: GPL-2.0-or-later
// Every hard case, with every model, proxy and arithmetic: what is promised holds. `hard_cases_table` prints
// the figures.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "random_cases.hpp"
#include "suite.hpp"

namespace {

using namespace phantom;
using namespace phantom::hard;

/// Samples are that much farther apart than in the case; where the force is steep it is looked at as closely.
#ifdef __SANITIZE_ADDRESS__
constexpr bool sanitized = true; // ten times slower
constexpr double coarseness = 12;
#else
constexpr bool sanitized = false;
constexpr double coarseness = 3;
#endif

/// Is it the same source as another one, only wider?
bool is_wide(const phantom_float_ops& ops)
{
    return ops.isa == PHANTOM_ISA_AVX2 || ops.isa == PHANTOM_ISA_AVX512;
}

/// All runs of one case.
void expect_kept(const Case& hard)
{
    const Course course(hard, coarseness);
    for (const phantom_float_ops* ops : sections()) {
        if (sanitized && is_wide(*ops))
            continue;
        for (const Variant& variant : variants) {
            Measured sum;
            for (const std::uint32_t proxy : proxies_of(hard))
                sum.add(course.run(*ops, variant, proxy));
            for (const std::string& sentence : broken(hard, *ops, variant, sum))
                ADD_FAILURE() << hard.name << ", " << variant.name << ", " << ops->name << ": " << sentence;
        }
    }
}

void expect_kept(Kind kind)
{
    unsigned cases = 0;
    for (const Case& hard : corpus()) {
        if (hard.kind != kind)
            continue;
        if (++cases % 3 == 1 || !sanitized) // the release build has them all
            expect_kept(hard);
    }
    EXPECT_GT(cases, 2U);
}

TEST(HardCases, SliversAndPoints)
{
    expect_kept(Kind::slivers);
}
TEST(HardCases, TipExactlyOnVertexEdgePlaneAndWall)
{
    expect_kept(Kind::on_feature);
}
TEST(HardCases, RidgesConesCornersAndSaddles)
{
    expect_kept(Kind::edges);
}
TEST(HardCases, GroovesAndFoldedShells)
{
    expect_kept(Kind::folds);
}
TEST(HardCases, PlacesNarrowerThanTwoR)
{
    expect_kept(Kind::narrow);
}
TEST(HardCases, FarAndSmallMeshes)
{
    expect_kept(Kind::place);
}
TEST(HardCases, DoubledFlippedOpenAndCrossingFaces)
{
    expect_kept(Kind::doubles);
}
TEST(HardCases, FastAndFaultyTips)
{
    expect_kept(Kind::speed);
}
TEST(HardCases, SetsExchangedInMidContact)
{
    expect_kept(Kind::exchange);
}
TEST(HardCases, LimitsOfTheIntegerBorder)
{
    expect_kept(Kind::limits);
}

/// Which seeds: PHANTOM_SEED is the first, PHANTOM_SEEDS how many.
std::uint64_t from_environment(const char* name, std::uint64_t otherwise)
{
    const char* text = std::getenv(name);
    return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

/// What is needed to look at it again.
void describe(const Case& hard, std::uint64_t seed)
{
    const std::string file = fmt::format("{}hard-case-{}.obj", testing::TempDir(), seed);
    std::ofstream(file) << as_obj(hard.sets[0]);
    ADD_FAILURE() << "seed " << seed << ": its mesh is in " << file << "\nagain: PHANTOM_SEED=" << seed
                  << " PHANTOM_SEEDS=1 hard_cases_test --gtest_filter=RandomCases.KeepWhatIsPromised"
                  << "\nfigures: hard_cases_table --random " << seed << " 1"
                  << "\nonce it is mended, the seed goes into tests/hard_cases/seeds.txt";
}

void expect_seed_kept(std::uint64_t seed, const std::string& fault = {})
{
    Case hard = random_case(seed);
    hard.fault = fault;
    const int before = testing::UnitTest::GetInstance()->current_test_info()->result()->total_part_count();
    expect_kept(hard);
    const int after = testing::UnitTest::GetInstance()->current_test_info()->result()->total_part_count();
    if (after > before)
        describe(hard, seed);
}

TEST(RandomCases, KeepWhatIsPromised)
{
    const std::uint64_t first = from_environment("PHANTOM_SEED", 1),
                        count = from_environment("PHANTOM_SEEDS", 30);
    for (std::uint64_t seed = first; seed < first + count; ++seed)
        expect_seed_kept(seed);
}

/// Seeds that once found a fault, with its story; those of faults not yet mended are marked.
TEST(RandomCases, ThatOnceFailedAreKept)
{
    std::ifstream file(PHANTOM_HARD_SEEDS);
    std::string line;
    unsigned seeds = 0;
    while (std::getline(file, line)) {
        std::istringstream row(line.substr(0, line.find('#')));
        std::uint64_t seed = 0;
        if (!(row >> seed))
            continue;
        ++seeds;
        std::string word;
        expect_seed_kept(seed, row >> word ? line : std::string());
    }
    EXPECT_GT(seeds, 0U) << PHANTOM_HARD_SEEDS;
}

} // namespace
