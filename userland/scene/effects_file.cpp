// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/effects_file.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace phantom::scene {

namespace {

/// A number that has no default.
double needed(TomlReader& reader, std::string_view key, const Range& range)
{
    if (!reader.has(key))
        reader.fault(key, fmt::format("is missing, expected {}", range.text));
    return reader.number(key, range).value_or(range.high);
}

Magnet read_magnet(TomlReader reader, double radius_mm)
{
    Magnet out;
    out.range_mm = needed(reader, "range_mm", range::length_mm);
    out.force_n = needed(reader, "force_n", range::effect_force_n);
    if (out.range_mm >= radius_mm && reader.has("range_mm"))
        reader.fault("range_mm", fmt::format("is {:g}, expected less than the material's radius_mm, {:g}",
                                             out.range_mm, radius_mm));
    return out;
}

Friction read_friction(TomlReader reader, double stiffness_n_mm)
{
    Friction out;
    out.statical = needed(reader, "static", range::friction);
    out.dynamic = reader.number("dynamic", range::friction).value_or(out.statical);
    if (out.dynamic > out.statical)
        reader.fault("dynamic",
                     fmt::format("is {:g}, expected no more than static, {:g}", out.dynamic, out.statical));
    out.stiffness_n_mm = reader.number("stiffness_n_mm", range::effect_stiffness_n_mm)
                             .value_or(std::min(stiffness_n_mm, range::effect_stiffness_n_mm.high));
    out.stribeck_mm_s = reader.number("stribeck_mm_s", range::stribeck_mm_s).value_or(0);
    return out;
}

Texture read_texture(TomlReader reader)
{
    Texture out;
    out.amplitude_mm = needed(reader, "amplitude_mm", range::amplitude_mm);
    out.wavelength_mm = needed(reader, "wavelength_mm", range::wavelength_mm);
    std::array<double, 3> across = out.direction;
    if (reader.numbers("direction", range::position_mm, across)) {
        const double length = std::hypot(across[0], across[1], across[2]);
        if (!(length > 0))
            reader.fault("direction", "has no length, expected the way across the ribs");
        for (std::size_t axis = 0; axis < 3 && length > 0; ++axis)
            out.direction[axis] = across[axis] / length;
    }
    double sum = 0;
    for (const double component : out.direction)
        sum += std::abs(component);
    const double steepest = out.wavelength_mm / (2 * std::numbers::pi * sum);
    if (out.amplitude_mm > 0.999 * steepest && reader.has("amplitude_mm"))
        reader.fault("amplitude_mm", fmt::format("is {:g}, expected at most {:.3g} for waves of {:g} mm",
                                                 out.amplitude_mm, 0.999 * steepest, out.wavelength_mm));
    return out;
}

} // namespace

void read_effects(TomlReader& reader, const std::string& path, Faults& faults, Material& material)
{
    if (const toml::table* table = reader.table("magnet"))
        material.magnet = read_magnet(TomlReader(*table, path + "magnet.", {"range_mm", "force_n"}, faults),
                                      material.radius_mm);
    if (const toml::table* table = reader.table("friction"))
        material.friction =
            read_friction(TomlReader(*table, path + "friction.",
                                     {"static", "dynamic", "stiffness_n_mm", "stribeck_mm_s"}, faults),
                          material.stiffness_n_mm);
    if (const toml::table* table = reader.table("texture"))
        material.texture = read_texture(
            TomlReader(*table, path + "texture.", {"amplitude_mm", "wavelength_mm", "direction"}, faults));
}

} // namespace phantom::scene
