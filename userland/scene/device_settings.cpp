// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/device_settings.hpp"

namespace phantom::scene {

namespace {

std::vector<std::string> names(const DeviceSettings& device, bool simulated)
{
    const std::pair<const char*, bool> parts[] = {
        {"encoder", device.encoder_mm.has_value()},   {"hand", device.hand.has_value()},
        {"damping", device.damping_ns_m.has_value()}, {"friction", device.friction_n.has_value()},
        {"delay", device.delay_ms.has_value()},       {"amplifier", device.amplifier.has_value()},
    };
    std::vector<std::string> out;
    for (const auto& [name, named] : parts)
        if (named == simulated)
            out.emplace_back(name);
    return out;
}

} // namespace

std::vector<std::string> DeviceSettings::simulated() const
{
    return names(*this, true);
}

std::vector<std::string> DeviceSettings::not_simulated() const
{
    return names(*this, false);
}

} // namespace phantom::scene
