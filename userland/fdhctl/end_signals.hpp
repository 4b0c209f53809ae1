// SPDX-License-Identifier: GPL-2.0-or-later
// What ends a command that runs until somebody ends it.
#pragma once

#include <chrono>
#include <csignal>
#include <ctime>

namespace phantom::fdhctl {

/// SIGINT, SIGTERM and SIGHUP, blocked in every thread made from now on and waited for in this one.
class EndSignals {
  public:
    EndSignals()
    {
        sigemptyset(&set_);
        for (const int signal : {SIGINT, SIGTERM, SIGHUP})
            sigaddset(&set_, signal);
        pthread_sigmask(SIG_BLOCK, &set_, nullptr);
        std::signal(SIGPIPE, SIG_IGN);
    }
    /// True when one came within the time.
    [[nodiscard]] bool wait(std::chrono::milliseconds time) const
    {
        const timespec limit{static_cast<time_t>(time.count() / 1000),
                             static_cast<long>(time.count() % 1000 * 1000000)};
        return sigtimedwait(&set_, nullptr, &limit) > 0;
    }

  private:
    sigset_t set_{};
};

} // namespace phantom::fdhctl
