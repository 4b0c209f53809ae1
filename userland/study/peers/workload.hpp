// SPDX-License-Identifier: GPL-2.0-or-later
// Where the tip is in each query, and how far it looks.
#pragma once

#include <cstddef>
#include <vector>

#include "study/peers/mesh.hpp"

namespace phantom::peers {

/// The part of the mesh's diagonal that a walk moves by between queries: a hand at 100 mm/s over a mesh of
/// 200 mm, asked every millisecond.
inline constexpr double walk_step_part = 5e-4;

struct Workload {
    double radius = 0;   ///< [mm], of the median sphere round a surface point that holds 64 triangles
    double accuracy = 0; ///< [mm], that the hull library promises for distances up to the radius
    std::vector<fdh::Point> walk; ///< strokes along the surface, one after the other
    std::vector<fdh::Point> jump; ///< points of random triangles
};

/// `strokes` walks of `steps` points each, and as many jumps. Points are float32 values. The same for the
/// same mesh. The mesh has at least one triangle.
Workload make_workload(const Mesh& mesh, std::size_t strokes, std::size_t steps);

} // namespace phantom::peers
