// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/coverage.hpp"

#include <algorithm>
#include <cmath>

#include "fdh/parallel.hpp"
#include "mesh/vector.hpp"

namespace phantom::scene {

namespace {

using mesh::Vec3;

Vec3 to_world(const fdh::Pose& pose, const Vec3& v)
{
    const auto& r = pose.rotation;
    return {r[0] * v[0] + r[1] * v[1] + r[2] * v[2] + pose.translation[0],
            r[3] * v[0] + r[4] * v[1] + r[5] * v[2] + pose.translation[1],
            r[6] * v[0] + r[7] * v[1] + r[8] * v[2] + pose.translation[2]};
}

/// Area of the faces up to each, in the order of objects and faces.
std::vector<double> summed_areas(const Scene& scene)
{
    std::vector<double> sums;
    sums.reserve(scene.triangles());
    double sum = 0;
    for (const Object& object : scene.objects) {
        for (const mesh::Triple& face : object.mesh.faces) {
            const Vec3& a = object.mesh.vertices[face[0]];
            sum += 0.5 * mesh::length(mesh::cross(mesh::subtract(object.mesh.vertices[face[1]], a),
                                                  mesh::subtract(object.mesh.vertices[face[2]], a)));
            sums.push_back(sum);
        }
    }
    return sums;
}

/// Evenly spread in a face: the n-th point of the R2 sequence (Roberts 2018), folded into the triangle.
Vec3 point_in(const Object& object, const mesh::Triple& face, std::size_t n)
{
    const double number = static_cast<double>(n + 1);
    double b = std::fmod(0.7548776662466927 * number, 1.0), c = std::fmod(0.5698402909980532 * number, 1.0);
    if (b + c > 1) {
        b = 1 - b;
        c = 1 - c;
    }
    return to_world(object.pose, mesh::add(mesh::add(mesh::scaled(object.mesh.vertices[face[0]], 1 - b - c),
                                                     mesh::scaled(object.mesh.vertices[face[1]], b)),
                                           mesh::scaled(object.mesh.vertices[face[2]], c)));
}

/// Equal steps of area through all faces.
std::vector<Vec3> spread_points(const Scene& scene, std::size_t count)
{
    std::vector<Vec3> points;
    const std::vector<double> sums = summed_areas(scene);
    if (sums.empty() || !(sums.back() > 0))
        return points;
    points.reserve(count);
    std::size_t object = 0, first = 0, at = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double area = (static_cast<double>(i) + 0.5) / static_cast<double>(count) * sums.back();
        while (at + 1 < sums.size() && sums[at] < area)
            ++at;
        while (at >= first + scene.objects[object].mesh.faces.size())
            first += scene.objects[object++].mesh.faces.size();
        points.push_back(point_in(scene.objects[object], scene.objects[object].mesh.faces[at - first], i));
    }
    return points;
}

} // namespace

std::vector<float> coverage_at(const fdh::SceneTree<14>& tree, std::span<const Vec3> points_mm,
                               std::uint32_t budget)
{
    std::vector<float> out(points_mm.size());
    fdh::parallel_for(0, points_mm.size(), fdh::thread_count(0), [&](std::size_t begin, std::size_t end) {
        fdh::Nearest nearest;
        for (std::size_t i = begin; i < end; ++i) {
            tree.nearest(points_mm[i], budget, coverage_max_mm, nearest);
            out[i] = static_cast<float>(nearest.coverage);
        }
    });
    return out;
}

Coverage measure_coverage(const Scene& scene, const fdh::SceneTree<14>& tree, std::uint32_t budget,
                          std::size_t samples)
{
    Coverage out;
    out.budget = budget;
    std::vector<float> all = coverage_at(tree, spread_points(scene, samples), budget);
    out.samples = all.size();
    if (all.empty())
        return out;
    std::sort(all.begin(), all.end());
    out.min_mm = all.front();
    out.p1_mm = all[all.size() / 100];
    out.median_mm = all[all.size() / 2];
    return out;
}

std::vector<float> vertex_coverage(const Object& object, const fdh::SceneTree<14>& tree, std::uint32_t budget)
{
    std::vector<Vec3> points;
    points.reserve(object.mesh.vertices.size());
    for (const Vec3& vertex : object.mesh.vertices)
        points.push_back(to_world(object.pose, vertex));
    return coverage_at(tree, points, budget);
}

double reach_needed_mm(double contact_radius_mm, double speed_mm_s, double delay_s)
{
    return contact_radius_mm + way_margin * speed_mm_s * delay_s;
}

double speed_allowed_mm_s(double reach_mm, double contact_radius_mm, double delay_s)
{
    return std::max(0.0, reach_mm - contact_radius_mm) / (way_margin * delay_s);
}

} // namespace phantom::scene
