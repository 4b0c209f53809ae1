// SPDX-License-Identifier: GPL-2.0-or-later
// Gathers what searches of one or several trees find, inside the caller's own vectors, so that a warm query
// allocates nothing.
#pragma once

#include <algorithm>
#include <span>

#include "fdh/precise_search.hpp"
#include "fdh/search.hpp"

namespace phantom::fdh {

/// How far a computed distance d from one query point may be from the true one: base + slope d [mesh unit].
struct ErrorBound {
    double base = 0, slope = 0;
    [[nodiscard]] double at(double distance) const { return base + slope * distance; }
};

/// The `count` nearest within a radius, and how far they reach.
class NearestCollector {
  public:
    NearestCollector(Nearest& out, std::size_t count, double max_radius);
    NearestCollector(const NearestCollector&) = delete;

    /// Distance beyond which no triangle is of interest [mesh unit].
    [[nodiscard]] double limit() const { return std::min(max_radius_, kept_limit_); }

    /// Searches a tree from a point in its neighbourhood, or from anywhere.
    template <int K>
    void search(const TreeView<K>& tree, const SearchKernels<K>& kernels, const SearchPoint<K>& point,
                double step, std::uint32_t object, const ErrorBound& error);
    template <int K>
    void search_precisely(const TreeView<K>& tree, const Point& steps, double step, std::uint32_t object,
                          const ErrorBound& error);
    /// Looks only at some leaves, which hold all triangles of a tree within `room` of the point. False, and
    /// nothing taken, if that is not enough to know the nearest.
    template <int K>
    [[nodiscard]] bool search_some(std::span<const Leaf> leaves, double room, const SearchKernels<K>& kernels,
                                   const SearchPoint<K>& point, double step, std::uint32_t object,
                                   const ErrorBound& error);

    /// Cuts to `count` and computes the coverage. The collector is done then.
    void finish();

  private:
    class HitSink;
    void note(const ErrorBound& error);
    [[nodiscard]] Candidates candidates(const ErrorBound& error, double step);
    template <int K>
    void take(Candidates& found, const SearchKernels<K>& kernels, double step, std::uint32_t object);
    [[nodiscard]] Hit* room_for(std::size_t more);
    /// Once `keep_` hits are there: forgets the others and puts the farthest of them last.
    void narrow();

    Nearest& out_;
    std::size_t keep_;     ///< one more than asked for: the nearest left out tells how far the rest reach
    std::size_t size_ = 0; ///< hits so far; out_.hits may be longer
    double max_radius_;
    ErrorBound error_;  ///< the worst of the trees searched
    double kept_limit_; ///< no hit beyond this is wanted: the farthest of keep_ found so far
};

/// All within a radius.
class WithinCollector {
  public:
    WithinCollector(std::vector<Hit>& out, double radius);
    WithinCollector(const WithinCollector&) = delete;

    [[nodiscard]] double limit() const { return radius_; }
    template <int K>
    void search(const TreeView<K>& tree, const SearchKernels<K>& kernels, const SearchPoint<K>& point,
                double step, std::uint32_t object, const ErrorBound& error);
    template <int K>
    void search_precisely(const TreeView<K>& tree, const Point& steps, double step, std::uint32_t object,
                          const ErrorBound& error);

  private:
    std::vector<Hit>& out_;
    double radius_;
};

/// Whether a query can be answered at all; if not, the answer is empty and covers nothing.
bool valid_query(const Point& p, double radius);

} // namespace phantom::fdh
