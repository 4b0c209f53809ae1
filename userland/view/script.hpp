// SPDX-License-Identifier: GPL-2.0-or-later
// A script moves the mouse when there is no hand to do it: for pictures and tests without a window.
#pragma once

#include <filesystem>
#include <vector>

#include "base/result.hpp"

namespace phantom::view {

/// The first line of a script file, exactly.
inline constexpr const char* script_header = "time_s,x,y,press,depth_mm";

/// The mouse at one moment. x, y: part of the whole view's width and height, from its lower left.
struct MouseMoment {
    double time_s = 0, x = 0, y = 0;
    bool press = false;
    double depth_mm = 0; ///< pushed in along the line of sight, as by the wheel
};

struct Script {
    std::vector<MouseMoment> rows; ///< at least one, times ascending

    /// Linear between rows, held before the first and after the last; press is that of the row before.
    [[nodiscard]] MouseMoment at(double time_s) const;
};

/// Reads a whole script or nothing; errors name file:line and what was expected.
Result<Script> read_script(const std::filesystem::path& file);

} // namespace phantom::view
