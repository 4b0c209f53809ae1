// SPDX-License-Identifier: GPL-2.0-or-later
// Touch: one moment of the tip at the surface, live or out of a trace. What every picture shows.
#pragma once

#include "base/vector.hpp"

namespace phantom::view {

struct Touch {
    double time_s = 0;
    Vec3 tip_mm{};
    Vec3 proxy_mm{}; ///< equals the tip outside the surface
    Vec3 force_n{};
    unsigned contacts = 0;
    bool inside = false; ///< the tip is below the surface, the proxy holds it

    [[nodiscard]] double force_norm_n() const { return length(force_n); }
    /// Where the hierarchy is asked for the nearest triangles, as the feeder does: inside the
    /// surface the set must cover tip and proxy, so the middle of both.
    [[nodiscard]] Vec3 query_centre_mm() const { return inside ? 0.5 * (tip_mm + proxy_mm) : tip_mm; }
};

} // namespace phantom::view
