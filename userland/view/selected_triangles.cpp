// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/selected_triangles.hpp"

#include <algorithm>
#include <vector>

#include <vtkCellArray.h>
#include <vtkPoints.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "view/colour.hpp"
#include "view/scene_actors.hpp"

namespace phantom::view {

namespace {

constexpr double lift_part = 0.03; ///< of the contact radius: no flicker, and not to be seen

} // namespace

SelectedTriangles::SelectedTriangles()
{
    show({}, {}, nullptr);
}

vtkActor* SelectedTriangles::add_to(vtkRenderer* renderer, double opacity, double edge_width) const
{
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(triangles_);
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    vtkProperty* look = actor->GetProperty();
    set_colour(look, palette::selected);
    look->SetOpacity(opacity);
    look->SetAmbient(0.35);
    look->SetDiffuse(0.65);
    look->SetInterpolationToFlat();
    look->EdgeVisibilityOn();
    look->SetEdgeColor(palette::selected_edge[0], palette::selected_edge[1], palette::selected_edge[2]);
    look->SetLineWidth(static_cast<float>(edge_width));
    renderer->AddActor(actor);
    return actor;
}

void SelectedTriangles::show(std::span<const fdh::Hit> hits, const scene::Scene& of,
                             const scene::Moment* moment)
{
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> faces;
    for (const fdh::Hit& hit : hits) {
        if (hit.object >= of.objects.size())
            continue;
        const scene::Object& object = of.objects[hit.object];
        if (hit.triangle >= object.mesh.faces.size())
            continue;
        // They lie in the surface: draw them a hair above it.
        const double lift_mm = lift_part * of.materials[object.material_of(hit.triangle)].radius_mm;
        const bool deformed = moment && !moment->objects[hit.object].vertices.empty();
        const fdh::Pose pose = moment ? moment->pose(of, hit.object) : object.pose;
        faces->InsertNextCell(3);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t number = object.mesh.faces[hit.triangle][i];
            const Vec3& vertex =
                deformed ? moment->objects[hit.object].vertices[number] : object.mesh.vertices[number];
            const Vec3& normal = object.mesh.normals[object.mesh.face_normals[hit.triangle][i]];
            const Vec3 corner = to_world(pose, vertex + lift_mm * normal);
            faces->InsertCellPoint(points->InsertNextPoint(corner.data()));
        }
    }
    count_ = static_cast<std::size_t>(faces->GetNumberOfCells());
    triangles_->SetPoints(points);
    triangles_->SetPolys(faces);
    triangles_->Modified();
}

double SelectedTriangles::reach_mm(const Vec3& centre) const
{
    vtkPoints* points = triangles_->GetPoints();
    std::vector<double> distances;
    for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i) {
        Vec3 corner{};
        points->GetPoint(i, corner.data());
        distances.push_back(length(corner - centre));
    }
    if (distances.empty())
        return 0;
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    return *middle;
}

Vec3 SelectedTriangles::facing(const Vec3& otherwise) const
{
    vtkPoints* points = triangles_->GetPoints();
    Vec3 sum{};
    for (vtkIdType i = 0; i + 2 < points->GetNumberOfPoints(); i += 3) {
        Vec3 a{}, b{}, c{};
        points->GetPoint(i, a.data());
        points->GetPoint(i + 1, b.data());
        points->GetPoint(i + 2, c.data());
        sum = sum + cross(b - a, c - a);
    }
    return unit_or(sum, otherwise);
}

} // namespace phantom::view
