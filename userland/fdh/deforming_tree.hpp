// SPDX-License-Identifier: GPL-2.0-or-later
// A tree that follows a mesh whose vertices move: refitted while that is good enough, else built anew.
#pragma once

#include "fdh/tree.hpp"

namespace phantom::fdh {

/// How good a refit is: TriangleTree::spread(), which a query's number of leaves grows with. A tree is built
/// anew when its spread has come to tolerated_growth times what it was when last built.
///
/// What that costs: building takes some 4 to 10 times as long as refitting (README, "Figures"). Walking
/// queries of the 64 nearest on the bunny, twisted and sheared until its spread had grown 1.5 times, took 1.1
/// times (median) and 1.5 times (p99) as long as of a tree built anew; at 1.9 times, 1.35 and 2.1; at 2.5
/// times, twice. A shape that comes and goes, such as a drum's, never gets there.
template <int K>
class DeformingTree {
  public:
    static constexpr double tolerated_growth = 1.5;

    /// Of the mesh as it is now.
    explicit DeformingTree(TriangleTree<K> tree) : tree_(std::move(tree)), built_spread_(tree_.spread()) {}

    /// The same triangles with other vertices. True if it was built anew. Throws as TriangleTree::refitted().
    bool update(const MeshView& mesh, const BuildOptions& options = {});
    [[nodiscard]] const TriangleTree<K>& tree() const { return tree_; }

  private:
    TriangleTree<K> tree_;
    double built_spread_; ///< when it was last built
};

template <int K>
bool DeformingTree<K>::update(const MeshView& mesh, const BuildOptions& options)
{
    tree_ = tree_.refitted(mesh, options);
    if (!(tree_.spread() > tolerated_growth * built_spread_))
        return false;
    tree_ = TriangleTree<K>::build(mesh, options);
    built_spread_ = tree_.spread();
    return true;
}

} // namespace phantom::fdh
