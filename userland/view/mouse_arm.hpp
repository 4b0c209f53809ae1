// SPDX-License-Identifier: GPL-2.0-or-later
// From mouse to space: where in the world the hand wants the arm.
#pragma once

#include <vtkRenderer.h>

#include "base/vector.hpp"
#include "view/surface_picker.hpp"

namespace phantom::view {

/// Keeps a plane parallel to the screen and where on it the cursor points. Positions in pixels of the
/// window, points in world mm.
class MouseArm {
  public:
    MouseArm(vtkRenderer* renderer, const SurfacePicker& picker, const Vec3& tip_mm);

    /// The plane goes through the surface under the cursor; beside the scene, through the tip.
    void press(double x, double y, const Vec3& tip_mm);
    void drag(double x, double y);
    /// Shifts the plane away from the viewer.
    void push(double mm) { depth_mm_ += mm; }
    void set_depth(double mm) { depth_mm_ = mm; }

    [[nodiscard]] Vec3 target_mm() const { return point_ + depth_mm_ * into_; }

  private:
    struct Sight {
        Vec3 from{}, to{}; ///< on the near and far clipping plane
    };
    [[nodiscard]] Sight sight(double x, double y) const;

    vtkRenderer* renderer_;
    const SurfacePicker& picker_;
    Vec3 point_;          ///< under the cursor, before the push
    Vec3 into_{0, 0, -1}; ///< the camera's direction when pressed
    double depth_mm_ = 0;
};

} // namespace phantom::view
