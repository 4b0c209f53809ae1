// SPDX-License-Identifier: GPL-2.0-or-later
// Meshes whose sharp edges keep the normals of their faces, with the fans that fill the gaps between them.
#pragma once

#include "meshes.hpp"

namespace phantom::hard {

/// Faces, then the fans of their creases: what the user side's preparation makes of the shape.
std::vector<reference::Triangle> creased(const Shape& shape, double crease_deg, double stiffness,
                                         double radius, bool two_sided = false);

} // namespace phantom::hard
