// SPDX-License-Identifier: GPL-2.0-or-later
// What objects that move ask of a set: coverage goes along with them (phantom_abi.h, MOVING OBJECTS), so it
// is the tip's way against each that counts.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/live_scene.hpp"

namespace phantom::feeder {

/// One round of the slow loop.
struct TipRound {
    const scene::Moment& moment;
    Vec3 tip_mm{};
    Vec3 velocity_mm_s{};
    double delay_s = 0; ///< until the next round
};

class MovingObjects {
  public:
    explicit MovingObjects(const scene::Scene& scene);
    [[nodiscard]] bool none() const { return bodies_.empty(); }
    /// How far an object of the scene may be from its frame's origin, and which.
    struct Reach {
        std::uint32_t object = 0;
        double mm = 0;
    };
    [[nodiscard]] Reach farthest() const;

    /// Looks at every object for the round in hand; where the tip was in the one before is remembered.
    /// reach_mm: within that of a surface something is felt.
    void look(const TipRound& round, double reach_mm);

    /// Those that may be felt before the next round; in order.
    [[nodiscard]] const std::vector<std::uint32_t>& near() const { return near_; }
    /// Of these, the farthest that the tip may go along until the next round: as far as since the last one,
    /// or at the speed of now, and scene::way_margin more.
    [[nodiscard]] double way_mm() const { return way_mm_; }
    /// Of these, the fastest that the tip is against what is there of them.
    [[nodiscard]] double speed_mm_s() const { return speed_mm_s_; }

  private:
    /// A ball round an object, in its frame.
    struct Body {
        std::uint32_t object;
        Vec3 centre_mm;
        double radius_mm;
    };

    std::vector<Body> bodies_;
    std::vector<Vec3> tips_; ///< of the round before, seen from each body; empty in the first
    std::vector<std::uint32_t> near_;
    double way_mm_ = 0, speed_mm_s_ = 0;
};

} // namespace phantom::feeder
