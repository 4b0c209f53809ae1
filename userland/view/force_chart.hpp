// SPDX-License-Identifier: GPL-2.0-or-later
// Force over time as a line chart.
#pragma once

#include <deque>
#include <optional>
#include <span>

#include <vtkChartXY.h>
#include <vtkContextActor.h>
#include <vtkNew.h>
#include <vtkRenderer.h>
#include <vtkTable.h>

#include "view/colour.hpp"
#include "view/flat_shapes.hpp"
#include "view/touch.hpp"

namespace phantom::view {

class ForceChart {
  public:
    enum class Lines { norm, norm_and_components };
    ForceChart(vtkRenderer* renderer, Lines lines);

    /// Size of words and width of thin lines, in pixels.
    void set_scale(int font_px, double line_px);
    /// Size of the renderer's viewport in pixels; the chart fills it. After set_scale().
    void set_size(int width, int height);
    /// Draws the samples (times ascending) over [from_s, to_s]; full_scale_n: the least height of the axis.
    void show(const std::deque<Touch>& samples, double from_s, double to_s, double full_scale_n);
    /// A vertical line at that time, or none.
    void mark(std::optional<double> time_s);

  private:
    void add_line(int column, const Colour& colour, const char* name);

    Lines lines_;
    FlatShapes words_;
    int font_px_ = 13;
    vtkNew<vtkChartXY> chart_;
    vtkNew<vtkContextActor> actor_;
    vtkNew<vtkTable> table_, marker_;
    std::optional<double> marked_s_;
};

} // namespace phantom::view
