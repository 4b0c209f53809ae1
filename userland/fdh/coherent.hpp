// SPDX-License-Identifier: GPL-2.0-or-later
// Queries of a point that moves little between them: triangles of a somewhat larger sphere are kept at hand,
// packed, and searched instead of the tree while the point's own sphere lies within that one.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fdh/scene_tree.hpp"

namespace phantom::fdh {

/// One walk. Gives the same answers as TriangleTree::nearest and SceneTree::nearest, bit for bit. For one
/// thread at a time; the trees may be queried by others meanwhile. No allocation once warm.
///
/// How much larger the sphere is follows the point's steps: of reach R and step s it is about sqrt(s / R)
/// more, where what the larger sphere costs per query balances what taking a new one costs. Steps above a
/// fifth of the reach are answered by the tree.
template <int K>
class CoherentQuery {
  public:
    CoherentQuery();
    CoherentQuery(CoherentQuery&&) noexcept;
    CoherentQuery& operator=(CoherentQuery&&) noexcept;
    ~CoherentQuery();

    void nearest(const TriangleTree<K>& tree, const Point& p, std::size_t count, double max_radius,
                 Nearest& out);
    /// Each object near the point is searched in its own frame: moving objects cost no more than a moving
    /// point.
    void nearest(const SceneTree<K>& scene, const Point& p, std::size_t count, double max_radius,
                 Nearest& out);

    /// How the queries so far were answered, each counted once per object.
    struct Counts {
        std::uint64_t kept = 0;     ///< from the triangles at hand
        std::uint64_t gathered = 0; ///< from a sphere taken anew
        std::uint64_t searched = 0; ///< from the tree
    };
    [[nodiscard]] const Counts& counts() const { return counts_; }

  private:
    class Sphere;
    Counts counts_;
    std::vector<Sphere> spheres_; ///< by object
};

extern template class CoherentQuery<6>;
extern template class CoherentQuery<14>;
extern template class CoherentQuery<18>;
extern template class CoherentQuery<26>;

} // namespace phantom::fdh
