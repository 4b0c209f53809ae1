// SPDX-License-Identifier: GPL-2.0-or-later
// Time of a piece of code that takes a tenth of a microsecond.
#pragma once

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <numeric>
#include <random>

#if defined(__x86_64__)
#include <x86intrin.h>
#endif

namespace phantom::peers {

/// The processor's time stamp counter, between fences so that nothing moves across, held against the
/// steady clock once; on other processors the steady clock itself. What reading it costs is taken off.
///
/// The counter may move in steps of 10 ns, a tenth of what is to be measured. Every duration is therefore
/// spread at random over one step round what was read: medians and percentiles of many are then right to
/// a fraction of the step.
class Stopwatch {
  public:
    Stopwatch()
    {
#if defined(__x86_64__)
        using Clock = std::chrono::steady_clock;
        const auto start = Clock::now();
        const std::uint64_t ticks = now();
        while (Clock::now() - start < std::chrono::milliseconds(50)) {
        }
        const std::uint64_t passed = now() - ticks;
        ns_per_tick_ = std::chrono::duration<double, std::nano>(Clock::now() - start).count() /
                       static_cast<double>(passed);
#endif
        measure_itself();
    }

    static std::uint64_t now()
    {
#if defined(__x86_64__)
        _mm_lfence();
        const std::uint64_t ticks = __rdtsc();
        _mm_lfence();
        return ticks;
#else
        return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                              std::chrono::steady_clock::now().time_since_epoch())
                                              .count());
#endif
    }

    [[nodiscard]] double ns(std::uint64_t begin, std::uint64_t end)
    {
        std::uniform_real_distribution<double> within(-0.5, 0.5);
        const double ticks = static_cast<double>(end - begin) + within(random_) * step_ticks_ - own_ticks_;
        return std::max(0.0, ticks * ns_per_tick_);
    }

  private:
    void measure_itself()
    {
        constexpr int readings = 20000;
        // An interrupted reading says nothing about the others.
        constexpr std::uint64_t interrupted = 1000;
        std::uint64_t step = 0, sum = 0, count = 0;
        for (int i = 0; i < readings; ++i) {
            const std::uint64_t begin = now(), passed = now() - begin;
            if (passed >= interrupted)
                continue;
            sum += passed;
            ++count;
            step = std::gcd(step, passed);
        }
        if (count == 0)
            return;
        own_ticks_ = static_cast<double>(sum) / static_cast<double>(count);
        step_ticks_ = static_cast<double>(step);
    }

    double ns_per_tick_ = 1;
    double own_ticks_ = 0;  ///< between two readings with nothing in between
    double step_ticks_ = 1; ///< by which the counter moves
    std::mt19937 random_{5};
};

/// Time that all threads of this process have computed [ns]: of work on one thread, what it takes however
/// busy the machine is with others'.
inline double cpu_ns()
{
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return 1e9 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
}

} // namespace phantom::peers
