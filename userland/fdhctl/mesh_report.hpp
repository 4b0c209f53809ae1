// SPDX-License-Identifier: GPL-2.0-or-later
// mesh::Report for people and for programs.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "mesh/prepare.hpp"

namespace phantom::fdhctl {

nlohmann::json report_json(const mesh::Report& report);
std::string report_text(const mesh::Report& report);

} // namespace phantom::fdhctl
