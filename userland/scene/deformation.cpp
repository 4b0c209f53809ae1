// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/deformation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/vector.hpp"
#include "scene/motion.hpp"

namespace phantom::scene {

double Deformation::profile(const mesh::Vec3& rest_mm) const
{
    const mesh::Vec3 from = rest_mm - centre_mm;
    const double height = dot(from, axis);
    double below = 1;
    if (depth_mm) {
        const double u = std::clamp(1 + height / *depth_mm, 0.0, 1.0);
        below = u * u * (3 - 2 * u);
    }
    if (kind == Kind::wave)
        return below * std::cos(std::numbers::pi * dot(from, across) / radius_mm);
    const double part = std::max(0.0, 1 - (dot(from, from) - height * height) / (radius_mm * radius_mm));
    return below * part * part;
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
