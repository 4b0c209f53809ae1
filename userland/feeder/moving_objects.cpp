// SPDX-License-Identifier: GPL-2.0-or-later
#include "feeder/moving_objects.hpp"

#include <algorithm>
#include <utility>

#include "scene/coverage.hpp"

namespace phantom::feeder {

MovingObjects::MovingObjects(const scene::Scene& scene)
{
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
        const scene::Object& object = scene.objects[i];
        if (!object.motion || object.mesh.vertices.empty())
            continue;
        const mesh::Bounds bounds = mesh::bounds_of(object.mesh.vertices);
        const fdh::Pose& pose = object.pose;
        const Vec3 middle = 0.5 * (bounds.low + bounds.high);
        Vec3 turned{};
        for (std::size_t row = 0; row < 3; ++row)
            turned[row] = pose.rotation[3 * row] * middle[0] + pose.rotation[3 * row + 1] * middle[1] +
                          pose.rotation[3 * row + 2] * middle[2];
        const double swell_mm = object.deformation ? object.deformation->amplitude_mm : 0.0;
        bodies_.push_back({i, turned + pose.translation - object.motion->centre_mm,
                           0.5 * length(bounds.high - bounds.low) + swell_mm});
    }
}

MovingObjects::Reach MovingObjects::farthest() const
{
    Reach out;
    for (const Body& body : bodies_)
        if (const double mm = length(body.centre_mm) + body.radius_mm; mm > out.mm)
            out = {body.object, mm};
    return out;
}

void MovingObjects::look(const TipRound& round, double reach_mm)
{
    near_.clear();
    way_mm_ = speed_mm_s_ = 0;
    const bool first = tips_.empty();
    tips_.resize(bodies_.size());
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const scene::Placement& now = *round.moment.objects[bodies_[i].object].placement;
        const Vec3 tip = now.to_frame(round.tip_mm);
        const double speed = length(round.velocity_mm_s - now.velocity_at(round.tip_mm));
        const double come = first ? 0.0 : length(tip - tips_[i]);
        const double way = scene::way_margin * std::max(come, speed * round.delay_s);
        tips_[i] = tip;
        if (length(tip - bodies_[i].centre_mm) > bodies_[i].radius_mm + reach_mm + way)
            continue;
        near_.push_back(bodies_[i].object);
        way_mm_ = std::max(way_mm_, way);
        speed_mm_s_ = std::max(speed_mm_s_, speed);
    }
}

} // namespace phantom::feeder
