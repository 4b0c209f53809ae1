// SPDX-License-Identifier: GPL-2.0-or-later
// The command line of fdhview.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "scene/scene.hpp"
#include "view/camera_angles.hpp"

namespace phantom::view {

struct Options {
    std::filesystem::path scene;
    scene::LoadOptions load;

    bool usermode = false;
    bool control = true; ///< let fdhctl reach us; off: several may run beside each other
    std::optional<std::uint32_t> rate_hz;
    std::optional<double> seconds; ///< live: end after that time; else for ever, offscreen 2
    std::optional<std::filesystem::path> script;

    std::optional<std::filesystem::path> trace;
    std::optional<std::size_t> at_row;

    std::optional<std::filesystem::path> screenshot, chart;
    std::optional<std::filesystem::path> survey; ///< a picture of what preparation made of the scene
    double feed_hz = 250;                        ///< sets a second that the survey reckons with
    bool window = false;                         ///< a window although a screenshot is asked for
    int width = 1280, height = 800;
    std::optional<CameraAngles> camera;
    bool json = false;

    /// Pictures only: no window, works without a display.
    [[nodiscard]] bool offscreen() const { return survey || ((screenshot || chart) && !window); }
};

/// The options, or the exit status when the program shall end here: 0 after --help, 2 after a usage error
/// (both have been printed).
std::variant<Options, int> parse_options(int argc, char** argv);

} // namespace phantom::view
