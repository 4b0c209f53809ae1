// SPDX-License-Identifier: GPL-2.0-or-later
// What objects that move ask of a set: coverage goes along with them (phantom_abi.h, MOVING OBJECTS), so it
// is the tip's way against each that counts.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scene/live_scene.hpp"

namespace phantom::feeder {

/// One round of the slow loop.
struct TipRound {
    std::shared_ptr<const scene::Moment> moment;
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

    /// Looks at every object for the round in hand; the one before is remembered. reach_mm: within that of a
    /// surface something is felt.
    void look(const TipRound& round, double reach_mm);

    /// Those that may be felt before the next round; in order.
    [[nodiscard]] const std::vector<std::uint32_t>& near() const { return near_; }
    /// Of these, the farthest that the tip came along since the round before.
    [[nodiscard]] double way_mm() const { return way_mm_; }
    /// Of these, the fastest that the tip is against what is there of them.
    [[nodiscard]] double speed_mm_s() const { return speed_mm_s_; }
    /// Of these, how far the tip of the round before is from a set's centre, both seen from the object.
    [[nodiscard]] double previous_mm(const Vec3& centre_mm) const;

  private:
    /// A ball round an object, in its frame.
    struct Body {
        std::uint32_t object;
        Vec3 centre_mm;
        double radius_mm;
    };
    [[nodiscard]] const scene::Placement& placement(std::uint32_t object) const
    {
        return *round_.moment->objects[object].placement;
    }

    std::vector<Body> bodies_;
    TipRound round_;
    std::vector<Vec3> tips_; ///< of the round before, seen from each body; empty in the first
    std::vector<Vec3> tips_now_;
    std::vector<std::uint32_t> near_;
    std::vector<Vec3> near_previous_; ///< tips_ of these
    double way_mm_ = 0, speed_mm_s_ = 0;
};

} // namespace phantom::feeder
