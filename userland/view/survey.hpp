// SPDX-License-Identifier: GPL-2.0-or-later
// What preparation made of a scene, edge by edge and face by face: where its creases and its rims are, where
// it is not sound, and where its triangles are too fine for a hand in a hurry.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/vector.hpp"
#include "scene/scene.hpp"
#include "view/colour.hpp"

namespace phantom::view {

/// An edge in the world, mm.
struct SurveyLine {
    Vec3 from, to;
};

/// Faces by the speed that a set's triangles last for, see scene/coverage.hpp.
struct SpeedBand {
    double from_mm_s; ///< up to the next band's
    Colour colour;
    double area_part = 0; ///< of the scene's surface
};

struct Survey {
    std::vector<SurveyLine>
        creases;                  ///< whose two faces keep normals of their own, more than 10 degrees apart
    std::vector<SurveyLine> rims; ///< where the surface ends
    std::vector<SurveyLine>
        faults;            ///< without a neighbour though the surface goes on: not manifold, not welded
    std::size_t loops = 0; ///< of the rims
    std::vector<std::vector<unsigned char>> bands; ///< per object and face: index into `speeds`
    std::array<SpeedBand, 4> speeds;               ///< ascending
    std::vector<std::string> repairs;              ///< what preparation did: "12 faces turned"
};

/// budget: triangles in a set; feed_hz: sets a second.
Survey survey_of(const scene::Scene& scene, std::uint32_t budget, double feed_hz);

} // namespace phantom::view
