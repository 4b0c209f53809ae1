// SPDX-License-Identifier: GPL-2.0-or-later
// The objects of a scene as smooth-shaded surfaces.
#pragma once

#include <vector>

#include <vtkActor.h>
#include <vtkMatrix4x4.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "base/vector.hpp"
#include "scene/live_scene.hpp"
#include "scene/scene.hpp"

namespace phantom::view {

/// World position (mm) of a point in an object's frame.
Vec3 to_world(const fdh::Pose& pose, const Vec3& local);
/// The same for a direction.
Vec3 rotate(const fdh::Pose& pose, const Vec3& local);

/// A pose as VTK takes it.
vtkSmartPointer<vtkMatrix4x4> matrix_of(const fdh::Pose& pose);

/// A mesh in its object's frame. A corner's own normal is kept: where corners of one vertex have different
/// normals (a crease), the vertex becomes several points. Cell i is face i.
vtkSmartPointer<vtkPolyData> surface_of(const mesh::Mesh& mesh);

class SceneActors {
  public:
    /// The scene must outlive them.
    explicit SceneActors(const scene::Scene& scene);

    /// Adds the surfaces; opacity below 1 lets the tip be seen inside. Geometry is shared between renderers.
    void add_to(vtkRenderer* renderer, double opacity) const;
    /// Brings everything to where it is then, in all renderers; what rests is not touched.
    void show(const scene::Moment& moment);
    /// One per object, in its frame.
    [[nodiscard]] const std::vector<vtkSmartPointer<vtkPolyData>>& surfaces() const { return surfaces_; }
    /// World positions of up to about 20,000 vertices, evenly chosen: enough to frame a picture.
    [[nodiscard]] const std::vector<Vec3>& outline() const { return outline_; }

  private:
    std::vector<vtkSmartPointer<vtkPolyData>> surfaces_;
    const scene::Scene& scene_;
    std::vector<vtkSmartPointer<vtkMatrix4x4>> poses_;       ///< per object, of its actors
    std::vector<std::vector<std::uint32_t>> point_vertices_; ///< per object that deforms: of every point
    std::vector<std::uint32_t> revisions_;                   ///< per object, as it is drawn
    std::vector<Vec3> outline_;
};

} // namespace phantom::view
