// SPDX-License-Identifier: GPL-2.0-or-later
// The status page for people and for programs.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "phantom_abi.h"

namespace phantom::feeder {

/// Everything on the page in mm, N, us and words.
nlohmann::json status_json(const phantom_status& status);

/// "RUNNING 3000 Hz | tick 0.9/1.8/12.0 us | idle 99.1 % | set 2.1 ms, 64 patches | 3 contacts | |F| 0.82 N";
/// on a coarser level of detail " | level 2, 0.13 mm off" as well.
std::string status_line(const phantom_status& status);

/// The same as a paragraph, one fact a line.
std::string status_text(const nlohmann::json& status);

} // namespace phantom::feeder
