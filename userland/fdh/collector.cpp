// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/collector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fdh/ranking.hpp"

namespace phantom::fdh {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Hits a query makes room for beyond those it must keep, before it sorts some out.
constexpr std::size_t spare_hits = 128;

} // namespace

bool valid_query(const Point& p, double radius)
{
    return std::abs(p[0]) <= largest_coordinate && std::abs(p[1]) <= largest_coordinate &&
           std::abs(p[2]) <= largest_coordinate && radius >= 0;
}

NearestCollector::NearestCollector(Nearest& out, std::size_t count, double max_radius)
    : out_(out), count_(count), max_radius_(max_radius), kept_limit_(infinity)
{
    out_.clear();
    sink_.full = make_room;
    sink_.owner = this;
}

Sink& NearestCollector::open(double distance_error)
{
    error_ = std::max(error_, distance_error);
    sink_.limit = std::min(max_radius_ + distance_error, kept_limit_);
    return sink_;
}

double NearestCollector::limit() const
{
    return std::min(max_radius_, kept_limit_);
}

void NearestCollector::make_room(Sink& sink)
{
    auto& self = *static_cast<NearestCollector*>(sink.owner);
    // One more than asked for: the nearest of those left out tells how far the rest reach.
    if (const std::size_t wanted = self.count_ + 1; self.count_ < sink.size && wanted < sink.size) {
        select_nearest({sink.hits, sink.size}, wanted);
        sink.size = wanted;
        self.kept_limit_ = sink.hits[wanted - 1].distance;
        sink.limit = std::min(sink.limit, self.kept_limit_);
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
    const bool bounded = count_ < sink_.size;
    sort_nearest({sink_.hits, sink_.size}, bounded ? count_ + 1 : sink_.size, out_.hits);
    out_.coverage = max_radius_;
    if (bounded) {
        // The error bound has room for the rounding of the difference.
        out_.coverage = std::clamp(out_.hits.back().distance - error_, 0.0, max_radius_);
        out_.hits.pop_back();
    }
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
    sink_.limit = radius_ + distance_error;
    return sink_;
}

void WithinCollector::make_room(Sink& sink)
{
    auto& hits = static_cast<WithinCollector*>(sink.owner)->out_;
    hits.resize(
        std::max(2 * sink.size, spare_hits)); // not to its capacity: filling that would cost every query
    sink.hits = hits.data();
    sink.capacity = hits.size();
}

void WithinCollector::finish()
{
    out_.resize(sink_.size);
}

} // namespace phantom::fdh
