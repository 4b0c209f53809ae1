// SPDX-License-Identifier: GPL-2.0-or-later
// Flat coloured shapes and lines of text over a renderer, in pixels from its lower left corner.
#pragma once

#include <string>
#include <vector>

#include <vtkActor2D.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>
#include <vtkUnsignedCharArray.h>

#include "view/colour.hpp"

namespace phantom::view {

enum class Align { left, centre, right };

struct TextLook {
    int pixels = 14; ///< font size
    Colour colour = palette::ink;
    bool bold = false;
    Align align = Align::left;
};

/// Everything drawn since clear(), redrawn with the renderer. Text is anchored at its vertical middle.
class FlatShapes {
  public:
    explicit FlatShapes(vtkRenderer* renderer);

    void clear();
    void rectangle(double x, double y, double width, double height, const Colour& colour);
    void frame(double x, double y, double width, double height, double line, const Colour& colour);
    void disc(double x, double y, double radius, const Colour& colour);
    void text(double x, double y, const std::string& words, const TextLook& look);

  private:
    void polygon(const std::vector<std::array<double, 2>>& corners, const Colour& colour);

    vtkRenderer* renderer_;
    vtkNew<vtkPolyData> shapes_;
    vtkNew<vtkActor2D> actor_;
    std::vector<vtkSmartPointer<vtkTextActor>> texts_; ///< reused from one clear() to the next
    std::size_t texts_used_ = 0;
};

} // namespace phantom::view
