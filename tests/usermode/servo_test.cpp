// SPDX-License-Identifier: GPL-2.0-or-later
// The tick on a virtual clock: periods, sets, coverage, fades.
#include "machine.hpp"

namespace phantom::test {
namespace {

constexpr double fade_ticks = PHANTOM_FADE_NS / 1e6; // at 1 kHz

class Servo : public MachineTest {
  protected:
    /// In contact 2 mm over the plane (1 N up), settled, limits off.
    void touch(File& feeder, Plane& plane, std::int64_t z = 2'000'000)
    {
        ASSERT_EQ(feeder.submit(plane), 0);
        ASSERT_EQ(feeder.move(0, 0, z), 0);
        ASSERT_EQ(feeder.start_unlimited(), 0);
        step(PHANTOM_FADE_NS / 1'000'000 + 2);
        feeder.read();
    }
};

// ---- periods

TEST_F(Servo, RateChangeMissesNoTick)
{
    File feeder(machine);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    std::vector<std::uint64_t> periods;
    for (std::uint32_t hz : {1000u, 10'000u, 3000u, 7777u, 1000u}) {
        ASSERT_EQ(feeder.rate(hz), 0);
        for (int i = 0; i < 50; ++i)
            periods.push_back(1'000'000'000 / hz);
        step(50);
        EXPECT_EQ(feeder.status().rate_hz, hz);
    }
    const auto records = feeder.read();
    ASSERT_EQ(records.size(), periods.size());
    for (std::size_t i = 1; i < records.size(); ++i) {
        EXPECT_EQ(records[i].tick, records[i - 1].tick + 1);
        EXPECT_EQ(records[i].time_ns - records[i - 1].time_ns, periods[i - 1])
            << "the tick that saw the new rate is followed by the new period";
    }
    EXPECT_EQ(feeder.status().missed, 0u);
}

TEST_F(Servo, LatePeriodsAreSkippedCountedAndNeverCaughtUp)
{
    File feeder(machine);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    step(3);
    phantom_um_inject_stall(machine, 5'400'000); // tick 4 comes 5.4 periods late
    step(3);
    const auto records = feeder.read();
    ASSERT_EQ(records.size(), 6u);
    const std::uint64_t begin = feeder.status().start_ns;
    EXPECT_EQ(records[3].tick, 4u);
    EXPECT_EQ(records[3].time_ns, begin + 9'400'000);
    EXPECT_EQ(records[3].latency_ns, 5'400'000u);
    EXPECT_EQ(records[4].tick, 9u) << "5, 6, 7 and 8 are over";
    EXPECT_EQ(records[5].tick, 10u);
    EXPECT_EQ(records[5].time_ns, begin + 10'000'000) << "back on the old grid";
    EXPECT_EQ(feeder.status().missed, 4u);
}

TEST_F(Servo, TenThousandTicksAreReproducible)
{
    std::vector<phantom_tick> runs[2];
    for (auto& run : runs) {
        create({});
        File feeder(machine);
        Plane plane(1);
        feeder.submit(plane);
        feeder.move(0, 0, 4'000'000);
        ASSERT_EQ(feeder.start_unlimited(), 0);
        for (int i = 0; i < 10'000; ++i) {
            feeder.move(i * 1000, i * 500, 4'000'000 - std::int64_t(i) * 600);
            step();
            if (i % 1000 == 0) {
                const auto records = feeder.read();
                run.insert(run.end(), records.begin(), records.end());
            }
        }
        const auto records = feeder.read();
        run.insert(run.end(), records.begin(), records.end());
    }
    ASSERT_EQ(runs[0].size(), 10'000u);
    ASSERT_EQ(runs[0].size(), runs[1].size());
    EXPECT_EQ(std::memcmp(runs[0].data(), runs[1].data(), runs[0].size() * sizeof(phantom_tick)), 0);
}

TEST_F(Servo, ForcesHaveTheSameBitsInEveryInstructionSet)
{
    std::vector<phantom_tick> narrow;
    int wider = 0;
    for (std::uint32_t isa : {PHANTOM_ISA_SSE2, PHANTOM_ISA_AVX2, PHANTOM_ISA_AVX512}) {
        const char* const name = isa == PHANTOM_ISA_AVX2 ? "avx2" : "avx512f";
        if (isa != PHANTOM_ISA_SSE2 && !(isa == PHANTOM_ISA_AVX2 ? __builtin_cpu_supports("avx2")
                                                                 : __builtin_cpu_supports("avx512f") &&
                                                                       __builtin_cpu_supports("avx512dq")))
            continue;
        create({.isa = isa});
        File feeder(machine);
        Plane plane(1);
        feeder.submit(plane);
        feeder.move(0, 0, 4'000'000);
        ASSERT_EQ(feeder.start_unlimited(), 0);
        for (int i = 0; i < 2000; ++i) {
            feeder.move(i * 7001, i * 3001, 4'000'000 - std::int64_t(i) * 2500);
            step();
        }
        EXPECT_EQ(feeder.status().isa, isa);
        const std::vector<phantom_tick> run = feeder.read();
        if (isa == PHANTOM_ISA_SSE2) {
            narrow = run;
            continue;
        }
        ++wider;
        ASSERT_EQ(narrow.size(), run.size());
        for (std::size_t i = 0; i < run.size(); ++i)
            ASSERT_EQ(std::memcmp(&narrow[i], &run[i], sizeof(phantom_tick)), 0) << name << ", tick " << i;
    }
    if (!wider)
        GTEST_SKIP() << "no AVX2 here";
}

// ---- contact through the whole chain

TEST_F(Servo, PlaneForceIsStiffnessTimesDepthOfTheShell)
{
    File feeder(machine);
    Plane plane(1);
    touch(feeder, plane);
    for (std::int64_t z = 2'900'000; z > 100'000; z -= 100'000) {
        feeder.move(5'000'000, -3'000'000, z);
        step();
        const phantom_status status = feeder.status();
        EXPECT_NEAR(status.force_un[2], 3'000'000 - double(z), 5) << z;
        EXPECT_NEAR(status.force_un[0], 0, 5);
    }
}

TEST_F(Servo, TipBelowTheSurfaceIsHeldByItsProxy)
{
    File feeder(machine);
    Plane plane(1);
    touch(feeder, plane);
    for (std::int64_t z = 2'000'000; z >= -5'000'000; z -= 50'000) {
        feeder.move(0, 0, z);
        step();
    }
    phantom_status status = feeder.status();
    EXPECT_TRUE(status.flags & PHANTOM_TICK_INSIDE);
    EXPECT_NEAR(double(status.proxy_nm[2]), 0, 50);
    EXPECT_NEAR(status.force_un[2], 8'000'000, 100) << "k (R + depth)";
    for (std::int64_t z = -5'000'000; z <= 1'000'000; z += 50'000) {
        feeder.move(0, 0, z);
        step();
    }
    status = feeder.status();
    EXPECT_FALSE(status.flags & PHANTOM_TICK_INSIDE);
    EXPECT_NEAR(status.force_un[2], 2'000'000, 5);
}

TEST_F(Servo, FarFromTheOriginNothingChanges)
{
    const std::array<std::int64_t, 3> far{5'000'000'000'000'000, -3'000'000'000'000'000, 70'000'000'000};
    File feeder(machine);
    Plane plane(1);
    for (int axis = 0; axis < 3; ++axis)
        plane.header.origin_nm[axis] = far[axis];
    feeder.submit(plane);
    feeder.move(far[0] + 123, far[1], far[2] + 2'000'000);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    step(30);
    EXPECT_NEAR(feeder.status().force_un[2], 1'000'000, 5);
    feeder.move(far[0], far[1], far[2] - 1'000'000);
    step();
    EXPECT_TRUE(feeder.status().flags & PHANTOM_TICK_INSIDE);
    EXPECT_EQ(feeder.status().proxy_nm[0] / 1'000'000, far[0] / 1'000'000);
}

TEST_F(Servo, FartherFromTheOriginThanTheBorderReachesIsUncovered)
{
    constexpr std::int64_t farthest = INT32_MAX - PHANTOM_COORDINATE_MAX_NM;
    File feeder(machine);
    Plane plane(1, 1'000'000'000, 2'000'000'000);
    feeder.submit(plane);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    for (const std::int64_t sign : {-1, 1}) {
        feeder.move(sign * farthest, 0, 1'000'000);
        step();
        EXPECT_FALSE(feeder.status().flags & PHANTOM_TICK_UNCOVERED);
        // a vertex on the other side would be nearer by 2^32 nm
        feeder.move(sign * (farthest + 1), 0, 1'000'000);
        step();
        EXPECT_TRUE(feeder.status().flags & PHANTOM_TICK_UNCOVERED);
    }
}

// ---- swaps

TEST_F(Servo, SwapInContactKeepsTheForce)
{
    File feeder(machine);
    Plane plane(1);
    touch(feeder, plane);
    for (std::uint64_t id = 2; id < 200; ++id) {
        const std::array<std::int64_t, 3> origin{std::int64_t(id) * 17'777, -std::int64_t(id) * 9'999,
                                                 std::int64_t(id) * 3'333};
        Plane next(id, 50'000'000, 40'000'000, origin);
        ASSERT_EQ(feeder.submit(next), 0);
        step();
        const phantom_status status = feeder.status();
        ASSERT_EQ(status.set_id, id);
        ASSERT_NEAR(status.force_un[2], 1'000'000, 5);
        ASSERT_FALSE(status.flags & PHANTOM_TICK_FADING);
    }
    EXPECT_EQ(feeder.status().fades, 1u) << "the first touch only";
}

TEST_F(Servo, SwapBelowTheSurfaceKeepsProxyAndForce)
{
    File feeder(machine);
    Plane plane(1);
    touch(feeder, plane);
    for (std::int64_t z = 2'000'000; z >= -4'000'000; z -= 100'000) {
        feeder.move(0, 0, z);
        step();
    }
    const phantom_status before = feeder.status();
    ASSERT_TRUE(before.flags & PHANTOM_TICK_INSIDE);
    Plane next(2, 50'000'000, 40'000'000, {-9'000'000, 12'345'678, 22'222'222});
    feeder.submit(next);
    step();
    const phantom_status after = feeder.status();
    EXPECT_EQ(after.set_id, 2u);
    EXPECT_TRUE(after.flags & PHANTOM_TICK_INSIDE);
    EXPECT_FALSE(after.flags & PHANTOM_TICK_FADING);
    EXPECT_LT(distance(after.force_un, before.force_un), 100);
    EXPECT_NEAR(double(after.proxy_nm[2]), double(before.proxy_nm[2]), 50);
}

TEST_F(Servo, OnlyTheNewestOfSeveralSetsIsTaken)
{
    File feeder(machine);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    for (std::uint64_t id = 1; id <= 50; ++id) {
        Plane plane(id);
        ASSERT_EQ(feeder.submit(plane), 0) << "never out of slots";
    }
    step();
    EXPECT_EQ(feeder.status().set_id, 50u);
    EXPECT_EQ(feeder.status().sets, 1u);
}

TEST_F(Servo, NewRevisionFades)
{
    File feeder(machine);
    Plane plane(1);
    touch(feeder, plane);
    Plane lower(2, 50'000'000, 40'000'000, {0, 0, 0}, -500'000); // the surface has sunk by half a millimetre
    lower.objects[0].revision = 1;
    feeder.submit(lower);
    double last = 1e6;
    for (int tick = 0; tick < 19; ++tick) {
        step();
        const phantom_status status = feeder.status();
        EXPECT_TRUE(status.flags & PHANTOM_TICK_FADING);
        EXPECT_LE(std::abs(status.force_un[2] - last), 500'000 / fade_ticks + 5);
        last = status.force_un[2];
    }
    step(2);
    EXPECT_NEAR(feeder.status().force_un[2], 500'000, 5);
    EXPECT_FALSE(feeder.status().flags & PHANTOM_TICK_FADING);
}

TEST_F(Servo, ModelChangeFades)
{
    File feeder(machine);
    Plane plane(1);
    touch(feeder, plane);
    phantom_model off{PHANTOM_MODEL_OFF, 0, 0, 0, 0, {}};
    ASSERT_EQ(feeder.ioctl(PHANTOM_SET_MODEL, &off), 0);
    double last = 1e6;
    for (int tick = 0; tick < 25; ++tick) {
        step();
        const double force = feeder.status().force_un[2];
        EXPECT_LE(std::abs(force - last), 1e6 / fade_ticks + 5);
        last = force;
    }
    EXPECT_EQ(last, 0.0);
    phantom_model paper{PHANTOM_MODEL_PAPER, 0, PHANTOM_COMBINE_PAPER, PHANTOM_PROXY_PAPER, 0, {}};
    ASSERT_EQ(feeder.ioctl(PHANTOM_SET_MODEL, &paper), 0);
    step();
    EXPECT_LE(feeder.status().force_un[2], 1e6 / fade_ticks + 5);
    step(25);
    EXPECT_NEAR(feeder.status().force_un[2], 1'000'000, 5);
}

// ---- coverage

TEST_F(Servo, CoverageEndsWhereTheBallOfTheContactRadiusLeavesIt)
{
    File feeder(machine);
    Plane plane(1, 50'000'000, 20'000'000);
    feeder.submit(plane);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    const auto uncovered = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
        feeder.move(x, y, z);
        step();
        return bool(feeder.status().flags & PHANTOM_TICK_UNCOVERED);
    };
    EXPECT_FALSE(uncovered(0, 0, 17'000'000));
    EXPECT_TRUE(uncovered(0, 0, 17'000'001));
    EXPECT_FALSE(uncovered(-17'000'000, 0, 0));
    EXPECT_TRUE(uncovered(-17'000'000, 0, 5'000));
    EXPECT_FALSE(uncovered(10'200'000, 13'600'000, 0)) << "3-4-5";
    EXPECT_TRUE(uncovered(10'200'000, 13'600'001, 0));
}

TEST_F(Servo, CoverageLossFadesWithoutAStep)
{
    File feeder(machine);
    Plane plane(1, 50'000'000, 20'000'000);
    touch(feeder, plane);
    feeder.move(19'000'000, 0, 2'000'000); // in contact, but 19 mm out
    std::vector<double> force{1e6};
    for (int tick = 0; tick < 30; ++tick) {
        step();
        const phantom_status status = feeder.status();
        EXPECT_TRUE(status.flags & PHANTOM_TICK_UNCOVERED);
        EXPECT_EQ(status.contacts, 0u);
        force.push_back(status.force_un[2]);
    }
    for (std::size_t i = 1; i < force.size(); ++i) {
        EXPECT_LE(force[i], force[i - 1]);
        EXPECT_LE(force[i - 1] - force[i], 1e6 / fade_ticks + 2);
    }
    EXPECT_EQ(force[21], 0.0) << "within PHANTOM_FADE_NS";
    EXPECT_EQ(feeder.read().back().set_id, 1u) << "still in use, though it does not cover the tip";

    Plane wide(2);
    feeder.submit(wide);
    double last = 0;
    for (int tick = 0; tick < 30; ++tick) {
        step();
        const double now = feeder.status().force_un[2];
        EXPECT_LE(std::abs(now - last), 1e6 / fade_ticks + 2) << "and comes back the same way";
        last = now;
    }
    EXPECT_NEAR(last, 1'000'000, 5);
}

TEST_F(Servo, FlickeringCoverageNeverSteps)
{
    File feeder(machine);
    Plane plane(1, 50'000'000, 20'000'000);
    touch(feeder, plane);
    double last = 1e6;
    for (int tick = 0; tick < 200; ++tick) {
        feeder.move(tick % 3 ? 16'999'000 : 17'100'000, 0, 2'000'000);
        step();
        const double now = feeder.status().force_un[2];
        EXPECT_LE(std::abs(now - last), 1e6 / fade_ticks + 5) << tick;
        last = now;
    }
}

TEST_F(Servo, InsideStateOutlivesAShortLossOfCoverage)
{
    File feeder(machine);
    Plane plane(1, 50'000'000, 20'000'000);
    touch(feeder, plane);
    for (std::int64_t z = 2'000'000; z >= -2'000'000; z -= 100'000) {
        feeder.move(0, 0, z);
        step();
    }
    ASSERT_TRUE(feeder.status().flags & PHANTOM_TICK_INSIDE);
    Plane nothing(2, 50'000'000, 0);
    feeder.submit(nothing);
    step(50); // 50 ms: the force is long gone
    phantom_status status = feeder.status();
    EXPECT_EQ(status.force_un[2], 0);
    EXPECT_TRUE(status.flags & PHANTOM_TICK_UNCOVERED);
    EXPECT_TRUE(status.flags & PHANTOM_TICK_INSIDE) << "remembered, for the feeder to cover";
    Plane back(3);
    feeder.submit(back);
    step(30);
    status = feeder.status();
    EXPECT_TRUE(status.flags & PHANTOM_TICK_INSIDE);
    EXPECT_NEAR(status.force_un[2], 5'000'000, 100);
}

TEST_F(Servo, InsideStateIsDroppedAfterALongLossOfCoverage)
{
    File feeder(machine);
    Plane plane(1, 50'000'000, 20'000'000);
    touch(feeder, plane);
    for (std::int64_t z = 2'000'000; z >= -2'000'000; z -= 100'000) {
        feeder.move(0, 0, z);
        step();
    }
    Plane nothing(2, 50'000'000, 0);
    feeder.submit(nothing);
    step(PHANTOM_MEMORY_NS / 1'000'000);
    EXPECT_TRUE(feeder.status().flags & PHANTOM_TICK_INSIDE);
    step();
    EXPECT_FALSE(feeder.status().flags & PHANTOM_TICK_INSIDE);
    Plane back(3);
    feeder.submit(back);
    step(30);
    EXPECT_EQ(feeder.status().force_un[2], 0) << "no force at a depth nobody felt coming";
}

TEST_F(Servo, TipThatGoesThroughWhileUncoveredIsFoundInside)
{
    File feeder(machine);
    Plane plane(1);
    touch(feeder, plane);
    Plane nothing(2, 50'000'000, 0);
    feeder.submit(nothing);
    for (std::int64_t z = 2'000'000; z >= -1'000'000; z -= 100'000) {
        feeder.move(0, 0, z);
        step();
    }
    EXPECT_FALSE(feeder.status().flags & PHANTOM_TICK_INSIDE) << "nobody looked";
    Plane back(3);
    feeder.submit(back);
    step();
    EXPECT_TRUE(feeder.status().flags & PHANTOM_TICK_INSIDE)
        << "the path since the last look crossed the plane";
    step(30);
    EXPECT_NEAR(feeder.status().force_un[2], 4'000'000, 100);
}

TEST_F(Servo, InsideNeedsTipAndProxyCovered)
{
    File feeder(machine);
    Plane plane(1);
    touch(feeder, plane);
    for (std::int64_t z = 2'000'000; z >= -6'000'000; z -= 100'000) {
        feeder.move(0, 0, z);
        step();
    }
    Plane round_tip(2, 50'000'000, 5'000'000);
    round_tip.header.centre_nm[2] = -6'000'000; // reaches up to -1 mm: not to the proxy
    feeder.submit(round_tip);
    step();
    EXPECT_TRUE(feeder.status().flags & PHANTOM_TICK_UNCOVERED);
    Plane round_middle(3, 50'000'000, 3'100'000); // both, with less
    round_middle.header.centre_nm[2] = -3'000'000;
    feeder.submit(round_middle);
    step();
    EXPECT_FALSE(feeder.status().flags & PHANTOM_TICK_UNCOVERED);
}

TEST_F(Servo, TipBeyondTheBorderOfS32IsUncoveredAndComesBack)
{
    File feeder(machine);
    Plane plane(1);
    plane.header.radius_nm = 0xffffffff;
    touch(feeder, plane);
    for (std::int64_t far : {std::int64_t{2'147'483'648}, std::int64_t{-2'147'483'649},
                             std::int64_t{PHANTOM_POSITION_MAX_NM}, std::int64_t{-PHANTOM_POSITION_MAX_NM}}) {
        feeder.move(far, 0, 2'000'000);
        step();
        EXPECT_TRUE(feeder.status().flags & PHANTOM_TICK_UNCOVERED) << far;
        EXPECT_EQ(feeder.status().tip_nm[0], far);
    }
    feeder.move(0, 0, 2'000'000);
    step(30);
    EXPECT_NEAR(feeder.status().force_un[2], 1'000'000, 5);
}

TEST_F(Servo, StaleSetFadesAndAFreshOneBringsTheForceBack)
{
    File feeder(machine);
    Plane plane(1);
    feeder.submit(plane);
    feeder.move(0, 0, 2'000'000);
    phantom_start start{};
    start.flags = PHANTOM_START_LIMITS_OFF;
    start.stale_ms = 60;
    ASSERT_EQ(feeder.start(start), 0);
    step(61); // taken by the first tick, so now 60 ms old
    EXPECT_FALSE(feeder.status().flags & PHANTOM_TICK_STALE);
    EXPECT_NEAR(feeder.status().force_un[2], 1'000'000, 5);
    feeder.read();
    step();
    EXPECT_TRUE(feeder.status().flags & PHANTOM_TICK_STALE);
    EXPECT_EQ(feeder.poll(POLLPRI), POLLPRI);
    step(20);
    EXPECT_EQ(feeder.status().force_un[2], 0);
    Plane fresh(2);
    feeder.submit(fresh);
    step(21);
    EXPECT_FALSE(feeder.status().flags & PHANTOM_TICK_STALE);
    EXPECT_NEAR(feeder.status().force_un[2], 1'000'000, 5);
}

TEST_F(Servo, SetThatBecameEmptyFades)
{
    File feeder(machine);
    Plane plane(1);
    touch(feeder, plane);
    Plane empty(2);
    empty.patches.clear();
    feeder.submit(empty);
    double last = 1e6;
    for (int tick = 0; tick < 25; ++tick) {
        step();
        const double now = feeder.status().force_un[2];
        EXPECT_LE(std::abs(now - last), 1e6 / fade_ticks + 2);
        last = now;
    }
    EXPECT_EQ(last, 0.0);
    EXPECT_FALSE(feeder.status().flags & PHANTOM_TICK_UNCOVERED) << "covered, and nothing there";
}

TEST_F(Servo, ReferenceMachineTakesAWholeMesh)
{
    create({.isa = PHANTOM_ISA_DOUBLE, .patches_max = 5000});
    File feeder(machine);
    phantom_model model{PHANTOM_MODEL_PROJECTED, 3, PHANTOM_COMBINE_BOUNDED, PHANTOM_PROXY_PAPER,
                        PHANTOM_ARITH_DOUBLE,    {}};
    ASSERT_EQ(feeder.ioctl(PHANTOM_SET_MODEL, &model), 0);
    Plane plane(1);
    phantom_patch far = plane.patches[0];
    for (auto& vertex : far.vertex_nm)
        vertex[2] -= 30'000'000;
    far.face = 2;
    far.neighbour[2] = PHANTOM_PATCH_NONE;
    plane.patches.resize(5000, far);
    touch(feeder, plane);
    EXPECT_EQ(feeder.status().isa, std::uint32_t(PHANTOM_ISA_DOUBLE));
    EXPECT_EQ(feeder.status().set_patches, 5000u);
    EXPECT_NEAR(feeder.status().force_un[2], 1'000'000, 5);
    plane.header.id = 2;
    plane.patches.push_back(far);
    EXPECT_EQ(feeder.submit(plane), -EINVAL);
}

} // namespace
} // namespace phantom::test
