// SPDX-License-Identifier: GPL-2.0-or-later
// Detail follows speed: the finest level of an object's chain of simplifications whose sets last until the
// next set is there.
//
// A set of so many triangles holds the surface within `reach` of a point of it: the finer the triangles, the
// shorter. Until the next set comes the tip goes on by way = speed * delay. What it then needs
// (phantom_abi.h, COVERAGE) must still be in the set in use:
//
//   outside   the ball of the contact radius R round the tip:
//                                              reach >= R + way
//   inside    tip and proxy, seen from the middle of the two, which the set is centred at: that is depth / 2
//             over the surface, so that the set covers sqrt(reach^2 + depth^2 / 4) of it. Along the surface
//             the tip comes sqrt(depth^2 / 4 + way^2) away from there, and the proxy goes with it; what it
//             dives counts in full:
//                                              reach^2 >= way^2 + depth * dive
//
// On a round surface the proxy goes faster than the tip under it, by radius / (radius - depth), and hands
// speed up: `way` is taken larger than it is by scene::way_margin.
#pragma once

#include <cstddef>
#include <vector>

#include "scene/coverage.hpp"
#include "scene/levels.hpp"

namespace phantom::feeder {

struct DetailLevel {
    double reach_mm = 0; ///< what a set covers at 99 of 100 points of the surface
    double error_mm = 0; ///< how far the level lies from the mesh
};

/// Of a scene's levels, finest first.
std::vector<DetailLevel> details_of(const scene::Levels& levels);

/// What the tip does.
struct LevelDemand {
    double speed_mm_s = 0;        ///< of tip or proxy, whichever is faster
    double delay_s = 0;           ///< from the moment speed and place were known until the next set is in use
    double contact_radius_mm = 0; ///< largest of the scene
    double depth_mm = 0;          ///< from proxy to tip; 0 outside
    double dive_mm_s = 0;         ///< the speed's part away from the proxy; not below 0
};

/// The reach that a set must have at least.
double reach_needed_mm(const LevelDemand& demand);

class LevelChoice {
  public:
    static constexpr double way_margin = scene::way_margin;
    /// A finer level is taken only where it would do for a demand that much larger: a tip whose speed wavers
    /// stays on one level.
    static constexpr double finer_margin = 1.25;
    /// And only after as many sets in a row: a hand that turns round stands still for a moment.
    static constexpr unsigned finer_sets = 8;

    /// Finest first, at least one; reach grows.
    explicit LevelChoice(std::vector<DetailLevel> levels);
    /// The number of the level for the next set; the coarsest if none reaches far enough. The finest for the
    /// first one, if it does.
    std::size_t choose(const LevelDemand& demand);
    [[nodiscard]] std::size_t current() const { return current_; }
    [[nodiscard]] const DetailLevel& level(std::size_t number) const { return levels_[number]; }

  private:
    std::vector<DetailLevel> levels_;
    std::size_t current_ = 0;
    std::size_t finer_ = 0;  ///< the level that would have done for all of the last sets,
    unsigned finer_for_ = 0; ///< as many as these
};

} // namespace phantom::feeder
