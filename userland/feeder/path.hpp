// SPDX-License-Identifier: GPL-2.0-or-later
// The way of a tip: CSV with the columns time_s,x_mm,y_mm,z_mm.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace phantom::feeder {

struct PathRow {
    double time_s = 0;
    std::array<double, 3> tip_mm{};
};
using Path = std::vector<PathRow>;

inline constexpr const char* path_header = "time_s,x_mm,y_mm,z_mm";

/// Reads a whole path or nothing. Errors name file and line: header missing, wrong number of columns, not a
/// number, not finite, beyond what the interface carries, time not increasing, no row.
Result<Path> read_path(const std::filesystem::path& file);

/// The rows as CSV, numbers with 9 significant digits.
std::string path_text(const Path& path);

/// Position at a time, linear between rows, held before the first and after the last. path is not empty.
std::array<double, 3> position_at(const Path& path, double time_s);

/// Nanometres, as the module counts them.
std::array<std::int64_t, 3> to_nanometres(const std::array<double, 3>& tip_mm);

} // namespace phantom::feeder
