// SPDX-License-Identifier: GPL-2.0-or-later
// Reading phantom_histogram: the layout is told in phantom_abi.h.
#include <cmath>

#include "device/device.hpp"

namespace phantom::device {

double bucket_end_ns(std::uint32_t bucket)
{
    if (bucket < 8)
        return bucket;
    const int exponent = static_cast<int>(bucket / 8) + 2;
    const std::uint32_t mantissa = bucket % 8;
    return std::ldexp(9.0 + mantissa, exponent - 3);
}

std::uint64_t total_count(const phantom_histogram& histogram)
{
    std::uint64_t total = 0;
    for (const __u32 count : histogram.count)
        total += count;
    return total;
}

double percentile_ns(const phantom_histogram& histogram, double fraction)
{
    const std::uint64_t total = total_count(histogram);
    if (total == 0)
        return 0.0;
    const double wanted = fraction * static_cast<double>(total);
    std::uint64_t below = 0;
    for (std::uint32_t bucket = 0; bucket < PHANTOM_HISTOGRAM_BUCKETS; ++bucket) {
        below += histogram.count[bucket];
        // The maximum is exact: no bucket's end may lie beyond it.
        if (static_cast<double>(below) >= wanted && below > 0)
            return std::min(bucket_end_ns(bucket), static_cast<double>(histogram.max_ns));
    }
    return histogram.max_ns;
}

} // namespace phantom::device
