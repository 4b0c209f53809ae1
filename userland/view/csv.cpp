// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/csv.hpp"

#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>

#include <fmt/format.h>

namespace phantom::view {

namespace {

std::vector<std::string_view> split(std::string_view line)
{
    std::vector<std::string_view> fields;
    for (;;) {
        const std::size_t comma = line.find(',');
        fields.push_back(line.substr(0, comma));
        if (comma == std::string_view::npos)
            return fields;
        line.remove_prefix(comma + 1);
    }
}

std::optional<double> finite_number(std::string_view text)
{
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
        return std::nullopt;
    return value;
}

Status parse_row(const std::string& line, const std::vector<std::string_view>& columns,
                 const std::string& where, std::vector<double>& row)
{
    const auto fields = split(line);
    if (fields.size() != columns.size())
        return Error{where, fmt::format("{} columns, expected {}", fields.size(), columns.size())};
    row.clear();
    for (std::size_t i = 0; i < fields.size(); ++i) {
        const auto number = finite_number(fields[i]);
        if (!number)
            return Error{where, fmt::format("column {}: '{}' is not a finite number", columns[i],
                                            fields[i].substr(0, 40))};
        row.push_back(*number);
    }
    return success();
}

bool next_line(std::ifstream& in, std::string& line)
{
    if (!std::getline(in, line))
        return false;
    if (!line.empty() && line.back() == '\r')
        line.pop_back();
    return true;
}

} // namespace

Status read_table(const std::filesystem::path& file, const std::string& header, const std::string& what,
                  const std::string& remedy,
                  const std::function<Status(std::span<const double> row, const std::string& where)>& take)
{
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored))
        return Error{file.string(), "no such " + what + " file", remedy};
    if (std::filesystem::is_directory(file, ignored))
        return Error{file.string(), "is a directory, expected a " + what + " CSV file"};
    std::ifstream in(file);
    if (!in)
        return Error{file.string(), "cannot be read", "check its permissions"};

    std::string line;
    if (!next_line(in, line))
        return Error{file.string(), "is empty, expected a " + what + " CSV file"};
    if (line != header)
        return Error{file.string() + ":1", fmt::format("not a {}, expected the columns {}", what, header)};

    const auto columns = split(header);
    std::vector<double> row;
    std::size_t rows = 0;
    for (std::size_t number = 2; next_line(in, line); ++number) {
        if (line.empty())
            continue;
        const std::string where = fmt::format("{}:{}", file.string(), number);
        if (Status parsed = parse_row(line, columns, where, row); !parsed)
            return parsed;
        if (Status taken = take(row, where); !taken)
            return taken;
        ++rows;
    }
    if (in.bad())
        return Error{file.string(), "reading failed"};
    if (rows == 0)
        return Error{file.string(), "has no rows"};
    return success();
}

} // namespace phantom::view
