// SPDX-License-Identifier: GPL-2.0-or-later
// Level one of the hierarchy: objects with rigid poses, hulls over objects. A query goes down to the
// objects near the point and is answered by each in its own frame: a rigid motion rebuilds nothing.
#pragma once

#include <memory>
#include <vector>

#include "fdh/tree.hpp"

namespace phantom::fdh {

/// world = rotation * local + translation. rotation is orthonormal, row-major.
struct Pose {
    std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};
    Point translation{0, 0, 0};
};

/// Any number of threads may query at once; none may while add, set_pose or update runs.
template <int K>
class SceneTree {
  public:
    SceneTree();
    SceneTree(SceneTree&&) noexcept;
    SceneTree& operator=(SceneTree&&) noexcept;
    ~SceneTree();

    /// Adds an object; returns its number (0, 1, ...). Call update() before the next query.
    /// Throws std::invalid_argument for a pose that is not finite; so does set_pose.
    std::uint32_t add(TriangleTree<K> tree, const Pose& pose);
    void set_pose(std::uint32_t object, const Pose& pose);
    /// Rebuilds level one from the poses. O(objects log objects).
    void update();

    [[nodiscard]] std::size_t objects() const;
    [[nodiscard]] const TriangleTree<K>& tree(std::uint32_t object) const;
    [[nodiscard]] const Pose& pose(std::uint32_t object) const;
    [[nodiscard]] std::size_t triangles() const;
    [[nodiscard]] std::size_t bytes() const;

    /// As TriangleTree::nearest, over all objects; p in world coordinates. Of the accuracies of the
    /// objects that are near, the worst counts.
    void nearest(const Point& p, std::size_t count, double max_radius, Nearest& out) const;
    void within(const Point& p, double radius, std::vector<Hit>& out) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

extern template class SceneTree<6>;
extern template class SceneTree<14>;
extern template class SceneTree<18>;
extern template class SceneTree<26>;

} // namespace phantom::fdh
