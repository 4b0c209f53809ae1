// SPDX-License-Identifier: GPL-2.0-or-later
// VTK: vtkStaticCellLocator's FindCellsWithinBounds, every triangle whose box meets the box round the query's
// sphere. (Its closest-N query is for points, not for cells.)
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStaticCellLocator.h>

#include "study/peers/contenders.hpp"
#include "study/peers/heap.hpp"
#include "study/peers/nearest_keeper.hpp"
#include "study/peers/vtk_threads.hpp"

namespace phantom::peers {

namespace {

class Vtk final : public Contender {
  public:
    [[nodiscard]] std::string name() const override { return "VTK"; }
    [[nodiscard]] std::string method() const override { return "vtkStaticCellLocator, box round the sphere"; }
    [[nodiscard]] std::size_t largest_mesh() const override { return 5'000'000; }

    void prepare(const Mesh& mesh) override
    {
        locator_ = nullptr;
        mesh_ = &mesh;
        vtkNew<vtkPoints> points;
        points->SetDataTypeToFloat();
        points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.points.size()));
        for (std::size_t i = 0; i < mesh.points.size(); ++i)
            points->SetPoint(static_cast<vtkIdType>(i), mesh.vertices[i].data());
        vtkNew<vtkCellArray> cells;
        const auto count = static_cast<vtkIdType>(mesh.triangles.size());
        cells->AllocateExact(count, 3 * count);
        for (const fdh::Triangle& t : mesh.triangles)
            cells->InsertNextCell({t[0], t[1], t[2]});
        surface_ = vtkSmartPointer<vtkPolyData>::New();
        surface_->SetPoints(points);
        surface_->SetPolys(cells);
        surface_->BuildCells();
    }
    void build(unsigned threads) override
    {
        set_vtk_threads(threads);
        const std::size_t before = heap_bytes();
        locator_ = vtkSmartPointer<vtkStaticCellLocator>::New();
        locator_->SetDataSet(surface_);
        locator_->BuildLocator();
        bytes_ = heap_bytes() - before;
    }
    [[nodiscard]] bool builds_parallel() const override { return true; }
    [[nodiscard]] std::size_t bytes() const override { return bytes_; }

    void query(const fdh::Point& p, double radius) override
    {
        keeper_.start(*mesh_, p, radius);
        double box[6];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box[2 * axis] = p[axis] - radius;
            box[2 * axis + 1] = p[axis] + radius;
        }
        locator_->FindCellsWithinBounds(box, found_);
        for (vtkIdType i = 0; i < found_->GetNumberOfIds(); ++i)
            keeper_.offer(static_cast<std::uint32_t>(found_->GetId(i)));
        keeper_.finish();
    }
    void distances(std::vector<double>& out) const override { keeper_.distances(out); }

  private:
    const Mesh* mesh_ = nullptr;
    vtkSmartPointer<vtkPolyData> surface_;
    vtkSmartPointer<vtkStaticCellLocator> locator_;
    vtkNew<vtkIdList> found_;
    std::size_t bytes_ = 0;
    NearestKeeper keeper_;
};

} // namespace

std::unique_ptr<Contender> make_vtk()
{
    return std::make_unique<Vtk>();
}

} // namespace phantom::peers
