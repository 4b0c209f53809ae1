// SPDX-License-Identifier: GPL-2.0-or-later
// From triangles to the arrays a search walks.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "fdh/grid.hpp"
#include "fdh/layout.hpp"

namespace phantom::fdh {

template <int K>
struct TreeData {
    Grid grid;
    std::span<const Node<K>> nodes; ///< parents before children, [0] is the root; empty for no triangles
    std::span<const Leaf> leaves;
    std::size_t triangles = 0;
    std::shared_ptr<const void> storage{}; ///< what nodes and leaves lie in
};

/// Throws as TriangleTree::build says.
template <int K>
TreeData<K> build_tree(const MeshView& mesh, unsigned threads);

/// False if a child is not there or does not stand behind its parent, or a leaf names a triangle that is not
/// there: a search would not end, or leave the arrays.
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
void set_child(Node<K>& node, int lane, const Hull<K>& hull, std::uint32_t child);

/// A node without children.
template <int K>
Node<K> empty_node();

} // namespace phantom::fdh
