// SPDX-License-Identifier: GPL-2.0-or-later
// Durations measured one by one.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

namespace phantom::study {

/// Median, 99th percentile and maximum; the unit is the samples'.
struct Distribution {
    std::uint64_t count = 0;
    double median = 0, p99 = 0, max = 0;

    static Distribution of(std::vector<double> samples)
    {
        if (samples.empty())
            return {};
        std::sort(samples.begin(), samples.end());
        const auto at = [&samples](double part) {
            return samples[static_cast<std::size_t>(part * static_cast<double>(samples.size() - 1))];
        };
        return {samples.size(), at(0.5), at(0.99), samples.back()};
    }
};

/// ns that a call takes, the clock's own 20 ... 30 ns included.
template <typename Call>
double nanoseconds_of(Call&& call)
{
    const auto begin = std::chrono::steady_clock::now();
    call();
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count();
}

} // namespace phantom::study
