// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/motion_file.hpp"

#include <cmath>

#include <fmt/format.h>

namespace phantom::scene {

namespace {

constexpr std::array<std::string_view, 2> motion_words = {"turntable", "oscillation"};
constexpr std::array<std::string_view, 2> deform_words = {"drum", "wave"};

double needed(TomlReader& reader, std::string_view key, const Range& range)
{
    const auto value = reader.number(key, range);
    if (!reader.has(key))
        reader.fault(key, fmt::format("is missing, expected {}", range.text));
    return value.value_or(range.high);
}

/// Left as it is where the key is absent or at fault.
void read_direction(TomlReader& reader, std::string_view key, Vec3& out)
{
    Vec3 given{};
    if (!reader.numbers(key, range::position_mm, given))
        return;
    if (length(given) > 0)
        out = (1 / length(given)) * given;
    else
        reader.fault(key, "is zero, expected a direction");
}

/// The kind that a table is of; nothing where it is not said.
template <std::size_t N>
std::optional<std::size_t> read_kind(TomlReader& reader, std::string_view key,
                                     const std::array<std::string_view, N>& words)
{
    const auto word = reader.word(key, words);
    if (!word) {
        if (!reader.has(key))
            reader.fault(key, fmt::format("is missing, expected {}, {}", words[0], words[1]));
        return std::nullopt;
    }
    return *word == words[0] ? 0 : 1;
}

/// A key of the other kind.
void refuse(TomlReader& reader, std::string_view key, std::string_view kind)
{
    if (reader.has(key))
        reader.fault(key, fmt::format("has no meaning for \"{}\"", kind));
}

void check_speed(TomlReader& reader, double speed_mm_s)
{
    if (speed_mm_s > range::motion_mm_s.high)
        reader.fault("amplitude_mm", fmt::format("times 2 pi frequency_hz is {:.0f} mm/s, expected {}",
                                                 speed_mm_s, range::motion_mm_s.text));
}

} // namespace

std::optional<Motion> read_motion(TomlReader& object, const std::string& path, const Vec3& rest_mm,
                                  Faults& faults)
{
    const toml::table* table = object.table("motion");
    if (!table)
        return std::nullopt;
    TomlReader reader(
        *table, path + "motion.",
        {"kind", "axis", "centre_mm", "rev_per_s", "direction", "amplitude_mm", "frequency_hz", "ramp_s"},
        faults);
    const auto kind = read_kind(reader, "kind", motion_words);
    if (!kind)
        return std::nullopt;
    Motion out;
    out.centre_mm = rest_mm;
    out.ramp_s = reader.number("ramp_s", range::motion_ramp_s).value_or(out.ramp_s);
    if (*kind == 0) {
        out.kind = Motion::Kind::turntable;
        for (const std::string_view key : {"direction", "amplitude_mm", "frequency_hz"})
            refuse(reader, key, motion_words[0]);
        read_direction(reader, "axis", out.axis);
        reader.numbers("centre_mm", range::position_mm, out.centre_mm);
        out.frequency = needed(reader, "rev_per_s", range::rev_per_s);
    } else {
        out.kind = Motion::Kind::oscillation;
        for (const std::string_view key : {"axis", "centre_mm", "rev_per_s"})
            refuse(reader, key, motion_words[1]);
        read_direction(reader, "direction", out.axis);
        out.amplitude_mm = needed(reader, "amplitude_mm", range::motion_mm);
        out.frequency = needed(reader, "frequency_hz", range::motion_hz);
        check_speed(reader, out.speed_max_mm_s());
    }
    return out;
}

std::optional<Deformation> read_deformation(TomlReader& object, const std::string& path, Faults& faults)
{
    const toml::table* table = object.table("deform");
    if (!table)
        return std::nullopt;
    TomlReader reader(*table, path + "deform.",
                      {"shape", "centre_mm", "axis", "across", "radius_mm", "wavelength_mm", "depth_mm",
                       "amplitude_mm", "frequency_hz", "ramp_s"},
                      faults);
    const auto kind = read_kind(reader, "shape", deform_words);
    if (!kind)
        return std::nullopt;
    Deformation out;
    reader.numbers("centre_mm", range::position_mm, out.centre_mm);
    read_direction(reader, "axis", out.axis);
    out.depth_mm = reader.number("depth_mm", range::length_mm);
    out.amplitude_mm = needed(reader, "amplitude_mm", range::motion_mm);
    out.frequency_hz = needed(reader, "frequency_hz", range::motion_hz);
    out.ramp_s = reader.number("ramp_s", range::motion_ramp_s).value_or(out.ramp_s);
    if (*kind == 0) {
        for (const std::string_view key : {"across", "wavelength_mm"})
            refuse(reader, key, deform_words[0]);
        out.radius_mm = needed(reader, "radius_mm", range::length_mm);
    } else {
        out.kind = Deformation::Kind::wave;
        refuse(reader, "radius_mm", deform_words[1]);
        read_direction(reader, "across", out.across);
        out.radius_mm = 0.5 * needed(reader, "wavelength_mm", range::length_mm);
    }
    check_speed(reader, out.speed_max_mm_s());
    constexpr double compression_max = 0.5;
    if (reader.has("amplitude_mm") && out.compression_max() > compression_max)
        reader.fault(
            "amplitude_mm",
            fmt::format("is {:g}, expected at most {:.3g}: more would fold the surface over (depth_mm "
                        "or wavelength_mm is small against it)",
                        out.amplitude_mm, out.amplitude_mm * compression_max / out.compression_max()));
    return out;
}

} // namespace phantom::scene
