// SPDX-License-Identifier: GPL-2.0-or-later
// Every colour of the application in one place. Things told apart by colour use the Okabe-Ito set
// (Okabe and Ito 2002), amounts use viridis (Smith and van der Walt 2015): both can be read with
// any common colour blindness, and viridis in grey too.
#pragma once

#include <array>

namespace phantom::view {

using Colour = std::array<double, 3>; ///< red, green, blue, sRGB, 0 ... 1

namespace palette {
inline constexpr Colour background_top{0.965, 0.970, 0.976};
inline constexpr Colour background_bottom{0.820, 0.842, 0.868};
inline constexpr Colour panel{0.992, 0.993, 0.995};
inline constexpr Colour rule{0.78, 0.80, 0.83};
inline constexpr Colour ink{0.13, 0.15, 0.19};
inline constexpr Colour faint_ink{0.40, 0.43, 0.48};
inline constexpr Colour surface{0.790, 0.770, 0.735};
inline constexpr Colour tip{0.000, 0.447, 0.698};      ///< Okabe-Ito blue
inline constexpr Colour proxy{0.000, 0.620, 0.451};    ///< Okabe-Ito bluish green
inline constexpr Colour force{0.835, 0.369, 0.000};    ///< Okabe-Ito vermilion
inline constexpr Colour selected{0.337, 0.706, 0.914}; ///< Okabe-Ito sky blue
inline constexpr Colour selected_edge{0.05, 0.25, 0.42};
inline constexpr Colour component_x{0.902, 0.624, 0.000}; ///< Okabe-Ito orange
inline constexpr Colour component_y{0.000, 0.620, 0.451}; ///< Okabe-Ito bluish green
inline constexpr Colour component_z{0.800, 0.475, 0.655}; ///< Okabe-Ito reddish purple
inline constexpr Colour path_in_air{0.45, 0.47, 0.51};
inline constexpr Colour warning{0.70, 0.13, 0.09};
inline constexpr Colour crease{0.10, 0.12, 0.16};
inline constexpr Colour fault{0.80, 0.00, 0.55};
/// Where triangles are too fine for the hand, the finest first: Okabe-Ito vermilion, orange, and a light
/// orange.
inline constexpr std::array<Colour, 3> thin{
    {{0.835, 0.369, 0.000}, {0.902, 0.624, 0.000}, {0.965, 0.850, 0.520}}};
} // namespace palette

/// The colour map of forces: viridis at `fraction`, clamped to 0 ... 1; NaN counts as 0.
Colour viridis(double fraction);

/// thing->SetColor(...), for the many VTK classes that have it.
template <typename Thing>
void set_colour(Thing* thing, const Colour& colour)
{
    thing->SetColor(colour[0], colour[1], colour[2]);
}

} // namespace phantom::view
