// SPDX-License-Identifier: GPL-2.0-or-later
// Other geometry in the place of the old (phantom_abi.h, OTHER GEOMETRY): a level of detail, a revision of an
// object that moves, bends, sinks or rises, in contact and under the surface.
#include "machine.hpp"

namespace phantom::test {
namespace {

constexpr double radius_un = 3e6; // k R

class Geometry : public MachineTest {
  protected:
    /// A plane at that height, the next set's.
    Plane plane(std::int64_t height_nm, std::uint32_t revision, std::uint32_t level = 0,
                std::uint32_t error_nm = 0)
    {
        Plane out(++id_, 50'000'000, 40'000'000, {0, 0, 0}, height_nm);
        out.header.centre_nm[2] = 0;
        out.objects[0].revision = revision;
        out.header.level = level;
        out.header.level_error_nm = error_nm;
        return out;
    }
    void begin(File& feeder, std::int64_t z, std::uint32_t crossfade_ms = 0)
    {
        Plane first = plane(0, 0);
        ASSERT_EQ(feeder.submit(first), 0);
        ASSERT_EQ(feeder.move(0, 0, 4 * mm), 0);
        phantom_start start{};
        start.flags = PHANTOM_START_LIMITS_OFF;
        start.stale_ms = 1'000'000;
        start.crossfade_ms = crossfade_ms;
        ASSERT_EQ(feeder.start(start), 0);
        step(30);
        go(feeder, z);
        step(30);
        EXPECT_NEAR(force(feeder), std::max(0.0, radius_un - double(z)), 20);
    }
    /// Straight up or down, 0.1 mm a tick.
    void go(File& feeder, std::int64_t z)
    {
        const std::int64_t from = feeder.status().tip_nm[2], steps = std::abs(z - from) / 100'000 + 1;
        for (std::int64_t i = 1; i <= steps; ++i) {
            feeder.move(0, 0, from + (z - from) * i / steps);
            step();
        }
    }
    static double force(File& feeder) { return feeder.status().force_un[2]; }
    static bool inside(File& feeder) { return (feeder.status().flags & PHANTOM_TICK_INSIDE) != 0; }
    /// Steps on to the end of a crossfade to `target`; never by more than its length allows.
    void expect_fade(File& feeder, double target, int ticks = 20)
    {
        double last = force(feeder);
        const double most = std::abs(target - last) / ticks + 20;
        for (int tick = 0; tick <= ticks + 1; ++tick) {
            step();
            EXPECT_LE(std::abs(force(feeder) - last), most) << "tick " << tick;
            EXPECT_EQ((feeder.status().flags & PHANTOM_TICK_FADING) != 0, tick < ticks) << "tick " << tick;
            last = force(feeder);
        }
        EXPECT_NEAR(last, target, 20);
    }

    std::uint64_t id_ = 0;
};

TEST_F(Geometry, AnotherLevelCarriesTheProxyAndCrossfades)
{
    for (const std::int64_t z : {-3 * mm, -mm / 100, mm}) {
        create({});
        id_ = 0;
        File feeder(machine);
        begin(feeder, z);
        for (int change = 0; change < 6; ++change) {
            const std::uint32_t level = 1 - change % 2;
            const std::int64_t height = level ? (change % 4 ? 30'000 : -30'000) : 0;
            Plane other = plane(height, 0, level, level ? 30'000 : 0);
            for (phantom_patch& patch : other.patches)
                patch.face += 7 + level; // numbers mean nothing across levels
            ASSERT_EQ(feeder.submit(other), 0);
            expect_fade(feeder, radius_un + double(height - z));
            EXPECT_EQ(inside(feeder), z < height);
            if (z < height) {
                EXPECT_NEAR(double(feeder.status().proxy_nm[2]), double(height), 20);
            }
        }
    }
}

TEST_F(Geometry, SurfaceThatMovesUnderAMovingTipIsFollowedWithoutAStep)
{
    for (const std::int64_t mean : {-2 * mm, mm}) { // under the surface and in contact with it
        create({});
        id_ = 0;
        File feeder(machine);
        begin(feeder, mean);
        double last = force(feeder);
        std::uint32_t revision = 0;
        for (int tick = 0; tick < 2000; ++tick) {
            const auto height = std::int64_t(0.4 * mm * std::sin(0.01 * tick)); // up to 4 um a tick
            const std::int64_t z = mean + std::int64_t(0.3 * mm * std::sin(0.05 * tick));
            if (tick % 4 == 0) {
                Plane next = plane(height, ++revision);
                ASSERT_EQ(feeder.submit(next), 0);
            }
            feeder.move(0, 0, z);
            step();
            const double now = force(feeder), exact = radius_un + double(height - z);
            EXPECT_EQ(inside(feeder), mean < 0) << tick;
            // each revision, 16 um from the last one, is five times begun to be faded to
            EXPECT_NEAR(now, exact, 100'000) << tick;
            EXPECT_LE(std::abs(now - last), 15'000 + 16'000) << tick; // the tip's 15 um a tick, the surface's
            last = now;
        }
    }
}

TEST_F(Geometry, SurfaceThatRisesOverTheTipTakesItIn)
{
    for (const std::int64_t rise : {mm / 5, mm, 5 * mm / 2}) {
        create({});
        id_ = 0;
        File feeder(machine);
        begin(feeder, mm / 10);
        Plane higher = plane(rise, 1);
        feeder.submit(higher);
        expect_fade(feeder, radius_un + double(rise - mm / 10));
        EXPECT_TRUE(inside(feeder));
        EXPECT_NEAR(double(feeder.status().proxy_nm[2]), double(rise), 20);
        go(feeder, rise + mm);
        EXPECT_FALSE(inside(feeder)) << "it lets go as any other";
        EXPECT_NEAR(force(feeder), radius_un - mm, 20);
    }
}

TEST_F(Geometry, SurfaceThatSinksBelowTheTipLetsItGo)
{
    for (const std::int64_t sink : {2 * mm, 4 * mm, 10 * mm}) {
        create({});
        id_ = 0;
        File feeder(machine);
        begin(feeder, -mm);
        Plane lower = plane(-sink, 1);
        feeder.submit(lower);
        expect_fade(feeder, std::max(0.0, radius_un - double(sink - mm)));
        EXPECT_FALSE(inside(feeder));
    }
}

/// A tilted plane: the force turns as well.
TEST_F(Geometry, SurfaceThatTiltsUnderTheTipTurnsTheForce)
{
    File feeder(machine);
    begin(feeder, -2 * mm);
    Plane tilted = plane(0, 1);
    const double angle = 0.2;
    for (phantom_patch& patch : tilted.patches)
        for (int corner = 0; corner < 3; ++corner) {
            patch.vertex_nm[corner][2] = std::int32_t(std::tan(angle) * patch.vertex_nm[corner][0]);
            patch.normal_q30[corner][0] = -std::int32_t(std::lround(std::sin(angle) * PHANTOM_Q30_ONE));
            patch.normal_q30[corner][2] = std::int32_t(std::lround(std::cos(angle) * PHANTOM_Q30_ONE));
        }
    feeder.submit(tilted);
    phantom_status last = feeder.status();
    const double size = radius_un + 2e6 * std::cos(angle);
    for (int tick = 0; tick < 22; ++tick) {
        step();
        const phantom_status now = feeder.status();
        EXPECT_LE(distance(now.force_un, last.force_un), 2 * 0.2 * 5e6 / 20);
        last = now;
    }
    EXPECT_TRUE(inside(feeder));
    EXPECT_NEAR(last.force_un[0], -std::sin(angle) * size, 50);
    EXPECT_NEAR(last.force_un[2], std::cos(angle) * size, 50);
}

TEST_F(Geometry, CrossfadeTakesTheTimeThatStartNames)
{
    for (const std::uint32_t ms : {0U, 1U, 5U, 100U, 1000U}) {
        create({});
        id_ = 0;
        File feeder(machine);
        begin(feeder, -mm, ms);
        Plane lower = plane(-mm / 2, 1);
        feeder.submit(lower);
        expect_fade(feeder, radius_un + mm / 2, ms ? int(ms) : 20);
    }
}

TEST_F(Geometry, CrossfadeDoesNotHoldTheForceOfAMovingTip)
{
    File feeder(machine);
    begin(feeder, -mm, 100);
    Plane lower = plane(-mm / 50, 1); // 20 um
    feeder.submit(lower);
    for (std::int64_t z = -mm; z > -3 * mm; z -= mm / 50) { // 2 mm in 100 ms
        feeder.move(0, 0, z);
        step();
        EXPECT_NEAR(force(feeder), radius_un - mm / 50 - double(z), 20'010) << "the surfaces' 20 um at most";
    }
}

TEST_F(Geometry, LossOfCoverageCutsALongCrossfadeShort)
{
    File feeder(machine);
    begin(feeder, -mm, 5000);
    Plane lower = plane(-mm / 2, 1);
    feeder.submit(lower);
    step(10);
    Plane nothing = plane(-mm / 2, 1);
    nothing.header.radius_nm = 0;
    feeder.submit(nothing);
    expect_fade(feeder, 0);
}

/// Two walls that meet in the y axis, `lift_nm` higher.
Plane groove(std::uint64_t id, double degrees, std::int64_t lift_nm)
{
    Plane out(id);
    out.patches.clear();
    const double half = degrees / 2 * M_PI / 180, high = 20, wide = high * std::tan(half), deep = 20;
    for (const int side : {-1, 1}) {
        // corners: two at the bottom, two above
        const double at[4][3] = {
            {0, -deep, 0}, {0, deep, 0}, {side * wide, -deep, high}, {side * wide, deep, high}};
        const double normal[3] = {-side * std::cos(half), 0, std::sin(half)};
        const int faces[2][2][3] = {{{0, 1, 3}, {0, 3, 2}}, {{0, 2, 3}, {0, 3, 1}}}; // left, right
        for (const auto& corners : faces[side > 0]) {
            phantom_patch patch{};
            for (int c = 0; c < 3; ++c) {
                for (int axis = 0; axis < 3; ++axis) {
                    patch.vertex_nm[c][axis] = std::int32_t(std::lround(at[corners[c]][axis] * mm));
                    patch.normal_q30[c][axis] = std::int32_t(std::lround(normal[axis] * PHANTOM_Q30_ONE));
                }
                patch.vertex_nm[c][2] += std::int32_t(lift_nm);
                patch.vertex[c] = std::uint32_t(corners[c] < 2 ? corners[c] : 10 * (side + 2) + corners[c]);
                patch.neighbour[c] = PHANTOM_PATCH_NONE;
            }
            patch.face = std::uint32_t(out.patches.size());
            out.patches.push_back(patch);
        }
    }
    return out;
}

/// On all sides of V, caught in the bottom, the new surface is higher: no way along a wall's normal finds it.
TEST_F(Geometry, GrooveThatRisesAroundTheProxyKeepsIt)
{
    for (const double degrees : {5.0, 60.0, 120.0}) {
        for (const bool level : {true, false}) {
            for (const std::int64_t lift : {-30'000, 30'000, 300'000}) {
                for (int aside = -10; aside <= 10; ++aside) {
                    if (level && lift > 30'000)
                        continue; // more than its error
                    create({});
                    File feeder(machine);
                    Plane first = groove(1, degrees, 0);
                    ASSERT_EQ(feeder.submit(first), 0);
                    ASSERT_EQ(feeder.move(0, 0, 5 * mm), 0);
                    ASSERT_EQ(feeder.start_unlimited(), 0);
                    step(30);
                    go(feeder, -mm);
                    for (int i = 0; i <= 40; ++i) {
                        feeder.move(aside * i * mm / 200, 0, -mm); // 2 mm at most
                        step();
                    }
                    ASSERT_TRUE(inside(feeder));
                    Plane other = groove(2, degrees, lift);
                    other.header.level = level;
                    other.header.level_error_nm = level ? 30'000 : 0;
                    other.objects[0].revision = !level;
                    ASSERT_EQ(feeder.submit(other), 0);
                    step(22);
                    EXPECT_TRUE(inside(feeder)) << degrees << " degrees, level " << level << ", by " << lift
                                                << " nm, aside " << aside;
                    // up the wall, as far as the tip is past the bottom's wedge
                    const double half = degrees / 2 * M_PI / 180, x = aside * double(mm) / 5;
                    const double up =
                        std::max(0.0, std::abs(x) * std::sin(half) - double(mm + lift) * std::cos(half));
                    EXPECT_NEAR(double(feeder.status().proxy_nm[2]), double(lift) + up * std::cos(half), 50);
                    EXPECT_NEAR(std::abs(double(feeder.status().proxy_nm[0])), up * std::sin(half), 50);
                }
            }
        }
    }
}

/// Another object's revision, or a level, must not take a tip in that is between two walls.
TEST_F(Geometry, TipInASlotNarrowerThanTheContactRadiusStaysOutside)
{
    File feeder(machine);
    const auto slot = [&](std::uint32_t revision) {
        Plane out = plane(0, revision);
        for (const auto& [height, up] : {std::pair{1.0, false}, std::pair{1.2, true}}) {
            for (int f = 0; f < 2; ++f) {
                phantom_patch patch = out.patches[f];
                for (int corner = 0; corner < 3; ++corner) {
                    const phantom_patch& from = out.patches[f];
                    const int other = up ? corner : 2 - corner; // turned round, it looks down
                    std::copy_n(from.vertex_nm[other], 3, patch.vertex_nm[corner]);
                    patch.vertex_nm[corner][2] = std::int32_t(height * mm);
                    patch.normal_q30[corner][2] = up ? PHANTOM_Q30_ONE : -PHANTOM_Q30_ONE;
                    patch.vertex[corner] = from.vertex[other] + (up ? 200 : 100);
                    patch.neighbour[corner] = PHANTOM_PATCH_NONE;
                }
                patch.face = std::uint32_t(f) + (up ? 200 : 100);
                out.patches.push_back(patch);
            }
        }
        return out;
    };
    Plane first = slot(0);
    ASSERT_EQ(feeder.submit(first), 0);
    ASSERT_EQ(feeder.move(5 * mm, -3 * mm, 4 * mm / 10), 0);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    step(30);
    const phantom_status before = feeder.status();
    ASSERT_EQ(before.contacts, 2u);
    for (std::uint32_t revision = 1; revision < 20; ++revision) {
        Plane next = slot(revision);
        ASSERT_EQ(feeder.submit(next), 0);
        step();
        EXPECT_FALSE(inside(feeder));
        EXPECT_LT(distance(feeder.status().force_un, before.force_un), 20);
    }
}

} // namespace
} // namespace phantom::test
