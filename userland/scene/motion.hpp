// SPDX-License-Identifier: GPL-2.0-or-later
// How an object moves as a whole. A motion is a function of time, so a scene can be played twice alike.
#pragma once

#include <array>

#include "base/vector.hpp"
#include "fdh/pose.hpp"

namespace phantom::scene {

/// Time that starts from rest and then passes as it does: for ramp_s its pace p goes from 0 to 1 as
/// u^2 (3 - 2 u), u = t / ramp_s, so neither place, speed nor acceleration of what follows it has a step.
struct EasedTime {
    double seconds = 0; ///< the pace's integral
    double pace = 0;    ///< 0 ... 1
};
/// t before 0: at rest, 0 s.
EasedTime eased_time(double t_s, double ramp_s);

/// Rotation of a unit quaternion (w, x, y, z), row-major.
std::array<double, 9> rotation_of(const std::array<double, 4>& quaternion);

/// Where a rigid motion has brought an object, and how fast. Of a point x of the scene at rest:
///
///     world = centre + offset + rotation (x - centre)
///
/// The frame of an object that moves has the motion's centre for its origin and the world's axes at rest: a
/// turntable's origin then stands still, and a constant angular velocity describes it exactly.
struct Placement {
    std::array<double, 4> quaternion{1, 0, 0, 0}; ///< rotation, w x y z, unit
    Vec3 centre_mm{}, offset_mm{};
    Vec3 velocity_mm_s{};          ///< of the centre
    Vec3 angular_velocity_rad_s{}; ///< about the world's axes

    [[nodiscard]] Vec3 to_world(const Vec3& framed) const;
    [[nodiscard]] Vec3 to_frame(const Vec3& world) const;
    /// Of the body's point that is there.
    [[nodiscard]] Vec3 velocity_at(const Vec3& world) const;
    /// The object's pose in the world: `rest` carried along.
    [[nodiscard]] fdh::Pose carried(const fdh::Pose& rest) const;
};

/// Of an [[object]]; scenes/README.md has the keys.
struct Motion {
    enum class Kind { turntable, oscillation };
    Kind kind = Kind::turntable;
    Vec3 axis{0, 0, 1};   ///< unit: of rotation, right-handed; the way of an oscillation
    Vec3 centre_mm{};     ///< on the axis of rotation, in the world at rest
    double frequency = 0; ///< revolutions or periods per second; a turntable's may be negative
    double amplitude_mm = 0;
    double ramp_s = 1; ///< from rest; see EasedTime

    /// t: since the motion began; before 0 it is at rest.
    [[nodiscard]] Placement at(double t_s) const;
    /// The centre's largest speed.
    [[nodiscard]] double speed_max_mm_s() const;
};

} // namespace phantom::scene
