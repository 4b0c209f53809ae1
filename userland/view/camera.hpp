// SPDX-License-Identifier: GPL-2.0-or-later
// Where the pictures are taken from.
#pragma once

#include <span>

#include <vtkRenderer.h>

#include "view/camera_angles.hpp"
#include "view/vector.hpp"

namespace phantom::view {

/// Places the camera so that the points fill the renderer's viewport with a small margin.
/// Aspect: width / height of the viewport.
void frame_all(vtkRenderer* renderer, std::span<const Vec3> points, const CameraAngles& angles,
               double aspect);

/// A close-up of a spot on the surface from its side, normal upward: parallel projection, so that
/// one scale bar holds everywhere. half_height_mm: from the picture's middle to its upper edge.
void frame_spot(vtkRenderer* renderer, const Vec3& centre, const Vec3& normal, const Vec3& towards_viewer,
                double half_height_mm);

} // namespace phantom::view
