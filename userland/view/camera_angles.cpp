// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/camera_angles.hpp"

#include <algorithm>
#include <numbers>

namespace phantom::view {

namespace {

constexpr double degree = std::numbers::pi / 180;

} // namespace

Vec3 CameraAngles::direction() const
{
    const double azimuth = azimuth_deg * degree, elevation = elevation_deg * degree;
    return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
            std::cos(elevation) * std::cos(azimuth)};
}

CameraAngles CameraAngles::facing(const Vec3& normal)
{
    CameraAngles angles;
    const double flat = std::hypot(normal[0], normal[2]);
    // A normal that points straight up or down may be looked at from any side.
    if (flat > 0.1)
        angles.azimuth_deg = std::atan2(normal[0], normal[2]) / degree + 38;
    angles.elevation_deg = std::clamp(std::atan2(normal[1], flat) / degree * 0.5, -15.0, 35.0);
    return angles;
}

} // namespace phantom::view
