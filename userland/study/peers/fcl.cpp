// SPDX-License-Identifier: GPL-2.0-or-later
// FCL: collide() of a sphere with a BVHModel of OBBRSS, every triangle that the sphere touches. Of FCL's
// bounding volumes the oriented ones are queried in place; with boxes and k-DOPs collide() copies the whole
// model first.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>

#include <memory>

#include "study/peers/contenders.hpp"
#include "study/peers/heap.hpp"
#include "study/peers/nearest_keeper.hpp"

namespace phantom::peers {

namespace {

using Model = fcl::BVHModel<fcl::OBBRSSd>;

class Fcl final : public Contender {
  public:
    [[nodiscard]] std::string name() const override { return "FCL"; }
    [[nodiscard]] std::string method() const override { return "collide(sphere, BVHModel<OBBRSS>)"; }
    [[nodiscard]] std::size_t largest_mesh() const override { return 1'000'000; }

    void prepare(const Mesh& mesh) override
    {
        model_.reset();
        mesh_ = &mesh;
        copy_points(mesh);
        triangles_.clear();
        for (const fdh::Triangle& t : mesh.triangles)
            triangles_.emplace_back(t[0], t[1], t[2]);
    }
    void build(unsigned /*threads*/) override
    {
        const std::size_t before = heap_bytes();
        model_ = std::make_unique<Model>();
        model_->beginModel(static_cast<int>(triangles_.size()), static_cast<int>(points_.size()));
        model_->addSubModel(points_, triangles_);
        model_->endModel();
        bytes_ = heap_bytes() - before;
    }
    [[nodiscard]] std::size_t bytes() const override { return bytes_; }

    void query(const fdh::Point& p, double radius) override
    {
        keeper_.start(*mesh_, p, radius);
        const fcl::Sphered sphere(radius);
        fcl::Transform3d pose = fcl::Transform3d::Identity();
        pose.translation() = fcl::Vector3d(p[0], p[1], p[2]);
        result_.clear();
        const fcl::CollisionRequestd everything(triangles_.size());
        fcl::collide(model_.get(), fcl::Transform3d::Identity(), &sphere, pose, everything, result_);
        for (std::size_t i = 0; i < result_.numContacts(); ++i)
            keeper_.offer(static_cast<std::uint32_t>(result_.getContact(i).b1));
        keeper_.finish();
    }
    void distances(std::vector<double>& out) const override { keeper_.distances(out); }

    [[nodiscard]] bool refits() const override { return true; }
    void prepare_refit(const Mesh& moved, unsigned /*threads*/) override
    {
        mesh_ = &moved;
        copy_points(moved);
    }
    void refit() override
    {
        model_->beginReplaceModel();
        model_->replaceSubModel(points_);
        model_->endReplaceModel(true, true);
    }

  private:
    void copy_points(const Mesh& mesh)
    {
        points_.clear();
        for (const fdh::Point& p : mesh.vertices)
            points_.emplace_back(p[0], p[1], p[2]);
    }

    const Mesh* mesh_ = nullptr;
    std::vector<fcl::Vector3d> points_;
    std::vector<fcl::Triangle> triangles_;
    std::unique_ptr<Model> model_;
    fcl::CollisionResultd result_;
    std::size_t bytes_ = 0;
    NearestKeeper keeper_;
};

} // namespace

std::unique_ptr<Contender> make_fcl()
{
    return std::make_unique<Fcl>();
}

} // namespace phantom::peers
