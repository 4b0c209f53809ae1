// SPDX-License-Identifier: GPL-2.0-or-later
// What a scene may feel like beyond contact: effects of a material's surface, and effects of space. Their
// laws stand in kmod/float/effects/; names, ranges and defaults of what is in here in effect_parameters.hpp.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>

namespace phantom::scene {

/// The first range_mm of the contact radius pull towards the surface.
struct Magnet {
    double range_mm = 0; ///< below the material's contact radius
    double force_n = 0;  ///< at most
};

/// Coulomb's, of a spring to the stick point.
struct Friction {
    double statical = 0;
    std::optional<double> dynamic{};        ///< coefficient, no larger than statical, which it else is
    std::optional<double> stiffness_n_mm{}; ///< else the material's
    double stribeck_mm_s = 0;               ///< half way from static to dynamic; 0: no Stribeck curve
};

/// A wave through the scene's space, felt where the surface cuts it.
struct Grating {
    double amplitude_mm = 0;
    double wavelength_mm = 1;
    std::array<double, 3> direction{1, 0, 0}; ///< across the ribs, unit
};

/// One grating, or two added.
struct Texture {
    Grating first;
    std::optional<Grating> second{};
};

/// Gravity, wind.
struct ConstantForce {
    std::array<double, 3> force_n{};
};

/// A medium: in a ball, or everywhere.
struct Viscosity {
    double viscosity_ns_m = 0; ///< force against velocity
    double drag_ns2_m2 = 0;    ///< force against its square
    std::array<double, 3> centre_mm{};
    std::optional<double> radius_mm{}; ///< else everywhere
    std::optional<double> border_mm{}; ///< over which it comes in; else a quarter of the radius
};

/// A spring to a place: a point, a line or a plane.
struct Guide {
    enum class Place : std::size_t { point, line, plane };
    Place to = Place::point;
    std::array<double, 3> point_mm{};  ///< of the line, of the plane
    std::array<double, 3> direction{}; ///< unit: along the line, across the plane
    double stiffness_n_mm = 1;
    double force_n = 1;               ///< the most it pulls
    std::optional<double> reach_mm{}; ///< it lets go over the last quarter of that distance; else never
};

/// [effect.NAME]
struct SpaceEffect {
    std::string name;
    std::variant<ConstantForce, Viscosity, Guide> law;

    /// "constant", "viscosity", "guide"
    [[nodiscard]] const char* kind() const;
};

} // namespace phantom::scene
