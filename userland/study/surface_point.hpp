// SPDX-License-Identifier: GPL-2.0-or-later
// The nearest point of a scene's surface, with its normal; and what a ray meets, by sphere tracing.
#pragma once

#include <array>
#include <optional>

#include "base/vector.hpp"
#include "fdh/scene_tree.hpp"
#include "scene/scene.hpp"

namespace phantom::study {

struct SurfacePoint {
    Vec3 position_mm{};
    Vec3 normal{}; ///< unit, interpolated between the corners'
};

class Surface {
  public:
    Surface(const scene::Scene& scene, const fdh::SceneTree<14>& tree);

    /// Nothing when no triangle lies within `within_mm`.
    std::optional<SurfacePoint> nearest(const Vec3& point_mm, double within_mm);

    /// The first point along a ray (direction unit) not farther than `length_mm`. Sphere tracing: no triangle
    /// is nearer than the nearest one, so the ray may step that far.
    std::optional<SurfacePoint> trace(const Vec3& start_mm, const Vec3& direction, double length_mm);

    /// A point of a face in world coordinates; weights of its corners, sum 1.
    [[nodiscard]] SurfacePoint on_face(std::uint32_t object, std::uint32_t face, const Vec3& weights) const;

  private:
    const scene::Scene& scene_;
    const fdh::SceneTree<14>& tree_;
    fdh::Nearest found_;
};

} // namespace phantom::study
