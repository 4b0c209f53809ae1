// SPDX-License-Identifier: GPL-2.0-or-later
// The parameters of every effect by name, with their ranges: one list for scene files, for `fdhctl effect`
// and for what reports show. A reader of parameters is handed each of them in turn.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scene/effects.hpp"
#include "scene/ranges.hpp"
#include "scene/scene.hpp"

namespace phantom::scene {

/// fixed: required, and stays as it is while it runs.
enum class Need { required, optional, fixed };

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
    /// A file that `load` takes in; a relative path starts at the folder of the scene file. Fixed.
    virtual void file(std::string_view key, std::string& name,
                      const std::function<Status(const std::filesystem::path&)>& load) = 0;
};

/// Stiffness and damping: what may change of a material itself. Its contact radius decides on rims and reach.
void parameters(Material& material, Parameters& out);
void parameters(Magnet& magnet, Parameters& out);
void parameters(Friction& friction, Parameters& out);
void parameters(Grating& grating, Parameters& out);
void parameters(HeightMap& map, Parameters& out);
void parameters(Impact& impact, Parameters& out);
void parameters(ConstantForce& constant, Parameters& out);
void parameters(Viscosity& viscosity, Parameters& out);
void parameters(Guide& guide, Parameters& out);
void parameters(ForceField& field, Parameters& out);
void parameters(BallTip& tip, Parameters& out);

/// Each in its range, and yet together they make no sense.
struct Contradiction {
    const char* key;
    std::string what; ///< "is 3, expected ..."
};

std::optional<Contradiction> contradiction(const Magnet& magnet, const Material& of);
std::optional<Contradiction> contradiction(const Friction& friction);
/// `other`: the grating that it is added to, if any.
std::optional<Contradiction> contradiction(const Grating& grating, const Grating* other);
std::optional<Contradiction> contradiction(const HeightMap& map);
std::optional<Contradiction> contradiction(const Impact& impact);
std::optional<Contradiction> contradiction(const ConstantForce& constant);
std::optional<Contradiction> contradiction(const Viscosity& viscosity);
std::optional<Contradiction> contradiction(const Guide& guide);
std::optional<Contradiction> contradiction(const ForceField& field);
std::optional<Contradiction> contradiction(const BallTip& tip);

/// Kinds of SpaceEffect, in the order of its variant.
inline constexpr std::array<std::string_view, 5> space_kinds = {"constant", "viscosity", "guide", "field",
                                                                "tip"};

/// What sets carry of one kind: any number of constant forces, which are added up, so many media and so many
/// guides, and one of the others.
inline constexpr std::size_t regions_max = 8; ///< PHANTOM_REGIONS_MAX
/// Samples of all height maps together; they and a field fit into PHANTOM_EFFECT_BYTES_MAX.
inline constexpr std::size_t map_samples_max = 16384;

/// That law with its defaults. kind: one of space_kinds.
SpaceEffect make_space_effect(std::string name, std::string_view kind);

/// What all effects of space together may be; the name is that of the first that is too much.
struct SpaceContradiction {
    std::string name;
    std::string what;
};
std::optional<SpaceContradiction> contradiction(std::span<const SpaceEffect> effects);

} // namespace phantom::scene
