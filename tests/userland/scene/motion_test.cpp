// SPDX-License-Identifier: GPL-2.0-or-later
// Motions and deformations as functions of time, and the keys that they are read from.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "folder.hpp"
#include "scene/motion.hpp"
#include "scene/scene.hpp"

namespace phantom::scene::test {
namespace {

using std::numbers::pi;

Motion turntable()
{
    return {.kind = Motion::Kind::turntable,
            .axis = unit({1, 2, 2}),
            .centre_mm = {30, -20, 10},
            .frequency = -2,
            .ramp_s = 0.5};
}

Motion oscillation()
{
    return {.kind = Motion::Kind::oscillation,
            .axis = unit({0, 3, 4}),
            .centre_mm = {1, 2, 3},
            .frequency = 3,
            .amplitude_mm = 5,
            .ramp_s = 0.25};
}

TEST(Motion, VelocitiesAreTheDerivativesOfThePlaces)
{
    constexpr double dt = 1e-6;
    const Vec3 framed = {40, 5, -7};
    for (const Motion& motion : {turntable(), oscillation()}) {
        for (const double t : {0.0, 0.1, 0.3, 0.5, 1.234, 17.7}) {
            const Placement now = motion.at(t);
            const Vec3 at = now.to_world(framed);
            const Vec3 moved = motion.at(t + dt).to_world(framed) - motion.at(t - dt).to_world(framed);
            EXPECT_LT(length((0.5 / dt) * moved - now.velocity_at(at)), 1e-4) << t;
            EXPECT_LT(length(now.to_frame(at) - framed), 1e-12);
            EXPECT_LE(length(now.velocity_mm_s), motion.speed_max_mm_s() * (1 + 1e-12));
        }
    }
}

TEST(Motion, BeginsFromRestWithoutAStepOfVelocityOrAcceleration)
{
    constexpr double dt = 1e-4;
    for (const Motion& motion : {turntable(), oscillation()}) {
        const Placement rest = motion.at(-1);
        EXPECT_EQ(length(rest.velocity_mm_s) + length(rest.angular_velocity_rad_s), 0);
        EXPECT_LT(length(rest.to_world({1, 2, 3}) - motion.centre_mm - Vec3{1, 2, 3}), 1e-12);
        // Steepest: 94 mm/s and 13 rad/s within the ramp, at 1.5 times the mean.
        double most = 0;
        for (double t = -dt; t < 1; t += dt) {
            const Placement a = motion.at(t), b = motion.at(t + dt);
            most = std::max(most, length(b.velocity_mm_s - a.velocity_mm_s) / 94.3);
            most = std::max(most, length(b.angular_velocity_rad_s - a.angular_velocity_rad_s) / 12.6);
        }
        EXPECT_LT(most, 20 * dt);
    }
    EXPECT_NEAR(eased_time(0.5, 0.5).seconds, 0.25, 1e-15);
    EXPECT_NEAR(eased_time(0.5 - 1e-9, 0.5).seconds, 0.25, 2e-9);
}

TEST(Motion, TurntableTurnsAsManyTimesAsItIsAskedTo)
{
    Motion motion = turntable();
    // The ramp costs half of its time.
    const Placement whole = motion.at(100.25), quarter = motion.at(100.25 + 0.125);
    EXPECT_LT(length(whole.to_world({7, 8, 9}) - motion.centre_mm - Vec3{7, 8, 9}), 1e-9);
    const Vec3 radial = perpendicular(motion.axis, {1, 0, 0});
    // Clockwise by a quarter.
    EXPECT_LT(length(quarter.to_world(radial) - motion.centre_mm - cross(radial, motion.axis)), 1e-9);
}

TEST(Motion, CarriesTheObjectsPose)
{
    const fdh::Pose rest{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {3, 4, 5}};
    const Placement now = turntable().at(0.77);
    const fdh::Pose pose = now.carried(rest);
    const Vec3 local = {1, -2, 6};
    const Vec3 resting = {2 + 3, 1 + 4, 6 + 5};
    EXPECT_LT(length(fdh::to_local(pose, now.to_world(resting - now.centre_mm)) - local), 1e-12);
}

TEST(Deformation, DrumIsFlatAtItsRimAndHighestInTheMiddle)
{
    const Deformation drum{.centre_mm = {1, 2, 3}, .radius_mm = 40, .depth_mm = 8};
    EXPECT_DOUBLE_EQ(drum.profile({1, 2, 3}), 1);
    EXPECT_DOUBLE_EQ(drum.profile({1 + 20, 2, 3}), 0.75 * 0.75);
    EXPECT_DOUBLE_EQ(drum.profile({1, 2 - 40, 3}), 0);
    EXPECT_DOUBLE_EQ(drum.profile({1, 2 + 90, 3}), 0);
    EXPECT_LT(drum.profile({1 + 39.99, 2, 3}), 1e-6);
    EXPECT_DOUBLE_EQ(drum.profile({1, 2, 3 - 4}), 0.5);
    EXPECT_DOUBLE_EQ(drum.profile({1, 2, 3 - 8}), 0);
    EXPECT_DOUBLE_EQ(drum.profile({1, 2, 3 + 50}), 1);
}

TEST(Deformation, WaveIsPeriodic)
{
    const Deformation wave{.kind = Deformation::Kind::wave, .across = {0, 1, 0}, .radius_mm = 10};
    EXPECT_DOUBLE_EQ(wave.profile({5, 0, 7}), 1);
    EXPECT_NEAR(wave.profile({5, 5, 7}), 0, 1e-15);
    EXPECT_DOUBLE_EQ(wave.profile({5, 10, 7}), -1);
    EXPECT_DOUBLE_EQ(wave.profile({5, 20, 7}), 1);
}

TEST(Deformation, SpeedIsBounded)
{
    const Deformation drum{.radius_mm = 40, .amplitude_mm = 2, .frequency_hz = 4, .ramp_s = 0.3};
    constexpr double dt = 1e-4;
    double most = 0;
    for (double t = -0.1; t < 2; t += dt)
        most = std::max(most, std::abs(drum.displacement_mm(t + dt) - drum.displacement_mm(t)) / dt);
    EXPECT_LE(most, drum.speed_max_mm_s());
    EXPECT_GT(most, 0.99 * drum.speed_max_mm_s());
    EXPECT_EQ(drum.displacement_mm(0), 0);
}

class MotionKeys : public ::testing::Test {
  protected:
    Result<Scene> scene_of(const std::string& keys)
    {
        return load(folder.write("a.toml", "[[object]]\nshape = \"sphere\"\nradius_mm = 10\n"
                                           "pose = { translation_mm = [1, 2, 3] }\n" +
                                               keys + "\n"),
                    {});
    }
    std::string error_of(const std::string& keys)
    {
        const auto scene = scene_of(keys);
        if (scene)
            return "none";
        const std::string text = scene.error().text();
        return text.substr(text.find("a.toml"));
    }
    Folder folder;
};

TEST_F(MotionKeys, AreRead)
{
    const auto scene = scene_of("motion = { kind = \"turntable\", rev_per_s = 2, axis = [0, 2, 0] }\n"
                                "deform = { shape = \"drum\", radius_mm = 9, amplitude_mm = 0.5, "
                                "frequency_hz = 3, ramp_s = 2 }");
    ASSERT_TRUE(scene) << scene.error().text();
    const Object& object = scene->objects.front();
    ASSERT_TRUE(object.motion && object.deformation);
    EXPECT_EQ(object.motion->centre_mm, (Vec3{1, 2, 3})); // where it stands
    EXPECT_EQ(object.motion->axis, (Vec3{0, 1, 0}));
    EXPECT_EQ(object.motion->frequency, 2);
    EXPECT_EQ(object.motion->ramp_s, 1);
    EXPECT_EQ(object.deformation->radius_mm, 9);
    EXPECT_EQ(object.deformation->ramp_s, 2);
    EXPECT_FALSE(object.deformation->depth_mm);

    const auto wave =
        scene_of("motion = { kind = \"oscillation\", direction = [3, 0, 0], amplitude_mm = 4, "
                 "frequency_hz = 0.5 }\n"
                 "deform = { shape = \"wave\", wavelength_mm = 9, amplitude_mm = 0.5, frequency_hz = 3 }");
    ASSERT_TRUE(wave) << wave.error().text();
    EXPECT_EQ(wave->objects.front().motion->axis, (Vec3{1, 0, 0}));
    EXPECT_EQ(wave->objects.front().deformation->radius_mm, 4.5);
}

TEST_F(MotionKeys, FaultsAreNamedWithTheirLine)
{
    EXPECT_EQ(error_of("motion = 3"), "a.toml:5: object 1: motion: is 3, expected a table");
    EXPECT_EQ(error_of("motion = { rev_per_s = 1 }"),
              "a.toml:5: object 1: motion.kind: is missing, expected turntable, oscillation");
    EXPECT_EQ(error_of("motion = { kind = \"turn\", rev_per_s = 1 }"),
              "a.toml:5: object 1: motion.kind: is \"turn\", expected turntable, oscillation");
    EXPECT_EQ(error_of("motion = { kind = \"turntable\", rev_per_s = 11 }"),
              "a.toml:5: object 1: motion.rev_per_s: is 11, expected -10 ... 10 revolutions per second");
    EXPECT_EQ(error_of("motion = { kind = \"turntable\" }"),
              "a.toml:5: object 1: motion.rev_per_s: is missing, expected -10 ... 10 revolutions per second");
    EXPECT_EQ(error_of("motion = { kind = \"turntable\", rev_per_s = 1, axis = [0, 0, 0] }"),
              "a.toml:5: object 1: motion.axis: is zero, expected a direction");
    EXPECT_EQ(error_of("motion = { kind = \"turntable\", rev_per_s = 1, frequency_hz = 1 }"),
              "a.toml:5: object 1: motion.frequency_hz: has no meaning for \"turntable\"");
    EXPECT_EQ(
        error_of("motion = { kind = \"oscillation\", amplitude_mm = 100, frequency_hz = 4 }"),
        "a.toml:5: object 1: motion.amplitude_mm: times 2 pi frequency_hz is 2513 mm/s, expected no more "
        "than 2000 mm/s");
    EXPECT_EQ(error_of("motion = { kind = \"turntable\", rev_per_s = 1, ramp_s = 0 }"),
              "a.toml:5: object 1: motion.ramp_s: is 0, expected 0.05 ... 60 s");
    EXPECT_EQ(error_of("deform = { shape = \"drum\", amplitude_mm = 1, frequency_hz = 1 }"),
              "a.toml:5: object 1: deform.radius_mm: is missing, expected 0.000001 ... 1000000 mm");
    EXPECT_EQ(error_of("deform = { shape = \"wave\", wavelength_mm = 9, radius_mm = 1, amplitude_mm = 1, "
                       "frequency_hz = 1 }"),
              "a.toml:5: object 1: deform.radius_mm: has no meaning for \"wave\"");
    EXPECT_EQ(error_of("deform = { shape = \"drum\", radius_mm = 1, amplitude_mm = -1, frequency_hz = 1 }"),
              "a.toml:5: object 1: deform.amplitude_mm: is -1, expected 0 ... 1000 mm");
}

} // namespace
} // namespace phantom::scene::test
