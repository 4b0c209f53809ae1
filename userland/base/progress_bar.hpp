// SPDX-License-Identifier: GPL-2.0-or-later
// A progress bar on the terminal, for work that takes over a second.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <string>

namespace phantom {

/// Draws on stderr, and only when that is a terminal and a second has passed. Erases itself at the end.
class ProgressBar {
  public:
    explicit ProgressBar(std::string what) : what_(std::move(what)) {}
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    ~ProgressBar()
    {
        if (drawn_)
            std::fputs("\r\033[K", stderr);
    }

    /// done: 0 ... 1.
    void update(double done)
    {
        constexpr int width = 40;
        constexpr auto patience = std::chrono::seconds(1);
        constexpr auto redraw = std::chrono::milliseconds(50);
        const auto now = std::chrono::steady_clock::now();
        if (!terminal_ || now - begin_ < patience || now - last_ < redraw)
            return;
        last_ = now;
        drawn_ = true;
        const double part = std::clamp(done, 0.0, 1.0);
        const int filled = static_cast<int>(part * width);
        std::fprintf(stderr, "\r\033[K%s [%s%s] %3.0f %%", what_.c_str(), std::string(filled, '#').c_str(),
                     std::string(width - filled, '.').c_str(), 100.0 * part);
    }

    /// For options that take a callback; the bar must outlive it.
    std::function<void(double)> callback()
    {
        return [this](double done) { update(done); };
    }

  private:
    std::string what_;
    bool terminal_ = ::isatty(STDERR_FILENO) == 1;
    bool drawn_ = false;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now(), last_{};
};

} // namespace phantom
