// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "mesh/steps.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

std::uint64_t mixed(std::uint64_t a)
{
    // Finalizer of MurmurHash3 (Appleby, public domain).
    a = (a ^ a >> 33) * 0xff51afd7ed558ccdULL;
    a = (a ^ a >> 33) * 0xc4ceb9fe1a85ec53ULL;
    return a ^ a >> 33;
}

/// Open addressing over vertex numbers; the key is whatever `hash` was made of. Never removes.
class VertexTable {
  public:
    explicit VertexTable(std::size_t vertices) : slots_(std::bit_ceil(2 * vertices + 1), no_neighbour) {}

    void insert(std::uint64_t hash, std::uint32_t vertex)
    {
        std::size_t slot = hash & (slots_.size() - 1);
        while (slots_[slot] != no_neighbour)
            slot = (slot + 1) & (slots_.size() - 1);
        slots_[slot] = vertex;
    }

    /// The smallest vertex of the chain for which fits(vertex) holds, or no_neighbour.
    template <typename Fits>
    std::uint32_t find(std::uint64_t hash, Fits&& fits) const
    {
        std::uint32_t best = no_neighbour;
        for (std::size_t slot = hash & (slots_.size() - 1); slots_[slot] != no_neighbour;
             slot = (slot + 1) & (slots_.size() - 1)) {
            if (slots_[slot] < best && fits(slots_[slot]))
                best = slots_[slot];
        }
        return best;
    }

  private:
    std::vector<std::uint32_t> slots_;
};

/// Each vertex's representative: the first vertex with the same coordinates (-0 equals 0).
std::vector<std::uint32_t> weld_equal(const std::vector<Vec3>& vertices)
{
    VertexTable table(vertices.size());
    std::vector<std::uint32_t> to(vertices.size());
    for (std::uint32_t v = 0; v < vertices.size(); ++v) {
        std::uint64_t hash = 0;
        for (const double x : vertices[v])
            hash = mixed(hash + std::bit_cast<std::uint64_t>(x + 0.0));
        const std::uint32_t same =
            table.find(hash, [&](std::uint32_t other) { return vertices[other] == vertices[v]; });
        to[v] = same == no_neighbour ? v : same;
        if (same == no_neighbour)
            table.insert(hash, v);
    }
    return to;
}

/// Each vertex's representative: the first representative within weld_mm. Cells are as wide as the
/// distance, so candidates lie in the 27 cells round the vertex.
std::vector<std::uint32_t> weld_near(const std::vector<Vec3>& vertices, double weld_mm)
{
    VertexTable table(vertices.size());
    std::vector<std::uint32_t> to(vertices.size());
    const auto cell_hash = [](double x, double y, double z) {
        std::uint64_t hash = 0;
        for (const double c : {x, y, z})
            hash = mixed(hash + std::bit_cast<std::uint64_t>(c + 0.0));
        return hash;
    };
    for (std::uint32_t v = 0; v < vertices.size(); ++v) {
        // Cell numbers stay doubles: they may be larger than any integer type.
        const Vec3 cell = {std::floor(vertices[v][0] / weld_mm), std::floor(vertices[v][1] / weld_mm),
                           std::floor(vertices[v][2] / weld_mm)};
        std::uint32_t best = no_neighbour;
        for (int k = 0; k < 27; ++k) {
            const int x = k % 3 - 1, y = k / 3 % 3 - 1, z = k / 9 - 1;
            const std::uint64_t hash = cell_hash(cell[0] + x, cell[1] + y, cell[2] + z);
            best = std::min(best, table.find(hash, [&](std::uint32_t other) {
                return distance(vertices[other], vertices[v]) <= weld_mm;
            }));
        }
        to[v] = best == no_neighbour ? v : best;
        if (best == no_neighbour)
            table.insert(cell_hash(cell[0], cell[1], cell[2]), v);
    }
    return to;
}

} // namespace

void drop_unused_vertices(Soup& soup)
{
    std::vector<std::uint32_t> number(soup.vertices.size(), no_neighbour);
    for (const Triple& face : soup.faces) {
        for (const std::uint32_t v : face)
            number[v] = 0;
    }
    std::uint32_t kept = 0;
    for (std::uint32_t v = 0; v < number.size(); ++v) {
        if (number[v] == no_neighbour)
            continue;
        soup.vertices[kept] = soup.vertices[v];
        number[v] = kept++;
    }
    soup.vertices.resize(kept);
    for (Triple& face : soup.faces) {
        for (std::uint32_t& v : face)
            v = number[v];
    }
}

void weld(Soup& soup, double weld_mm, Report& report)
{
    const std::vector<std::uint32_t> to =
        weld_mm > 0 ? weld_near(soup.vertices, weld_mm) : weld_equal(soup.vertices);
    for (std::uint32_t v = 0; v < to.size(); ++v)
        report.vertices_welded += to[v] != v;
    if (weld_mm > 0) {
        for (std::uint32_t v = 0; v < to.size(); ++v)
            report.moved_max_mm =
                std::max(report.moved_max_mm, distance(soup.vertices[v], soup.vertices[to[v]]));
    }
    for (Triple& face : soup.faces) {
        for (std::uint32_t& v : face)
            v = to[v];
    }
}

} // namespace phantom::mesh
