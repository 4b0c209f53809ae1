// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/mouse_arm.hpp"

#include <vtkCamera.h>

namespace phantom::view {

MouseArm::MouseArm(vtkRenderer* renderer, const SurfacePicker& picker, const Vec3& tip_mm)
    : renderer_(renderer), picker_(picker), point_(tip_mm)
{
    renderer_->GetActiveCamera()->GetDirectionOfProjection(into_.data());
}

MouseArm::Sight MouseArm::sight(double x, double y) const
{
    const auto unproject = [&](double depth) -> Vec3 {
        renderer_->SetDisplayPoint(x, y, depth);
        renderer_->DisplayToWorld();
        const double* point = renderer_->GetWorldPoint();
        return {point[0] / point[3], point[1] / point[3], point[2] / point[3]};
    };
    return {unproject(0), unproject(1)};
}

void MouseArm::press(double x, double y, const Vec3& tip_mm)
{
    const Sight line = sight(x, y);
    renderer_->GetActiveCamera()->GetDirectionOfProjection(into_.data());
    point_ = picker_.first_hit(line.from, line.to).value_or(tip_mm);
    depth_mm_ = 0;
    drag(x, y);
}

void MouseArm::drag(double x, double y)
{
    const Sight line = sight(x, y);
    const Vec3 along = line.to - line.from;
    const double closing = dot(along, into_);
    if (closing <= 0) // a camera turned away since the press: stay
        return;
    point_ = line.from + (dot(point_ - line.from, into_) / closing) * along;
}

} // namespace phantom::view
