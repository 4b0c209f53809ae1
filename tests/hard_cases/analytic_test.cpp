// SPDX-License-Identifier: GPL-2.0-or-later
// Cases with a closed answer: spheres, plates, the law of damping, the limits of the border.
#include <gtest/gtest.h>

#include "contact.hpp"
#include "shapes_of_interest.hpp"

namespace {

using namespace phantom;
using namespace phantom::hard;

/// A square plate of two triangles, 20 mm wide, normals +z.
std::vector<reference::Triangle> plate(double stiffness, double radius)
{
    return field(1, 10, [](double, double) { return 0.0; }).triangles(stiffness, radius);
}

/// Largest angle (rad) between the contact normal and the radial direction.
double largest_angle(Contact& contact, const std::vector<reference::Triangle>& triangles)
{
    std::mt19937 random(3);
    double largest = 0;
    unsigned touched = 0;
    for (int i = 0; i < 500; ++i) {
        const Vec3 p = point_near(triangles, random, 0.1, 2.9);
        const Touch touch = contact.tick(p);
        if (touch.contacts == 0)
            continue; // beside a coarse triangle its shell may end below this point
        ++touched;
        largest = std::max(largest, length(cross(touch.normal, unit(p))));
    }
    EXPECT_GT(touched, 350U);
    return largest;
}

TEST(Projected, IsRadialOnASphereWhateverTheTessellation)
{
    for (unsigned subdivisions = 1; subdivisions <= 4; ++subdivisions) {
        const auto triangles = sphere(subdivisions, 20).triangles(1, 3);
        for (const phantom_float_ops* ops : sections()) {
            Contact contact(*ops, triangles, {});
            // float32: some units in the last place. double: the nm grid of the vertices, 20 mm away.
            const double tolerance_rad = ops->isa == PHANTOM_ISA_DOUBLE ? 5e-8 : 1e-6;
            EXPECT_LE(largest_angle(contact, triangles), tolerance_rad) << ops->name << " " << subdivisions;
        }
    }
}

TEST(Projected, NewtonStepsAreTheAccuracyKnob)
{
    const auto triangles = sphere(3, 20).triangles(1, 3);
    double before = 1;
    for (std::uint32_t steps = 0; steps <= 3; ++steps) {
        Settings settings;
        settings.newton_steps = steps;
        Contact contact(phantom_float_double, triangles, settings);
        const double angle = largest_angle(contact, triangles);
        EXPECT_TRUE(angle < before / 10 || angle < 5e-8) << steps << " steps: " << angle << " rad";
        before = angle;
    }
}

TEST(BothModels, GiveKTimesRLessDistanceOverAFlatPlate)
{
    for (const phantom_float_ops* ops : sections()) {
        for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED}) {
            for (const std::uint32_t combine : {PHANTOM_COMBINE_PAPER, PHANTOM_COMBINE_BOUNDED}) {
                Settings settings;
                settings.model = model;
                settings.combine = combine;
                Contact contact(*ops, plate(0.8, 2), settings);
                for (double d = 0; d < 2.5; d += 0.0625) {
                    for (const double x : {-3.0, 0.0, 1.5}) { // on and off the diagonal
                        const Touch touch = contact.tick({x, 1.5, d});
                        const double expected = d < 2 ? 0.8 * (2 - d) : 0;
                        EXPECT_NEAR(touch.force[2], expected, 2e-6) << ops->name << " d " << d;
                        EXPECT_NEAR(touch.force[0], 0, 1e-6);
                        EXPECT_NEAR(touch.force[1], 0, 1e-6);
                    }
                }
            }
        }
    }
}

TEST(Penetration, MeetsTheShellsForceAtDepthZero)
{
    for (const phantom_float_ops* ops : sections()) {
        for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED}) {
            Settings settings;
            settings.model = model;
            settings.proxy = PHANTOM_PROXY_PAPER;
            Contact contact(*ops, plate(1, 2), settings);
            for (int z = 20; z > -2000; --z) { // nm, through the surface
                const Touch touch = contact.tick({1, 2, z * 1e-6});
                EXPECT_EQ(touch.inside, z < 0) << z << " nm";
                EXPECT_NEAR(touch.force[2], 2 - z * 1e-6, 3e-6) << ops->name << " at " << z << " nm";
            }
        }
    }
}

TEST(Materials, EachPatchHasItsOwnStiffnessAndRadius)
{
    auto left = plate(2, 1), right = plate(0.5, 3);
    for (auto& t : right)
        for (Vec3& x : t.corner)
            x[0] += 100;
    left.insert(left.end(), right.begin(), right.end());
    for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED}) {
        Settings settings;
        settings.model = model;
        Contact contact(phantom_float_sse2, left, settings);
        EXPECT_NEAR(contact.tick({3, 1, 0.5}).force[2], 1.0, 2e-6);
        EXPECT_NEAR(contact.tick({103, 1, 0.5}).force[2], 1.25, 2e-6);
        EXPECT_NEAR(contact.tick({3, 1, 1.5}).force[2], 0, 2e-6);
        EXPECT_NEAR(contact.tick({103, 1, 1.5}).force[2], 0.75, 2e-6);
    }
}

TEST(Damping, PushesOnTheWayInAndNeverPullsOnTheWayOut)
{
    Settings settings;
    settings.damping = 2; // N s/m = 0.002 N per mm/s
    settings.effects = PHANTOM_EFFECT_DAMPING;
    for (const phantom_float_ops* ops : sections()) {
        Contact contact(*ops, plate(1, 2), settings);
        EXPECT_NEAR(contact.tick({1, 2, 1}, {0, 0, -100}).force[2], 1.2, 3e-6);
        EXPECT_NEAR(contact.tick({1, 2, 1}, {0, 0, 100}).force[2], 0.8, 3e-6);
        EXPECT_NEAR(contact.tick({1, 2, 1}, {0, 0, 1000}).force[2], 0, 1e-6);
        EXPECT_NEAR(contact.tick({1, 2, 1}, {500, 500, 0}).force[0], 0, 1e-6); // only along the normal
        EXPECT_EQ(contact.tick({1, 2, 3}, {0, 0, -100}).force[2], 0);          // not without contact
        contact.job().effects = 0;
        EXPECT_NEAR(contact.tick({1, 2, 1}, {0, 0, -100}).force[2], 1, 3e-6);
    }
}

TEST(Border, ForcesBeyondItSaturateAndAreCounted)
{
    const auto stiff = plate(4e6, 2); // N/mm: 4 GN/m times 2 mm is far beyond 2147 N
    for (const phantom_float_ops* ops : sections()) {
        for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED}) {
            Settings settings;
            settings.model = model;
            Contact contact(*ops, stiff, settings);
            const Touch touch = contact.tick({1, 2, 0.5});
            EXPECT_EQ(touch.job.force_un[2], INT32_MAX);
            EXPECT_EQ(touch.saturated, 1U);
            EXPECT_FALSE(touch.invalid);
            EXPECT_EQ(contact.tick({1, 2, 2.5}).saturated, 0U);
        }
    }
}

TEST(Model, OffGivesNoForceAndNoContact)
{
    Settings settings;
    settings.model = PHANTOM_MODEL_OFF;
    Contact contact(phantom_float_sse2, plate(1, 2), settings);
    const Touch touch = contact.tick({1, 2, 0.5});
    EXPECT_EQ(length(touch.force), 0);
    EXPECT_EQ(touch.contacts, 0U);
}

} // namespace
