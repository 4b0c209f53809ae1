// SPDX-License-Identifier: GPL-2.0-or-later
// Which point of the scene lies under a line of sight.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/vector.hpp"
#include "scene/scene.hpp"
#include "view/scene_actors.hpp"

namespace phantom::view {

class SurfacePicker {
  public:
    /// surfaces: one per object of the scene, in its frame; shared, not copied.
    SurfacePicker(const scene::Scene& scene, const SceneActors& surfaces);
    ~SurfacePicker();

    /// What moves is looked for where it is then. A shape that changed was changed in `surfaces`.
    void follow(const scene::Scene& scene, const scene::Moment& moment);

    /// The first point of the surface on the way from `from` to `to`, world mm.
    [[nodiscard]] std::optional<Vec3> first_hit(const Vec3& from, const Vec3& to) const;

  private:
    struct Part;
    std::vector<std::unique_ptr<Part>> parts_;
};

} // namespace phantom::view
