// SPDX-License-Identifier: GPL-2.0-or-later
// Sphere, ellipsoid, torus, box, cylinder, cone and superquadric against their formulas, written here anew.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "mesh/prepare.hpp"
#include "mesh/vector.hpp"
#include "shape_checks.hpp"

namespace phantom::scene::test {
namespace {

using mesh::Vec3;
constexpr double pi = std::numbers::pi;

Vec3 on_unit_sphere(double u, double v)
{
    const double around = 2 * pi * u, up = pi * (v - 0.5);
    return {std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up)};
}

Formula sphere_formula(double radius)
{
    return {[radius](const Vec3& p) { return std::abs(mesh::length(p) - radius); },
            [](const Vec3& p, const Vec3&) { return mesh::normalized(p); },
            [radius](double u, double v) { return mesh::scaled(on_unit_sphere(u, v), radius); }};
}

/// Nearest point by bisection of the multiplier t in x_i = a_i^2 p_i / (a_i^2 + t).
double ellipsoid_distance(const Vec3& axes, const Vec3& p)
{
    const auto nearest = [&](double t) {
        Vec3 x{};
        for (std::size_t i = 0; i < 3; ++i)
            x[i] = axes[i] * axes[i] * p[i] / (axes[i] * axes[i] + t);
        return x;
    };
    const auto value = [&](double t) {
        const Vec3 x = nearest(t);
        return x[0] * x[0] / axes[0] / axes[0] + x[1] * x[1] / axes[1] / axes[1] +
               x[2] * x[2] / axes[2] / axes[2] - 1;
    };
    const double least = std::min({axes[0], axes[1], axes[2]});
    double low = -least * least * (1 - 1e-9),
           high = 4 * mesh::length(p) * std::max({axes[0], axes[1], axes[2]});
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        (value(middle) > 0 ? low : high) = middle;
    }
    return mesh::distance(nearest(low), p);
}

Formula ellipsoid_formula(const Vec3& axes)
{
    return {[axes](const Vec3& p) { return ellipsoid_distance(axes, p); },
            [axes](const Vec3& p, const Vec3&) {
                return mesh::normalized(
                    {p[0] / (axes[0] * axes[0]), p[1] / (axes[1] * axes[1]), p[2] / (axes[2] * axes[2])});
            },
            [axes](double u, double v) {
                const Vec3 s = on_unit_sphere(u, v);
                return Vec3{axes[0] * s[0], axes[1] * s[1], axes[2] * s[2]};
            }};
}

Formula torus_formula(double ring, double tube)
{
    const auto from_middle = [ring](const Vec3& p) {
        const double rho = std::hypot(p[0], p[1]);
        return Vec3{p[0] - ring * p[0] / rho, p[1] - ring * p[1] / rho, p[2]};
    };
    return {
        [=](const Vec3& p) { return std::abs(mesh::length(from_middle(p)) - tube); },
        [=](const Vec3& p, const Vec3&) { return mesh::normalized(from_middle(p)); },
        [=](double u, double v) {
            const double rho = ring + tube * std::cos(2 * pi * v);
            return Vec3{rho * std::cos(2 * pi * u), rho * std::sin(2 * pi * u), tube * std::sin(2 * pi * v)};
        }};
}

/// A line segment's distance in the half plane of (rho, z).
double segment_distance(double x, double z, double x0, double z0, double x1, double z1)
{
    const double dx = x1 - x0, dz = z1 - z0;
    const double t = std::clamp(((x - x0) * dx + (z - z0) * dz) / (dx * dx + dz * dz), 0.0, 1.0);
    return std::hypot(x - x0 - t * dx, z - z0 - t * dz);
}

Formula cone_formula(double lower, double upper, double height)
{
    const double half = height / 2;
    return {[=](const Vec3& p) {
                const double rho = std::hypot(p[0], p[1]);
                double least = std::min(segment_distance(rho, p[2], lower, -half, upper, half),
                                        segment_distance(rho, p[2], 0, -half, lower, -half));
                if (upper > 0)
                    least = std::min(least, segment_distance(rho, p[2], 0, half, upper, half));
                return least;
            },
            [=](const Vec3& p, const Vec3& face) {
                if (std::abs(face[2]) > 0.999999)
                    return Vec3{0, 0, std::copysign(1.0, face[2])};
                // At a tip: that of the face, all of whose generators lean alike.
                const Vec3& out = std::hypot(p[0], p[1]) > 1e-9 ? p : face;
                const double rho = std::hypot(out[0], out[1]);
                return mesh::normalized({height * out[0] / rho, height * out[1] / rho, lower - upper});
            },
            [=](double u, double v) {
                const double lean = std::hypot(height, lower - upper), whole = lower + lean + upper;
                // Samples do hit the rims.
                for (const double rim : {lower, lower + lean})
                    v = std::abs(v * whole - rim) < whole / 300 ? rim / whole : v;
                double rho = 0, z = 0;
                if (v * whole < lower) {
                    rho = v * whole;
                    z = -half;
                } else if (v * whole < lower + lean) {
                    const double t = (v * whole - lower) / lean;
                    rho = (1 - t) * lower + t * upper;
                    z = (t - 0.5) * height;
                } else {
                    rho = std::max(0.0, whole - v * whole);
                    z = half;
                }
                return Vec3{rho * std::cos(2 * pi * u), rho * std::sin(2 * pi * u), z};
            }};
}

/// Barr's parametric form; the distance is that along the ray, which bounds it from above.
Formula superquadric_formula(const Vec3& axes, double e1, double e2)
{
    const auto inside = [=](const Vec3& p) {
        const double flat = std::pow(
            std::pow(std::abs(p[0] / axes[0]), 2 / e2) + std::pow(std::abs(p[1] / axes[1]), 2 / e2), e2 / e1);
        return flat + std::pow(std::abs(p[2] / axes[2]), 2 / e1);
    };
    return {[=](const Vec3& p) { return std::abs(1 - std::pow(inside(p), -e1 / 2)) * mesh::length(p); },
            [=](const Vec3& p, const Vec3&) {
                const double x = std::abs(p[0] / axes[0]), y = std::abs(p[1] / axes[1]),
                             z = std::abs(p[2] / axes[2]);
                // Chain rule over inside(); z-axis: the sum over x and y vanishes with its factor.
                const double sum = std::pow(x, 2 / e2) + std::pow(y, 2 / e2);
                const double factor = sum > 0 ? std::pow(sum, e2 / e1 - 1) : 0;
                return mesh::normalized({std::copysign(factor * std::pow(x, 2 / e2 - 1) / axes[0], p[0]),
                                         std::copysign(factor * std::pow(y, 2 / e2 - 1) / axes[1], p[1]),
                                         std::copysign(std::pow(z, 2 / e1 - 1) / axes[2], p[2])});
            },
            [=](double u, double v) {
                const auto power = [](double c, double e) {
                    return std::copysign(std::pow(std::abs(c), e), c);
                };
                const Vec3 s{std::cos(2 * pi * u), std::sin(2 * pi * u), std::sin(pi * (v - 0.5))};
                const double c = std::cos(pi * (v - 0.5));
                return Vec3{axes[0] * power(c, e1) * power(s[0], e2),
                            axes[1] * power(c, e1) * power(s[1], e2), axes[2] * power(s[2], e1)};
            }};
}

struct Case {
    const char* name;
    Shape shape;
    Formula formula;
    double size_mm, chord_mm;
};

void PrintTo(const Case& c, std::ostream* out)
{
    *out << c.name;
}

std::vector<Case> cases()
{
    return {
        {"Sphere", Sphere{50}, sphere_formula(50), 50, 0.05},
        {"SphereCoarse", Sphere{1}, sphere_formula(1), 1, 0.4},
        {"SphereChordBeyondRadius", Sphere{1}, sphere_formula(1), 1, 10},
        {"Ellipsoid", Ellipsoid{{120, 60, 40}}, ellipsoid_formula({60, 30, 20}), 60, 0.1},
        {"EllipsoidNeedle", Ellipsoid{{2, 2, 80}}, ellipsoid_formula({1, 1, 40}), 40, 0.05},
        {"EllipsoidDisc", Ellipsoid{{80, 80, 2}}, ellipsoid_formula({40, 40, 1}), 40, 0.05},
        {"Torus", Torus{30, 10}, torus_formula(30, 10), 40, 0.05},
        {"TorusThin", Torus{50, 0.5}, torus_formula(50, 0.5), 50, 0.02},
        {"TorusFat", Torus{10, 9.9}, torus_formula(10, 9.9), 20, 0.1},
        {"Cylinder", Cone{20, 20, 60}, cone_formula(20, 20, 60), 60, 0.02},
        {"CylinderLong", Cone{1, 1, 500}, cone_formula(1, 1, 500), 500, 0.001},
        {"Cone", Cone{20, 0, 60}, cone_formula(20, 0, 60), 60, 0.02},
        {"ConeFlat", Cone{50, 0, 2}, cone_formula(50, 0, 2), 50, 0.02},
        {"Frustum", Cone{20, 35, 10}, cone_formula(20, 35, 10), 35, 0.05},
        {"SuperquadricRound", Superquadric{{60, 40, 50}, 1, 1}, superquadric_formula({30, 20, 25}, 1, 1), 30,
         0.05},
        {"SuperquadricBox", Superquadric{{60, 40, 50}, 0.1, 0.1},
         superquadric_formula({30, 20, 25}, 0.1, 0.1), 40, 0.05},
        {"SuperquadricPillow", Superquadric{{60, 60, 30}, 1, 0.3}, superquadric_formula({30, 30, 15}, 1, 0.3),
         40, 0.05},
        {"SuperquadricSpindle", Superquadric{{40, 40, 60}, 1.7, 1},
         superquadric_formula({20, 20, 30}, 1.7, 1), 30, 0.05},
        {"SuperquadricOctahedron", Superquadric{{60, 60, 60}, 1.9, 1.9},
         superquadric_formula({30, 30, 30}, 1.9, 1.9), 30, 0.05},
    };
}

class SceneShapes : public testing::TestWithParam<Case> {};

TEST_P(SceneShapes, TrianglesAndFormulaLieWithinTheChordErrorOfEachOther)
{
    const Case& c = GetParam();
    const mesh::Soup soup = soup_of(c.shape, c.chord_mm);
    const double worst = expect_within_chord(soup, c.formula, c.chord_mm);
    RecordProperty("triangles", static_cast<int>(soup.faces.size()));
    RecordProperty("worst_um", static_cast<int>(1000 * worst));
    // A tenth of the error with as many triangles would be a wasteful bound, or an error that is not
    // measured.
    if (c.chord_mm < 0.2 * c.size_mm) {
        EXPECT_GT(worst, 0.1 * c.chord_mm);
    }
}

TEST_P(SceneShapes, CornersKeepThePositionsAndNormalsOfTheFormula)
{
    const Case& c = GetParam();
    expect_exact_corners(soup_of(c.shape, c.chord_mm), c.formula, c.size_mm);
}

TEST_P(SceneShapes, ClosedOutwardAndWithoutADefect)
{
    const Case& c = GetParam();
    expect_sound(soup_of(c.shape, c.chord_mm));
    expect_sound(soup_of(c.shape));
}

TEST_P(SceneShapes, AFinerChordErrorTakesMoreTriangles)
{
    const Case& c = GetParam();
    const double chord_mm = std::min(c.chord_mm, 0.05 * c.size_mm);
    const std::size_t coarse = soup_of(c.shape, chord_mm).faces.size();
    const std::size_t fine = soup_of(c.shape, chord_mm / 4).faces.size();
    EXPECT_GT(fine, coarse);
    EXPECT_LT(fine, 8 * coarse);
}

INSTANTIATE_TEST_SUITE_P(, SceneShapes, testing::ValuesIn(cases()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(SceneShapesDefaults, SphereHas5120TrianglesWhateverItsRadius)
{
    for (const double radius : {0.5, 50.0, 4321.0})
        EXPECT_EQ(soup_of(Sphere{radius}).faces.size(), 5120U);
}

TEST(SceneShapesDefaults, ChordErrorIsThePartOfTheSizeThatIsDocumented)
{
    for (const Case& c : cases()) {
        double size = c.size_mm;
        if (const auto* cone = std::get_if<Cone>(&c.shape))
            size = std::max(cone->radius_mm, cone->top_radius_mm);
        if (!std::holds_alternative<Superquadric>(c.shape))
            expect_within_chord(soup_of(c.shape), c.formula, 0.0012 * size);
    }
}

TEST(SceneShapesDefaults, BoxIsSharpAndOfItsSize)
{
    const mesh::Soup soup = soup_of(Box{{80, 60, 40}});
    expect_sound(soup);
    const auto prepared = mesh::prepare(soup, {}, "box");
    ASSERT_TRUE(prepared.ok());
    EXPECT_EQ(prepared->mesh.faces.size(), 12U);
    EXPECT_EQ(prepared->report.crease_edges, 12U);
    EXPECT_EQ(prepared->report.size_mm[0], 80);
    EXPECT_EQ(prepared->report.size_mm[1], 60);
    EXPECT_EQ(prepared->report.size_mm[2], 40);
    for (const mesh::Vec3& normal : prepared->mesh.normals)
        EXPECT_EQ(std::max({std::abs(normal[0]), std::abs(normal[1]), std::abs(normal[2])}), 1);
}

TEST(SceneShapesDefaults, RimsKeepTwoNormalsAndATipOneForEveryTriangle)
{
    const mesh::Soup soup = soup_of(Cone{20, 0, 60}, 0.05);
    std::size_t at_tip = 0;
    std::vector<std::uint32_t> tip_normals;
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i) {
            if (soup.vertices[soup.faces[f][i]][2] < 30)
                continue;
            ++at_tip;
            tip_normals.push_back(soup.face_normals[f][i]);
        }
    }
    std::sort(tip_normals.begin(), tip_normals.end());
    EXPECT_GE(at_tip, 40U);
    EXPECT_EQ(std::unique(tip_normals.begin(), tip_normals.end()) - tip_normals.begin(),
              static_cast<std::ptrdiff_t>(at_tip));
}

TEST(SceneShapesDefaults, NoCornerOfALidHasHundredsOfTriangles)
{
    const mesh::Soup soup = soup_of(Cone{20, 20, 60}, 0.0005);
    std::vector<int> faces(soup.vertices.size(), 0);
    for (const mesh::Triple& face : soup.faces)
        for (const std::uint32_t corner : face)
            ++faces[corner];
    EXPECT_GT(soup.faces.size(), 2000U);
    EXPECT_LE(*std::max_element(faces.begin(), faces.end()), 10);
}

TEST(SceneShapesDefaults, CoarseFacesOfASuperquadricDoNotLieAskewToTheirNormals)
{
    for (const double exponent : {0.1, 0.5, 1.5, 1.9}) {
        const mesh::Soup soup = soup_of(Superquadric{{60, 60, 30}, exponent, exponent}, 20);
        double least = 1;
        for (std::size_t f = 0; f < soup.faces.size(); ++f) {
            const auto& [a, b, c] = soup.faces[f];
            const Vec3 plane =
                mesh::normalized(mesh::cross(mesh::subtract(soup.vertices[b], soup.vertices[a]),
                                             mesh::subtract(soup.vertices[c], soup.vertices[a])));
            for (const std::uint32_t corner : soup.face_normals[f])
                least = std::min(least, mesh::dot(soup.normals[corner], plane));
        }
        EXPECT_GE(least, 0.3) << exponent;
        EXPECT_LT(soup.faces.size(), 4000U) << exponent;
    }
}

TEST(SceneShapesDefaults, TooManyTrianglesAreRefusedByTheirKey)
{
    for (const Case& c : cases()) {
        const auto soup = triangulate(c.shape, 1e-9);
        ASSERT_FALSE(soup.ok()) << c.name;
        EXPECT_EQ(soup.error().where, "chord_mm") << c.name;
        EXPECT_NE(soup.error().what.find("expected at most 10000000: a larger one"), std::string::npos)
            << soup.error().text();
    }
}

} // namespace
} // namespace phantom::scene::test
