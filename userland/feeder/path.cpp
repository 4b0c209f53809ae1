// SPDX-License-Identifier: GPL-2.0-or-later
#include "feeder/path.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "base/csv_line.hpp"

namespace phantom::feeder {

namespace {

/// Positions cross the border as 64-bit nm: 9.2e12 mm.
constexpr double coordinate_max_mm = 9e12;

/// One row, or what is wrong with it.
Result<PathRow> row_of(std::string_view line, const std::string& where)
{
    constexpr const char* names[] = {"time_s", "x_mm", "y_mm", "z_mm"};
    const auto cells = csv::cells_of(line);
    if (cells.size() != 4)
        return Error{where, fmt::format("expected 4 columns ({}), found {}", path_header, cells.size())};
    std::array<double, 4> values{};
    for (std::size_t i = 0; i < 4; ++i) {
        const std::optional<double> value = csv::number_of(cells[i]);
        if (!value)
            return Error{where, fmt::format("{}: expected a number, found '{}'", names[i], cells[i])};
        if (!std::isfinite(*value))
            return Error{where, fmt::format("{}: expected a finite number, found '{}'", names[i], cells[i])};
        if (i > 0 && std::abs(*value) > coordinate_max_mm)
            return Error{where, fmt::format("{}: expected at most {:g} mm, found {}", names[i],
                                            coordinate_max_mm, cells[i])};
        values[i] = *value;
    }
    return PathRow{values[0], {values[1], values[2], values[3]}};
}

} // namespace

Result<Path> read_path(const std::filesystem::path& file)
{
    const std::string name = file.string();
    std::error_code code;
    if (std::filesystem::is_directory(file, code))
        return Error{name,
                     "is a directory, expected a CSV file with the columns " + std::string(path_header)};
    std::ifstream stream(file);
    if (!stream)
        return Error{name, "no such file, or it cannot be read"};

    Path path;
    std::string line;
    std::size_t number = 0;
    bool header = false;
    while (std::getline(stream, line)) {
        ++number;
        const std::string_view text = csv::trimmed(line);
        const std::string where = fmt::format("{}:{}", name, number);
        if (!header) {
            if (text != path_header)
                return Error{where, fmt::format("expected the header {}", path_header)};
            header = true;
            continue;
        }
        // A blank line may end the file, nothing may follow it.
        if (text.empty()) {
            if (stream.peek() == std::ifstream::traits_type::eof())
                break;
            return Error{where, fmt::format("expected 4 columns ({}), found an empty line", path_header)};
        }
        Result<PathRow> row = row_of(text, where);
        if (!row)
            return row.error();
        if (!path.empty() && !(row->time_s > path.back().time_s))
            return Error{where,
                         fmt::format("time_s must increase: {} after {}", row->time_s, path.back().time_s)};
        path.push_back(*row);
    }
    if (!header)
        return Error{name, fmt::format("is empty, expected the header {}", path_header)};
    if (path.empty())
        return Error{name, "has a header and no row"};
    return path;
}

std::string path_text(const Path& path)
{
    std::string text = std::string(path_header) + "\n";
    for (const PathRow& row : path)
        text += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g}\n", row.time_s, row.tip_mm[0], row.tip_mm[1],
                            row.tip_mm[2]);
    return text;
}

std::array<double, 3> position_at(const Path& path, double time_s)
{
    const auto after = std::upper_bound(path.begin(), path.end(), time_s,
                                        [](double time, const PathRow& row) { return time < row.time_s; });
    if (after == path.begin())
        return path.front().tip_mm;
    if (after == path.end())
        return path.back().tip_mm;
    const PathRow& a = *(after - 1);
    const PathRow& b = *after;
    const double t = (time_s - a.time_s) / (b.time_s - a.time_s);
    std::array<double, 3> tip{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        tip[axis] = a.tip_mm[axis] + t * (b.tip_mm[axis] - a.tip_mm[axis]);
    return tip;
}

std::array<std::int64_t, 3> to_nanometres(const std::array<double, 3>& tip_mm)
{
    constexpr double nm_per_mm = 1e6;
    return {std::llround(tip_mm[0] * nm_per_mm), std::llround(tip_mm[1] * nm_per_mm),
            std::llround(tip_mm[2] * nm_per_mm)};
}

} // namespace phantom::feeder
