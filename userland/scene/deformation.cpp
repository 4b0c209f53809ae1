// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/deformation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/vector.hpp"
#include "scene/motion.hpp"

namespace phantom::scene {

Deformation::Parts Deformation::parts(const mesh::Vec3& rest_mm) const
{
    const mesh::Vec3 from = rest_mm - centre_mm;
    const double height = dot(from, axis);
    Parts out;
    if (depth_mm) {
        const double u = std::clamp(1 + height / *depth_mm, 0.0, 1.0);
        out.below = u * u * (3 - 2 * u);
        out.below_slope = 6 * u * (1 - u) / *depth_mm;
    }
    if (kind == Kind::wave) {
        const double k = std::numbers::pi / radius_mm, phase = k * dot(from, across);
        out.lateral = std::cos(phase);
        out.lateral_gradient = -k * std::sin(phase) * across;
    } else {
        const mesh::Vec3 radial = from - height * axis;
        const double part = std::max(0.0, 1 - dot(radial, radial) / (radius_mm * radius_mm));
        out.lateral = part * part;
        out.lateral_gradient = (-4 * part / (radius_mm * radius_mm)) * radial;
    }
    return out;
}

double Deformation::profile(const mesh::Vec3& rest_mm) const
{
    const Parts at = parts(rest_mm);
    return at.below * at.lateral;
}

mesh::Vec3 Deformation::gradient(const mesh::Vec3& rest_mm) const
{
    const Parts at = parts(rest_mm);
    return at.below * at.lateral_gradient + at.lateral * at.below_slope * axis;
}

double Deformation::compression_max() const
{
    // |across . axis| of the lateral part, 1.5 / depth of the smooth step.
    const double lateral =
        kind == Kind::wave ? std::numbers::pi / radius_mm * std::abs(dot(across, axis)) : 0.0;
    return amplitude_mm * (lateral + (depth_mm ? 1.5 / *depth_mm : 0.0));
}

double Deformation::displacement_mm(double t_s) const
{
    const double periods = frequency_hz * eased_time(t_s, ramp_s).seconds;
    return amplitude_mm * std::sin(2 * std::numbers::pi * std::remainder(periods, 1.0));
}

double Deformation::speed_max_mm_s() const
{
    return 2 * std::numbers::pi * frequency_hz * amplitude_mm;
}

} // namespace phantom::scene
