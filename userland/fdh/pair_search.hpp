// SPDX-License-Identifier: GPL-2.0-or-later
// Triangle against triangle between two posed trees: both are gone down together, the hulls of the second as
// seen in the frame of the first.
#pragma once

#include <vector>

#include "fdh/grid.hpp"
#include "fdh/layout.hpp"
#include "fdh/pose.hpp"
#include "fdh/query.hpp"

namespace phantom::fdh {

template <int K>
struct PosedTree {
    TreeView<K> tree;
    Grid grid;
    Pose pose;
};

/// Adds every pair of a triangle of the first and one of the second tree that are within `distance`; some
/// that are farther, too, by no more than twice the sum of what the trees' vertices and the poses are rounded
/// by.
template <int K>
void search_pairs(const PosedTree<K>& first, const PosedTree<K>& second, double distance,
                  std::vector<TrianglePair>& out);

} // namespace phantom::fdh
