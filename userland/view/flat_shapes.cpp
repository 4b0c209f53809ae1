// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/flat_shapes.hpp"

#include <cmath>
#include <numbers>

#include <vtkCellData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkTextProperty.h>

namespace phantom::view {

FlatShapes::FlatShapes(vtkRenderer* renderer) : renderer_(renderer)
{
    clear();
    vtkNew<vtkPolyDataMapper2D> mapper;
    mapper->SetInputData(shapes_);
    mapper->SetScalarModeToUseCellData();
    actor_->SetMapper(mapper);
    renderer_->AddActor2D(actor_);
}

void FlatShapes::clear()
{
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> polygons;
    vtkNew<vtkUnsignedCharArray> colours;
    colours->SetNumberOfComponents(3);
    shapes_->SetPoints(points);
    shapes_->SetPolys(polygons);
    shapes_->GetCellData()->SetScalars(colours);
    texts_used_ = 0;
    for (const auto& text : texts_)
        text->VisibilityOff();
}

void FlatShapes::polygon(const std::vector<std::array<double, 2>>& corners, const Colour& colour)
{
    vtkPoints* points = shapes_->GetPoints();
    vtkCellArray* polygons = shapes_->GetPolys();
    polygons->InsertNextCell(static_cast<int>(corners.size()));
    for (const auto& corner : corners)
        polygons->InsertCellPoint(points->InsertNextPoint(corner[0], corner[1], 0));
    for (const double part : colour)
        vtkUnsignedCharArray::SafeDownCast(shapes_->GetCellData()->GetScalars())
            ->InsertNextValue(static_cast<unsigned char>(std::lround(255 * part)));
    points->Modified();
    polygons->Modified();
    shapes_->Modified();
}

void FlatShapes::rectangle(double x, double y, double width, double height, const Colour& colour)
{
    polygon({{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}}, colour);
}

void FlatShapes::frame(double x, double y, double width, double height, double line, const Colour& colour)
{
    rectangle(x, y, width, line, colour);
    rectangle(x, y + height - line, width, line, colour);
    rectangle(x, y, line, height, colour);
    rectangle(x + width - line, y, line, height, colour);
}

void FlatShapes::disc(double x, double y, double radius, const Colour& colour)
{
    constexpr int sides = 40;
    std::vector<std::array<double, 2>> corners;
    for (int i = 0; i < sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        corners.push_back({x + radius * std::cos(angle), y + radius * std::sin(angle)});
    }
    polygon(corners, colour);
}

void FlatShapes::text(double x, double y, const std::string& words, const TextLook& look)
{
    if (texts_used_ == texts_.size()) {
        texts_.push_back(vtkSmartPointer<vtkTextActor>::New());
        renderer_->AddActor2D(texts_.back());
    }
    vtkTextActor* actor = texts_[texts_used_++];
    actor->VisibilityOn();
    actor->SetInput(words.c_str());
    actor->SetPosition(x, y);
    vtkTextProperty* property = actor->GetTextProperty();
    property->SetFontFamilyToArial();
    property->SetFontSize(look.pixels);
    set_colour(property, look.colour);
    property->SetBold(look.bold);
    property->SetVerticalJustificationToCentered();
    switch (look.align) {
    case Align::left:
        property->SetJustificationToLeft();
        break;
    case Align::centre:
        property->SetJustificationToCentered();
        break;
    case Align::right:
        property->SetJustificationToRight();
        break;
    }
}

} // namespace phantom::view
