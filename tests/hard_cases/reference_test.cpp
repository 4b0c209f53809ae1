// SPDX-License-Identifier: GPL-2.0-or-later
// The float sections against the __float128 brute force, on whole meshes.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "contact.hpp"
#include "corpus.hpp"
#include "shapes_of_interest.hpp"

namespace {

using namespace phantom;
using namespace phantom::hard;
using reference::margin_mm;
using reference::Reference;

/// The border's grid: forces are whole uN.
constexpr double double_tolerance_n = 2e-6;

Settings settings_of(const reference::Options& options)
{
    Settings s;
    s.model = options.model == reference::Model::paper ? PHANTOM_MODEL_PAPER : PHANTOM_MODEL_PROJECTED;
    s.combine =
        options.combine == reference::Combine::paper ? PHANTOM_COMBINE_PAPER : PHANTOM_COMBINE_BOUNDED;
    s.proxy = options.penetration ? PHANTOM_PROXY_PAPER : PHANTOM_PROXY_OFF;
    return s;
}

/// Random points in the shell; counts are compared as well as forces.
void expect_shell_agrees(const Named& shape, reference::Options options, unsigned points)
{
    options.penetration = false;
    const Reference reference(shape.triangles, options);
    std::vector<Contact> contacts;
    for (const phantom_float_ops* ops : sections())
        contacts.emplace_back(*ops, shape.triangles, settings_of(options));
    std::mt19937 random(11);
    unsigned judged = 0, touched = 0;
    for (unsigned i = 0; i < points; ++i) {
        const Vec3 p = point_near(shape.triangles, random, 0, 1.05 * shape.radius);
        const auto expected = reference.shell(p);
        if (expected.margin < margin_mm)
            continue;
        ++judged;
        touched += expected.contacts > 0;
        for (Contact& contact : contacts) {
            const Touch got = contact.tick(p);
            const bool exact = contact.name() == "double";
            SCOPED_TRACE(fmt::format("{} {} at {}", shape.name, contact.name(), fmt::join(p, " ")));
            ASSERT_EQ(got.contacts, expected.contacts);
            ASSERT_EQ(got.folded, expected.folded);
            ASSERT_LE(length(subtract(got.force, expected.force)),
                      exact ? std::max(double_tolerance_n, shape.tolerance_n / 10) : shape.tolerance_n);
        }
    }
    EXPECT_GT(judged, points * 8 / 10) << shape.name;
    EXPECT_GT(touched, points / 2) << shape.name;
}

TEST(Reference, PaperInTheShellWithBothCombinations)
{
    for (const Named& shape : shapes_of_interest()) {
        for (const auto combine : {reference::Combine::paper, reference::Combine::bounded}) {
            SCOPED_TRACE(shape.name);
            expect_shell_agrees(shape, {reference::Model::paper, combine}, 200);
        }
    }
}

TEST(Reference, ProjectedInTheShell)
{
    for (const Named& shape : shapes_of_interest()) {
        SCOPED_TRACE(shape.name);
        expect_shell_agrees(shape, {reference::Model::projected}, 200);
    }
}

/// A path that comes down on the mesh, slides 1 mm under the surface and leaves again.
std::vector<Vec3> dive(const Named& shape, std::mt19937& random, unsigned ticks)
{
    const Vec3 top = point_near(shape.triangles, random, 0.8 * shape.radius, 0.8 * shape.radius);
    const Vec3 deep = scale(1 - (0.8 * shape.radius + 1.2) / length(top), top);
    std::normal_distribution<double> any;
    const Vec3 aside = scale(2, unit(cross(top, {any(random), any(random), any(random)})));
    std::vector<Vec3> path;
    for (unsigned i = 0; i < ticks; ++i) {
        const double s = static_cast<double>(i) / ticks;
        const double in = std::min({1.0, 4 * s, 4 * (1 - s)});
        path.push_back(on_grid(add(add(scale(1 - in, top), scale(in, deep)), scale(s, aside))));
    }
    return path;
}

/// Paths: the same state at every tick, the same proxy to some nm, the same force.
void expect_path_agrees(const Named& shape, reference::Options options, unsigned paths)
{
    // V is on the nm grid, carried on for 200 ticks; a slanting P1 V multiplies it. Times k: N.
    constexpr double proxy_tolerance_mm = 1e-4;
    Reference reference(shape.triangles, options);
    std::vector<Contact> contacts;
    for (const phantom_float_ops* ops : sections())
        contacts.emplace_back(*ops, shape.triangles, settings_of(options));
    std::mt19937 random(5);
    unsigned inside = 0, left = 0;
    for (unsigned path = 0; path < paths; ++path) {
        bool was_inside = false;
        reference.restart();
        for (Contact& contact : contacts)
            contact.restart();
        for (const Vec3& p : dive(shape, random, 200)) {
            const auto expected = reference.tick(p);
            inside += expected.inside;
            left += was_inside && !expected.inside;
            was_inside = expected.inside;
            for (Contact& contact : contacts) {
                const Touch got = contact.tick(p);
                SCOPED_TRACE(
                    fmt::format("{} {} path {} at {}", shape.name, contact.name(), path, fmt::join(p, " ")));
                ASSERT_EQ(got.inside, expected.inside);
                if (expected.margin < margin_mm)
                    continue;
                ASSERT_LE(length(subtract(got.proxy, expected.proxy)), proxy_tolerance_mm);
                ASSERT_LE(length(subtract(got.force, expected.force)), 2 * proxy_tolerance_mm);
            }
        }
    }
    EXPECT_GT(inside, 50 * paths) << shape.name;
    EXPECT_GT(left, paths / 2) << shape.name;
}

TEST(Reference, PathsThatEnterSlideAndLeave)
{
    for (const Named& shape : shapes_of_interest()) {
        if (shape.name == "soup" || shape.name == "saddle")
            continue; // open: there is no inside
        SCOPED_TRACE(shape.name);
        expect_path_agrees(shape, {reference::Model::paper}, 6);
        expect_path_agrees(shape, {reference::Model::projected}, 6);
    }
}

/// The fine dent of the corpus: five-fold round the z axis.
constexpr double dent_radius = 12;
std::vector<reference::Triangle> fine_dent()
{
    return star(3, [](const Vec3& d) { return 10 - 4 * std::exp(-15 * (1 - d[2])); })
        .triangles(1, dent_radius);
}

/// From the axis, away from every wall.
Vec3 beside_axis(double rho, double azimuth, double z)
{
    return {rho * std::cos(azimuth), rho * std::sin(azimuth), z};
}

/// Where on the axis the shells of a ring are a point: under it the force leans, over it it stands upright.
double focus_of_dent(const Reference& reference)
{
    double low = 9.42, high = 9.44;
    for (int i = 0; i < 40; ++i) {
        const double z = (low + high) / 2;
        const Vec3 force = reference.shell(beside_axis(1e-9, 0.3, z)).force;
        (std::hypot(force[0], force[1]) > 0.3 * dent_radius ? low : high) = z;
    }
    return low;
}

constexpr std::array<double, 3> azimuths{0.3, 1.7, 4.4};

TEST(Focus, OfARingHasAForceThatDependsOnTheDirectionAloneSoItJumps)
{
    const Reference reference(fine_dent(), {});
    const double z = focus_of_dent(reference);
    std::vector<Vec3> limits;
    for (const double elevation : {-1.2, -0.1, 0.4, 1.4})
        for (const double azimuth : azimuths) {
            const auto at = [&](double rho) {
                return scale(1 / dent_radius, reference
                                                  .shell(beside_axis(rho * std::cos(elevation), azimuth,
                                                                     z + rho * std::sin(elevation)))
                                                  .force);
            };
            const Vec3 near = at(1e-5), nearer = at(1e-6);
            EXPECT_LT(length(subtract(near, nearer)), 0.005) << elevation << ' ' << azimuth;
            limits.push_back(nearer);
        }
    double apart = 0;
    for (const Vec3& a : limits)
        for (const Vec3& b : limits)
            apart = std::max(apart, length(subtract(a, b)));
    EXPECT_GT(apart, 1.0) << "kR, from one side of the axis to the other";
}

TEST(Focus, IsPassedAlongTheAxisWithTheJumpThatTheCorpusAllows)
{
    const Reference reference(fine_dent(), {});
    const double z = focus_of_dent(reference);
    double most = 0;
    for (const double azimuth : azimuths) {
        const Vec3 below = reference.shell(beside_axis(1e-9, azimuth, z - 1e-4)).force;
        const Vec3 above = reference.shell(beside_axis(1e-9, azimuth, z + 1e-4)).force;
        most = std::max(most, length(subtract(above, below)) / dent_radius);
    }
    EXPECT_LT(most, focus_step);
    EXPECT_GT(most, focus_step - 0.05);
}

} // namespace
