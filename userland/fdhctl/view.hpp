// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace phantom::fdhctl {

/// Becomes fdhview with these arguments. Comes back only when that fails: it has been told, and the exit
/// status is given.
int exec_view(const std::vector<std::string>& arguments);

/// --picture
CLI::Option* add_picture(CLI::App& app, std::optional<std::string>& picture);

/// With --picture: becomes fdhview, which draws what preparation made of a scene (the words that name and
/// prepare it). Without: exit_success. The last thing that a command does.
int draw_picture(const std::optional<std::string>& picture, std::vector<std::string> scene_words,
                 double feed_rate_hz);

} // namespace phantom::fdhctl
