// SPDX-License-Identifier: GPL-2.0-or-later
// NURBS patches that are exactly a sphere, a cylinder, a torus and a paraboloid, against those; and a free
// one against its own formula by de Boor's algorithm, which the code does not use.
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

/// A weighted point of a profile in the half plane of (rho, z).
struct ProfilePoint {
    double rho, z, weight;
};

/// The profile turned round the z axis: a full circle is four quarters, of degree 2, in u.
NurbsPatch revolved(const std::vector<ProfilePoint>& profile, std::uint32_t degree,
                    const std::vector<double>& knots)
{
    NurbsPatch patch;
    patch.u = {2, 9, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}};
    patch.v = {degree, static_cast<std::uint32_t>(profile.size()), knots};
    constexpr std::array<std::array<double, 2>, 9> square{
        {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}, {1, 0}}};
    for (std::size_t i = 0; i < square.size(); ++i) {
        for (const ProfilePoint& p : profile) {
            patch.points.push_back({p.rho * square[i][0], p.rho * square[i][1], p.z});
            patch.weights.push_back(p.weight * (i % 2 ? std::sqrt(0.5) : 1));
        }
    }
    return patch;
}

const std::vector<double> half_circle_knots{0, 0, 0, 1, 1, 2, 2, 2};

NurbsPatch sphere_patch(double r)
{
    const double w = std::sqrt(0.5);
    return revolved({{0, -r, 1}, {r, -r, w}, {r, 0, 1}, {r, r, w}, {0, r, 1}}, 2, half_circle_knots);
}

Formula sphere_formula(double r)
{
    return {[r](const Vec3& p) { return std::abs(mesh::length(p) - r); },
            [](const Vec3& p, const Vec3&) { return mesh::normalized(p); },
            [r](double u, double v) {
                const double up = pi * (v - 0.5);
                return Vec3{r * std::cos(up) * std::cos(2 * pi * u), r * std::cos(up) * std::sin(2 * pi * u),
                            r * std::sin(up)};
            }};
}

TEST(SceneNurbs, SphereIsClosedWithPolesAndASeamAndRadialNormals)
{
    const NurbsPatch patch = sphere_patch(30);
    const mesh::Soup soup = soup_of(patch, 0.1);
    expect_sound(soup);
    expect_exact_corners(soup, sphere_formula(30), 30);
    const double worst = expect_within_chord(soup, sphere_formula(30), 0.1);
    EXPECT_GT(worst, 0.01);
    RecordProperty("worst_um", static_cast<int>(1000 * worst));
    RecordProperty("triangles", static_cast<int>(soup.faces.size()));
    EXPECT_EQ(soup.vertices.size(), soup.normals.size()) << "a seam, a pole or a knot got two normals";
}

TEST(SceneNurbs, InsideOutIsTurnedWithItsNormals)
{
    NurbsPatch patch = sphere_patch(30);
    // The same points with v running down.
    for (std::size_t i = 0; i < patch.u.count; ++i) {
        for (std::size_t j = 0; j < patch.v.count / 2; ++j) {
            std::swap(patch.points[i * patch.v.count + j], patch.points[(i + 1) * patch.v.count - 1 - j]);
            std::swap(patch.weights[i * patch.v.count + j], patch.weights[(i + 1) * patch.v.count - 1 - j]);
        }
    }
    const mesh::Soup soup = soup_of(patch, 0.5);
    expect_sound(soup);
    expect_exact_corners(soup, sphere_formula(30), 30);
}

TEST(SceneNurbs, PolesMayLieAtTheEndsOfEitherDirection)
{
    const NurbsPatch patch = sphere_patch(30);
    NurbsPatch other{patch.v, patch.u, {}, {}};
    for (std::size_t j = 0; j < patch.v.count; ++j) {
        for (std::size_t i = 0; i < patch.u.count; ++i) {
            other.points.push_back(patch.points[i * patch.v.count + j]);
            other.weights.push_back(patch.weights[i * patch.v.count + j]);
        }
    }
    const mesh::Soup soup = soup_of(other, 0.2);
    expect_sound(soup);
    expect_exact_corners(soup, sphere_formula(30), 30);
    EXPECT_EQ(soup.vertices.size(), soup.normals.size());
}

TEST(SceneNurbs, TorusHasTwoSeams)
{
    const double ring = 30, tube = 10, w = std::sqrt(0.5);
    std::vector<ProfilePoint> circle;
    constexpr std::array<std::array<double, 2>, 9> square{
        {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}, {1, 0}}};
    for (std::size_t i = 0; i < square.size(); ++i)
        circle.push_back({ring + tube * square[i][0], tube * square[i][1], i % 2 ? w : 1});
    const NurbsPatch patch = revolved(circle, 2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4});
    const auto out = [=](const Vec3& p) {
        const double rho = std::hypot(p[0], p[1]);
        return Vec3{p[0] * (1 - ring / rho), p[1] * (1 - ring / rho), p[2]};
    };
    const Formula formula{
        [=](const Vec3& p) { return std::abs(mesh::length(out(p)) - tube); },
        [=](const Vec3& p, const Vec3&) { return mesh::normalized(out(p)); },
        [=](double u, double v) {
            const double rho = ring + tube * std::cos(2 * pi * v);
            return Vec3{rho * std::cos(2 * pi * u), rho * std::sin(2 * pi * u), tube * std::sin(2 * pi * v)};
        }};
    const mesh::Soup soup = soup_of(patch, 0.1);
    expect_sound(soup);
    expect_exact_corners(soup, formula, 40);
    expect_within_chord(soup, formula, 0.1);
}

TEST(SceneNurbs, ConeKeepsItsRimAndItsTip)
{
    // A lid and a side in one profile of degree 1: a crease at the knot between them, poles at both ends.
    const mesh::Soup soup = soup_of(revolved({{0, 0, 1}, {20, 0, 1}, {0, 40, 1}}, 1, {0, 0, 1, 2, 2}), 0.05);
    expect_sound(soup);
    const Vec3 lean = mesh::normalized({40, 20, 0});
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3& n = soup.normals[soup.face_normals[f][i]];
            const bool lid = n[2] < 0;
            EXPECT_NEAR(n[2], lid ? -1 : lean[1], 1e-12);
            EXPECT_NEAR(std::hypot(n[0], n[1]), lid ? 0 : lean[0], 1e-12);
        }
    }
}

/// A free patch of degrees 3 and 2 with uneven knots and weights, open.
NurbsPatch free_patch()
{
    NurbsPatch patch;
    patch.u = {3, 6, {0, 0, 0, 0, 0.3, 1, 2, 2, 2, 2}};
    patch.v = {2, 4, {-1, -1, -1, 0.5, 1, 1, 1}};
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 4; ++j) {
            patch.points.push_back({10.0 * i, 12.0 * j, 6 * std::sin(1.3 * i + 0.4) * std::cos(1.1 * j)});
            patch.weights.push_back(1 + 0.5 * std::sin(2.0 * i + 3.0 * j));
        }
    }
    return patch;
}

using Homogeneous = std::array<double, 4>;

/// De Boor's algorithm along one direction.
Homogeneous de_boor(const NurbsPatch::Direction& d, std::vector<Homogeneous> points, double t)
{
    std::size_t k = d.degree;
    while (k + 1 < d.count && t >= d.knots[k + 1])
        ++k;
    for (std::size_t r = 1; r <= d.degree; ++r) {
        for (std::size_t i = k; i > k - d.degree + r - 1; --i) {
            const double a = (t - d.knots[i]) / (d.knots[i + d.degree - r + 1] - d.knots[i]);
            for (std::size_t c = 0; c < 4; ++c)
                points[i][c] = (1 - a) * points[i - 1][c] + a * points[i][c];
        }
    }
    return points[k];
}

Vec3 point_of(const NurbsPatch& patch, double u, double v)
{
    std::vector<Homogeneous> column;
    for (std::size_t i = 0; i < patch.u.count; ++i) {
        std::vector<Homogeneous> row;
        for (std::size_t j = 0; j < patch.v.count; ++j) {
            const Vec3& p = patch.points[i * patch.v.count + j];
            const double w = patch.weights[i * patch.v.count + j];
            row.push_back({w * p[0], w * p[1], w * p[2], w});
        }
        column.push_back(de_boor(patch.v, row, v));
    }
    const Homogeneous h = de_boor(patch.u, column, u);
    return {h[0] / h[3], h[1] / h[3], h[2] / h[3]};
}

/// Nearest parameters by Gauss-Newton with differences, from the nearest of a grid.
std::array<double, 2> nearest_parameters(const NurbsPatch& patch, const std::vector<Vec3>& grid, int samples,
                                         const Vec3& p)
{
    const double u0 = 0, u1 = 2, v0 = -1, v1 = 1;
    std::size_t best = 0;
    for (std::size_t i = 1; i < grid.size(); ++i)
        if (mesh::distance(grid[i], p) < mesh::distance(grid[best], p))
            best = i;
    const auto side = static_cast<std::size_t>(samples + 1);
    double u = u0 + (u1 - u0) * static_cast<double>(best / side) / samples;
    double v = v0 + (v1 - v0) * static_cast<double>(best % side) / samples;
    for (int step = 0; step < 8; ++step) {
        constexpr double h = 1e-6;
        const Vec3 at = point_of(patch, u, v);
        const double hu = u + h > u1 ? -h : h, hv = v + h > v1 ? -h : h;
        const Vec3 du = mesh::scaled(mesh::subtract(point_of(patch, u + hu, v), at), 1 / hu);
        const Vec3 dv = mesh::scaled(mesh::subtract(point_of(patch, u, v + hv), at), 1 / hv);
        const Vec3 r = mesh::subtract(p, at);
        const double a = mesh::dot(du, du), b = mesh::dot(du, dv), c = mesh::dot(dv, dv);
        const double det = a * c - b * b, e = mesh::dot(r, du), f = mesh::dot(r, dv);
        u = std::clamp(u + (c * e - b * f) / det, u0, u1);
        v = std::clamp(v + (a * f - b * e) / det, v0, v1);
    }
    return {u, v};
}

TEST(SceneNurbs, FreePatchWithWeightsAndUnevenKnots)
{
    const NurbsPatch patch = free_patch();
    constexpr int samples = 24;
    std::vector<Vec3> grid;
    for (int i = 0; i <= samples; ++i)
        for (int j = 0; j <= samples; ++j)
            grid.push_back(point_of(patch, 2.0 * i / samples, 2.0 * j / samples - 1));
    const Formula formula{[&](const Vec3& p) {
                              const auto [u, v] = nearest_parameters(patch, grid, samples, p);
                              return mesh::distance(point_of(patch, u, v), p);
                          },
                          {},
                          [&](double u, double v) { return point_of(patch, 2 * u, 2 * v - 1); }};
    const mesh::Soup soup = soup_of(patch, 4);
    expect_sound(soup, false);
    EXPECT_GT(expect_within_chord(soup, formula, 4), 0.04) << "the bound of rational patches is a loose one";
    // The normals at right angles to differences along the patch.
    std::size_t checked = 0;
    for (std::size_t f = 0; f < soup.faces.size(); f += 3) {
        const Vec3& at = soup.vertices[soup.faces[f][0]];
        const auto [u, v] = nearest_parameters(patch, grid, samples, at);
        EXPECT_LT(mesh::distance(point_of(patch, u, v), at), 1e-9);
        // Differences reach over the edge, or over the knot where the second derivative jumps.
        if (std::min({u, 2 - u, v + 1, 1 - v, std::abs(v - 0.5)}) < 1e-3)
            continue;
        constexpr double h = 1e-4;
        const Vec3 du = mesh::subtract(point_of(patch, u + h, v), point_of(patch, u - h, v));
        const Vec3 dv = mesh::subtract(point_of(patch, u, v + h), point_of(patch, u, v - h));
        EXPECT_LT(
            mesh::distance(mesh::normalized(mesh::cross(du, dv)), soup.normals[soup.face_normals[f][0]]),
            1e-5);
        ++checked;
    }
    EXPECT_GT(checked, 20U);
}

TEST(SceneNurbs, SaddleHasExactNormals)
{
    // z = x y / 50 over [0, 50]^2, bilinear: |S_uv| is the whole error.
    NurbsPatch patch;
    patch.u = patch.v = {1, 2, {0, 0, 1, 1}};
    patch.points = {{0, 0, 0}, {0, 50, 0}, {50, 0, 0}, {50, 50, 50}};
    patch.weights = {1, 1, 1, 1};
    const Formula formula{[](const Vec3& p) { return std::abs(p[2] - p[0] * p[1] / 50); },
                          [](const Vec3& p, const Vec3&) {
                              return mesh::normalized({-p[1] / 50, -p[0] / 50, 1});
                          },
                          [](double u, double v) {
                              return Vec3{50 * u, 50 * v, 50 * u * v};
                          }};
    const mesh::Soup soup = soup_of(patch, 0.05);
    expect_sound(soup, false);
    expect_exact_corners(soup, formula, 50);
    EXPECT_GT(expect_within_chord(soup, formula, 0.05), 0.02);
}

TEST(SceneNurbs, WithoutAreaIsRefused)
{
    NurbsPatch patch;
    patch.u = patch.v = {1, 2, {0, 0, 1, 1}};
    patch.points.assign(4, {1, 2, 3});
    patch.weights.assign(4, 1);
    const auto soup = triangulate(patch, 0.1);
    ASSERT_FALSE(soup.ok());
    EXPECT_EQ(soup.error().where, "points_mm");
    const auto many = triangulate(sphere_patch(30), 1e-9);
    ASSERT_FALSE(many.ok());
    EXPECT_EQ(many.error().where, "chord_mm");
}

} // namespace
} // namespace phantom::scene::test
