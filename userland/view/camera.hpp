// SPDX-License-Identifier: GPL-2.0-or-later
// Where the pictures are taken from.
#pragma once

#include <span>

#include <vtkRenderer.h>

#include "base/vector.hpp"
#include "view/camera_angles.hpp"

namespace phantom::view {

/// A viewport in pixels, and what words take of it above and below.
struct Room {
    double width = 1, height = 1, header = 0, footer = 0;
};

/// Places the camera so that the points fill the room that is left, with a small margin.
void frame_all(vtkRenderer* renderer, std::span<const Vec3> points, const CameraAngles& angles,
               const Room& room);

/// A close-up of a spot on the surface from its side, normal upward: parallel projection, so that
/// one scale bar holds everywhere. half_height_mm: from the picture's middle to its upper edge.
void frame_spot(vtkRenderer* renderer, const Vec3& centre, const Vec3& normal, const Vec3& towards_viewer,
                double half_height_mm);

} // namespace phantom::view
