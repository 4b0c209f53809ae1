// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/collector.hpp"

#include <algorithm>
#include <cmath>

#include "fdh/grid.hpp"
#include "fdh/ranking.hpp"

namespace phantom::fdh {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Hits a query makes room for beyond those it must keep, before it sorts some out.
constexpr std::size_t spare_hits = 128;

double square_up(double x)
{
    return x * x * (1 + 0x1p-50);
}

} // namespace

bool valid_query(const Point& p, double radius)
{
    return std::abs(p[0]) <= largest_coordinate && std::abs(p[1]) <= largest_coordinate &&
           std::abs(p[2]) <= largest_coordinate && radius >= 0;
}

NearestCollector::NearestCollector(Nearest& out, std::size_t count, double max_radius)
    : out_(out), count_(count), max_radius_(max_radius), kept_limit2_(infinity)
{
    out_.clear();
    sink_.full = make_room;
    sink_.owner = this;
}

Sink& NearestCollector::open(double distance_error)
{
    error_ = std::max(error_, distance_error);
    sink_.limit2 = std::min(square_up(max_radius_ + distance_error), kept_limit2_);
    return sink_;
}

double NearestCollector::limit2() const
{
    return std::min(square_up(max_radius_), kept_limit2_);
}

/// Reduces the hits to the `wanted` nearest; the last of them is then the farthest.
void NearestCollector::keep_nearest(std::size_t wanted)
{
    select_nearest({sink_.hits, sink_.size}, wanted);
    sink_.size = wanted;
    kept_limit2_ = sink_.hits[wanted - 1].distance;
}

void NearestCollector::make_room(Sink& sink)
{
    auto& self = *static_cast<NearestCollector*>(sink.owner);
    // One more than asked for: the nearest of those left out tells how far the rest reach.
    const bool bounded = self.count_ < std::numeric_limits<std::uint32_t>::max();
    const std::size_t wanted = bounded ? self.count_ + 1 : std::numeric_limits<std::size_t>::max();
    if (sink.size > wanted) {
        self.keep_nearest(wanted);
        sink.limit2 = std::min(sink.limit2, self.kept_limit2_);
    }
    if (sink.size + spare_hits / 2 <= sink.capacity)
        return;
    auto& hits = self.out_.workspace;
    hits.resize(std::max({hits.size(), 2 * sink.size, spare_hits}));
    sink.hits = hits.data();
    sink.capacity = hits.size();
}

void NearestCollector::finish()
{
    double covered = max_radius_;
    if (sink_.size > count_) {
        keep_nearest(count_ + 1);
        const Hit& left_out = sink_.hits[count_];
        // The error bound has room for the rounding of the square root and the difference.
        covered = std::clamp(std::sqrt(left_out.distance) - error_, 0.0, max_radius_);
        sink_.size = count_;
    }
    const std::span<Hit> found(sink_.hits, sink_.size);
    for (Hit& hit : found)
        hit.distance = std::sqrt(hit.distance);
    out_.hits.resize(found.size());
    sort_into(found, out_.hits);
    out_.coverage = covered;
    out_.counts = sink_.counts;
}

WithinCollector::WithinCollector(std::vector<Hit>& out, double radius) : out_(out), radius_(radius)
{
    out_.clear();
    sink_.full = make_room;
    sink_.owner = this;
}

Sink& WithinCollector::open(double distance_error)
{
    sink_.limit2 = square_up(radius_ + distance_error);
    return sink_;
}

void WithinCollector::make_room(Sink& sink)
{
    auto& hits = static_cast<WithinCollector*>(sink.owner)->out_;
    hits.resize(std::max({hits.capacity(), 2 * sink.size, spare_hits}));
    sink.hits = hits.data();
    sink.capacity = hits.size();
}

void WithinCollector::finish()
{
    for (std::size_t i = 0; i < sink_.size; i++)
        sink_.hits[i].distance = std::sqrt(sink_.hits[i].distance);
    out_.resize(sink_.size);
}

} // namespace phantom::fdh
