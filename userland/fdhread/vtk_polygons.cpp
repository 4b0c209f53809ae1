// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdhread/vtk_polygons.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include <vtk3DSImporter.h>
#include <vtkActor.h>
#include <vtkActorCollection.h>
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCompositeDataIterator.h>
#include <vtkDataArray.h>
#include <vtkDataSetSurfaceFilter.h>
#include <vtkGLTFReader.h>
#include <vtkGenericDataObjectReader.h>
#include <vtkMapper.h>
#include <vtkMatrix4x4.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>

#include "fdhread/chunks_3ds.hpp"

namespace phantom::fdhread {

namespace {

using mesh::PolygonSoup;

/// Parts of a file, one after the other.
class Collector {
  public:
    /// False when the part contradicts itself.
    bool add(vtkPolyData* part)
    {
        if (part == nullptr || part->GetPoints() == nullptr)
            return true;
        const auto first = static_cast<std::uint32_t>(soup_.vertices.size());
        const vtkIdType points = part->GetNumberOfPoints();
        if (points + static_cast<vtkIdType>(first) >= static_cast<vtkIdType>(mesh::no_neighbour))
            return false;
        for (vtkIdType i = 0; i < points; ++i) {
            soup_.vertices.emplace_back();
            part->GetPoint(i, soup_.vertices.back().data());
        }
        return add_normals(part, points) && add_cells(part->GetPolys(), first, points, false) &&
               add_cells(part->GetStrips(), first, points, true);
    }

    /// With normals as soon as one part has some.
    PolygonSoup take()
    {
        if (!any_normals_)
            soup_.normals.clear();
        return std::move(soup_);
    }

  private:
    bool add_normals(vtkPolyData* part, vtkIdType points)
    {
        vtkDataArray* normals = part->GetPointData()->GetNormals();
        if (normals != nullptr &&
            (normals->GetNumberOfComponents() != 3 || normals->GetNumberOfTuples() != points))
            return false;
        any_normals_ = any_normals_ || normals != nullptr;
        for (vtkIdType i = 0; i < points; ++i) {
            // Zero: preparation makes one.
            soup_.normals.push_back({0, 0, 0});
            if (normals != nullptr)
                normals->GetTuple(i, soup_.normals.back().data());
        }
        return true;
    }

    bool add_cells(vtkCellArray* cells, std::uint32_t first, vtkIdType points, bool strips)
    {
        if (cells == nullptr)
            return true;
        const auto iterator = vtk::TakeSmartPointer(cells->NewIterator());
        for (iterator->GoToFirstCell(); !iterator->IsDoneWithTraversal(); iterator->GoToNextCell()) {
            vtkIdType count = 0;
            const vtkIdType* ids = nullptr;
            iterator->GetCurrentCell(count, ids);
            if (std::any_of(ids, ids + count, [points](vtkIdType id) { return id < 0 || id >= points; }))
                return false;
            if (!strips) {
                end_polygon(first, {ids, static_cast<std::size_t>(count)});
                continue;
            }
            for (vtkIdType i = 0; i + 2 < count; ++i) {
                // Every second triangle of a strip runs the other way.
                const std::array<vtkIdType, 3> triangle{ids[i], ids[i + 1 + i % 2], ids[i + 2 - i % 2]};
                end_polygon(first, triangle);
            }
        }
        return true;
    }

    void end_polygon(std::uint32_t first, std::span<const vtkIdType> ids)
    {
        for (const vtkIdType id : ids)
            soup_.corners.push_back(first + static_cast<std::uint32_t>(id));
        soup_.first.push_back(soup_.corners.size());
    }

    PolygonSoup soup_;
    bool any_normals_ = false;
};

const Error contradiction{"", "is damaged: its polygons name points that it does not have"};

Result<PolygonSoup> one_part(vtkPolyData* part)
{
    Collector collector;
    if (!collector.add(part))
        return contradiction;
    return collector.take();
}

Result<PolygonSoup> read_vtp(const std::string& file)
{
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    return one_part(reader->GetOutput());
}

Result<PolygonSoup> read_legacy(const std::string& file)
{
    vtkNew<vtkGenericDataObjectReader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    if (auto* polygons = vtkPolyData::SafeDownCast(reader->GetOutput()))
        return one_part(polygons);
    auto* grid = vtkUnstructuredGrid::SafeDownCast(reader->GetOutput());
    if (grid == nullptr)
        return Error{"",
                     "holds no mesh, expected a legacy VTK file with DATASET POLYDATA or UNSTRUCTURED_GRID"};
    vtkNew<vtkDataSetSurfaceFilter> surface;
    surface->SetInputData(grid);
    surface->Update();
    return one_part(surface->GetOutput());
}

Result<PolygonSoup> read_gltf(const std::string& file)
{
    vtkNew<vtkGLTFReader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    vtkMultiBlockDataSet* blocks = reader->GetOutput();
    if (blocks == nullptr)
        return PolygonSoup{};
    Collector collector;
    const auto iterator = vtk::TakeSmartPointer(blocks->NewIterator());
    for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem()) {
        if (!collector.add(vtkPolyData::SafeDownCast(iterator->GetCurrentDataObject())))
            return contradiction;
    }
    return collector.take();
}

Result<PolygonSoup> read_3ds(const std::string& file)
{
    if (std::string bad = bad_chunk(file); !bad.empty())
        return Error{"", std::move(bad)};
    // An importer makes a scene; nothing of it is ever drawn.
    vtkNew<vtk3DSImporter> importer;
    importer->SetFileName(file.c_str());
    importer->Update();
    if (importer->GetRenderer() == nullptr)
        return PolygonSoup{};
    Collector collector;
    vtkActorCollection* actors = importer->GetRenderer()->GetActors();
    actors->InitTraversal();
    while (vtkActor* actor = actors->GetNextActor()) {
        if (actor->GetMapper() == nullptr)
            continue;
        actor->GetMapper()->Update();
        if (!collector.add(vtkPolyData::SafeDownCast(actor->GetMapper()->GetInput())))
            return contradiction;
    }
    return collector.take();
}

} // namespace

Result<PolygonSoup> read_polygons(const std::string& file)
{
    std::string extension = std::filesystem::path(file).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".vtp")
        return read_vtp(file);
    if (extension == ".vtk")
        return read_legacy(file);
    if (extension == ".3ds")
        return read_3ds(file);
    if (extension == ".gltf" || extension == ".glb")
        return read_gltf(file);
    return Error{"", "is no file that fdhread reads, expected .vtp, .vtk, .3ds, .gltf or .glb"};
}

} // namespace phantom::fdhread
