// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/script.hpp"

#include <algorithm>

#include "view/csv.hpp"

namespace phantom::view {

MouseMoment Script::at(double time_s) const
{
    const auto later = [](double time, const MouseMoment& row) { return time < row.time_s; };
    const auto next = std::upper_bound(rows.begin(), rows.end(), time_s, later);
    if (next == rows.begin())
        return rows.front();
    const MouseMoment& low = *(next - 1);
    if (next == rows.end())
        return low;
    const double part = (time_s - low.time_s) / (next->time_s - low.time_s);
    const auto between = [part](double a, double b) { return a + part * (b - a); };
    return {time_s, between(low.x, next->x), between(low.y, next->y), low.press,
            between(low.depth_mm, next->depth_mm)};
}

Result<Script> read_script(const std::filesystem::path& file)
{
    Script script;
    const auto take = [&](std::span<const double> row, const std::string& where) -> Status {
        if (row[3] != 0 && row[3] != 1)
            return Error{where, "column press: expected 0 or 1"};
        if (!script.rows.empty() && row[0] <= script.rows.back().time_s)
            return Error{where, "column time_s: time must increase"};
        script.rows.push_back({row[0], row[1], row[2], row[3] == 1, row[4]});
        return success();
    };
    Status read = read_table(file, script_header, "script", {}, take);
    if (!read)
        return read.error();
    return script;
}

} // namespace phantom::view
