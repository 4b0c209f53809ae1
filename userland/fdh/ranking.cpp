// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/ranking.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace phantom::fdh {

namespace {

/// Below this, comparisons are as fast.
constexpr std::size_t worth_dealing = 24;

/// Which bucket a distance falls into: monotonic, so that everything in a bucket is nearer than everything in
/// the next.
class Buckets {
  public:
    static constexpr int count = 128;

    explicit Buckets(std::span<const Hit> hits)
    {
        double low = hits[0].distance, high = low;
        for (const Hit& hit : hits) {
            low = std::min(low, hit.distance);
            high = std::max(high, hit.distance);
        }
        low_ = low;
        scale_ = (count - 1) / (high - low);
    }
    /// False if all are equally far, or too nearly so to tell apart by scaling.
    [[nodiscard]] bool useful() const { return scale_ < std::numeric_limits<double>::max(); }
    [[nodiscard]] int of(const Hit& hit) const { return static_cast<int>((hit.distance - low_) * scale_); }

  private:
    double low_, scale_;
};

/// Sorts what is nearly in order.
void insertion_sort(std::span<Hit> hits)
{
    for (std::size_t i = 1; i < hits.size(); i++) {
        const Hit hit = hits[i];
        std::size_t place = i;
        for (; place > 0 && nearer(hit, hits[place - 1]); place--)
            hits[place] = hits[place - 1];
        hits[place] = hit;
    }
}

} // namespace

void select_nearest(std::span<Hit> hits, std::size_t wanted)
{
    auto by_comparison = [](std::span<Hit> part, std::size_t first) {
        std::nth_element(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(first - 1), part.end(),
                         nearer);
    };
    const Buckets buckets(hits);
    if (hits.size() < worth_dealing || !buckets.useful()) {
        by_comparison(hits, wanted);
        return;
    }
    std::uint32_t members[Buckets::count] = {};
    for (const Hit& hit : hits)
        members[buckets.of(hit)]++;
    int last = 0; // the bucket in which the wanted end
    std::size_t before = 0;
    while (before + members[last] < wanted)
        before += members[last++];
    const auto inner =
        std::partition(hits.begin(), hits.end(), [&](const Hit& h) { return buckets.of(h) < last; });
    const auto border =
        std::partition(inner, hits.end(), [&](const Hit& h) { return buckets.of(h) == last; });
    by_comparison({inner, border}, wanted - before);
}

void sort_into(std::span<const Hit> from, std::span<Hit> to)
{
    if (from.empty())
        return;
    const Buckets buckets(from);
    if (from.size() < worth_dealing || !buckets.useful()) {
        std::copy(from.begin(), from.end(), to.begin());
        std::sort(to.begin(), to.end(), nearer);
        return;
    }
    std::uint32_t place[Buckets::count + 1] = {};
    for (const Hit& hit : from)
        place[buckets.of(hit) + 1]++;
    constexpr std::uint32_t crowded = 16;
    bool any_crowded = false;
    for (int b = 0; b < Buckets::count; b++) {
        any_crowded |= place[b + 1] > crowded;
        place[b + 1] += place[b];
    }
    for (const Hit& hit : from)
        to[place[buckets.of(hit)]++] = hit;
    if (any_crowded)
        for (int b = 0, begin = 0; b < Buckets::count; begin = static_cast<int>(place[b++]))
            std::sort(to.begin() + begin, to.begin() + place[b], nearer);
    else
        insertion_sort(to);
}

} // namespace phantom::fdh
