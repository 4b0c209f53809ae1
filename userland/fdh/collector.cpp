// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/collector.hpp"

#include <cmath>
#include <limits>

#include "fdh/grid.hpp"
#include "fdh/ranking.hpp"

namespace phantom::fdh {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Candidates a query makes room for beyond those it must keep, before it sorts some out.
constexpr std::size_t spare_candidates = 512;

/// A limit in mesh units, in a tree's steps; more than any distance if it is infinite.
float limit2_in_steps(double limit, const ErrorBound& error, double step)
{
    return search_limit2((limit + error.at(limit)) / step * (1 + 0x1p-40));
}

} // namespace

bool valid_query(const Point& p, double radius)
{
    return std::abs(p[0]) <= largest_coordinate && std::abs(p[1]) <= largest_coordinate &&
           std::abs(p[2]) <= largest_coordinate && radius >= 0;
}

NearestCollector::NearestCollector(Nearest& out, std::size_t count, double max_radius)
    : out_(out), keep_(count + 1), max_radius_(max_radius), kept_limit_(infinity)
{
    // The hits of last time are overwritten, not cleared: clearing would set all of them to zero again.
    out_.coverage = 0;
    out_.distance_error = 0;
    out_.counts = {};
    if (keep_ == 0)
        keep_--; // more than there can be
}

Hit* NearestCollector::room_for(std::size_t more)
{
    if (out_.hits.size() < size_ + more)
        out_.hits.resize(size_ + more);
    return out_.hits.data() + size_;
}

void NearestCollector::note(const ErrorBound& error)
{
    error_ = {std::max(error_.base, error.base), std::max(error_.slope, error.slope)};
}

void NearestCollector::narrow()
{
    if (size_ < keep_)
        return;
    select_nearest({out_.hits.data(), size_}, keep_);
    size_ = keep_;
    kept_limit_ = out_.hits[keep_ - 1].distance;
}

Candidates NearestCollector::candidates(const ErrorBound& error, double step)
{
    if (const std::size_t wanted = std::min(keep_, spare_candidates) + spare_candidates;
        out_.distances2.size() < wanted) {
        out_.distances2.resize(wanted);
        out_.triangles.resize(wanted);
    }
    Candidates found;
    found.distance2 = out_.distances2.data();
    found.triangle = out_.triangles.data();
    found.capacity = out_.distances2.size();
    found.keep = keep_;
    found.limit2 = limit2_in_steps(limit(), error, step);
    found.owner = &out_;
    found.full = [](Candidates& c) {
        auto& out = *static_cast<Nearest*>(c.owner);
        out.distances2.resize(2 * c.capacity);
        out.triangles.resize(2 * c.capacity);
        c.distance2 = out.distances2.data();
        c.triangle = out.triangles.data();
        c.capacity = out.distances2.size();
    };
    return found;
}

template <int K>
void NearestCollector::take(Candidates& found, const SearchKernels<K>& kernels, double step,
                            std::uint32_t object)
{
    if (size_ == 0 && found.size == keep_)
        kept_limit_ = std::sqrt(double{found.limit2}) * step;
    kernels.to_hits(found, object, step, room_for(found.size));
    out_.counts.nodes += found.counts.nodes;
    out_.counts.leaves += found.counts.leaves;
    out_.counts.triangles += found.counts.triangles;
    const bool first = size_ == 0;
    size_ += found.size;
    if (!first)
        narrow();
}

template <int K>
void NearestCollector::search(const TreeView<K>& tree, const SearchKernels<K>& kernels,
                              const SearchPoint<K>& point, double step, std::uint32_t object,
                              const ErrorBound& error)
{
    note(error);
    Candidates found = candidates(error, step);
    kernels.search(tree, point, found);
    kernels.select(found);
    take(found, kernels, step, object);
}

template <int K>
bool NearestCollector::search_some(std::span<const Leaf> leaves, double room, const SearchKernels<K>& kernels,
                                   const SearchPoint<K>& point, double step, std::uint32_t object,
                                   const ErrorBound& error)
{
    Candidates found = candidates(error, step);
    const float room2 = room > 0 ? round_down(room * room / (step * step) * (1 - 0x1p-40)) : 0;
    const bool all = found.limit2 <= room2;
    if (!all)
        found.limit2 = room2;
    kernels.scan(leaves.data(), leaves.size(), point, found);
    if (!all && found.size < keep_)
        return false;
    note(error);
    kernels.select(found);
    take(found, kernels, step, object);
    return true;
}

class NearestCollector::HitSink final : public DistanceSink {
  public:
    HitSink(NearestCollector& collector, double step, std::uint32_t object, const ErrorBound& error)
        : collector_(collector), step_(step), object_(object), error_(error)
    {
        set_limit();
    }
    void add(std::uint32_t triangle, double distance) override
    {
        *collector_.room_for(1) = {object_, triangle, distance * step_};
        collector_.size_++;
        if (collector_.size_ / 2 < collector_.keep_ || collector_.size_ < spare_candidates)
            return;
        collector_.narrow();
        set_limit();
    }
    [[nodiscard]] double limit() const override { return limit_; }

  private:
    void set_limit()
    {
        const double limit = collector_.limit();
        limit_ = (limit + error_.at(limit)) / step_ * (1 + 0x1p-40);
    }
    NearestCollector& collector_;
    double step_;
    std::uint32_t object_;
    ErrorBound error_;
    double limit_;
};

template <int K>
void NearestCollector::search_precisely(const TreeView<K>& tree, const Point& steps, double step,
                                        std::uint32_t object, const ErrorBound& error)
{
    note(error);
    HitSink sink(*this, step, object, error);
    precise_search(tree, steps, sink, out_.counts);
    narrow();
}

void NearestCollector::finish()
{
    out_.coverage = max_radius_;
    double farthest = max_radius_ + error_.at(max_radius_);
    if (size_ == keep_) { // the farthest stands last
        // The error bound has room for the rounding of the difference.
        farthest = out_.hits[--size_].distance;
        out_.coverage = std::clamp(farthest - error_.at(farthest), 0.0, max_radius_);
    } else if (!(max_radius_ < infinity)) {
        farthest = 0;
        for (std::size_t i = 0; i < size_; i++)
            farthest = std::max(farthest, out_.hits[i].distance);
    }
    out_.distance_error = error_.at(farthest);
    out_.hits.resize(size_);
}

WithinCollector::WithinCollector(std::vector<Hit>& out, double radius) : out_(out), radius_(radius)
{
    out_.clear();
}

template <int K>
void WithinCollector::search(const TreeView<K>& tree, const SearchKernels<K>& kernels,
                             const SearchPoint<K>& point, double step, std::uint32_t object,
                             const ErrorBound& error)
{
    struct Owner {
        std::vector<Hit>& out;
        const SearchKernels<K>& kernels;
        double step;
        std::uint32_t object;
    } owner{out_, kernels, step, object};
    constexpr std::size_t capacity = 512;
    float distance2[capacity];
    std::uint32_t triangle[capacity];
    Candidates found;
    found.distance2 = distance2;
    found.triangle = triangle;
    found.capacity = capacity;
    found.keep = std::numeric_limits<std::size_t>::max();
    found.limit2 = limit2_in_steps(radius_, error, step);
    found.owner = &owner;
    found.full = [](Candidates& c) {
        auto& to = *static_cast<Owner*>(c.owner);
        const std::size_t before = to.out.size();
        to.out.resize(before + c.size);
        to.kernels.to_hits(c, to.object, to.step, to.out.data() + before);
        c.size = 0;
    };
    kernels.search(tree, point, found);
    found.full(found);
}

template <int K>
void WithinCollector::search_precisely(const TreeView<K>& tree, const Point& steps, double step,
                                       std::uint32_t object, const ErrorBound& error)
{
    class Sink final : public DistanceSink {
      public:
        Sink(std::vector<Hit>& out, double limit, double step, std::uint32_t object)
            : out_(out), limit_(limit), step_(step), object_(object)
        {
        }
        void add(std::uint32_t triangle, double distance) override
        {
            out_.push_back({object_, triangle, distance * step_});
        }
        [[nodiscard]] double limit() const override { return limit_; }

      private:
        std::vector<Hit>& out_;
        double limit_, step_;
        std::uint32_t object_;
    } sink(out_, (radius_ + error.at(radius_)) / step * (1 + 0x1p-40), step, object);
    QueryCounts counts;
    precise_search(tree, steps, sink, counts);
}

#define PHANTOM_FDH_COLLECTOR(K)                                                                             \
    template bool NearestCollector::search_some<K>(std::span<const Leaf>, double, const SearchKernels<K>&,   \
                                                   const SearchPoint<K>&, double, std::uint32_t,             \
                                                   const ErrorBound&);                                       \
    template void NearestCollector::search<K>(const TreeView<K>&, const SearchKernels<K>&,                   \
                                              const SearchPoint<K>&, double, std::uint32_t,                  \
                                              const ErrorBound&);                                            \
    template void NearestCollector::search_precisely<K>(const TreeView<K>&, const Point&, double,            \
                                                        std::uint32_t, const ErrorBound&);                   \
    template void WithinCollector::search<K>(const TreeView<K>&, const SearchKernels<K>&,                    \
                                             const SearchPoint<K>&, double, std::uint32_t,                   \
                                             const ErrorBound&);                                             \
    template void WithinCollector::search_precisely<K>(const TreeView<K>&, const Point&, double,             \
                                                       std::uint32_t, const ErrorBound&);
PHANTOM_FDH_COLLECTOR(6)
PHANTOM_FDH_COLLECTOR(14)
PHANTOM_FDH_COLLECTOR(18)
PHANTOM_FDH_COLLECTOR(26)

} // namespace phantom::fdh
