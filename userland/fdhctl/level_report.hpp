// SPDX-License-Identifier: GPL-2.0-or-later
// What sets cover, how fast a tip that allows, and levels of detail, for people and for programs.
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "scene/levels.hpp"

namespace phantom::fdhctl {

/// What a tip's speed is reckoned with.
struct FeedPace {
    double feed_rate_hz = 0;      ///< sets a second
    double contact_radius_mm = 0; ///< largest of the scene

    [[nodiscard]] double speed_mm_s(const scene::Coverage& coverage) const;
};

/// --feed-rate HZ.
CLI::Option* add_feed_rate(CLI::App& app, double& feed_rate_hz, const char* description);

nlohmann::json coverage_json(const scene::Coverage& coverage, const FeedPace& pace);
/// One line, without what it is called.
std::string coverage_text(const scene::Coverage& coverage, const FeedPace& pace);
/// Where a hand in a hurry is too fast for it: one line that names the options that help.
std::optional<std::string> coverage_warning(const scene::Coverage& coverage, const FeedPace& pace);

/// An entry per level, the scene itself first.
nlohmann::json levels_json(const scene::Scene& scene, const scene::Levels& levels, const FeedPace& pace);
/// A table, or a line where there are none.
std::string levels_text(const scene::Scene& scene, const scene::Levels& levels, const FeedPace& pace);

} // namespace phantom::fdhctl
