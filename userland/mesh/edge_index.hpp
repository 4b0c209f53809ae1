// SPDX-License-Identifier: GPL-2.0-or-later
// Half-edges grouped by the edge they lie on: a counting sort by the lower vertex, then short sorts. Linear
// in practice, and indifferent to non-manifold edges.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"

namespace phantom::mesh {

/// Half-edge 3 f + i goes from corner i of face f to corner i + 1.
using HalfEdge = std::uint32_t;

inline std::uint32_t from_vertex(std::span<const Triple> faces, HalfEdge half)
{
    return faces[half / 3][half % 3];
}

inline std::uint32_t to_vertex(std::span<const Triple> faces, HalfEdge half)
{
    return faces[half / 3][(half % 3 + 1) % 3];
}

class EdgeIndex {
  public:
    /// Holds as long as no face changes its corners. `vertices` is how many there are.
    EdgeIndex(std::span<const Triple> faces, std::size_t vertices)
        : start_(vertices + 1, 0), entries_(3 * faces.size())
    {
        const auto halves = static_cast<HalfEdge>(entries_.size());
        for (HalfEdge half = 0; half < halves; ++half)
            ++start_[std::min(from_vertex(faces, half), to_vertex(faces, half)) + 1];
        for (std::size_t v = 0; v < vertices; ++v)
            start_[v + 1] += start_[v];
        std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
        for (HalfEdge half = 0; half < halves; ++half) {
            const std::uint32_t a = from_vertex(faces, half), b = to_vertex(faces, half);
            entries_[next[std::min(a, b)]++] = {std::max(a, b), half};
        }
        for (std::size_t v = 0; v < vertices; ++v)
            std::sort(entries_.begin() + start_[v], entries_.begin() + start_[v + 1],
                      [](const Entry& a, const Entry& b) {
                          return a.high != b.high ? a.high < b.high : a.half < b.half;
                      });
    }

    /// Calls visit(low vertex, high vertex, span of half-edges in ascending order) once for each edge, edges
    /// in ascending order of their vertices. The two vertices are equal on a face with two equal corners.
    template <typename Visit>
    void for_each(Visit&& visit) const
    {
        std::vector<HalfEdge> group;
        for (std::uint32_t v = 0; v + 1 < start_.size(); ++v) {
            for (std::uint32_t at = start_[v]; at < start_[v + 1];) {
                group.clear();
                const std::uint32_t high = entries_[at].high;
                for (; at < start_[v + 1] && entries_[at].high == high; ++at)
                    group.push_back(entries_[at].half);
                visit(v, high, std::span<const HalfEdge>(group));
            }
        }
    }

  private:
    struct Entry {
        std::uint32_t high;
        HalfEdge half;
    };
    std::vector<std::uint32_t> start_; ///< per lower vertex: its first entry
    std::vector<Entry> entries_;
};

} // namespace phantom::mesh
