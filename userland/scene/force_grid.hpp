// SPDX-License-Identifier: GPL-2.0-or-later
// Forces at the nodes of a grid along the axes, from a CSV file with the header
//
//   x_mm,y_mm,z_mm,fx_N,fy_N,fz_N
//
// and a row for every node, in any order. Along each axis the nodes are evenly spaced.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/result.hpp"

namespace phantom::scene {

struct ForceGrid {
    std::array<double, 3> corner_mm{};          ///< node 0 0 0
    std::array<double, 3> spacing_mm{};         ///< 0.1 mm at least
    std::array<std::uint32_t, 3> nodes{};       ///< 2 or more; force_grid_nodes_max in all
    std::vector<std::array<double, 3>> force_n; ///< x fastest

    [[nodiscard]] double shortest_side_mm() const;
    /// Largest part of a force, N, and largest change of one along an axis, N/mm.
    [[nodiscard]] double force_max_n() const;
    [[nodiscard]] double slope_max_n_mm() const;
};

inline constexpr std::size_t force_grid_nodes_max = 4096; ///< PHANTOM_FIELD_NODES_MAX
inline constexpr double force_grid_spacing_min_mm = 0.1;  ///< PHANTOM_FIELD_SPACING_MIN_NM
inline constexpr double force_grid_side_max_mm = 1000;    ///< as Range region_mm

/// Errors: "file:line: what was expected", or of the whole the file alone.
Result<ForceGrid> read_force_grid(const std::filesystem::path& file);

} // namespace phantom::scene
