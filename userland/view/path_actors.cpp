// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/path_actors.hpp"

#include <algorithm>
#include <vector>

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkTubeFilter.h>

#include "view/colour.hpp"

namespace phantom::view {

namespace {

struct Knot {
    Vec3 at{};
    double force_n = 0;
};

/// Knots at least spacing_mm apart. A tube through thousands of almost equal points looks rough; of the
/// rows a knot stands for, it shows the strongest.
std::vector<Knot> thin_out(const Trace& trace, double spacing_mm)
{
    std::vector<Knot> knots;
    for (const Touch& row : trace.rows) {
        const double force_n = row.force_norm_n();
        if (knots.empty() || length(row.proxy_mm - knots.back().at) >= spacing_mm)
            knots.push_back({row.proxy_mm, force_n});
        else
            knots.back().force_n = std::max(knots.back().force_n, force_n);
    }
    return knots;
}

/// Runs of segments with (contact) or without force on them, as polylines with |F| at the points.
vtkSmartPointer<vtkPolyData> runs(const std::vector<Knot>& knots, bool contact)
{
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> lines;
    vtkNew<vtkDoubleArray> forces;
    forces->SetName("force");
    std::vector<vtkIdType> run;
    const auto add = [&](const Knot& knot) {
        run.push_back(points->InsertNextPoint(knot.at.data()));
        forces->InsertNextValue(knot.force_n);
    };
    const auto finish = [&] {
        if (run.size() > 1)
            lines->InsertNextCell(static_cast<vtkIdType>(run.size()), run.data());
        run.clear();
    };
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
        const bool touches = knots[i].force_n > 0 || knots[i + 1].force_n > 0;
        if (touches != contact) {
            finish();
            continue;
        }
        if (run.empty())
            add(knots[i]);
        add(knots[i + 1]);
    }
    finish();
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(points);
    data->SetLines(lines);
    data->GetPointData()->SetScalars(forces);
    return data;
}

vtkSmartPointer<vtkLookupTable> force_colours(double max_force_n)
{
    auto table = vtkSmartPointer<vtkLookupTable>::New();
    constexpr int entries = 256;
    table->SetNumberOfTableValues(entries);
    table->SetTableRange(0, max_force_n);
    for (int i = 0; i < entries; ++i) {
        const Colour colour = viridis(static_cast<double>(i) / (entries - 1));
        table->SetTableValue(i, colour[0], colour[1], colour[2], 1);
    }
    return table;
}

vtkSmartPointer<vtkActor> tube_actor(vtkPolyData* lines, double radius_mm)
{
    vtkNew<vtkTubeFilter> tube;
    tube->SetInputData(lines);
    tube->SetRadius(radius_mm);
    tube->SetNumberOfSides(16);
    tube->CappingOn();
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(tube->GetOutputPort());
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    return actor;
}

} // namespace

void add_path(vtkRenderer* renderer, const Trace& trace, double width_mm, double max_force_n)
{
    const std::vector<Knot> knots = thin_out(trace, 0.5 * width_mm);

    const auto in_contact = runs(knots, true);
    if (in_contact->GetNumberOfLines() > 0) {
        const auto path = tube_actor(in_contact, width_mm);
        path->GetMapper()->SetLookupTable(force_colours(max_force_n));
        path->GetMapper()->UseLookupTableScalarRangeOn();
        // Colours must be found again in the scalar bar: little shading.
        path->GetProperty()->SetAmbient(0.55);
        path->GetProperty()->SetDiffuse(0.45);
        renderer->AddActor(path);

        // A dark rim keeps the yellow end apart from the light surface: the far side of a thicker tube.
        const auto rim = tube_actor(in_contact, 1.35 * width_mm);
        rim->GetMapper()->ScalarVisibilityOff();
        set_colour(rim->GetProperty(), palette::ink);
        rim->GetProperty()->SetLighting(false);
        rim->GetProperty()->FrontfaceCullingOn();
        renderer->AddActor(rim);
    }
    const auto in_air = runs(knots, false);
    if (in_air->GetNumberOfLines() > 0) {
        const auto path = tube_actor(in_air, 0.35 * width_mm);
        path->GetMapper()->ScalarVisibilityOff();
        set_colour(path->GetProperty(), palette::path_in_air);
        path->GetProperty()->SetAmbient(0.5);
        path->GetProperty()->SetDiffuse(0.5);
        renderer->AddActor(path);
    }
}

} // namespace phantom::view
