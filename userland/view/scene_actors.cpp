// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/scene_actors.hpp"

#include <unordered_map>

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "view/colour.hpp"

namespace phantom::view {

namespace {

constexpr std::size_t outline_points = 20000;

/// The vertex of every point of surface_of(mesh).
std::vector<std::uint32_t> vertices_of_points(const mesh::Mesh& mesh, vtkPolyData* surface)
{
    std::vector<std::uint32_t> vertices(static_cast<std::size_t>(surface->GetNumberOfPoints()));
    vtkNew<vtkIdList> corners;
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        surface->GetCellPoints(static_cast<vtkIdType>(face), corners);
        for (std::size_t corner = 0; corner < 3; ++corner)
            vertices[static_cast<std::size_t>(corners->GetId(static_cast<vtkIdType>(corner)))] =
                mesh.faces[face][corner];
    }
    return vertices;
}

} // namespace

vtkSmartPointer<vtkMatrix4x4> matrix_of(const fdh::Pose& pose)
{
    auto matrix = vtkSmartPointer<vtkMatrix4x4>::New();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            matrix->SetElement(
                row, column,
                pose.rotation[3 * static_cast<std::size_t>(row) + static_cast<std::size_t>(column)]);
        matrix->SetElement(row, 3, pose.translation[static_cast<std::size_t>(row)]);
    }
    return matrix;
}

Vec3 rotate(const fdh::Pose& pose, const Vec3& local)
{
    const auto& r = pose.rotation;
    return {r[0] * local[0] + r[1] * local[1] + r[2] * local[2],
            r[3] * local[0] + r[4] * local[1] + r[5] * local[2],
            r[6] * local[0] + r[7] * local[1] + r[8] * local[2]};
}

Vec3 to_world(const fdh::Pose& pose, const Vec3& local)
{
    return rotate(pose, local) + pose.translation;
}

vtkSmartPointer<vtkPolyData> surface_of(const mesh::Mesh& mesh)
{
    vtkNew<vtkPoints> points;
    points->SetDataTypeToFloat();
    vtkNew<vtkFloatArray> normals;
    normals->SetNumberOfComponents(3);
    normals->SetName("Normals");
    vtkNew<vtkCellArray> faces;
    faces->AllocateEstimate(static_cast<vtkIdType>(mesh.faces.size()), 3);

    std::unordered_map<std::uint64_t, vtkIdType> point_of; // (vertex, normal) to point
    point_of.reserve(mesh.vertices.size());
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        std::array<vtkIdType, 3> corners{};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = mesh.faces[face][corner];
            const std::uint32_t normal = mesh.face_normals[face][corner];
            const std::uint64_t key = std::uint64_t{vertex} << 32U | normal;
            const auto [found, is_new] = point_of.try_emplace(key, points->GetNumberOfPoints());
            if (is_new) {
                points->InsertNextPoint(mesh.vertices[vertex].data());
                normals->InsertNextTuple(mesh.normals[normal].data());
            }
            corners[corner] = found->second;
        }
        faces->InsertNextCell(3, corners.data());
    }
    auto surface = vtkSmartPointer<vtkPolyData>::New();
    surface->SetPoints(points);
    surface->SetPolys(faces);
    surface->GetPointData()->SetNormals(normals);
    return surface;
}

SceneActors::SceneActors(const scene::Scene& scene) : scene_(scene)
{
    std::size_t vertices = 0;
    for (const scene::Object& object : scene.objects)
        vertices += object.mesh.vertices.size();
    const std::size_t stride = 1 + vertices / outline_points;
    for (const scene::Object& object : scene.objects) {
        surfaces_.push_back(surface_of(object.mesh));
        poses_.push_back(matrix_of(object.pose));
        point_vertices_.push_back(object.deformation ? vertices_of_points(object.mesh, surfaces_.back())
                                                     : std::vector<std::uint32_t>());
        revisions_.push_back(0);
        for (std::size_t i = 0; i < object.mesh.vertices.size(); i += stride)
            outline_.push_back(to_world(object.pose, object.mesh.vertices[i]));
    }
}

void SceneActors::add_to(vtkRenderer* renderer, double opacity) const
{
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
        vtkNew<vtkPolyDataMapper> mapper;
        mapper->SetInputData(surfaces_[i]);
        vtkNew<vtkActor> actor;
        actor->SetMapper(mapper);
        actor->SetUserMatrix(poses_[i]);
        vtkProperty* look = actor->GetProperty();
        set_colour(look, palette::surface);
        look->SetInterpolationToPhong();
        look->SetAmbient(0.12);
        look->SetDiffuse(0.88);
        look->SetSpecular(0.12);
        look->SetSpecularPower(24);
        look->SetOpacity(opacity);
        // See-through: the far side would only confuse.
        look->SetBackfaceCulling(opacity < 1);
        renderer->AddActor(actor);
    }
}

void SceneActors::show(const scene::Moment& moment)
{
    for (std::uint32_t i = 0; i < surfaces_.size(); ++i) {
        const scene::Moment::ObjectNow& now = moment.objects[i];
        if (now.placement)
            poses_[i]->DeepCopy(matrix_of(moment.pose(scene_, i)));
        if (now.revision == revisions_[i])
            continue;
        revisions_[i] = now.revision;
        vtkPoints* points = surfaces_[i]->GetPoints();
        vtkDataArray* normals = surfaces_[i]->GetPointData()->GetNormals();
        for (std::size_t p = 0; p < point_vertices_[i].size(); ++p) {
            points->SetPoint(static_cast<vtkIdType>(p), now.vertices[point_vertices_[i][p]].data());
            // Points and the moment's normals are numbered alike: see Moment.
            normals->SetTuple(static_cast<vtkIdType>(p), now.normals[p].data());
        }
        points->Modified();
        normals->Modified();
        surfaces_[i]->Modified();
    }
}

} // namespace phantom::view
