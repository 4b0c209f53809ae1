// SPDX-License-Identifier: GPL-2.0-or-later
// The triangles that the feeder has chosen: filled and with their edges, just above the surface.
#pragma once

#include <span>

#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>

#include "base/vector.hpp"
#include "fdh/query.hpp"
#include "scene/live_scene.hpp"
#include "scene/scene.hpp"

namespace phantom::view {

class SelectedTriangles {
  public:
    SelectedTriangles();

    /// Adds them to a renderer; edge_width in pixels. Returns what the renderer draws, and owns.
    vtkActor* add_to(vtkRenderer* renderer, double opacity, double edge_width) const;
    /// Replaces the selection. `of` is what the hits are of: the scene, or a level of detail of it. moment:
    /// where all of that is; nullptr: at rest.
    void show(std::span<const fdh::Hit> hits, const scene::Scene& of, const scene::Moment* moment);

    [[nodiscard]] std::size_t count() const { return count_; }
    /// Distance in mm from `centre` within which half of the selection's corners lie: its size to the
    /// eye. 0 without a selection.
    [[nodiscard]] double reach_mm(const Vec3& centre) const;
    /// Sum of the selection's face normals times their areas, made unit: which way it looks.
    /// `otherwise` without one.
    [[nodiscard]] Vec3 facing(const Vec3& otherwise) const;

  private:
    vtkNew<vtkPolyData> triangles_;
    std::size_t count_ = 0;
};

} // namespace phantom::view
