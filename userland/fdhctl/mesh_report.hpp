// SPDX-License-Identifier: GPL-2.0-or-later
// mesh::Report for people and for programs: what preparation found, step by step, and what came out.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "scene/scene.hpp"

namespace phantom::fdhctl {

/// Every count of the report, and "patches": {"faces", "fans", "rims"}.
nlohmann::json report_json(const scene::Object& object);
/// Lines of a word and what it says; steps that had nothing to do are left out.
std::string report_text(const scene::Object& object);

} // namespace phantom::fdhctl
