// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/motion.hpp"

#include <cmath>
#include <numbers>

namespace phantom::scene {

namespace {

Vec3 rotated(const std::array<double, 9>& r, const Vec3& v)
{
    return {r[0] * v[0] + r[1] * v[1] + r[2] * v[2], r[3] * v[0] + r[4] * v[1] + r[5] * v[2],
            r[6] * v[0] + r[7] * v[1] + r[8] * v[2]};
}

} // namespace

EasedTime eased_time(double t_s, double ramp_s)
{
    if (!(t_s > 0))
        return {};
    if (t_s >= ramp_s)
        return {t_s - 0.5 * ramp_s, 1};
    const double u = t_s / ramp_s;
    return {ramp_s * u * u * u * (1 - 0.5 * u), u * u * (3 - 2 * u)};
}

std::array<double, 9> rotation_of(const std::array<double, 4>& quaternion)
{
    const auto [w, x, y, z] = quaternion;
    return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
            2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
            2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
}

Vec3 Placement::to_world(const Vec3& framed) const
{
    return centre_mm + offset_mm + rotated(rotation_of(quaternion), framed);
}

Vec3 Placement::to_frame(const Vec3& world) const
{
    return fdh::to_local(fdh::Pose{rotation_of(quaternion), centre_mm + offset_mm}, world);
}

Vec3 Placement::velocity_at(const Vec3& world) const
{
    return velocity_mm_s + cross(angular_velocity_rad_s, world - centre_mm - offset_mm);
}

fdh::Pose Placement::carried(const fdh::Pose& rest) const
{
    const std::array<double, 9> r = rotation_of(quaternion);
    fdh::Pose out;
    for (std::size_t column = 0; column < 3; ++column) {
        const Vec3 turned =
            rotated(r, {rest.rotation[column], rest.rotation[3 + column], rest.rotation[6 + column]});
        for (std::size_t row = 0; row < 3; ++row)
            out.rotation[3 * row + column] = turned[row];
    }
    out.translation = to_world(rest.translation - centre_mm);
    return out;
}

Placement Motion::at(double t_s) const
{
    const EasedTime time = eased_time(t_s, ramp_s);
    const double rate = 2 * std::numbers::pi * frequency; // rad/s
    Placement out;
    out.centre_mm = centre_mm;
    if (kind == Kind::turntable) {
        // Whole turns are taken off first: a table that turns for days keeps its accuracy.
        const double half = std::numbers::pi * std::remainder(frequency * time.seconds, 2.0);
        const double s = std::sin(half);
        out.quaternion = {std::cos(half), s * axis[0], s * axis[1], s * axis[2]};
        out.angular_velocity_rad_s = rate * time.pace * axis;
    } else {
        const double phase = 2 * std::numbers::pi * std::remainder(frequency * time.seconds, 1.0);
        out.offset_mm = amplitude_mm * std::sin(phase) * axis;
        out.velocity_mm_s = amplitude_mm * rate * time.pace * std::cos(phase) * axis;
    }
    return out;
}

double Motion::speed_max_mm_s() const
{
    return kind == Kind::oscillation ? 2 * std::numbers::pi * std::abs(frequency) * amplitude_mm : 0;
}

} // namespace phantom::scene
