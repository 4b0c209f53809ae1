// SPDX-License-Identifier: GPL-2.0-or-later
// A surface that is deformed, from what it is at rest: every revision is made of the rest, so nothing drifts.
#pragma once

#include <cstdint>
#include <vector>

#include "fdh/deforming_tree.hpp"
#include "scene/deformation.hpp"
#include "scene/scene.hpp"

namespace phantom::scene {

/// Vertices go to x + s p(x) a, s the displacement, p the profile and a its axis. Normals go along by the
/// inverse transpose of that map's gradient,
///
///     n - (s a.n / (1 + s a.grad p)) grad p        made unit,
///
/// so a shape's exact normals stay those of the deformed shape, creases stay creases and smooth edges smooth.
/// Faces, neighbours, fans and rims keep their numbers.
class DeformingSurface {
  public:
    DeformingSurface(Surface rest, const Deformation& deformation);
    /// The surface displaced by so much; shares with the rest what is the same.
    [[nodiscard]] const Surface& displaced(double s_mm);
    [[nodiscard]] const Surface& now() const { return now_; }

  private:
    /// Normals that belong to one vertex each, so that they can go along with it.
    void part_normals();
    [[nodiscard]] mesh::Vec3 turned(std::uint32_t vertex, const mesh::Vec3& normal, double s_mm) const;

    Surface rest_;
    mesh::Vec3 axis_;
    std::vector<double> profile_;              ///< per vertex
    std::vector<mesh::Vec3> gradient_;         ///< of the profile, per vertex, 1/mm
    std::vector<std::uint32_t> normal_vertex_; ///< per normal
    fdh::DeformingTree<14> tree_;
    Surface now_;
};

/// Time between two revisions of a mesh of so many triangles: 10 ms up to 20,000, which take 0.3 ms to
/// deform and refit (AMD Zen 5); beyond in proportion: 100,000 take 5 to 11 ms, for there caches end.
double revision_interval_s(std::size_t triangles);

} // namespace phantom::scene
