// SPDX-License-Identifier: GPL-2.0-or-later
// The path of a trace: a thin grey line in the air, a tube coloured by |F| in contact. It runs through the
// proxy, which is the tip outside the surface and stays visible where the tip goes below it.
#pragma once

#include <vtkRenderer.h>

#include "view/trace.hpp"

namespace phantom::view {

/// Adds the path to a renderer. width_mm: radius of the tube; max_force_n: the top of the colour map.
void add_path(vtkRenderer* renderer, const Trace& trace, double width_mm, double max_force_n);

} // namespace phantom::view
