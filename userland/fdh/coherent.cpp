// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/coherent.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fdh/scene_tree_impl.hpp"
#include "fdh/tree_impl.hpp"

namespace phantom::fdh {

/// The triangles of one tree within a radius of a centre, as leaves.
template <int K>
class CoherentQuery<K>::Sphere {
  public:
    using Tree = typename TriangleTree<K>::Impl;

    void search(const std::shared_ptr<const Tree>& tree, const Point& p, std::uint32_t object,
                NearestCollector& collector, Counts& counts)
    {
        if (tree_ != tree) {
            tree_ = tree;
            leaves_.clear();
            reach_ = 0;
        }
        if (tree->data.nodes.empty())
            return;
        const Point steps = tree->data.grid.to_steps(p);
        const double step_size = tree->data.grid.step, moved = distance(steps, last_) * step_size;
        const double before = std::min(reach_, collector.limit());
        last_ = steps;
        const bool near = Tree::near(steps);
        if (near && from_leaves(steps, object, collector)) {
            counts.kept++;
        } else if (near && moved < most_step * before && std::isfinite(before) &&
                   gather(steps, before, moved) && from_leaves(steps, object, collector)) {
            counts.gathered++;
        } else {
            leaves_.clear();
            tree->collect(p, object, collector);
            counts.searched++;
        }
        reach_ = collector.limit();
    }

  private:
    static constexpr double most_step = 0.2; ///< of the reach

    [[nodiscard]] static double distance(const Point& a, const Point& b)
    {
        return std::sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                         (a[2] - b[2]) * (a[2] - b[2]));
    }

    [[nodiscard]] bool from_leaves(const Point& steps, std::uint32_t object,
                                   NearestCollector& collector) const
    {
        if (leaves_.empty())
            return false;
        const double step_size = tree_->data.grid.step;
        // Everything within radius_ of the centre is there, as computed from there; twice the error, once at
        // each point.
        const ErrorBound error = tree_->error_from(steps);
        const double left = radius_ - distance(steps, centre_) * step_size;
        const double room = left - 2 * error.at(radius_);
        // Where the last answer did not fit in, this one would hardly: not worth looking.
        constexpr double hopeful = 0.95;
        if (!(room > 0) || room < hopeful * std::min(reach_, collector.limit()))
            return false;
        return collector.search_some<K>(leaves_, room, *tree_->kernels,
                                        search_point<K>(steps, tree_->data.longest_edge, false), step_size,
                                        object, error);
    }

    /// Takes the triangles round the point anew; false if there are too many.
    [[nodiscard]] bool gather(const Point& steps, double reach, double moved)
    {
        if (!gathered_)
            gathered_ = std::make_unique<Gathered>();
        Gathered& found = *gathered_;
        found.size = 0;
        found.complete = true;
        const double more = std::clamp(std::sqrt(2.5 * moved / reach), 0.1, 0.6);
        radius_ = reach * (1 + more);
        centre_ = steps;
        const auto point = search_point<K>(steps, tree_->data.longest_edge, tree_->prefetch);
        tree_->kernels->gather(tree_->view, point, search_limit2(radius_ / tree_->data.grid.step), found);
        pack(found);
        return found.complete;
    }

    /// Leaves hold their fields sixteen by sixteen.
    void pack(const Gathered& found)
    {
        leaves_.clear();
        if (!found.complete || found.size == 0)
            return;
        leaves_.resize((found.size + lanes - 1) / lanes);
        for (std::size_t l = 0; l < leaves_.size(); l++) {
            Leaf& leaf = leaves_[l];
            const std::size_t first = l * lanes;
            for (std::size_t axis = 0; axis < 3; axis++) {
                std::copy_n(found.field[axis] + first, lanes, leaf.vertex[axis]);
                std::copy_n(found.field[3 + axis] + first, lanes, leaf.edge1[axis]);
                std::copy_n(found.field[6 + axis] + first, lanes, leaf.edge2[axis]);
            }
            std::copy_n(found.triangle + first, lanes, leaf.triangle);
        }
        for (std::size_t lane = (found.size - 1) % lanes + 1; lane < lanes; lane++) {
            leaves_.back().vertex[0][lane] = std::numeric_limits<float>::quiet_NaN();
            leaves_.back().triangle[lane] = no_triangle;
        }
    }

    std::shared_ptr<const Tree> tree_;
    Point centre_{}, last_{};  ///< [steps]
    double radius_ = 0;        ///< [mesh unit]
    double reach_ = 0;         ///< of the last answer [mesh unit]
    std::vector<Leaf> leaves_; ///< empty: nothing at hand
    std::unique_ptr<Gathered> gathered_;
};

template <int K>
CoherentQuery<K>::CoherentQuery() = default;
template <int K>
CoherentQuery<K>::CoherentQuery(CoherentQuery&&) noexcept = default;
template <int K>
CoherentQuery<K>& CoherentQuery<K>::operator=(CoherentQuery&&) noexcept = default;
template <int K>
CoherentQuery<K>::~CoherentQuery() = default;

template <int K>
void CoherentQuery<K>::nearest(const TriangleTree<K>& tree, const Point& p, std::size_t count,
                               double max_radius, Nearest& out)
{
    if (!valid_query(p, max_radius)) {
        out.clear();
        return;
    }
    if (spheres_.empty())
        spheres_.resize(1);
    NearestCollector collector(out, count, max_radius);
    spheres_[0].search(tree.impl_, p, 0, collector, counts_);
    collector.finish();
}

template <int K>
void CoherentQuery<K>::nearest(const SceneTree<K>& scene, const Point& p, std::size_t count,
                               double max_radius, Nearest& out)
{
    if (!valid_query(p, max_radius)) {
        out.clear();
        return;
    }
    if (spheres_.size() < scene.objects())
        spheres_.resize(scene.objects());
    NearestCollector collector(out, count, max_radius);
    scene.impl_->visit(p, collector, [&](std::uint32_t object, const Point& local) {
        spheres_[object].search(scene.impl_->objects[object].tree.impl_, local, object, collector, counts_);
    });
    collector.finish();
}

template class CoherentQuery<6>;
template class CoherentQuery<14>;
template class CoherentQuery<18>;
template class CoherentQuery<26>;

} // namespace phantom::fdh
