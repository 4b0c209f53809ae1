// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/device_file.hpp"

#include <fmt/format.h>

namespace phantom::scene {

namespace {

double needed(TomlReader& reader, std::string_view key, const Range& range)
{
    if (!reader.has(key))
        reader.fault(key, fmt::format("is missing, expected {}", range.text));
    return reader.number(key, range).value_or(range.high);
}

HandSettings read_hand(const toml::table& table, Faults& faults)
{
    TomlReader hand(table, "device.hand.", {"stiffness_n_mm", "damping_ns_m", "mass_kg"}, faults);
    HandSettings out;
    out.stiffness_n_mm = needed(hand, "stiffness_n_mm", range::effect_stiffness_n_mm);
    out.damping_ns_m = needed(hand, "damping_ns_m", range::damping_ns_m);
    out.mass_kg = hand.number("mass_kg", range::hand_mass_kg).value_or(0);
    return out;
}

AmplifierSettings read_amplifier(const toml::table& table, Faults& faults)
{
    TomlReader amplifier(table, "device.amplifier.", {"max_force_n", "bandwidth_hz"}, faults);
    AmplifierSettings out;
    out.max_force_n = amplifier.number("max_force_n", range::max_force_n);
    out.bandwidth_hz = amplifier.number("bandwidth_hz", range::bandwidth_hz);
    if (table.empty())
        faults.add(table.source(), "device.amplifier: is empty, expected max_force_n or bandwidth_hz");
    return out;
}

} // namespace

DeviceSettings read_device(const toml::table& table, Faults& faults)
{
    TomlReader device(table, "device.",
                      {"max_force_n", "slew_n_per_ms", "ramp_ms", "encoder_mm", "hand", "mass_kg",
                       "damping_ns_m", "friction_n", "delay_ms", "amplifier"},
                      faults);
    DeviceSettings out;
    out.max_force_n = device.number("max_force_n", range::max_force_n);
    out.slew_n_per_ms = device.number("slew_n_per_ms", range::slew_n_per_ms);
    out.ramp_ms = device.number("ramp_ms", range::ramp_ms);
    out.encoder_mm = device.number("encoder_mm", range::encoder_mm);
    if (const toml::table* hand = device.table("hand"))
        out.hand = read_hand(*hand, faults);
    out.mass_kg = device.number("mass_kg", range::arm_mass_kg);
    out.damping_ns_m = device.number("damping_ns_m", range::damping_ns_m);
    out.friction_n = device.number("friction_n", range::effect_force_n);
    out.delay_ms = device.number("delay_ms", range::delay_ms);
    if (const toml::table* amplifier = device.table("amplifier"))
        out.amplifier = read_amplifier(*amplifier, faults);
    if (device.has("hand") && !device.has("mass_kg"))
        device.fault("mass_kg",
                     fmt::format("is missing, expected {} of the arm beside hand", range::arm_mass_kg.text));
    // Without a hand the tip is where the path says, whatever the force.
    for (const char* key : {"mass_kg", "damping_ns_m", "friction_n", "delay_ms", "amplifier"})
        if (device.has(key) && !device.has("hand"))
            device.fault(key, "has no meaning without hand, which the arm answers");
    return out;
}

} // namespace phantom::scene
