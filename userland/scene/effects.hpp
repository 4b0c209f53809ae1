// SPDX-License-Identifier: GPL-2.0-or-later
// What a material may feel like beyond contact and damping. The laws stand in kmod/float/effects/.
#pragma once

#include <array>

namespace phantom::scene {

/// The first range_mm of the contact radius pull towards the surface.
struct Magnet {
    double range_mm = 0; ///< below the material's contact radius
    double force_n = 0;  ///< at most
};

/// Coulomb's, of a spring to the stick point.
struct Friction {
    double statical = 0, dynamic = 0; ///< coefficients, dynamic <= statical
    double stiffness_n_mm = 1;
    double stribeck_mm_s = 0; ///< half way from static to dynamic; 0: no Stribeck curve
};

/// A grating: a wave through the scene's space, felt where the surface cuts it.
struct Texture {
    double amplitude_mm = 0;
    double wavelength_mm = 1;
    std::array<double, 3> direction{1, 0, 0}; ///< across the ribs, unit
};

} // namespace phantom::scene
