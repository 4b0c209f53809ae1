// SPDX-License-Identifier: GPL-2.0-or-later
// From where a scene is looked at. World y is up and z comes out of the screen, as on the desk of a
// haptic device.
#pragma once

#include "base/vector.hpp"

namespace phantom::view {

struct CameraAngles {
    double azimuth_deg = 25;   ///< to the right round the y axis; 0 looks along -z
    double elevation_deg = 15; ///< up from the horizontal; -89 ... 89
    double zoom = 1;           ///< 1: the whole scene just fits

    /// Unit vector from the scene to the camera.
    [[nodiscard]] Vec3 direction() const;
    /// Angles from which a spot of the surface with that outward normal is seen at a slant, so that an
    /// arrow along the normal shows its length.
    static CameraAngles facing(const Vec3& normal);
};

} // namespace phantom::view
