// SPDX-License-Identifier: GPL-2.0-or-later
// From triangles to the arrays a search walks.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "fdh/grid.hpp"
#include "fdh/isa.hpp"
#include "fdh/layout.hpp"

namespace phantom::fdh {

template <int K>
struct TreeData {
    Grid grid;
    std::span<const Node<K>> nodes; ///< level by level (Levels), [0] is the root; empty for no triangles
    std::span<const Leaf> leaves;
    std::size_t triangles = 0;
    double longest_edge = 0;               ///< [steps], or more
    double spread = 0;                     ///< see TriangleTree::spread
    std::shared_ptr<const void> storage{}; ///< what nodes and leaves lie in

    [[nodiscard]] TreeView<K> view() const
    {
        return {nodes.data(), leaves.data(), Levels::above(leaves.size())};
    }
};

/// Throws as TriangleTree::build says.
template <int K>
TreeData<K> build_tree(const MeshView& mesh, unsigned threads, Isa isa);

/// The same triangles in the same places of the tree, with the vertices of `mesh`. Throws as
/// TriangleTree::refitted says.
template <int K>
TreeData<K> refit_tree(const TreeData<K>& old, const MeshView& mesh, unsigned threads);

/// False if the arrays do not fit each other, or a leaf names a triangle that is not there: a search would
/// leave the arrays.
template <int K>
bool consistent(const TreeData<K>& data);

/// The hull of everything below a node, per direction.
template <int K>
struct Hull {
    float low[K / 2];
    float high[K / 2];

    static Hull empty();
    void grow(const Hull& other);
};

template <int K>
Hull<K> hull_of(const Node<K>& node);

template <int K>
void set_child(Node<K>& node, int lane, const Hull<K>& hull);

/// A node without children.
template <int K>
Node<K> empty_node();

} // namespace phantom::fdh
