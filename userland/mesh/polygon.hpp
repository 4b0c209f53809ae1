// SPDX-License-Identifier: GPL-2.0-or-later
// Polygons of any shape into triangles: concave ones, such that are not flat, such with corners in a row, and
// such with holes that are bridged by an edge there and back.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"

namespace phantom::mesh {

/// Cuts polygons into triangles, without new corners. Keeps its memory from one polygon to the next.
///
/// A flat convex polygon becomes a fan round its first corner. Any other loses one ear after the other
/// (Meisters 1975, "Polygons have ears"), the best shaped first, seen along the axis next to its normal by
/// Newell; of a bent quadrilateral's diagonals the one that bends it less is taken. Takes about n log n
/// steps.
class PolygonCutter {
  public:
    /// Appends corners - 2 triangles of corner numbers to `out`, in the sense of the polygon. False when it
    /// was found to cross itself (it has no ears left, or does not go round once): then they overlap.
    bool cut(std::span<const Vec3> corners, std::vector<Triple>& out);

  private:
    struct Point {
        double x, y;
    };
    struct Ear {
        double shape;
        std::uint32_t corner, stamp;
        bool operator<(const Ear& b) const { return shape != b.shape ? shape < b.shape : corner > b.corner; }
    };

    bool project();
    [[nodiscard]] bool is_convex() const;
    [[nodiscard]] bool is_flat() const;
    [[nodiscard]] bool goes_round_once() const;
    bool cut_quadrilateral(std::vector<Triple>& out) const;
    bool clip_ears(std::vector<Triple>& out);
    /// The best shaped one that still is one, or no_neighbour.
    std::uint32_t best_ear();
    void clip(std::uint32_t corner, std::vector<Triple>& out);
    void sort_into_cells();
    void consider(std::uint32_t corner);
    [[nodiscard]] bool is_ear(std::uint32_t corner) const;
    [[nodiscard]] bool holds_another(std::uint32_t corner) const;
    [[nodiscard]] double shape_of(std::uint32_t corner) const;
    [[nodiscard]] bool turns_left(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
    [[nodiscard]] std::size_t cell_of(double at, double low, double high) const;

    std::span<const Vec3> corners_;
    Vec3 normal_{};
    std::vector<Point> points_;                 ///< the corners, seen along an axis; counter-clockwise
    std::vector<std::uint32_t> before_, after_; ///< of the corners that are left
    std::vector<std::uint32_t> stamp_;          ///< of the newest entry in ears_; no_neighbour: gone
    std::vector<Ear> ears_;                     ///< a heap
    Point low_{}, high_{};
    std::size_t side_ = 1;                       ///< cells along x and y
    std::vector<std::uint32_t> first_, in_cell_; ///< corners that do not turn left, by cell
};

} // namespace phantom::mesh
