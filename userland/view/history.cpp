// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/history.hpp"

#include <algorithm>
#include <cmath>

namespace phantom::view {

namespace {

constexpr double kept_s = 60;
constexpr double bin_s = 1e-3;

/// phantom_tick and phantom_status carry the same fields here.
template <typename Record>
Touch touch_from(const Record& record, std::uint64_t start_ns)
{
    Touch touch;
    touch.time_s = 1e-9 * static_cast<double>(static_cast<std::int64_t>(record.time_ns - start_ns));
    for (std::size_t i = 0; i < 3; ++i) {
        touch.tip_mm[i] = 1e-6 * static_cast<double>(record.tip_nm[i]);
        touch.proxy_mm[i] = 1e-6 * static_cast<double>(record.proxy_nm[i]);
        touch.force_n[i] = 1e-6 * record.force_un[i];
    }
    touch.contacts = record.contacts;
    touch.inside = (record.flags & PHANTOM_TICK_INSIDE) != 0;
    return touch;
}

} // namespace

Touch touch_of(const phantom_status& status, std::uint64_t start_ns)
{
    return touch_from(status, start_ns);
}

void History::append(std::span<const phantom_tick> ticks)
{
    for (const phantom_tick& tick : ticks) {
        if (ticks_++ == 0)
            start_ns_ = tick.time_ns;
        const Touch touch = touch_from(tick, start_ns_);
        max_force_n_ = std::max(max_force_n_, touch.force_norm_n());
        const bool same_bin = !samples_.empty() &&
                              std::floor(samples_.back().time_s / bin_s) == std::floor(touch.time_s / bin_s);
        if (!same_bin)
            samples_.push_back(touch);
        else if (touch.force_norm_n() > samples_.back().force_norm_n())
            samples_.back() = touch;
    }
    while (!samples_.empty() && samples_.front().time_s < samples_.back().time_s - kept_s)
        samples_.pop_front();
}

} // namespace phantom::view
