// SPDX-License-Identifier: GPL-2.0-or-later
// A scene that moves: its objects' places and shapes at one moment after the other. The scene that it was
// made from stays as it is, at rest.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "fdh/scene_tree.hpp"
#include "scene/deforming_surface.hpp"
#include "scene/scene.hpp"

namespace phantom::scene {

/// What is where at one time. Immutable, so that others may look at it while the next is made.
struct Moment {
    double t_s = 0; ///< since everything began to move; below 0 all is at rest
    struct ObjectNow {
        std::optional<Placement> placement{}; ///< of one that moves
        std::uint32_t revision = 0;           ///< of its shape, from 0
        /// Of one that deforms, in its own frame. Normals are one for each vertex and normal that meet at
        /// a corner of the mesh at rest, in the order of their first corners.
        SharedArray<mesh::Vec3> vertices{}, normals{};
    };
    std::vector<ObjectNow> objects;

    /// Where the object's own frame is.
    [[nodiscard]] fdh::Pose pose(const Scene& rest, std::uint32_t object) const;
};

/// One thread's own: advance() and queries of the tree may not overlap.
class LiveScene {
  public:
    /// Whether there is anything that moves or deforms.
    static bool is_called_for(const Scene& scene);

    /// A copy that shares all arrays and hulls.
    LiveScene(const Scene& rest, const fdh::SceneTree<14>& tree);

    /// To that time since everything began to move: poses always, shapes where revision_interval_s() has
    /// passed since their last revision (or time went backward).
    void advance(double t_s);
    /// To the moment of another level of detail of the same scene. Shapes are shared: what deforms has the
    /// same mesh on every level.
    void follow(const LiveScene& finest);

    /// Poses at rest, shapes as they are now.
    [[nodiscard]] const Scene& scene() const { return scene_; }
    /// All as it is now.
    [[nodiscard]] const fdh::SceneTree<14>& tree() const { return tree_; }
    [[nodiscard]] const std::shared_ptr<const Moment>& moment() const { return moment_; }

  private:
    void take_poses(const Moment& moment);
    void take_shape(std::uint32_t object, const Surface& surface);

    Scene scene_;
    fdh::SceneTree<14> tree_;
    std::vector<std::optional<DeformingSurface>> shapes_; ///< per object
    std::vector<double> shaped_s_;                        ///< time of each one's revision
    std::shared_ptr<const Moment> moment_;
};

} // namespace phantom::scene
