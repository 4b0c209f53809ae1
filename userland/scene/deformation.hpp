// SPDX-License-Identifier: GPL-2.0-or-later
// How an object changes its shape: every vertex is displaced along one direction, by a profile in space
// times a sine in time. The numbers of vertices and faces stay.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"

namespace phantom::scene {

/// Of an [[object]]; scenes/README.md has the keys. All in the object's own frame.
///
/// drum: a head clamped at its rim, r from the axis through the centre, z above the centre:
///
///     (1 - (r / radius)^2)^2 g(z) amplitude sin(2 pi frequency t)       r < radius
///
/// the static shape of a clamped plate under even load (Timoshenko & Woinowsky-Krieger 1959, eq. 62): flat
/// where it meets the rim. g is 1 above the centre and falls smoothly to 0 depth below, where a body goes on
/// beneath its head.
///
/// wave: a standing wave along `across`, wavelength 2 radius: cos(pi s / radius) g(z) amplitude sin(...).
struct Deformation {
    enum class Kind { drum, wave };
    Kind kind = Kind::drum;
    mesh::Vec3 centre_mm{};
    mesh::Vec3 axis{0, 0, 1};         ///< unit: what displacement is along
    mesh::Vec3 across{1, 0, 0};       ///< unit: where a wave goes
    double radius_mm = 0;             ///< of a drum's head; half a wave's length
    std::optional<double> depth_mm{}; ///< of g; nothing: g = 1 everywhere
    double amplitude_mm = 0;
    double frequency_hz = 0;
    double ramp_s = 1; ///< from rest, see EasedTime

    /// Profile of a point at rest, -1 ... 1.
    [[nodiscard]] double profile(const mesh::Vec3& rest_mm) const;
    /// Of the profile, 1/mm.
    [[nodiscard]] mesh::Vec3 gradient(const mesh::Vec3& rest_mm) const;
    /// The displaced shape does not fold over as long as this is below 1: the largest change of the
    /// displacement along its own direction.
    [[nodiscard]] double compression_max() const;
    /// What the profile is multiplied with: t since the deformation began.
    [[nodiscard]] double displacement_mm(double t_s) const;
    /// No point moves faster than that.
    [[nodiscard]] double speed_max_mm_s() const;

  private:
    /// The profile is lateral times below.
    struct Parts {
        double lateral = 0, below = 1, below_slope = 0; ///< slope along the axis, 1/mm
        mesh::Vec3 lateral_gradient{};
    };
    [[nodiscard]] Parts parts(const mesh::Vec3& rest_mm) const;
};

} // namespace phantom::scene
