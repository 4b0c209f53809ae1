// SPDX-License-Identifier: GPL-2.0-or-later
#include "feeder/path_player.hpp"

#include <algorithm>
#include <chrono>

namespace phantom::feeder {

namespace {

/// A wake-up later than this many periods slows the path down instead of making it jump.
constexpr double periods_max = 4.0;

} // namespace

PathPlayer::PathPlayer(device::Device& device, const Path& path, std::uint32_t rate_hz)
    : device_(device),
      path_(path),
      rate_hz_(rate_hz),
      thread_([this](const std::stop_token& stop) { play(stop); })
{
}

PathPlayer::~PathPlayer() = default;

void PathPlayer::play(const std::stop_token& stop)
{
    using Clock = std::chrono::steady_clock;
    using Seconds = std::chrono::duration<double>;
    const Seconds period(1.0 / rate_hz_);
    double time_s = path_.front().time_s;
    double late_s = 0.0;
    auto before = Clock::now();
    auto next = before;
    while (!stop.stop_requested()) {
        if (!device_.move_simulated_tip(to_nanometres(position_at(path_, time_s))))
            break;
        if (time_s >= path_.back().time_s)
            break;
        next = std::max(next + std::chrono::duration_cast<Clock::duration>(period), before);
        std::this_thread::sleep_until(next);
        const auto now = Clock::now();
        const double passed_s = Seconds(now - before).count();
        const double advance_s = std::min(passed_s, periods_max * period.count());
        late_s += passed_s - advance_s;
        late_s_ = late_s;
        time_s += advance_s;
        before = now;
    }
    finished_ = true;
}

} // namespace phantom::feeder
