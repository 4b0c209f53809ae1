// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/surface_point.hpp"

#include <algorithm>

namespace phantom::study {

namespace {

/// A ray ends this near to the surface.
constexpr double arrived_mm = 1e-6;

/// A ray that grazes a surface makes small steps for ever; it is given up after this many.
constexpr int trace_steps_max = 2000;

Vec3 rotate(const fdh::Pose& pose, const Vec3& v)
{
    const auto& r = pose.rotation;
    return {r[0] * v[0] + r[1] * v[1] + r[2] * v[2], r[3] * v[0] + r[4] * v[1] + r[5] * v[2],
            r[6] * v[0] + r[7] * v[1] + r[8] * v[2]};
}

/// Weights on a segment's ends.
std::array<double, 2> nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b)
{
    const Vec3 ab = b - a;
    const double squared = dot(ab, ab);
    const double t = squared > 0 ? std::clamp(dot(p - a, ab) / squared, 0.0, 1.0) : 0.0;
    return {1.0 - t, t};
}

/// Corner weights of the point of a triangle nearest to p: inside the face's prism, else on the best edge.
Vec3 nearest_on_triangle(const Vec3& p, const std::array<Vec3, 3>& x)
{
    const Vec3 e1 = x[1] - x[0], e2 = x[2] - x[0], q = p - x[0];
    const double d11 = dot(e1, e1), d12 = dot(e1, e2), d22 = dot(e2, e2), q1 = dot(q, e1), q2 = dot(q, e2);
    const double determinant = d11 * d22 - d12 * d12;
    if (determinant > 0) {
        const double v = (d22 * q1 - d12 * q2) / determinant, w = (d11 * q2 - d12 * q1) / determinant;
        if (v >= 0 && w >= 0 && v + w <= 1)
            return {1 - v - w, v, w};
    }
    Vec3 best{1, 0, 0};
    double best_squared = -1;
    for (int edge = 0; edge < 3; ++edge) {
        const int from = edge, to = (edge + 1) % 3;
        const std::array<double, 2> weight = nearest_on_segment(p, x[from], x[to]);
        const Vec3 away = p - (weight[0] * x[from] + weight[1] * x[to]);
        const double squared = dot(away, away);
        if (best_squared < 0 || squared < best_squared) {
            best_squared = squared;
            best = {0, 0, 0};
            best[from] = weight[0];
            best[to] = weight[1];
        }
    }
    return best;
}

} // namespace

Surface::Surface(const scene::Scene& scene, const fdh::SceneTree<14>& tree) : scene_(scene), tree_(tree) {}

SurfacePoint Surface::on_face(std::uint32_t object, std::uint32_t face, const Vec3& weights) const
{
    const scene::Object& owner = scene_.objects[object];
    Vec3 position{}, normal{};
    for (int corner = 0; corner < 3; ++corner) {
        position = position + weights[corner] * owner.mesh.vertices[owner.mesh.faces[face][corner]];
        normal = normal + weights[corner] * owner.mesh.normals[owner.mesh.face_normals[face][corner]];
    }
    return {rotate(owner.pose, position) + owner.pose.translation, unit(rotate(owner.pose, normal))};
}

std::optional<SurfacePoint> Surface::nearest(const Vec3& point_mm, double within_mm)
{
    found_.clear();
    tree_.nearest(point_mm, 1, within_mm, found_);
    if (found_.hits.empty())
        return std::nullopt;
    const fdh::Hit& hit = found_.hits.front();
    std::array<Vec3, 3> corners;
    for (int corner = 0; corner < 3; ++corner) {
        Vec3 weights{};
        weights[corner] = 1;
        corners[corner] = on_face(hit.object, hit.triangle, weights).position_mm;
    }
    return on_face(hit.object, hit.triangle, nearest_on_triangle(point_mm, corners));
}

std::optional<SurfacePoint> Surface::trace(const Vec3& start_mm, const Vec3& direction, double length_mm)
{
    double gone_mm = 0;
    for (int step = 0; step < trace_steps_max && gone_mm <= length_mm; ++step) {
        const Vec3 here = start_mm + gone_mm * direction;
        const std::optional<SurfacePoint> point = nearest(here, length_mm);
        if (!point)
            return std::nullopt;
        const double free_mm = phantom::length(point->position_mm - here);
        if (free_mm <= arrived_mm)
            return point;
        gone_mm += free_mm;
    }
    return std::nullopt;
}

} // namespace phantom::study
