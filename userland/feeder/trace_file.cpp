// SPDX-License-Identifier: GPL-2.0-or-later
#include "feeder/trace_file.hpp"

#include <iterator>

#include <fmt/format.h>

namespace phantom::feeder {

TraceRow trace_row(const phantom_tick& tick, double time_s)
{
    constexpr double mm_per_nm = 1e-6, n_per_un = 1e-6;
    TraceRow row;
    row.time_s = time_s;
    row.inside = (tick.flags & PHANTOM_TICK_INSIDE) != 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        row.tip_mm[axis] = static_cast<double>(tick.tip_nm[axis]) * mm_per_nm;
        row.force_n[axis] = tick.force_un[axis] * n_per_un;
        row.proxy_mm[axis] =
            row.inside ? static_cast<double>(tick.proxy_nm[axis]) * mm_per_nm : row.tip_mm[axis];
    }
    row.contacts = tick.contacts;
    const bool off = tick.model % 16 == PHANTOM_MODEL_OFF;
    const bool from_set = !off && (tick.flags & (PHANTOM_TICK_UNCOVERED | PHANTOM_TICK_STALE)) == 0;
    row.set_id = from_set ? tick.set_id : 0;
    row.tick_ns = tick.duration_ns;
    row.flags = tick.flags;
    return row;
}

void append_trace_row(std::string& text, const TraceRow& row)
{
    fmt::format_to(
        std::back_inserter(text),
        "{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{},{},{:.9g},{:.9g},{:.9g},{},{:.9g},{:.9g}\n",
        row.time_s, row.tip_mm[0], row.tip_mm[1], row.tip_mm[2], row.force_n[0], row.force_n[1],
        row.force_n[2], row.contacts, row.inside ? 1 : 0, row.proxy_mm[0], row.proxy_mm[1], row.proxy_mm[2],
        row.set_id, row.query_us, row.tick_ns);
}

} // namespace phantom::feeder
