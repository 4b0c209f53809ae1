// SPDX-License-Identifier: GPL-2.0-or-later
// Level one of the hierarchy: objects with rigid poses, hulls over objects. A query goes down to the
// objects near the point and is answered by each in its own frame: a rigid motion rebuilds nothing.
#pragma once

#include <memory>
#include <vector>

#include "fdh/pose.hpp"
#include "fdh/tree.hpp"

namespace phantom::fdh {

/// Two objects that may be near each other.
struct ObjectPair {
    std::uint32_t first, second;
    double at_least; ///< no triangle of the one is nearer to any of the other [mesh unit]
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
    /// Another tree for an object, such as its refit after the object was deformed.
    void set_tree(std::uint32_t object, TriangleTree<K> tree);
    /// Takes poses and trees set since the last call into level one, which is refitted, or built anew where
    /// the refit would have become slow to query (object_tree.hpp has the measure). Returns true if it was
    /// built anew. Costs O(objects), then O(objects log objects), and allocates nothing once warm.
    bool update();

    [[nodiscard]] std::size_t objects() const;
    [[nodiscard]] const TriangleTree<K>& tree(std::uint32_t object) const;
    [[nodiscard]] const Pose& pose(std::uint32_t object) const;
    [[nodiscard]] std::size_t triangles() const;
    [[nodiscard]] std::size_t bytes() const;

    /// As TriangleTree::nearest, over all objects; p in world coordinates. Of the accuracies of the
    /// objects that are near, the worst counts.
    void nearest(const Point& p, std::size_t count, double max_radius, Nearest& out) const;
    void within(const Point& p, double radius, std::vector<Hit>& out) const;

    /// As TriangleTree::along and TriangleTree::in_box, over all objects, in world coordinates.
    void along(const Point& from, const Point& to, double radius, std::vector<Hit>& out) const;
    void in_box(const Box& box, std::vector<Hit>& out) const;

    /// Every object whose triangles may be within `distance` of the given object's, ordered by number: the
    /// first level of collision detection in Kabelac 2001, section 5, for the hand's own object. `first` is
    /// the given object. Never misses one. Hulls decide, as seen in world directions and from both objects'
    /// frames: some that are farther may be there. An invalid distance (negative, NaN) finds nothing; an
    /// object that is not there throws std::out_of_range.
    void pairs_near(std::uint32_t object, double distance, std::vector<ObjectPair>& out) const;
    /// All such pairs, each once with first < second, ordered.
    void pairs(double distance, std::vector<ObjectPair>& out) const;
    /// Every pair of a triangle of the one object and one of the other that are within `distance`, in no
    /// order: what the objects of a pair come down to. Never misses one; may include some that are farther,
    /// by twice the sum of both trees' accuracies and 2^-48 of the largest coordinate of their poses and
    /// meshes. Invalid distances and objects as for pairs_near().
    void triangle_pairs(std::uint32_t first, std::uint32_t second, double distance,
                        std::vector<TrianglePair>& out) const;

  private:
    friend class CoherentQuery<K>;
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

extern template class SceneTree<6>;
extern template class SceneTree<14>;
extern template class SceneTree<18>;
extern template class SceneTree<26>;

} // namespace phantom::fdh
