// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/mesh.hpp"

#include <algorithm>

#include "mesh/vector.hpp"

namespace phantom::mesh {

double Bounds::extent() const
{
    return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
}

double Bounds::diagonal() const
{
    return distance(low, high);
}

Bounds bounds_of(std::span<const Vec3> vertices)
{
    Bounds bounds;
    if (vertices.empty())
        return bounds;
    bounds.low = bounds.high = vertices.front();
    for (const Vec3& vertex : vertices) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            bounds.low[axis] = std::min(bounds.low[axis], vertex[axis]);
            bounds.high[axis] = std::max(bounds.high[axis], vertex[axis]);
        }
    }
    return bounds;
}

} // namespace phantom::mesh
