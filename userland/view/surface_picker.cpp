// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/surface_picker.hpp"

#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkStaticCellLocator.h>

#include "fdh/pose.hpp"

namespace phantom::view {

struct SurfacePicker::Part {
    fdh::Pose pose;
    vtkNew<vtkStaticCellLocator> locator;
};

SurfacePicker::SurfacePicker(const scene::Scene& scene, const SceneActors& surfaces)
{
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        auto part = std::make_unique<Part>();
        part->pose = scene.objects[i].pose;
        part->locator->SetDataSet(surfaces.surfaces()[i]);
        part->locator->BuildLocator();
        parts_.push_back(std::move(part));
    }
}

SurfacePicker::~SurfacePicker() = default;

void SurfacePicker::follow(const scene::Scene& scene, const scene::Moment& moment)
{
    for (std::uint32_t i = 0; i < parts_.size(); ++i)
        if (moment.objects[i].placement)
            parts_[i]->pose = moment.pose(scene, i);
}

std::optional<Vec3> SurfacePicker::first_hit(const Vec3& from, const Vec3& to) const
{
    std::optional<Vec3> nearest;
    double nearest_part = 2; // of the way; a hit has at most 1
    vtkNew<vtkGenericCell> cell;
    for (const auto& part : parts_) {
        part->locator->BuildLocator(); // nothing, unless the surface has changed
        const Vec3 begin = to_local(part->pose, from), end = to_local(part->pose, to);
        double t = 0;
        Vec3 at{}, parametric{};
        int sub_cell = 0;
        vtkIdType face = 0;
        if (part->locator->IntersectWithLine(begin.data(), end.data(), 0.0, t, at.data(), parametric.data(),
                                             sub_cell, face, cell) == 0 ||
            t >= nearest_part)
            continue;
        nearest_part = t;
        nearest = to_world(part->pose, at);
    }
    return nearest;
}

} // namespace phantom::view
