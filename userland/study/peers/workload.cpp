// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/peers/workload.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "base/vector.hpp"
#include "fdh/tree.hpp"
#include "mesh/nearest_on_triangle.hpp"
#include "study/peers/contender.hpp"

namespace phantom::peers {

namespace {

constexpr int radius_samples = 1001;
/// A stroke's direction turns by up to this in the surface, per step.
constexpr double turn_rad = 0.03;

fdh::Point as_float(const fdh::Point& p)
{
    return {double(float(p[0])), double(float(p[1])), double(float(p[2]))};
}

class Walker {
  public:
    explicit Walker(const Mesh& mesh)
        : mesh_(mesh), tree_(fdh::TriangleTree<14>::build(mesh.view())), random_(1)
    {
    }

    /// A point of a random triangle.
    fdh::Point anywhere()
    {
        std::uniform_real_distribution<double> unit(0, 1);
        face_ = random_() % mesh_.triangles.size();
        const auto [a, b, c] = mesh_.corners(face_);
        double s = unit(random_), t = unit(random_);
        if (s + t > 1)
            s = 1 - s, t = 1 - t;
        return as_float(a + s * (b - a) + t * (c - a));
    }

    double median_radius()
    {
        std::vector<double> reach;
        for (int i = 0; i < radius_samples; ++i) {
            tree_.nearest(anywhere(), wanted, std::numeric_limits<double>::max(), found_);
            double farthest = 0;
            for (const fdh::Hit& hit : found_.hits)
                farthest = std::max(farthest, hit.distance);
            reach.push_back(farthest);
        }
        std::nth_element(reach.begin(), reach.begin() + radius_samples / 2, reach.end());
        return reach[radius_samples / 2];
    }

    [[nodiscard]] double accuracy(const fdh::Point& p, double distance) const
    {
        return tree_.accuracy(p, distance);
    }

    void stroke(std::size_t steps, std::vector<fdh::Point>& out)
    {
        std::uniform_real_distribution<double> any(-1, 1);
        fdh::Point at = anywhere();
        Vec3 along = unit({any(random_), any(random_), any(random_)});
        for (std::size_t i = 0; i < steps; ++i) {
            out.push_back(as_float(at));
            const auto x = mesh_.corners(face_);
            const Vec3 normal = unit_or(cross(x[1] - x[0], x[2] - x[0]), {0, 0, 1});
            const Vec3 flat = along - dot(along, normal) * normal;
            along = unit_or(flat, perpendicular(normal, along));
            along = unit(along + turn_rad * any(random_) * cross(normal, along));
            at = pulled_back(at + mesh_.diagonal * walk_step_part * along);
        }
    }

  private:
    /// The surface's point nearest to p.
    fdh::Point pulled_back(const fdh::Point& p)
    {
        tree_.nearest(p, 1, std::numeric_limits<double>::max(), found_);
        face_ = found_.hits.front().triangle;
        const auto x = mesh_.corners(face_);
        const auto weights = mesh::nearest_on_triangle(p, x);
        return weights[0] * x[0] + weights[1] * x[1] + weights[2] * x[2];
    }

    const Mesh& mesh_;
    fdh::TriangleTree<14> tree_;
    fdh::Nearest found_;
    std::mt19937_64 random_;
    std::size_t face_ = 0; ///< that the last point lies on
};

} // namespace

Workload make_workload(const Mesh& mesh, std::size_t strokes, std::size_t steps)
{
    Walker walker(mesh);
    Workload work;
    work.radius = double(float(walker.median_radius()));
    for (std::size_t i = 0; i < strokes; ++i)
        walker.stroke(steps, work.walk);
    for (std::size_t i = 0; i < strokes * steps; ++i)
        work.jump.push_back(walker.anywhere());
    work.accuracy = walker.accuracy(work.jump.front(), work.radius);
    return work;
}

} // namespace phantom::peers
