// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/probe_actors.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <vtkCoordinate.h>
#include <vtkLineSource.h>
#include <vtkMatrix4x4.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkSphereSource.h>
#include <vtkTextProperty.h>

#include "view/colour.hpp"

namespace phantom::view {

namespace {

constexpr double smallest_force_n = 1e-4; ///< below this no arrow is drawn

void make_sphere(vtkActor* actor, const Colour& colour, double opacity)
{
    vtkNew<vtkSphereSource> sphere;
    sphere->SetRadius(1);
    sphere->SetThetaResolution(48);
    sphere->SetPhiResolution(32);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(sphere->GetOutputPort());
    actor->SetMapper(mapper);
    set_colour(actor->GetProperty(), colour);
    actor->GetProperty()->SetOpacity(opacity);
    actor->GetProperty()->SetInterpolationToPhong();
    actor->GetProperty()->SetAmbient(0.25);
    actor->GetProperty()->SetDiffuse(0.75);
    actor->GetProperty()->SetSpecular(0.25);
    actor->GetProperty()->SetSpecularPower(30);
}

void place_sphere(vtkActor* actor, const Vec3& at, double radius)
{
    actor->SetPosition(at[0], at[1], at[2]);
    actor->SetScale(radius);
}

} // namespace

ProbeActors::ProbeActors(vtkRenderer* renderer, double ball_opacity)
{
    make_sphere(ball_, palette::tip, ball_opacity);
    make_sphere(tip_, palette::tip, 1);
    make_sphere(proxy_, palette::proxy, 1);
    ball_->GetProperty()->SetBackfaceCulling(true);

    // vtkArrowSource runs along x from 0 to 1; proportions are set with the length, so that a long
    // arrow is not a thick one.
    arrow_shape_->SetShaftResolution(32);
    arrow_shape_->SetTipResolution(48);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(arrow_shape_->GetOutputPort());
    arrow_->SetMapper(mapper);
    set_colour(arrow_->GetProperty(), palette::force);
    arrow_->GetProperty()->SetAmbient(0.5);
    arrow_->GetProperty()->SetDiffuse(0.5);

    vtkNew<vtkLineSource> line;
    line->SetPoint1(0, 0, 0);
    line->SetPoint2(1, 0, 0);
    vtkNew<vtkPolyDataMapper> line_mapper;
    line_mapper->SetInputConnection(line->GetOutputPort());
    link_->SetMapper(line_mapper);
    set_colour(link_->GetProperty(), palette::proxy);
    link_->GetProperty()->SetLighting(false);

    label_->GetPositionCoordinate()->SetCoordinateSystemToWorld();
    vtkTextProperty* text = label_->GetTextProperty();
    text->SetFontFamilyToArial();
    text->BoldOn();
    set_colour(text, palette::force);
    text->SetBackgroundColor(palette::panel[0], palette::panel[1], palette::panel[2]);
    text->SetBackgroundOpacity(0.85);
    text->SetJustificationToCentered();
    text->SetVerticalJustificationToBottom();

    for (vtkActor* actor : {ball_.Get(), tip_.Get(), proxy_.Get(), link_.Get(), arrow_.Get()})
        renderer->AddActor(actor);
    renderer->AddActor2D(label_);
}

void ProbeActors::set_scale(int font_px, double line_px)
{
    label_->GetTextProperty()->SetFontSize(font_px);
    link_->GetProperty()->SetLineWidth(static_cast<float>(line_px));
}

void ProbeActors::show(const Touch& touch, const ProbeSizes& sizes)
{
    place_sphere(ball_, touch.tip_mm, sizes.radius_mm);
    place_sphere(tip_, touch.tip_mm, sizes.point_mm);
    place_sphere(proxy_, touch.proxy_mm, sizes.point_mm);
    // Outside the surface the proxy is the tip; one dot is enough.
    const Vec3 gap = touch.proxy_mm - touch.tip_mm;
    const bool apart = length(gap) > 0.05 * sizes.point_mm;
    proxy_->SetVisibility(apart);
    link_->SetVisibility(apart);
    if (apart) {
        vtkNew<vtkMatrix4x4> matrix;
        for (int axis = 0; axis < 3; ++axis) {
            matrix->SetElement(axis, 0, gap[static_cast<std::size_t>(axis)]);
            matrix->SetElement(axis, 3, touch.tip_mm[static_cast<std::size_t>(axis)]);
        }
        link_->SetUserMatrix(matrix);
    }
    place_arrow(touch, sizes);
}

void ProbeActors::place_arrow(const Touch& touch, const ProbeSizes& sizes)
{
    const double force_n = touch.force_norm_n();
    const bool visible = force_n > smallest_force_n;
    arrow_->SetVisibility(visible);
    label_->SetVisibility(visible && label_wanted_);
    if (!visible)
        return;

    const double head_mm = 6 * sizes.arrow_width_mm;
    const double arrow_mm = std::max(force_n * sizes.arrow_mm_per_n, head_mm);
    arrow_shape_->SetTipLength(std::min(head_mm / arrow_mm, 1.0));
    arrow_shape_->SetTipRadius(2.4 * sizes.arrow_width_mm / arrow_mm);
    arrow_shape_->SetShaftRadius(sizes.arrow_width_mm / arrow_mm);

    const Vec3 along = (1 / force_n) * touch.force_n;
    const Vec3 across = perpendicular(along, {0, 1, 0});
    const Vec3 third = cross(along, across);
    vtkNew<vtkMatrix4x4> matrix;
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        matrix->SetElement(axis, 0, arrow_mm * along[i]);
        matrix->SetElement(axis, 1, arrow_mm * across[i]);
        matrix->SetElement(axis, 2, arrow_mm * third[i]);
        matrix->SetElement(axis, 3, touch.tip_mm[i]);
    }
    arrow_->SetUserMatrix(matrix);

    const Vec3 head = touch.tip_mm + (arrow_mm + 0.6 * head_mm) * along;
    label_->GetPositionCoordinate()->SetValue(head[0], head[1], head[2]);
    label_->SetInput(fmt::format("{:.2f} N", force_n).c_str());
}

} // namespace phantom::view
