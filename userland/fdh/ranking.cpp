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
        // Several at a time: one chain of minima would wait for itself.
        constexpr std::size_t chains = 4;
        double low[chains], high[chains];
        std::fill(low, low + chains, hits[0].distance);
        std::fill(high, high + chains, hits[0].distance);
        for (std::size_t i = 0; i < hits.size(); i++) {
            low[i % chains] = std::min(low[i % chains], hits[i].distance);
            high[i % chains] = std::max(high[i % chains], hits[i].distance);
        }
        const double lowest = *std::min_element(low, low + chains),
                     highest = *std::max_element(high, high + chains);
        low2_ = lowest * lowest;
        scale_ = (count - 1) / (highest * highest - low2_);
    }
    /// False if all are equally far, or too nearly so to tell apart by scaling.
    [[nodiscard]] bool useful() const { return scale_ < std::numeric_limits<double>::max(); }
    [[nodiscard]] int of(const Hit& hit) const
    {
        return static_cast<int>((hit.distance * hit.distance - low2_) * scale_);
    }

  private:
    double low2_, scale_;
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

void sort_nearest(std::span<const Hit> hits, std::size_t wanted, std::vector<Hit>& sorted)
{
    wanted = std::min(wanted, hits.size());
    if (wanted == 0) {
        sorted.clear();
        return;
    }
    const Buckets buckets(hits);
    if (hits.size() < worth_dealing || !buckets.useful()) {
        sorted.assign(hits.begin(), hits.end());
        std::partial_sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(wanted), sorted.end(),
                          nearer);
        sorted.resize(wanted);
        return;
    }
    std::uint32_t place[Buckets::count] = {};
    for (const Hit& hit : hits)
        place[buckets.of(hit)]++;
    constexpr std::uint32_t crowded = 16;
    std::uint32_t largest = 0, taken = 0;
    int end = 0; // of the buckets that hold the wanted
    for (; taken < wanted; end++) {
        const std::uint32_t members = place[end];
        place[end] = taken;
        taken += members;
        largest = std::max(largest, members);
    }
    sorted.resize(taken);
    for (const Hit& hit : hits)
        if (const int b = buckets.of(hit); b < end)
            sorted[place[b]++] = hit;
    if (largest > crowded) {
        auto begin = sorted.begin();
        for (int b = 0; b < end; b++) {
            const auto next = sorted.begin() + place[b];
            std::sort(begin, next, nearer);
            begin = next;
        }
    } else {
        insertion_sort(sorted);
    }
    sorted.resize(wanted);
}

void Nearest::sort()
{
    sort_nearest(hits, hits.size(), sorted);
    hits.swap(sorted);
}

} // namespace phantom::fdh
