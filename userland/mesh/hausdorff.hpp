// SPDX-License-Identifier: GPL-2.0-or-later
// How far two surfaces lie from each other, by samples (as Metro does: Cignoni, Rocchini and Scopigno 1998,
// "Metro: measuring error on simplified surfaces").
#pragma once

#include <cstddef>

#include "fdh/tree.hpp"
#include "mesh/mesh.hpp"

namespace phantom::mesh {

/// How far the surface of `from` lies from that of `to` at most, mm: the one-sided Hausdorff distance, of
/// about so many samples: the vertices, and of every face the centres of the 1, 4, 9 ... equal parts that
/// it is cut into. With fewer samples than there are vertices and faces it is every n-th of them. Each
/// distance is exact, so the result is never too large; it is too small by the distance between samples at
/// most. to_tree is of `to`. The same for any number of threads (0: all cores). 0 when `from` has no face,
/// infinity when only `to` has none.
double one_sided_hausdorff_mm(const Mesh& from, const Mesh& to, const fdh::TriangleTree<14>& to_tree,
                              std::size_t samples, unsigned threads = 0);

} // namespace phantom::mesh
