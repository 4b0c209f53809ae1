// SPDX-License-Identifier: GPL-2.0-or-later
// The probe in one renderer: tip (a point in a sphere of the contact radius), proxy, and the force arrow
// with its label in newton.
#pragma once

#include <vtkActor.h>
#include <vtkArrowSource.h>
#include <vtkNew.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>

#include "view/touch.hpp"

namespace phantom::view {

/// Sizes in mm of the world, chosen for the renderer's scale.
struct ProbeSizes {
    double radius_mm = 1;        ///< R, the sphere round the tip
    double point_mm = 0.1;       ///< radius of the dots of tip and proxy
    double arrow_mm_per_n = 1;   ///< length of the arrow
    double arrow_width_mm = 0.1; ///< radius of its shaft
};

class ProbeActors {
  public:
    /// ball_opacity: 1 spares a renderer the pass for see-through things, most of a frame drawn in software.
    ProbeActors(vtkRenderer* renderer, double ball_opacity);

    /// Size of the label and width of the line between tip and proxy, in pixels.
    void set_scale(int font_px, double line_px);
    void show(const Touch& touch, const ProbeSizes& sizes);
    /// Off: no label beside the arrow (the other renderer has it).
    void set_label_visible(bool visible) { label_wanted_ = visible; }

  private:
    void place_arrow(const Touch& touch, const ProbeSizes& sizes);

    vtkNew<vtkActor> ball_, tip_, proxy_, link_, arrow_;
    vtkNew<vtkArrowSource> arrow_shape_;
    vtkNew<vtkTextActor> label_;
    bool label_wanted_ = true;
};

} // namespace phantom::view
