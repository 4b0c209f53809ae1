// SPDX-License-Identifier: GPL-2.0-or-later
// Level two of the hierarchy: one mesh, hulls over triangles.
#pragma once

#include <cstddef>
#include <memory>

#include "fdh/hull.hpp"
#include "fdh/query.hpp"

namespace phantom::fdh {

struct BuildOptions {
    unsigned threads = 0; ///< 0: all cores
};

/// A hierarchy of FDH-K hulls over the triangles of one mesh. Immutable; any number of threads may
/// query it at once. Distances hold for degenerate triangles too (a segment, a point).
template <int K>
class TriangleTree {
  public:
    static_assert(K == 6 || K == 14 || K == 18 || K == 26, "FDH6, FDH14, FDH18 or FDH26");

    /// Builds by surface area heuristic (SAH). An empty view gives a tree that finds nothing.
    static TriangleTree build(const MeshView& mesh, const BuildOptions& options = {});

    TriangleTree(TriangleTree&&) noexcept;
    TriangleTree& operator=(TriangleTree&&) noexcept;
    ~TriangleTree();

    /// The `count` nearest triangles within max_radius of p. `out` is reused: no allocation once warm.
    void nearest(const Point& p, std::size_t count, double max_radius, Nearest& out) const;

    /// Every triangle within radius of p (distance <= radius), unsorted.
    void within(const Point& p, double radius, std::vector<Hit>& out) const;

    /// Low and high of the whole in each of the K/2 directions, unnormalised, in mesh coordinates
    /// (rounded outward). Directions: see hull_directions<K>().
    [[nodiscard]] std::array<std::array<double, 2>, K / 2> hull() const;

    [[nodiscard]] std::size_t triangles() const;
    [[nodiscard]] std::size_t bytes() const;

  private:
    struct Impl;
    explicit TriangleTree(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

extern template class TriangleTree<6>;
extern template class TriangleTree<14>;
extern template class TriangleTree<18>;
extern template class TriangleTree<26>;

} // namespace phantom::fdh
