// SPDX-License-Identifier: GPL-2.0-or-later
// An open sheet that can be touched from both sides.
#pragma once

#include "mesh/mesh.hpp"

namespace phantom::mesh {

/// Adds a back to every face: the same corners the other way round, its normals turned over. Back f + n
/// belongs to face f of n. Backs are neighbours where faces are, and a face is its own back's neighbour at a
/// boundary: the sheet becomes a closed body without thickness, and make_fans() goes round its rim. An edge
/// of three and more faces counts as a boundary of each. Fails (false, nothing changed) when numbers of faces
/// would not fit.
bool make_two_sided(Mesh& mesh);

} // namespace phantom::mesh
