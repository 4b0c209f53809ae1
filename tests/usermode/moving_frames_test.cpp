// SPDX-License-Identifier: GPL-2.0-or-later
// Several frames in one set: each has patches, contact and memory of its own, whatever the others do.
#include <numbers>

#include "moving.hpp"
#include "split_probe.h"

namespace phantom::test {
namespace {

constexpr std::int64_t mm = 1'000'000; // nm; and with k = 1 N/mm, the uN of that much depth
constexpr double k = 1, radius = 3;    // N/mm, mm
constexpr std::uint64_t never = 1'000'000;

Place cross(const Place& a, const Place& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A roof of four faces, fans over its ridge and rims round it: patches of every kind. Corners in mm.
struct Roof {
    std::vector<phantom_patch> faces, fans, rims;

    Roof()
    {
        const Place ridge[2] = {{0, -10, 0}, {0, 10, 0}}, left[2] = {{-10, -10, -4}, {-10, 10, -4}},
                    right[2] = {{10, -10, -4}, {10, 10, -4}};
        const double size = std::hypot(4, 10);
        const Place nl{-4 / size, 0, 10 / size}, nr{4 / size, 0, 10 / size};
        face({left[0], ridge[0], ridge[1]}, nl);
        face({left[0], ridge[1], left[1]}, nl);
        face({ridge[0], right[0], right[1]}, nr);
        face({ridge[0], right[1], ridge[1]}, nr);
        fan({ridge[0], ridge[0], ridge[1]}, {nl, nr, nr});
        fan({ridge[0], ridge[1], ridge[1]}, {nl, nr, nl});
        rim(ridge[0], left[0]);
        rim(left[0], left[1]);
        rim(left[1], ridge[1]);
        rim(right[0], ridge[0]);
        rim(right[1], right[0]);
        rim(ridge[1], right[1]);
    }

  private:
    static phantom_patch patch(const std::array<Place, 3>& corner, const std::array<Place, 3>& normal)
    {
        phantom_patch out{};
        for (int c = 0; c < 3; ++c) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                out.vertex_nm[c][axis] = std::int32_t(std::lround(corner[c][axis] * 1e6));
                out.normal_q30[c][axis] = std::int32_t(std::lround(normal[c][axis] * PHANTOM_Q30_ONE));
            }
            out.vertex[c] = std::uint32_t(corner[c][0] / 10 + 1 + 3 * (corner[c][1] > 0));
            out.neighbour[c] = PHANTOM_PATCH_NONE;
        }
        out.surface = 1;
        out.face = PHANTOM_PATCH_NONE;
        return out;
    }
    void face(const std::array<Place, 3>& corner, const Place& normal)
    {
        phantom_patch next = patch(corner, {normal, normal, normal});
        next.face = std::uint32_t(faces.size());
        for (phantom_patch& other : faces) {
            for (int i = 0; i < 3; ++i) {
                for (int j = 0; j < 3; ++j) {
                    if (other.vertex[j] != next.vertex[(i + 1) % 3] ||
                        other.vertex[(j + 1) % 3] != next.vertex[i])
                        continue;
                    next.neighbour[i] = other.face;
                    other.neighbour[j] = next.face;
                }
            }
        }
        faces.push_back(next);
    }
    void fan(std::array<Place, 3> corner, std::array<Place, 3> normal)
    {
        const Place e1 = minus(corner[1], corner[0]), e2 = minus(corner[2], corner[0]);
        const Place f1 = minus(normal[1], normal[0]), f2 = minus(normal[2], normal[0]);
        const Place a = cross(e1, f2), b = cross(f1, e2);
        if (a[2] + b[2] < 0) {
            std::swap(corner[1], corner[2]);
            std::swap(normal[1], normal[2]);
        }
        fans.push_back(patch(corner, normal));
        fans.back().kind = PHANTOM_PATCH_EDGE;
    }
    void rim(const Place& from, const Place& to)
    {
        rims.push_back(patch({from, to, to}, {Place{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}));
        rims.back().kind = PHANTOM_PATCH_RIM;
    }
};

class Frames : public MovingTest {
  protected:
    /// The plane's patches once more, for another object.
    static void add_square(Plane& to, const std::vector<phantom_patch>& square, const phantom_object& object,
                           double height_mm = 0)
    {
        to.objects.push_back(object);
        const std::uint32_t index = std::uint32_t(to.objects.size() - 1);
        for (phantom_patch patch : square) {
            patch.object = index;
            patch.face += 2 * index;
            for (auto& corner : patch.vertex_nm)
                corner[2] += std::int32_t(std::lround(height_mm * 1e6));
            for (auto& vertex : patch.vertex)
                vertex += 4 * index;
            for (auto& neighbour : patch.neighbour)
                neighbour += neighbour == PHANTOM_PATCH_NONE ? 0 : 2 * index;
            to.patches.push_back(patch);
        }
    }
    static phantom_object resting(std::uint32_t number)
    {
        phantom_object out{};
        out.object = number;
        out.rotation_q30[0] = PHANTOM_Q30_ONE;
        return out;
    }
    /// 0.95 mm below the plane, of which sets come no more.
    void sink()
    {
        begin({0, 0, 3.5});
        for (int i = 0; i < 90; ++i)
            tick({0, 0, 3.5 - 0.05 * i});
        every = never;
        ASSERT_TRUE(flags & PHANTOM_TICK_INSIDE);
    }
    [[nodiscard]] double force_z() { return feeder->status().force_un[2] * 1e-6; }
};

TEST_F(Frames, TheirContactsAddUp)
{
    // a plane that rests, one that moves 0.5 mm above it, and a wall that moves
    every = never;
    begin({0, 0.7, 9});
    Plane next = plane(++set_id);
    const std::vector<phantom_patch> square = next.patches;
    phantom_object side = next.objects[0];
    side.object = 1;
    side.rotation_q30[0] = side.rotation_q30[2] = 759250125; // its z along the scene's x
    side.translation_nm[0] = -9 * mm / 4;
    add_square(next, square, side);
    add_square(next, square, resting(2));
    next.objects[0].translation_nm[2] = mm / 2;
    ASSERT_EQ(feeder->submit(next), 0);
    Place force{};
    for (int i = 0; i < 60; ++i)
        force = tick({0, 0.7, std::max(2.0, 9 - 0.2 * i)});
    EXPECT_NEAR(force[2], k * (radius - 1.5) + k * (radius - 2), 1e-5);
    EXPECT_NEAR(force[0], k * (radius - 2.25), 1e-5);
    EXPECT_EQ(feeder->status().contacts, 3u);
    EXPECT_NEAR(feeder->status().normal_q30[2], PHANTOM_Q30_ONE, 300) << "of the one that pushes most";

    // the scene itself pushes more than the wall
    Plane two = plane(++set_id);
    two.patches.clear();
    two.objects.clear();
    add_square(two, square, side);
    add_square(two, square, resting(2));
    for (phantom_patch& patch : two.patches)
        for (auto& neighbour : patch.neighbour)
            neighbour = PHANTOM_PATCH_NONE;
    ASSERT_EQ(feeder->submit(two), 0);
    for (int i = 0; i < 30; ++i)
        force = tick({0, 0.7, 2});
    EXPECT_NEAR(force[2], k * (radius - 2), 1e-5);
    EXPECT_NEAR(force[0], k * (radius - 2.25), 1e-5);
    EXPECT_NEAR(feeder->status().normal_q30[2], PHANTOM_Q30_ONE, 300);
}

TEST_F(Frames, TheirSumSaturates)
{
    every = never;
    begin({0, 0.7, 9});
    Plane next = plane(++set_id);
    const std::vector<phantom_patch> square = next.patches;
    add_square(next, square, resting(2));
    next.materials[0].stiffness_mn_mm = 0xffffffff;
    ASSERT_EQ(feeder->submit(next), 0);
    for (int i = 0; i < 80; ++i)
        tick({0, 0.7, std::max(1.0, 9 - 0.2 * i)});
    EXPECT_EQ(feeder->status().force_un[2], INT32_MAX);
    EXPECT_TRUE(flags & PHANTOM_TICK_SATURATED);
}

/// Up to three roofs, 30 mm apart, of which number 1 rests; patches of all in turn, by kind.
class Roofs : public Frames {
  protected:
    Plane set_of(std::uint64_t id, const std::vector<std::uint32_t>& which) const
    {
        Plane out(id);
        out.patches.clear();
        out.objects.clear();
        out.header.time_ns = 0;
        out.header.radius_nm = 100 * mm;
        for (const std::uint32_t i : which) {
            phantom_object object = resting(numbers[i]);
            if (i != 1) {
                object.flags = PHANTOM_OBJECT_MOVES;
                object.translation_nm[0] = (std::int64_t(i) - 1) * 30 * mm;
                object.origin_nm[1] = mm;
            }
            out.objects.push_back(object);
        }
        const auto take = [&](const std::vector<phantom_patch> Roof::*kind) {
            for (std::size_t p = 0; p < (roof.*kind).size(); ++p) {
                for (std::uint32_t at = 0; at < which.size(); ++at) {
                    phantom_patch patch = (roof.*kind)[p];
                    patch.object = at;
                    if (which[at] != 1)
                        for (auto& corner : patch.vertex_nm)
                            corner[1] -= mm;
                    for (auto& vertex : patch.vertex)
                        vertex += 6 * which[at];
                    if (patch.face != PHANTOM_PATCH_NONE)
                        patch.face += 4 * which[at];
                    patch.surface += which[at];
                    for (auto& neighbour : patch.neighbour)
                        if (neighbour != PHANTOM_PATCH_NONE)
                            neighbour = neighbour * std::uint32_t(which.size()) + at;
                    out.patches.push_back(patch);
                }
            }
        };
        take(&Roof::faces);
        take(&Roof::fans);
        take(&Roof::rims);
        return out;
    }

    static constexpr std::array<std::uint32_t, 3> numbers{4, 9, 2};
    Roof roof;
};

TEST_F(Roofs, AreSplitWithTheirNeighbours)
{
    const std::vector<std::uint32_t> which{2, 0, 1};
    Plane set = set_of(1, which);
    std::vector<phantom_patch> out(set.patches.size());
    std::array<split_part, 1 + PHANTOM_MOVING_MAX> part{};
    ASSERT_EQ(split_probe(&set.set(), out.data(), part.data()), 0);
    // the scene's, then those that move, in the objects' order
    const std::array<std::uint32_t, 3> object{2, 0, 1};
    std::uint32_t first = 0;
    for (std::size_t f = 0; f < 3; ++f) {
        EXPECT_EQ(part[f].first, first);
        EXPECT_EQ(part[f].patch_count, 12u);
        EXPECT_EQ(part[f].face_count, 4u);
        EXPECT_EQ(part[f].rim_count, 6u);
        for (std::uint32_t i = 0; i < 12; ++i) {
            const phantom_patch& patch = out[first + i];
            EXPECT_EQ(patch.object, object[f]);
            EXPECT_EQ(patch.kind, i < 4   ? PHANTOM_PATCH_FACE
                                  : i < 6 ? PHANTOM_PATCH_EDGE
                                          : PHANTOM_PATCH_RIM);
            for (int e = 0; e < 3; ++e) {
                const std::uint32_t beside = i < 4 ? roof.faces[i].neighbour[e] : PHANTOM_PATCH_NONE;
                EXPECT_EQ(patch.neighbour[e], beside) << f << ' ' << i << ' ' << e;
            }
        }
        first += 12;
    }
    EXPECT_EQ(part[3].patch_count, 0u);
}

TEST_F(Roofs, EachFeelsAsIfItWereAlone)
{
    for (const std::uint32_t touched : {0u, 1u, 2u}) {
        const auto along = [&](const std::vector<std::uint32_t>& which) {
            feeder.reset();
            create({});
            feeder.emplace(machine);
            Plane set = set_of(1, which);
            EXPECT_EQ(feeder->submit(set), 0);
            const double x = (double(touched) - 1) * 30;
            move({x, 0, 8});
            EXPECT_EQ(feeder->start_unlimited(), 0);
            // over the ridge, down to below it, along to the rim
            for (int i = 0; i < 600; ++i) {
                const double s = i / 600.0;
                move({x + 6 * std::sin(9 * s), 12 * s - 2, 4 - 6 * std::sin(12 * s)});
                step();
            }
            return feeder->read();
        };
        const auto alone = along({touched}), together = along({2, 0, 1});
        ASSERT_EQ(alone.size(), together.size());
        int fading = 0, inside = 0;
        for (std::size_t t = 0; t < alone.size(); ++t) {
            ASSERT_EQ(alone[t].flags, together[t].flags) << touched << ' ' << t;
            for (int axis = 0; axis < 3; ++axis) {
                ASSERT_EQ(alone[t].force_un[axis], together[t].force_un[axis]) << touched << ' ' << t;
                ASSERT_EQ(alone[t].proxy_nm[axis], together[t].proxy_nm[axis]) << touched << ' ' << t;
            }
            inside += (alone[t].flags & PHANTOM_TICK_INSIDE) != 0;
            fading += alone[t].contacts > 0 && norm(alone[t].force_un) < 1e6;
        }
        EXPECT_GT(inside, 50);
        EXPECT_GT(fading, 10);
    }
}

TEST_F(Frames, PatchesThatCannotBeComputedAreCountedInEach)
{
    every = never;
    begin({0, 0, 9});
    const std::uint64_t before = feeder->status().refused;
    Plane next = plane(++set_id);
    const std::vector<phantom_patch> square = next.patches;
    add_square(next, square, resting(2));
    for (const std::size_t flat : {0u, 2u})
        std::copy_n(next.patches[flat].vertex_nm[1], 3, next.patches[flat].vertex_nm[2]);
    ASSERT_EQ(feeder->submit(next), 0);
    tick({0, 0, 9});
    EXPECT_EQ(feeder->status().refused - before, 2u);
}

// ---- memory

TEST_F(Frames, ModelOffForgetsThem)
{
    sink();
    phantom_model model{PHANTOM_MODEL_OFF,         2, PHANTOM_COMBINE_BOUNDED,
                        PHANTOM_PROXY_CONSTRAINED, 0, {0, 0, 0}};
    ASSERT_EQ(feeder->ioctl(PHANTOM_SET_MODEL, &model), 0);
    tick({0, 0, -0.95});
    model.model = PHANTOM_MODEL_PROJECTED;
    ASSERT_EQ(feeder->ioctl(PHANTOM_SET_MODEL, &model), 0);
    for (int i = 0; i < 30; ++i)
        tick({0, 0, -0.95});
    EXPECT_FALSE(flags & PHANTOM_TICK_INSIDE);
    EXPECT_EQ(force_z(), 0);
}

TEST_F(Frames, AnUncoveredTipIsRememberedForAsLongAsTheScenesIs)
{
    for (const auto& [away, kept] : {std::pair{90, true}, std::pair{110, false}}) {
        every = 4;
        sink();
        const phantom_set covering = plane(++set_id).header;
        Plane narrow = plane(set_id);
        narrow.header.radius_nm = 0;
        ASSERT_EQ(feeder->submit(narrow), 0);
        for (int i = 0; i < away; ++i) {
            tick({0, 0, -0.95});
            ASSERT_EQ((flags & PHANTOM_TICK_INSIDE) != 0, i < 100) << i;
        }
        EXPECT_TRUE(flags & PHANTOM_TICK_UNCOVERED);
        Plane wide = plane(++set_id);
        EXPECT_EQ(wide.header.radius_nm, covering.radius_nm);
        ASSERT_EQ(feeder->submit(wide), 0);
        for (int i = 0; i < 30; ++i)
            tick({0, 0, -0.95});
        EXPECT_EQ((flags & PHANTOM_TICK_INSIDE) != 0, kept) << away;
    }
}

TEST_F(Frames, AFrameThatWasEmptiedFades)
{
    every = never;
    begin({0, 0, 1});
    Plane next = plane(++set_id);
    next.patches.clear();
    ASSERT_EQ(feeder->submit(next), 0);
    double last = force_z();
    EXPECT_NEAR(last, 2, 1e-5);
    for (int i = 0; i < 22; ++i) {
        const double force = tick({0, 0, 1})[2];
        ASSERT_LE(last - force, 2.0 / 20 + 1e-3);
        last = force;
    }
    EXPECT_EQ(last, 0);
}

TEST_F(Frames, NoTwoObjectsOfASetShareWhatIsRemembered)
{
    // six were there; then, uncovered and so all as old, one more than there is room for
    begin({0, 0, 2});
    every = never;
    const auto send = [&](const std::vector<std::uint32_t>& numbers, std::uint32_t radius_nm) {
        Plane next = plane(++set_id);
        const phantom_object object = next.objects[0];
        next.objects.clear();
        for (const std::uint32_t number : numbers) {
            next.objects.push_back(object);
            next.objects.back().object = number;
            // what has no patches is elsewhere
            if (number != numbers[0])
                next.objects.back().translation_nm[2] = (10 + number) * mm;
        }
        next.header.radius_nm = radius_nm;
        ASSERT_EQ(feeder->submit(next), 0);
        tick({0, 0, 2});
    };
    for (const std::uint32_t first : {0u, 1u}) {
        send({1, 2, 3}, 40 * mm);
        send({4, 5, 6}, 40 * mm);
        for (int i = 0; i < 2; ++i) {
            send({4, 5, 6}, 0);
            for (int t = 0; t < 150; ++t)
                tick({0, 0, 2});
        }
        if (first)
            send({4, 7, 8}, 40 * mm); // keeps the first and needs two
        else
            send({1, 2, 7}, 40 * mm);
        for (int i = 0; i < 60; ++i)
            tick({0, 0, 2});
        EXPECT_EQ(flags & PHANTOM_TICK_UNCOVERED, 0u);
        EXPECT_NEAR(force_z(), radius - 2, 1e-5) << first;
    }
}

TEST_F(Frames, ARevisionOfOneCarriesItsContact)
{
    // 0.1 mm above it, when it rises by 0.3 mm in its own frame
    begin({0, 0, 0.1});
    every = never;
    Plane next(++set_id, half_nm, 40'000'000, {0, 0, 0}, 3 * mm / 10);
    set_moving(next, pose(time()), now_ns);
    cover_round(next, at);
    next.objects[0].revision = 1;
    ASSERT_EQ(feeder->submit(next), 0);
    double last = force_z();
    for (int i = 0; i < 30; ++i) {
        const double force = tick({0, 0, 0.1})[2];
        ASSERT_LE(std::abs(force - last), 0.3 / 20 + 1e-3);
        last = force;
    }
    EXPECT_TRUE(flags & PHANTOM_TICK_INSIDE);
    EXPECT_NEAR(last, radius + 0.2, 1e-4);
}

/// As many patches as a set can have; all but the plane's lie far below.
class FullFrames : public Frames {
  protected:
    Plane plane(std::uint64_t id) override
    {
        Plane out = Frames::plane(id);
        phantom_patch far = out.patches[0];
        for (auto& corner : far.vertex_nm)
            corner[2] -= 500 * mm;
        for (auto& neighbour : far.neighbour)
            neighbour = PHANTOM_PATCH_NONE;
        out.patches.resize(PHANTOM_PATCHES_MAX, far);
        return out;
    }
};

TEST_F(FullFrames, AnotherArithmeticTakesThemAll)
{
    begin({0, 0, 2});
    for (const std::uint32_t arith : {PHANTOM_ARITH_FIXED, PHANTOM_ARITH_FLOAT, PHANTOM_ARITH_FIXED}) {
        phantom_model model{PHANTOM_MODEL_PROJECTED,   2,     PHANTOM_COMBINE_BOUNDED,
                            PHANTOM_PROXY_CONSTRAINED, arith, {0, 0, 0}};
        ASSERT_EQ(feeder->ioctl(PHANTOM_SET_MODEL, &model), 0);
        for (int i = 0; i < 60; ++i)
            tick({0, 0, 2});
        EXPECT_NEAR(force_z(), radius - 2, 1e-5);
    }
}

// ---- effects

TEST_F(Frames, EffectsOfSpaceAreTheScenesAlone)
{
    every = never;
    begin({0, 0, 9}, {.constant = phantom_constant{{300'000, 0, 0}, 0}});
    for (int i = 0; i < 30; ++i)
        tick({0, 0, 2});
    EXPECT_EQ(feeder->status().force_un[0], 300'000);
    EXPECT_NEAR(force_z(), radius - 2, 1e-5);
}

TEST_F(Frames, FrictionThatIsNotNamedHoldsNothing)
{
    every = 4;
    begin({0, 0, 1}, {.friction = friction(1, 1, 1)});
    every = never;
    EXPECT_NEAR(tick({0.3, 0, 1})[0], -0.3, 1e-5);
    feel = {};
    submit();
    for (int i = 0; i < 30; ++i)
        tick({0.3, 0, 1});
    EXPECT_EQ(feeder->status().force_un[0], 0);
    feel = {.friction = friction(1, 1, 1)};
    submit();
    for (int i = 0; i < 30; ++i)
        tick({0.3, 0, 1});
    EXPECT_NEAR(feeder->status().force_un[0], 0, 10) << "it stuck where it was named again";
}

TEST_F(Frames, DampingKnowsTheVelocityInTurnedFramesToo)
{
    // its z is the scene's x; it comes along x at 100 mm/s, and the tip goes along y at 50 mm/s
    const double up = 100;
    pose = [=](double t) {
        Pose out;
        out.at = {up * t, 0, 0};
        out.turn = turn_about({0, 1, 0}, std::numbers::pi / 2);
        out.velocity = {up, 0, 0};
        return out;
    };
    begin({2.5, 0, 0});
    Plane damped = plane(++set_id);
    damped.materials[0].effects = damped.header.effects = PHANTOM_EFFECT_DAMPING;
    damped.materials[0].damping_mns_m = 2000; // 2e-3 N per mm/s
    every = never;
    ASSERT_EQ(feeder->submit(damped), 0);
    const double from = up * time();
    Place force{};
    for (int i = 1; i <= 25; ++i)
        force = tick({2.5 + from, 0.05 * i, 0});
    EXPECT_NEAR(force[0], radius - 2.5 + 2.5 + 0.2, 5e-3);
    EXPECT_NEAR(force[1], 0, 1e-5);
}

TEST_F(Frames, ATipThatGetsTooFarFromAFramesOriginIsUncovered)
{
    // 3.9 m away along x, 2.76 m along its own axes, and going at 2 m/s: 4 m after 50 ms
    pose = [](double t) {
        Pose out;
        out.at = {3900 + 2000 * t, 0, 0};
        out.turn = turn_about({0, 0, 1}, std::numbers::pi / 4);
        out.velocity = {2000, 0, 0};
        return out;
    };
    half_nm = 1000;
    begin({0, 0, 2});
    Plane next(++set_id, half_nm, 40'000'000);
    set_moving(next, Pose{{3900, 0, 0}, turn_about({0, 0, 1}, std::numbers::pi / 4), {2000, 0, 0}, {}},
               now_ns);
    next.patches.clear();
    next.objects[0].origin_nm[0] = -2000 * mm;
    next.objects[0].origin_nm[1] = 2000 * mm;
    next.header.radius_nm = 2'000'000'000;
    every = never;
    ASSERT_EQ(feeder->submit(next), 0);
    int covered = 0;
    for (int i = 0; i < 80; ++i) {
        tick({0, 0, 2});
        covered += !(flags & PHANTOM_TICK_UNCOVERED);
    }
    EXPECT_NEAR(covered, 50, 1);
}

} // namespace
} // namespace phantom::test
