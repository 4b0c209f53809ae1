// SPDX-License-Identifier: GPL-2.0-or-later
// Keeps what a search finds inside the caller's own vectors, so that a warm query allocates nothing.
#pragma once

#include "fdh/search.hpp"

namespace phantom::fdh {

/// The `count` nearest within a radius, and how far they reach.
class NearestCollector {
  public:
    NearestCollector(Nearest& out, std::size_t count, double max_radius);
    NearestCollector(const NearestCollector&) = delete;

    /// Before each tree: searches to max_radius plus the tree's error bound for this query point, or to
    /// the farthest that may still be wanted.
    Sink& open(double distance_error);
    /// Distance beyond which no triangle is of interest.
    [[nodiscard]] double limit() const;
    /// Sorts, cuts to `count` and computes the coverage. The collector is done then.
    void finish();

  private:
    static void make_room(Sink& sink);

    Nearest& out_;
    Sink sink_;
    std::size_t count_;
    double max_radius_;
    double error_ = 0;  ///< largest distance_error of the trees searched
    double kept_limit_; ///< no hit beyond this is wanted: the farthest of count + 1 found so far
};

/// All within a radius.
class WithinCollector {
  public:
    WithinCollector(std::vector<Hit>& out, double radius);
    WithinCollector(const WithinCollector&) = delete;

    Sink& open(double distance_error);
    [[nodiscard]] double limit() const { return radius_; }
    void finish();

  private:
    static void make_room(Sink& sink);

    std::vector<Hit>& out_;
    Sink sink_;
    double radius_;
};

/// Whether a query can be answered at all; if not, the answer is empty and covers nothing.
bool valid_query(const Point& p, double radius);

} // namespace phantom::fdh
