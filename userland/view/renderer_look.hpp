// SPDX-License-Identifier: GPL-2.0-or-later
// Light and background, the same in every picture.
#pragma once

#include <vtkRenderer.h>

#include "view/colour.hpp"

namespace phantom::view {

/// A warm key light over the left shoulder, fill and back lights that leave no black.
void light(vtkRenderer* renderer);

/// A gradient from the lower to the upper edge.
void set_background(vtkRenderer* renderer, const Colour& bottom, const Colour& top);

} // namespace phantom::view
