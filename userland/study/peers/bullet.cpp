// SPDX-License-Identifier: GPL-2.0-or-later
// Bullet: btOptimizedBvh, the tree of its triangle meshes; every triangle whose box meets the box round the
// query's sphere. It is asked directly, which spares the copying of corners that
// btBvhTriangleMeshShape::processAllTriangles does.
//
// Bullet makes no box thinner than 0.002, so the mesh is scaled up by a power of two to triangles of about
// one. Its compressed nodes have 21 bits for a triangle's number; larger meshes get the uncompressed ones.
#include <BulletCollision/CollisionShapes/btOptimizedBvh.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>

#include <cmath>
#include <memory>

#include "study/peers/contenders.hpp"
#include "study/peers/heap.hpp"
#include "study/peers/nearest_keeper.hpp"

namespace phantom::peers {

namespace {

constexpr std::size_t compressed_up_to = std::size_t{1} << 21;

class Bullet final : public Contender {
  public:
    [[nodiscard]] std::string name() const override { return "Bullet"; }
    [[nodiscard]] std::string method() const override { return "btOptimizedBvh, box round the sphere"; }

    void prepare(const Mesh& mesh) override
    {
        drop();
        mesh_ = &mesh;
        double area = 0;
        for (const auto& t : mesh.triangles)
            area += twice_area(mesh, t);
        const double edge = std::sqrt(area / static_cast<double>(mesh.triangles.size()));
        scale_ = edge > 0 ? static_cast<float>(std::exp2(std::round(-std::log2(edge)))) : 1.0F;
        scale_points(mesh);
        // Bullet's arrays are not const, and are not written to.
        arrays_ = std::make_unique<btTriangleIndexVertexArray>(
            static_cast<int>(mesh.triangles.size()),
            reinterpret_cast<int*>(const_cast<fdh::Triangle*>(mesh.triangles.data())),
            static_cast<int>(sizeof(fdh::Triangle)), static_cast<int>(points_.size()), points_[0].data(),
            static_cast<int>(sizeof(points_[0])));
    }

    void build(unsigned /*threads*/) override
    {
        const std::size_t before = heap_bytes();
        tree_ = std::make_unique<btOptimizedBvh>();
        tree_->build(arrays_.get(), compressed(), low_, high_);
        bytes_ = heap_bytes() - before;
    }
    [[nodiscard]] std::size_t bytes() const override { return bytes_; }

    void query(const fdh::Point& p, double radius) override
    {
        Visitor visitor(keeper_);
        keeper_.start(*mesh_, p, radius);
        const btVector3 centre(scaled(p[0]), scaled(p[1]), scaled(p[2]));
        const float reach = scaled(radius);
        tree_->reportAabbOverlappingNodex(&visitor, centre - btVector3(reach, reach, reach),
                                          centre + btVector3(reach, reach, reach));
        keeper_.finish();
    }
    void distances(std::vector<double>& out) const override { keeper_.distances(out); }

    /// Bullet's refit leaves uncompressed nodes as they are.
    [[nodiscard]] bool refits() const override { return compressed(); }
    void prepare_refit(const Mesh& moved, unsigned /*threads*/) override
    {
        mesh_ = &moved;
        scale_points(moved);
    }
    void refit() override { tree_->refit(arrays_.get(), low_, high_); }

  private:
    class Visitor final : public btNodeOverlapCallback {
      public:
        explicit Visitor(NearestKeeper& keeper) : keeper_(keeper) {}
        void processNode(int /*part*/, int triangle) override
        {
            keeper_.offer(static_cast<std::uint32_t>(triangle));
        }

      private:
        NearestKeeper& keeper_;
    };

    [[nodiscard]] bool compressed() const { return mesh_->triangles.size() < compressed_up_to; }

    static double twice_area(const Mesh& mesh, const fdh::Triangle& t)
    {
        const FloatVector a = as_vector(mesh.points[t[0]]);
        const FloatVector n = cross(as_vector(mesh.points[t[1]]) - a, as_vector(mesh.points[t[2]]) - a);
        return std::sqrt(double{dot(n, n)});
    }

    [[nodiscard]] float scaled(double x) const { return scale_ * static_cast<float>(x); }

    /// In place where there are points already: a refit keeps the arrays.
    void scale_points(const Mesh& mesh)
    {
        points_.resize(mesh.points.size());
        low_.setValue(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
        high_ = -low_;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            const auto& p = mesh.points[i];
            points_[i] = {scale_ * p[0], scale_ * p[1], scale_ * p[2], 0};
            const btVector3 point(points_[i][0], points_[i][1], points_[i][2]);
            low_.setMin(point);
            high_.setMax(point);
        }
    }

    void drop()
    {
        tree_.reset();
        arrays_.reset();
    }

    const Mesh* mesh_ = nullptr;
    float scale_ = 1;
    std::vector<std::array<float, 4>> points_; ///< scaled
    btVector3 low_, high_;
    std::unique_ptr<btTriangleIndexVertexArray> arrays_;
    std::unique_ptr<btOptimizedBvh> tree_;
    std::size_t bytes_ = 0;
    NearestKeeper keeper_;
};

} // namespace

std::unique_ptr<Contender> make_bullet()
{
    return std::make_unique<Bullet>();
}

} // namespace phantom::peers
