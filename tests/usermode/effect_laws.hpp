// SPDX-License-Identifier: GPL-2.0-or-later
// What the effects that have a potential do, in double: their energy by place, over the plane z = 0 unless
// said otherwise, with k = 1 N/mm and R = 3 mm. mm, N, N mm.
#pragma once

#include <array>
#include <cmath>

#include "effects.hpp"

namespace phantom::test {

inline constexpr double contact_radius_mm = 3, two_pi = 6.283185307179586;

/// The height of both gratings there.
inline double grating_height(const phantom_texture& texture, const Place& at)
{
    double height = 0;
    for (int i = 0; i < 2; ++i) {
        double waves = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            waves += texture.wave_per_km[i][axis] * 1e-6 * at[axis];
        height += texture.amplitude_nm[i] * 1e-6 * std::sin(two_pi * waves);
    }
    return height;
}

/// The spline of a height map at a place in samples.
inline double spline(const HeightMap& map, double column, double row)
{
    const auto weights = [](double d) {
        return std::array{0.5 * (0.5 - d) * (0.5 - d), 0.75 - d * d, 0.5 * (0.5 + d) * (0.5 + d)};
    };
    const auto wrapped = [](double at, std::uint32_t size) {
        return std::uint32_t(at - std::floor(at / size) * size);
    };
    const double c = std::floor(column + 0.5), r = std::floor(row + 0.5);
    const auto along = weights(column - c), across = weights(row - r);
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            sum += across[i] * along[j] *
                   map.height_nm[wrapped(r + double(i) - 1, map.header.rows) * map.header.columns +
                                 wrapped(c + double(j) - 1, map.header.columns)];
    return 1e-6 * sum;
}

/// The height of a map at the foot of a contact whose normal is n.
inline double map_height(const HeightMap& map, const Place& n, const Place& foot)
{
    constexpr std::size_t columns[] = {1, 0, 0}, rows[] = {2, 2, 1};
    const double per_mm = 1e6 / map.header.spacing_nm;
    double height = 0, parts = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double part = std::pow(n[axis], 4);
        parts += part;
        height += part * spline(map, foot[columns[axis]] * per_mm, foot[rows[axis]] * per_mm);
    }
    return height / parts;
}

/// k q^2 / 2 of relief.h, at a depth p.
inline double relief_energy(double p, double height, double amplitude)
{
    const double q = p + p / (p + 2 * amplitude) * height;
    return p > 0 ? 0.5 * q * q : 0;
}

inline double relief_energy(const phantom_texture& texture, const Place& at)
{
    return relief_energy(contact_radius_mm - at[2], grating_height(texture, {at[0], at[1], 0}),
                         1e-6 * (double(texture.amplitude_nm[0]) + texture.amplitude_nm[1]));
}

/// Over the plane through 0 that faces n.
inline double relief_energy(const HeightMap& map, const Place& n, const Place& at)
{
    const double lift = dot(at, n);
    const Place foot{at[0] - lift * n[0], at[1] - lift * n[1], at[2] - lift * n[2]};
    return relief_energy(contact_radius_mm - lift, map_height(map, n, foot), 1e-6 * map.header.amplitude_nm);
}

inline double contact_energy(const Place& at)
{
    const double p = contact_radius_mm - at[2];
    return p > 0 ? 0.5 * p * p : 0;
}

inline double magnet_energy(const phantom_magnet& magnet, const Place& at)
{
    const double g = magnet.range_nm * 1e-6, f = magnet.force_un * 1e-6, p = contact_radius_mm - at[2];
    if (p <= 0)
        return 0;
    return p < g ? -4 * f * (p * p / (2 * g) - p * p * p / (3 * g * g))
                 : -2 * f * g / 3 + 0.5 * (p - g) * (p - g);
}

/// To a point, without a reach.
inline double guide_energy(const phantom_guide& guide, const Place& at)
{
    const double k = guide.stiffness_mn_mm * 1e-3, f = guide.force_un * 1e-6;
    const double e = length(minus(at, {double(guide.point_nm[0]) * 1e-6, double(guide.point_nm[1]) * 1e-6,
                                       double(guide.point_nm[2]) * 1e-6}));
    return k * e < f ? 0.5 * k * e * e : f * e - 0.5 * f * f / k;
}

} // namespace phantom::test
