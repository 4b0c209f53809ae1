// SPDX-License-Identifier: GPL-2.0-or-later
// Units of length that files may be in.
#pragma once

#include <optional>
#include <string>

namespace phantom::scene {

/// For messages.
inline constexpr const char* unit_names = "um, mm, cm, m or in";

/// Millimetres in one of the unit.
inline std::optional<double> millimetres_in(const std::string& unit)
{
    if (unit == "um")
        return 1e-3;
    if (unit == "mm")
        return 1.0;
    if (unit == "cm")
        return 10.0;
    if (unit == "m")
        return 1000.0;
    if (unit == "in")
        return 25.4;
    return std::nullopt;
}

} // namespace phantom::scene
