// SPDX-License-Identifier: GPL-2.0-or-later
// Open surfaces: the force fades over the last R before the rim, and a tip that slides off feels no step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "contact.hpp"
#include "creased.hpp"

namespace {

using namespace phantom;
using namespace phantom::hard;

constexpr double stiffness = 1, radius = 1;

using Triangles = std::vector<reference::Triangle>;

Triangles opened(const Shape& shape, double crease_deg = 60)
{
    return creased(shape, crease_deg, stiffness, radius);
}

double flat(double, double)
{
    return 0;
}

/// z = 0 over [-5, 5]^2, without the quarter x > 0, y > 0.
Shape bracket()
{
    Shape out = field(10, 5, flat);
    std::erase_if(out.faces, [&out](const auto& face) {
        const Vec3 sum = add(add(out.vertices[face[0]], out.vertices[face[1]]), out.vertices[face[2]]);
        return sum[0] > 0 && sum[1] > 0;
    });
    return out;
}

/// The part of a ball above the plane z = 0.
Shape half_ball(double ball_radius)
{
    Shape out = sphere(4, ball_radius);
    std::erase_if(out.faces, [&out](const auto& face) {
        return std::any_of(face.begin(), face.end(), [&out](auto v) { return out.vertices[v][2] < -1e-6; });
    });
    return out;
}

Shape disc()
{
    return fan(24, 5, 0);
}

Shape one_triangle()
{
    Shape out;
    out.vertices = {{-3, -2, 0}, {3, -2, 0}, {0, 3, 0}};
    out.faces = {{0, 1, 2}};
    smooth_normals(out);
    return out;
}

/// Two sheets that share one vertex.
Shape bow_tie()
{
    Shape out;
    out.vertices = {{0, 0, 0}, {4, -2, 0}, {4, 2, 0}, {-4, 2, 0}, {-4, -2, 0}};
    out.faces = {{0, 1, 2}, {0, 3, 4}};
    smooth_normals(out);
    return out;
}

double level(const Vec3& p)
{
    return p[2];
}

struct Sheet {
    const char* name;
    Triangles triangles;
    double (*over)(const Vec3&); ///< > 0 where the point is certainly in front
    double top;                  ///< z of the surface at `pressed`
};

/// Over each sheet's surface but the half ball's, R and more from a rim of all but the triangle's.
constexpr Vec3 pressed{-1.5, -0.4, 0};

std::vector<Sheet> sheets()
{
    const auto roof = [](double x, double) { return -std::abs(x); };
    const auto groove = [](double x, double) { return std::abs(x); };
    return {
        {"plate", opened(field(10, 5, flat)), level, 0},
        {"disc", opened(disc()), level, 0},
        {"bracket", opened(bracket()), level, 0},
        {"half ball", opened(half_ball(4)), [](const Vec3& p) { return length(p) - 4; }, 0},
        {"triangle", opened(one_triangle()), level, 0},
        {"bow tie", opened(bow_tie()), level, 0},
        {"roof", opened(field(10, 5, roof), 30), [](const Vec3& p) { return p[2] + std::abs(p[0]); }, -1.5},
        {"groove", opened(field(10, 5, groove), 30), [](const Vec3& p) { return p[2] - std::abs(p[0]); },
         1.5},
    };
}

Triangles without_rims(Triangles triangles)
{
    std::erase_if(triangles, [](const auto& t) { return t.rim; });
    return triangles;
}

std::size_t rims_of(const Triangles& triangles)
{
    return static_cast<std::size_t>(
        std::count_if(triangles.begin(), triangles.end(), [](const auto& t) { return t.rim; }));
}

double distance_to_rim(const Triangles& triangles, const Vec3& point)
{
    double least = 1e9;
    for (const auto& t : triangles) {
        if (!t.rim)
            continue;
        const Vec3 e = subtract(t.corner[1], t.corner[0]), q = subtract(point, t.corner[0]);
        const double s = std::clamp(dot(e, q) / dot(e, e), 0.0, 1.0);
        least = std::min(least, length(subtract(q, scale(s, e))));
    }
    return least;
}

Settings settings_of(std::uint32_t model, std::uint32_t proxy)
{
    Settings out;
    out.model = model;
    out.proxy = proxy;
    return out;
}

/// Rounding of the section: fixed and float32 alike, for a mesh of 10 mm.
constexpr double rounding_n = 2e-6;

TEST(Rim, ThePlateGivesExactlyThePartThatItsDistanceIsOfR)
{
    const Triangles plate = opened(field(10, 5, flat));
    EXPECT_EQ(rims_of(plate), 40U);
    for (const phantom_float_ops* ops : sections()) {
        for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED}) {
            Contact contact(*ops, plate, settings_of(model, PHANTOM_PROXY_OFF));
            for (const double height : {0.001, 0.3, 0.9}) {
                for (int i = 0; i <= 1300; ++i) {
                    const double away = i * 1e-3;
                    contact.restart();
                    const Touch edge = contact.tick({5 - away, 0.123, height});
                    contact.restart();
                    const Touch corner = contact.tick({5 - away, -5 + 2 * away, height});
                    const double whole = stiffness * (radius - height);
                    ASSERT_NEAR(edge.force[2], whole * std::min(1.0, away), rounding_n)
                        << ops->name << " model " << model << ", " << away << " mm from the rim";
                    ASSERT_NEAR(corner.force[2], whole * std::min(1.0, away), rounding_n) << ops->name;
                }
                EXPECT_EQ(contact.tick({5.001, 0.123, height}).force, Vec3{});
            }
        }
    }
}

/// Over the ridge of a roof, where fans give the force.
TEST(Rim, FansFadeAsFacesDo)
{
    const Triangles roof = opened(field(10, 5, [](double x, double) { return -std::abs(x); }), 30);
    ASSERT_TRUE(std::any_of(roof.begin(), roof.end(), [](const auto& t) { return t.fan; }));
    for (const phantom_float_ops* ops : sections()) {
        for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED}) {
            Contact contact(*ops, roof, settings_of(model, PHANTOM_PROXY_OFF));
            for (int i = 1; i <= 1300; ++i) {
                contact.restart();
                const double away = i * 1e-3;
                const Touch touch = contact.tick({0.01, 5 - away, 0.3});
                const double height = std::hypot(0.01, 0.3);
                ASSERT_NEAR(length(touch.force), stiffness * (radius - height) * std::min(1.0, away),
                            rounding_n)
                    << ops->name << " model " << model << ", " << away << " mm from the rim";
            }
        }
    }
}

TEST(Rim, UnderTheSurfaceTheProxysDistanceDecides)
{
    const Triangles plate = opened(field(10, 5, flat));
    for (const phantom_float_ops* ops : sections()) {
        for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED}) {
            for (const std::uint32_t proxy : {PHANTOM_PROXY_PAPER, PHANTOM_PROXY_CONSTRAINED}) {
                const double depth = 0.5;
                Contact contact(*ops, plate, settings_of(model, proxy));
                contact.tick({3, 0.123, 0.2});
                ASSERT_TRUE(contact.tick({3, 0.123, -depth}).inside);
                for (int i = 0; i <= 2000; ++i) {
                    const double away = 2 - i * 1e-3;
                    const Touch touch = contact.tick({5 - away, 0.123, -depth});
                    ASSERT_TRUE(touch.inside);
                    // proxy=paper stays where it was when the rim is passed
                    ASSERT_NEAR(touch.force[2], stiffness * (radius + depth) * std::min(1.0, away),
                                2e-3 * (i == 2000) + 2 * rounding_n)
                        << ops->name << " model " << model << " proxy " << proxy << " " << away;
                }
            }
        }
    }
}

/// The steepest that a force may be: of the shell k, turned and faded; see the case's shapes.
TEST(Rim, APathAcrossHasNoStep)
{
    std::mt19937 random(12);
    std::uniform_real_distribution<double> place(-1, 1);
    constexpr double step_mm = 1e-3;
    for (const Sheet& sheet : sheets()) {
        for (const phantom_float_ops* ops : sections()) {
            SCOPED_TRACE(std::string(sheet.name) + " " + ops->name);
            Contact contact(*ops, sheet.triangles, settings_of(PHANTOM_MODEL_PROJECTED, PHANTOM_PROXY_OFF));
            double most = 0;
            unsigned crossed = 0;
            for (int path = 0; path < 8; ++path) {
                // over a point of the rim, across it, at some height
                const auto& faces = sheet.triangles;
                std::size_t at;
                do
                    at = random() % faces.size();
                while (!faces[at].rim);
                const double part = path % 3 == 0 ? 0 : 0.5 + 0.5 * place(random);
                const Vec3 over = add(scale(1 - part, faces[at].corner[0]), scale(part, faces[at].corner[1]));
                const Vec3 way = unit({place(random), place(random), 0.3 * place(random)});
                const Vec3 from = add(over, {0, 0, 0.05 + 0.4 * (1 + place(random))});
                Vec3 before{};
                bool touched = false, free = false, in_front = false;
                for (int i = -1500; i <= 1500; ++i) {
                    const Vec3 p = add(from, scale(i * step_mm, way));
                    const Touch touch = contact.tick(p);
                    ASSERT_FALSE(touch.invalid);
                    ASSERT_LE(length(touch.force), stiffness * radius + rounding_n);
                    // one sheet only: who comes from behind meets its front at once
                    if (in_front && sheet.over(p) > 0)
                        most = std::max(most, length(subtract(touch.force, before)));
                    in_front = sheet.over(p) > 0;
                    before = touch.force;
                    touched |= length(before) > 0.01;
                    free |= length(before) == 0;
                }
                crossed += touched && free;
            }
            EXPECT_GT(crossed, 1U);
            // k for the height, k for the fade, and the direction turns within the shell
            EXPECT_LE(most, 4 * stiffness * step_mm) << most / step_mm << " N/mm";
        }
    }
}

TEST(Rim, SlidingOffPressedInAndComingBackHasNoStep)
{
    constexpr double step_mm = 1e-3, depth = 0.4;
    for (const Sheet& sheet : sheets()) {
        if (std::strcmp(sheet.name, "half ball") == 0)
            continue; // under its edges V has a choice of faces: the next test
        for (const phantom_float_ops* ops : sections()) {
            SCOPED_TRACE(std::string(sheet.name) + " " + ops->name);
            Contact contact(*ops, sheet.triangles,
                            settings_of(PHANTOM_MODEL_PROJECTED, PHANTOM_PROXY_CONSTRAINED));
            // down in the middle of a part, then off over the rim, up beside it and back over it
            Vec3 at = add(pressed, {0, 0, sheet.top + 2}), before{};
            double most = 0;
            bool inside = false, free = false;
            const auto go = [&](const Vec3& to) {
                const Vec3 way = unit(subtract(to, at));
                const int steps = static_cast<int>(length(subtract(to, at)) / step_mm);
                for (int i = 0; i < steps; ++i) {
                    at = add(at, scale(step_mm, way));
                    const Touch touch = contact.tick(at);
                    most = std::max(most, length(subtract(touch.force, before)));
                    before = touch.force;
                    inside |= touch.inside;
                    free |= length(before) == 0;
                }
            };
            go(add(pressed, {0, 0, sheet.top - depth}));
            EXPECT_TRUE(inside);
            go({-1.5, -7, sheet.top - depth});
            EXPECT_EQ(before, Vec3{}) << "beyond the rim";
            go({-1.5, -7, sheet.top + 0.5});
            go(add(pressed, {0, 0, sheet.top + 0.5}));
            EXPECT_GT(length(before), 0.1);
            EXPECT_TRUE(free);
            EXPECT_LE(most, (3 + depth / radius) * 2 * stiffness * step_mm) << most / step_mm << " N/mm";
        }
    }
}

/// Under the surface too the force is that of the same surface without a rim, times f; the state is the same.
TEST(Rim, UnderTheSurfaceNothingButTheForceIsAnother)
{
    std::mt19937 random(9);
    std::uniform_real_distribution<double> place(-5.5, 5.5), depth(-1.2, 0);
    for (const Sheet& sheet : sheets()) {
        const Triangles closed = without_rims(sheet.triangles);
        for (const phantom_float_ops* ops : sections()) {
            for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED}) {
                const Settings settings = settings_of(model, PHANTOM_PROXY_CONSTRAINED);
                Contact open(*ops, sheet.triangles, settings), whole(*ops, closed, settings);
                unsigned inside = 0, faded = 0;
                Vec3 at{-1.5, -0.4, 6}, to = at;
                for (int i = 0; i < 3000; ++i) {
                    if (i % 60 == 0)
                        to = i == 0 ? add(pressed, {0, 0, sheet.top - 0.5})
                                    : Vec3{place(random), place(random), sheet.top + depth(random)};
                    at = add(at, scale(1.0 / 20, subtract(to, at)));
                    const Touch a = open.tick(at), b = whole.tick(at);
                    ASSERT_EQ(a.inside, b.inside);
                    ASSERT_EQ(a.proxy, b.proxy);
                    if (!a.inside)
                        continue;
                    ++inside;
                    const double f = std::min(1.0, distance_to_rim(sheet.triangles, a.proxy) / radius);
                    faded += f < 1;
                    ASSERT_LE(length(subtract(a.force, scale(f, b.force))), 2 * rounding_n)
                        << sheet.name << " " << ops->name << " f = " << f;
                }
                EXPECT_GT(inside, 40U) << sheet.name;
                EXPECT_GT(faded, 20U) << sheet.name;
            }
        }
    }
}

/// Where the rim is R away or farther, not one bit differs from a surface that has none.
TEST(Rim, FarFromItEveryBitIsThatOfAClosedSurface)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-7, 7), height(-0.5, 1.5);
    for (const Sheet& sheet : sheets()) {
        const Triangles closed = without_rims(sheet.triangles);
        for (const phantom_float_ops* ops : sections()) {
            for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED}) {
                const Settings settings = settings_of(model, PHANTOM_PROXY_CONSTRAINED);
                Contact open(*ops, sheet.triangles, settings), whole(*ops, closed, settings);
                for (int i = 0; i < 400; ++i) {
                    Vec3 p{place(random), place(random), height(random)};
                    if (std::strcmp(sheet.name, "half ball") == 0)
                        p = scale(4 + height(random), unit({p[0], p[1], std::abs(p[0])}));
                    if (distance_to_rim(sheet.triangles, p) < 2 * radius + 0.6)
                        continue;
                    open.restart();
                    whole.restart();
                    phantom_float_job a = open.tick(p).job, b = whole.tick(p).job;
                    a.set = b.set = nullptr;
                    ASSERT_EQ(std::memcmp(&a, &b, sizeof(a)), 0) << sheet.name << " " << ops->name;
                }
            }
        }
    }
}

TEST(Rim, AgreesWithTheReference)
{
    std::mt19937 random(4);
    std::uniform_real_distribution<double> part(0, 1), height(0.01, 1.1);
    for (const Sheet& sheet : sheets()) {
        const std::size_t faces = sheet.triangles.size() - rims_of(sheet.triangles);
        for (const auto model : {reference::Model::paper, reference::Model::projected}) {
            reference::Options options;
            options.model = model;
            const reference::Reference reference(sheet.triangles, options);
            const Settings settings =
                settings_of(model == reference::Model::paper ? PHANTOM_MODEL_PAPER : PHANTOM_MODEL_PROJECTED,
                            PHANTOM_PROXY_OFF);
            std::vector<Contact> contacts;
            for (const phantom_float_ops* ops : sections())
                contacts.emplace_back(*ops, sheet.triangles, settings);
            unsigned faded = 0;
            for (int i = 0; i < 60; ++i) {
                const auto& t = sheet.triangles[random() % faces];
                const double a = part(random), b = (1 - a) * part(random);
                const Vec3 foot =
                    add(add(scale(a, t.corner[0]), scale(b, t.corner[1])), scale(1 - a - b, t.corner[2]));
                const Vec3 p = on_grid(add(foot, scale(height(random), t.normal[0])));
                const reference::Result expected = reference.shell(p);
                if (expected.margin < 1e-5)
                    continue;
                faded += length(expected.force) > 0 && distance_to_rim(sheet.triangles, foot) < radius;
                for (Contact& contact : contacts) {
                    contact.restart();
                    ASSERT_LE(length(subtract(contact.tick(p).force, expected.force)), 2e-5)
                        << sheet.name << " " << contact.name();
                }
            }
            EXPECT_GT(faded, 5U) << sheet.name;
        }
    }
}

/// A sheet that lies over another's rim has nothing to do with it.
TEST(Rim, FadesItsOwnSurfaceOnly)
{
    Triangles both = opened(field(10, 5, flat));
    Triangles other = both;
    const std::uint32_t rim_surface = both.back().surface;
    for (auto& t : other) {
        for (Vec3& x : t.corner)
            x = add(x, {8.7, 0, 0.25});
        t.surface = t.surface ? rim_surface + 1000 : 0;
        for (auto& v : t.vertex)
            v += 100000;
    }
    both.insert(both.end(), other.begin(), other.end());
    std::stable_partition(both.begin(), both.end(), [](const auto& t) { return !t.rim; });
    for (const phantom_float_ops* ops : sections()) {
        Contact two(*ops, both, settings_of(PHANTOM_MODEL_PROJECTED, PHANTOM_PROXY_OFF));
        // over the lower one's rim, and 1.3 R from the upper one's own, which its face knows
        EXPECT_NEAR(two.tick({5, 0.1, 1.15}).force[2], 0.1, rounding_n) << ops->name;
        two.restart();
        // beside the upper one's rim, and 1.4 R from the lower one's own
        EXPECT_NEAR(two.tick({3.6, 0.1, 0.9}).force[2], 0.1, rounding_n) << ops->name;
    }
}

TEST(Rim, DampingFadesWithTheForce)
{
    Settings settings = settings_of(PHANTOM_MODEL_PROJECTED, PHANTOM_PROXY_CONSTRAINED);
    settings.effects = PHANTOM_EFFECT_DAMPING;
    settings.damping = 5;
    const Vec3 dive{0, 0, -20}; // 0.1 N
    const Triangles plate = opened(field(10, 5, flat));
    for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED}) {
        for (const phantom_float_ops* ops : sections()) {
            settings.model = model;
            Contact contact(*ops, plate, settings);
            for (const double away : {2.0, 1.0, 0.5, 0.25, 1e-3}) {
                contact.restart();
                EXPECT_NEAR(contact.tick({5 - away, 0.123, 0.4}, dive).force[2],
                            (0.6 + 0.1) * std::min(1.0, away), rounding_n)
                    << ops->name;
                EXPECT_NEAR(contact.tick({5 - away, 0.123, -0.4}, dive).force[2],
                            (1.4 + 0.1) * std::min(1.0, away), rounding_n)
                    << ops->name;
            }
        }
    }
}

/// As many rims as a set can carry, in any order, of which one is near: found, and the same bits everywhere.
TEST(Rim, FromEveryWidthTheSameBits)
{
    std::mt19937 random(8);
    std::uniform_real_distribution<double> place(-6, 6), height(-0.6, 1.2);
    for (const Sheet& sheet : sheets()) {
        Triangles triangles = sheet.triangles;
        const auto rims =
            std::find_if(triangles.begin(), triangles.end(), [](const auto& t) { return t.rim; });
        std::shuffle(rims, triangles.end(), random);
        for (const phantom_float_ops* ops : wide_sections()) {
            for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED}) {
                const Settings settings = settings_of(model, random() % 3);
                Contact a(phantom_float_sse2, triangles, settings), b(*ops, triangles, settings),
                    c(phantom_float_sse2, sheet.triangles, settings);
                for (int i = 0; i < 1000; ++i) {
                    const Vec3 p{place(random), place(random), height(random)};
                    phantom_float_job x = a.tick(p).job, y = b.tick(p).job, z = c.tick(p).job;
                    x.set = y.set = z.set = nullptr;
                    ASSERT_EQ(std::memcmp(&x, &y, sizeof(x)), 0) << sheet.name << " " << ops->name;
                    ASSERT_EQ(std::memcmp(&x, &z, sizeof(x)), 0) << sheet.name << ": order of rims";
                }
            }
        }
    }
}

} // namespace
