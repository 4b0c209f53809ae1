// SPDX-License-Identifier: GPL-2.0-or-later
// The formula of a NURBS patch (Piegl and Tiller 1997, "The NURBS Book", chapters 2 to 4).
#pragma once

#include "scene/shapes/shape.hpp"

namespace phantom::scene {

/// Position, first derivatives and the mixed second one.
struct SurfacePoint {
    mesh::Vec3 position, u, v, uv;
};

/// At parameters within the closed knot spans [knots[span], knots[span + 1]]: at a knot the derivatives are
/// those of the side that the span lies on.
SurfacePoint surface_point(const NurbsPatch& patch, std::uint32_t span_u, double u, std::uint32_t span_v,
                           double v);

/// A part of a knot span, 0 and 1 its ends.
struct Window {
    double low = 0, high = 1;
};

/// Bounds, in mm over the whole span: triangles over 1/nu by 1/nv of the span that lie within the windows are
/// within (uu / nu^2 + 2 uv / (nu nv) + vv / nv^2) / 8 of the patch. The smaller the windows, the tighter.
struct Bend {
    double uu, uv, vv;
};
Bend bend_of(const NurbsPatch& patch, std::uint32_t span_u, const Window& u, std::uint32_t span_v,
             const Window& v);

/// How the patch ends, by its control points: exactly equal ones only.
struct Ends {
    bool closed_u = false, closed_v = false; ///< first and last row or column are the same: a seam
    std::array<bool, 2> pole_u{}, pole_v{};  ///< the edge at the low or high end of u (of v) is one point

    /// No rim is left.
    [[nodiscard]] bool encloses() const
    {
        const bool u_shut = closed_u || (pole_u[0] && pole_u[1]),
                   v_shut = closed_v || (pole_v[0] && pole_v[1]);
        return u_shut && v_shut;
    }
};
Ends ends_of(const NurbsPatch& patch);

} // namespace phantom::scene
