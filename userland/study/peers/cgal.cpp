// SPDX-License-Identifier: GPL-2.0-or-later
// CGAL: AABB_tree, with a traversal of our own as its distance queries have one: nearer child first, in a
// sphere that shrinks as the 64 nearest are found.
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <memory>
#include <utility>

#include "study/peers/contenders.hpp"
#include "study/peers/heap.hpp"
#include "study/peers/nearest_keeper.hpp"

namespace phantom::peers {

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Traits = CGAL::AABB_traits<Kernel, Primitive>;
using Tree = CGAL::AABB_tree<Traits>;

double squared_to_box(const fdh::Point& p, const CGAL::Bbox_3& box)
{
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double x = p[static_cast<std::size_t>(axis)];
        const double outside = std::max({box.min(axis) - x, x - box.max(axis), 0.0});
        sum += outside * outside;
    }
    return sum;
}

/// What CGAL asks its traversals: where to go, and in which order.
class Traversal {
  public:
    using Priority = double; ///< the greater, the earlier

    Traversal(const Triangles& triangles, NearestKeeper& keeper)
        : first_(triangles.begin()), keeper_(keeper), bound2_(keeper.bound2())
    {
    }
    [[nodiscard]] static constexpr bool go_further() { return true; }
    void intersection(const fdh::Point& /*p*/, const Primitive& primitive)
    {
        if (keeper_.offer(static_cast<std::uint32_t>(primitive.id() - first_)))
            bound2_ = keeper_.bound2();
    }
    template <class Node>
    [[nodiscard]] bool do_intersect(const fdh::Point& p, const Node& node) const
    {
        return squared_to_box(p, node.bbox()) <= bound2_;
    }
    template <class Node>
    [[nodiscard]] std::pair<bool, Priority> do_intersect_with_priority(const fdh::Point& p,
                                                                       const Node& node) const
    {
        const double squared = squared_to_box(p, node.bbox());
        return {squared <= bound2_, -squared};
    }

  private:
    Triangles::const_iterator first_;
    NearestKeeper& keeper_;
    double bound2_;
};

class Cgal final : public Contender {
  public:
    [[nodiscard]] std::string name() const override { return "CGAL"; }
    [[nodiscard]] std::string method() const override { return "AABB_tree, own traversal, radius shrinks"; }
    [[nodiscard]] std::size_t largest_mesh() const override { return 5'000'000; }

    void prepare(const Mesh& mesh) override
    {
        tree_.reset();
        mesh_ = &mesh;
        triangles_.clear();
        triangles_.reserve(mesh.triangles.size());
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            const auto x = mesh.corners(i);
            triangles_.emplace_back(point(x[0]), point(x[1]), point(x[2]));
        }
    }
    /// With the triangles that the tree points into: it cannot do without.
    void build(unsigned /*threads*/) override
    {
        const std::size_t before = heap_bytes();
        tree_ = std::make_unique<Tree>(triangles_.begin(), triangles_.end());
        tree_->build();
        bytes_ = heap_bytes() - before + triangles_.size() * sizeof(triangles_[0]);
    }
    [[nodiscard]] std::size_t bytes() const override { return bytes_; }

    void query(const fdh::Point& p, double radius) override
    {
        keeper_.start(*mesh_, p, radius);
        Traversal traversal(triangles_, keeper_);
        tree_->traversal_with_priority(p, traversal);
        keeper_.finish();
    }
    void distances(std::vector<double>& out) const override { keeper_.distances(out); }

  private:
    static Kernel::Point_3 point(const fdh::Point& p) { return {p[0], p[1], p[2]}; }

    const Mesh* mesh_ = nullptr;
    Triangles triangles_;
    std::unique_ptr<Tree> tree_;
    std::size_t bytes_ = 0;
    NearestKeeper keeper_;
};

} // namespace

std::unique_ptr<Contender> make_cgal()
{
    return std::make_unique<Cgal>();
}

} // namespace phantom::peers
