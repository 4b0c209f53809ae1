// SPDX-License-Identifier: GPL-2.0-or-later
// What a scene may feel like beyond contact: effects of a material's surface, and effects of space. Their
// laws stand in kmod/float/effects/; names, ranges and defaults of what is in here in effect_parameters.hpp.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>

#include "scene/force_grid.hpp"
#include "scene/shapes/grey_image.hpp"

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

/// A tile of heights, repeated through the scene's space and laid on surfaces along each axis.
struct HeightMap {
    std::string image;     ///< file of the samples
    GreyImage samples;     ///< 4, 8, ... 64 each way; its upper edge is at the larger y or z
    double spacing_mm = 1; ///< from sample to sample
    double height_mm = 0;  ///< of white over black; grey is the surface itself
    /// Largest changes from sample to sample along rows and along columns, round the tile; white is 1.
    [[nodiscard]] double steepest() const;
};

/// What rings when contact begins: min(gain v, force) exp(-t / decay) sin(2 pi frequency t).
struct Impact {
    double gain_ns_m = 0;
    double frequency_hz = 0;
    double decay_ms = 0;
    double force_n = 0; ///< the largest amplitude
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

/// Forces on a grid, between its nodes trilinear.
struct ForceField {
    std::string file;
    ForceGrid grid;
    double scale = 1;                  ///< of all forces
    std::optional<double> border_mm{}; ///< over which it comes in; else a quarter of its shortest side
};

/// A ball instead of a point: contact radii count so much more.
struct BallTip {
    double radius_mm = 0;
};

/// [effect.NAME]
struct SpaceEffect {
    std::string name;
    std::variant<ConstantForce, Viscosity, Guide, ForceField, BallTip> law;

    /// "constant", "viscosity", "guide", "field", "tip"
    [[nodiscard]] const char* kind() const;
};

} // namespace phantom::scene
