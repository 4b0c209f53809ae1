// SPDX-License-Identifier: GPL-2.0-or-later
// The parameters of every effect by name, with their ranges: one list for scene files, for `fdhctl effect`
// and for what reports show. A reader of parameters is handed each of them in turn.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scene/effects.hpp"
#include "scene/ranges.hpp"
#include "scene/scene.hpp"

namespace phantom::scene {

enum class Need { required, optional };

/// Reads, changes or shows parameters. What is optional and not given keeps its value.
class Parameters {
  public:
    virtual ~Parameters() = default;
    virtual void number(std::string_view key, double& value, const Range& range, Need need) = 0;
    virtual void number(std::string_view key, std::optional<double>& value, const Range& range) = 0;
    virtual void vector(std::string_view key, std::array<double, 3>& value, const Range& range,
                        Need need) = 0;
    /// Any length but zero; kept as a unit vector.
    virtual void direction(std::string_view key, std::array<double, 3>& value, Need need) = 0;
    /// Index of one of the words. What it says decides on other parameters: fixed while it runs.
    virtual void word(std::string_view key, std::size_t& value, std::span<const std::string_view> words) = 0;
};

/// Stiffness and damping: what may change of a material itself. Its contact radius decides on rims and reach.
void parameters(Material& material, Parameters& out);
void parameters(Magnet& magnet, Parameters& out);
void parameters(Friction& friction, Parameters& out);
void parameters(Grating& grating, Parameters& out);
void parameters(ConstantForce& constant, Parameters& out);
void parameters(Viscosity& viscosity, Parameters& out);
void parameters(Guide& guide, Parameters& out);

/// Each in its range, and yet together they make no sense.
struct Contradiction {
    const char* key;
    std::string what; ///< "is 3, expected ..."
};

std::optional<Contradiction> contradiction(const Magnet& magnet, const Material& of);
std::optional<Contradiction> contradiction(const Friction& friction);
/// `other`: the grating that it is added to, if any.
std::optional<Contradiction> contradiction(const Grating& grating, const Grating* other);
std::optional<Contradiction> contradiction(const ConstantForce& constant);
std::optional<Contradiction> contradiction(const Viscosity& viscosity);
std::optional<Contradiction> contradiction(const Guide& guide);

/// Kinds of SpaceEffect, in the order of its variant.
inline constexpr std::array<std::string_view, 3> space_kinds = {"constant", "viscosity", "guide"};

/// What sets carry: effects of one kind (constant forces are added up).
inline constexpr std::size_t regions_max = 8; ///< PHANTOM_REGIONS_MAX

/// That law with its defaults. kind: one of space_kinds.
SpaceEffect make_space_effect(std::string name, std::string_view kind);

/// What all effects of space together may be; the name is that of the first that is too much.
struct SpaceContradiction {
    std::string name;
    std::string what;
};
std::optional<SpaceContradiction> contradiction(std::span<const SpaceEffect> effects);

} // namespace phantom::scene
