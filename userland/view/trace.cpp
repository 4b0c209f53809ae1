// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/trace.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "view/csv.hpp"

namespace phantom::view {

namespace {

/// Columns of trace_header.
enum Column : std::size_t { time_s = 0, tip = 1, force = 4, contacts = 7, inside = 8, proxy = 9 };

Vec3 vector_at(std::span<const double> row, Column column)
{
    return {row[column], row[column + 1U], row[column + 2U]};
}

} // namespace

std::size_t Trace::strongest() const
{
    const auto weaker = [](const Touch& a, const Touch& b) { return a.force_norm_n() < b.force_norm_n(); };
    return static_cast<std::size_t>(std::max_element(rows.begin(), rows.end(), weaker) - rows.begin());
}

double Trace::max_force_n() const
{
    return rows[strongest()].force_norm_n();
}

Result<Trace> read_trace(const std::filesystem::path& file)
{
    Trace trace{file, {}};
    const auto take = [&](std::span<const double> row, const std::string& where) -> Status {
        constexpr double most_contacts = 1e9; // far beyond any set
        if (row[contacts] < 0 || row[contacts] > most_contacts || row[contacts] != std::floor(row[contacts]))
            return Error{where, fmt::format("column contacts: {} is not a count", row[contacts])};
        if (row[inside] != 0 && row[inside] != 1)
            return Error{where, fmt::format("column inside: {} is neither 0 nor 1", row[inside])};
        if (!trace.rows.empty() && row[time_s] < trace.rows.back().time_s)
            return Error{where, "column time_s: time runs backward"};
        trace.rows.push_back({row[time_s], vector_at(row, tip), vector_at(row, proxy), vector_at(row, force),
                              static_cast<unsigned>(row[contacts]), row[inside] == 1});
        return success();
    };
    Status read = read_table(file, trace_header, "trace", "write one with fdhctl trace", take);
    if (!read)
        return read.error();
    return trace;
}

} // namespace phantom::view
