// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdhctl/touch_record.hpp"

#include <algorithm>
#include <cmath>

namespace phantom::fdhctl {

Status TouchRecord::begin(device::Device& device, bool fed, const std::string& scene)
{
    return file_ ? file_->begin(device, fed, scene) : success();
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

Status TouchRecord::collect(device::Device& device, const TickFile::QueryTime& query_us)
{
    for (;;) {
        // The page first: whatever it counts has been recorded before.
        const phantom_status before = device.status();
        const Result<std::vector<phantom_tick>> ticks = device.read_ticks();
        if (!ticks)
            return ticks.error();
        for (const phantom_tick& tick : *ticks)
            count(tick);
        if (file_)
            if (Status status = file_->append(*ticks, before, query_us); !status)
                return status;
        if (ticks->empty())
            return success();
    }
}

Status TouchRecord::commit()
{
    return file_ ? file_->commit() : success();
}

} // namespace phantom::fdhctl
