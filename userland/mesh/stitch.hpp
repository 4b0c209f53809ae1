// SPDX-License-Identifier: GPL-2.0-or-later
// Closing what only looks closed: cracks between boundary vertices that are almost equal, and T-junctions,
// where a boundary vertex lies on another face's boundary edge. Both let a tip feel an end of the surface
// where there is none.
#pragma once

#include <vector>

#include "mesh/edge_index.hpp"
#include "mesh/prepare.hpp"

namespace phantom::mesh {

/// What counts as the same place: the weld distance, but at least a millionth of the mesh's diagonal, a few
/// times what float coordinates round to.
double stitch_tolerance_mm(const Soup& soup, double weld_mm);

/// Closes what lies within the tolerance, one round: what one round has moved can bring the next something to
/// do. Vertices are sewn onto the lowest of them, never farther than a quarter of the shortest edge there;
/// edges are cut where another face's boundary goes on along them. Counts vertices_sewn, t_junctions,
/// faces_cut and moved_max_mm. Children take their parent's place in the order. `edges` is the soup's; it is
/// no longer when true is returned: something was changed. Costs one pass over the edges where there is no
/// boundary.
bool stitch(Soup& soup, const EdgeIndex& edges, double tolerance_mm, Report& report);

/// The two parts of it. `boundary`: half-edges without another on the same edge. Each returns whether it
/// changed something.
bool sew_cracks(Soup& soup, const std::vector<HalfEdge>& boundary, double tolerance_mm, Report& report);
bool cut_t_junctions(Soup& soup, const std::vector<HalfEdge>& boundary, double tolerance_mm, Report& report);

} // namespace phantom::mesh
