// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdhctl/touch_record.hpp"

#include <algorithm>
#include <cmath>

#include "feeder/trace_file.hpp"

namespace phantom::fdhctl {

Status TouchRecord::begin()
{
    return trace_ ? trace_->append(std::string(feeder::trace_header) + "\n") : success();
}

void TouchRecord::count(const phantom_tick& tick)
{
    if (totals_.ticks > 0 && tick.tick > last_tick_ + 1)
        totals_.lost += tick.tick - last_tick_ - 1;
    last_tick_ = tick.tick;
    ++totals_.ticks;
    totals_.contact_ticks += tick.contacts > 0;
    totals_.inside_ticks += (tick.flags & PHANTOM_TICK_INSIDE) != 0;
    totals_.uncovered_ticks += (tick.flags & PHANTOM_TICK_UNCOVERED) != 0;
    const double force_un =
        std::hypot(double(tick.force_un[0]), double(tick.force_un[1]), double(tick.force_un[2]));
    totals_.force_max_n = std::max(totals_.force_max_n, force_un * 1e-6);
}

Status TouchRecord::collect(feeder::Session& session)
{
    std::string text;
    for (;;) {
        Result<std::vector<phantom_tick>> ticks = session.device().read_ticks();
        if (!ticks)
            return ticks.error();
        if (ticks->empty())
            break;
        const feeder::FeedReport fed = session.feeder().last();
        for (const phantom_tick& tick : *ticks) {
            if (totals_.ticks == 0)
                first_ns_ = tick.time_ns;
            count(tick);
            if (!trace_)
                continue;
            feeder::TraceRow row =
                feeder::trace_row(tick, static_cast<double>(tick.time_ns - first_ns_) * 1e-9);
            // A query's time stands once, where its set is used first; older ones are not known any more.
            if (tick.set_id != last_set_ && tick.set_id == fed.set_id)
                row.query_us = fed.query_us;
            last_set_ = tick.set_id;
            feeder::append_trace_row(text, row);
        }
    }
    return trace_ && !text.empty() ? trace_->append(text) : success();
}

Status TouchRecord::commit()
{
    return trace_ ? trace_->commit() : success();
}

} // namespace phantom::fdhctl
