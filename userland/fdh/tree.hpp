// SPDX-License-Identifier: GPL-2.0-or-later
// Level two of the hierarchy: one mesh, hulls over triangles.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "fdh/hull.hpp"
#include "fdh/isa.hpp"
#include "fdh/query.hpp"

namespace phantom::fdh {

template <int K>
class SceneTree;
template <int K>
class CoherentQuery;

struct BuildOptions {
    unsigned threads = 0; ///< 0: all cores. The tree is the same for any number.
    Isa isa = Isa::best;  ///< for the queries; must be available (isa_available)
};

/// A tree as bytes, to be kept in a file and opened in place. They are of this machine: its byte order and
/// this version's layout.
struct TreeImage {
    Point origin{0, 0, 0};
    double step = 1;
    double longest_edge = 0; ///< [steps]
    double spread = 0;
    std::uint64_t triangles = 0;
    std::span<const std::byte> nodes, leaves; ///< each to be aligned to image_alignment
};
inline constexpr std::size_t image_alignment = 64;

/// A hierarchy of FDH-K hulls over the triangles of one mesh. Immutable, and shared by its copies; any number
/// of threads may query it at once. Distances hold for degenerate triangles too (a segment, a point).
///
/// Accuracy. The tree keeps vertices rounded to a grid of its own, fine against the mesh's extent, and
/// computes in float from there, relative to the query point; from points outside twice the mesh's half
/// extent in double. Reported distances are off by no more than accuracy(); coverage and the set of hits
/// allow for that, so what they promise holds for the true mesh.
template <int K>
class TriangleTree {
  public:
    static_assert(K == 6 || K == 14 || K == 18 || K == 26, "FDH6, FDH14, FDH18 or FDH26");

    /// Builds by halving along the longest axis (order.hpp). An empty view gives a tree that finds nothing.
    /// Throws std::invalid_argument, naming the triangle, if one refers to a vertex that is not there or
    /// whose coordinates are not finite or beyond largest_coordinate; if there are 2^31 - 1 triangles or
    /// more; or if options.isa is not available. Vertices that no triangle uses are not looked at.
    static TriangleTree build(const MeshView& mesh, const BuildOptions& options = {});

    /// The same triangles after their vertices have moved: leaves and hulls are computed anew, several
    /// times as fast as building. Which triangles share a leaf stays, so the more they have moved past each
    /// other, the more leaves a query visits: see spread(). Throws std::invalid_argument as build() does,
    /// and if the mesh has another number of triangles.
    [[nodiscard]] TriangleTree refitted(const MeshView& mesh, const BuildOptions& options = {}) const;
    /// Squares of the mean widths of the leaves' boxes over the area of their triangles: how compact leaves
    /// are, which tells how many of them a ball of a leaf's size meets. 2.4 when just built of a
    /// sphere, 2.6 of the bunny; about the same if the mesh is scaled or moved. It grows as triangles of one
    /// leaf move apart, and as a leaf gets long and thin.
    [[nodiscard]] double spread() const;

    /// The bytes live as long as the tree or a copy of it.
    [[nodiscard]] TreeImage image() const;
    /// A tree in the bytes of an image, which `keeper` keeps alive. nullopt if they cannot be one: sizes,
    /// alignment or triangle numbers that do not fit. Whether they are the mesh's is for the caller to know.
    /// Throws std::invalid_argument if `isa` is not available.
    static std::optional<TriangleTree> open(const TreeImage& image, std::shared_ptr<const void> keeper,
                                            Isa isa = Isa::best);

    /// The `count` nearest triangles within max_radius of p. `out` is reused: no allocation once warm.
    /// A hit may be farther than max_radius by twice accuracy(p, max_radius) at most. A point with a NaN or a
    /// coordinate beyond largest_coordinate, or a radius that is negative or NaN, finds nothing and covers
    /// nothing.
    void nearest(const Point& p, std::size_t count, double max_radius, Nearest& out) const;

    /// Every triangle within radius of p (distance <= radius), in no order. Never misses one; may include
    /// some that are farther, by twice accuracy(p, radius) at most. Invalid input as for nearest().
    void within(const Point& p, double radius, std::vector<Hit>& out) const;

    /// Every triangle within radius of the segment, in no order: of the way from the tip to where it will be.
    /// Never misses one; may include some that are farther, by twice accuracy(p, radius) at most, p the end
    /// for which that is more. Invalid ends or radius find nothing.
    void along(const Point& from, const Point& to, double radius, std::vector<Hit>& out) const;

    /// Every triangle that touches the box, in no order; their distances are given as 0. Never misses one;
    /// may include some that touch it only when it is widened on every side by twice accuracy(p, 0), p the
    /// corner for which that is most. A box with low > high or a NaN finds nothing.
    void in_box(const Box& box, std::vector<Hit>& out) const;

    /// Largest difference between a reported distance d from p and the true one [mesh unit]: 1.04e-7 of the
    /// mesh's half extent (the longest half side of its box, rounded up to a power of two), 4e-6 of d and of
    /// the longest edge, and 1.5e-14 of p's distance from the mesh's centre.
    [[nodiscard]] double accuracy(const Point& p, double distance) const;

    /// Low and high of the whole in each of the K/2 directions, unnormalised, in mesh coordinates
    /// (rounded outward). Directions: see hull_directions<K>(). Of an empty tree: +infinity, -infinity.
    [[nodiscard]] std::array<std::array<double, 2>, K / 2> hull() const;

    [[nodiscard]] std::size_t triangles() const;
    /// Memory the tree occupies.
    [[nodiscard]] std::size_t bytes() const;
    /// The instruction set its queries run on.
    [[nodiscard]] Isa isa() const;

  private:
    friend class SceneTree<K>;
    friend class CoherentQuery<K>;
    struct Impl;
    explicit TriangleTree(std::shared_ptr<const Impl> impl);
    std::shared_ptr<const Impl> impl_;
};

extern template class TriangleTree<6>;
extern template class TriangleTree<14>;
extern template class TriangleTree<18>;
extern template class TriangleTree<26>;

} // namespace phantom::fdh
