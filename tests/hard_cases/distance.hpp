// SPDX-License-Identifier: GPL-2.0-or-later
// How far a point is from a mesh, and on which side of it: brute force over all faces, in double.
#pragma once

#include <vector>

#include "meshes.hpp"

namespace phantom::hard {

struct Nearest {
    double distance = 1e300; ///< mm
    bool in_front = true;    ///< of the nearest face; of several, of the one that faces the point most
};

/// Fans have no surface and are left out, and so are faces without a plane.
Nearest nearest(const std::vector<reference::Triangle>& mesh, const Vec3& point);

} // namespace phantom::hard
