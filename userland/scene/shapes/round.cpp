// SPDX-License-Identifier: GPL-2.0-or-later
// Sphere, ellipsoid and torus.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/vector.hpp"
#include "scene/shapes/geodesic.hpp"
#include "scene/shapes/soup_builder.hpp"

namespace phantom::scene {

namespace {

using mesh::Vec3;

/// The least frequency, a multiple of `step`, whose faces lie within that part of the radius.
Result<std::uint32_t> geodesic_frequency(double error, std::uint32_t step, double chord_mm)
{
    // The largest small face lies in the middle of a large one: its circumradius there is 0.7640 / f of the
    // sphere's, so the error tends to 0.2918 / f^2.
    const double about = std::sqrt(0.2918 / std::min(error, 1.0));
    if (Status status = check_count(20 * about * about, chord_mm); !status)
        return status.error();
    auto frequency = step * std::max(1U, static_cast<std::uint32_t>(0.97 * about) / step);
    while (geodesic_error(frequency) > error)
        frequency += step;
    return frequency;
}

} // namespace

Result<mesh::Soup> sphere_soup(const Sphere& sphere, double chord_mm)
{
    const auto frequency = geodesic_frequency(chord_mm / sphere.radius_mm, 2, chord_mm);
    if (!frequency)
        return frequency.error();
    mesh::Soup soup = geodesic_sphere(*frequency);
    soup.normals = soup.vertices;
    soup.face_normals = soup.faces;
    for (Vec3& vertex : soup.vertices)
        vertex = mesh::scaled(vertex, sphere.radius_mm);
    return soup;
}

// An affine image of the sphere. A ray from the middle that meets a face of the unit sphere's mesh at r s
// meets the ellipsoid at A s and the face's image at r A s: they are |A s| (1 - r) apart.
Result<mesh::Soup> ellipsoid_soup(const Ellipsoid& ellipsoid, double chord_mm)
{
    const Vec3 axes = mesh::scaled(ellipsoid.size_mm, 0.5);
    const double longest = std::max({axes[0], axes[1], axes[2]});
    // Even: a vertex lies on every tip, and no face reaches across one.
    const auto frequency = geodesic_frequency(chord_mm / longest, 2, chord_mm);
    if (!frequency)
        return frequency.error();
    mesh::Soup soup = geodesic_sphere(*frequency);
    soup.face_normals = soup.faces;
    soup.normals.reserve(soup.vertices.size());
    for (Vec3& vertex : soup.vertices) {
        // The gradient of |x/a|^2 + ..., times the longest axis against under- and overflow.
        soup.normals.push_back(
            mesh::normalized({vertex[0] * (longest / axes[0]), vertex[1] * (longest / axes[1]),
                              vertex[2] * (longest / axes[2])}));
        vertex = {axes[0] * vertex[0], axes[1] * vertex[1], axes[2] * vertex[2]};
    }
    return soup;
}

// A triangle over a right triangle of sides du and dv in the parameters is no farther than
// (du^2 |S_uu| + 2 du dv |S_uv| + dv^2 |S_vv|) / 8 from the surface, point by point (Filip, Magedson and
// Markot 1986, "Surface algorithms using bounds on derivatives"). Here |S_uu| <= R + r, |S_uv| <= r and
// |S_vv| = r; the steps are chosen so that the first and the last term are equal.
Result<mesh::Soup> torus_soup(const Torus& torus, double chord_mm)
{
    constexpr double least = 8, turn = 2 * std::numbers::pi;
    const double tube = torus.tube_radius_mm, outer = torus.radius_mm + tube;
    const double term = 4 * chord_mm / (1 + std::sqrt(tube / outer));
    const double around = std::max(least, std::ceil(turn / std::sqrt(term / outer)));
    const double across = std::max(least, std::ceil(turn / std::sqrt(term / tube)));
    if (Status status = check_count(2 * around * across, chord_mm); !status)
        return status.error();
    const auto nu = static_cast<std::uint32_t>(around), nv = static_cast<std::uint32_t>(across);
    SoupBuilder builder;
    for (std::uint32_t i = 0; i < nu; ++i) {
        const double u = turn * i / nu;
        for (std::uint32_t j = 0; j < nv; ++j) {
            const double v = turn * j / nv, c = std::cos(v), s = std::sin(v);
            const double from_axis = torus.radius_mm + tube * c;
            builder.vertex({from_axis * std::cos(u), from_axis * std::sin(u), tube * s});
            builder.normal(mesh::normalized({c * std::cos(u), c * std::sin(u), s}));
        }
    }
    const auto corner = [nu, nv](std::uint32_t i, std::uint32_t j) {
        const std::uint32_t number = i % nu * nv + j % nv;
        return Corner{number, number};
    };
    for (std::uint32_t i = 0; i < nu; ++i) {
        for (std::uint32_t j = 0; j < nv; ++j)
            builder.quad(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1));
    }
    return builder.take();
}

} // namespace phantom::scene
