// SPDX-License-Identifier: GPL-2.0-or-later
#include "poses.hpp"

#include <algorithm>
#include <cmath>

#include "oracle.hpp"

namespace phantom::fdh::test {

Pose turn(Point axis, double angle, const Point& translation)
{
    const double length = std::hypot(axis[0], axis[1], axis[2]);
    for (double& x : axis)
        x /= length;
    const double c = std::cos(angle), s = std::sin(angle), t = 1 - c;
    const auto [x, y, z] = axis;
    return {{c + t * x * x, t * x * y - s * z, t * x * z + s * y, t * x * y + s * z, c + t * y * y,
             t * y * z - s * x, t * x * z - s * y, t * y * z + s * x, c + t * z * z},
            translation};
}

Pose random_pose(double reach, std::mt19937_64& random)
{
    std::uniform_real_distribution<double> place(-reach, reach), angle(0, 6);
    std::normal_distribution<double> normal;
    Point axis, translation;
    for (int i = 0; i < 3; i++) {
        axis[i] = normal(random);
        translation[i] = place(random);
    }
    return turn(axis, angle(random), translation);
}

Point to_world(const Pose& pose, const Point& v)
{
    Point w;
    for (int row = 0; row < 3; row++) {
        long double sum = pose.translation[row];
        for (int axis = 0; axis < 3; axis++)
            sum += static_cast<long double>(pose.rotation[3 * row + axis]) * v[axis];
        w[row] = static_cast<double>(sum);
    }
    return w;
}

Mesh posed(Mesh mesh, const Pose& pose)
{
    for (auto& v : mesh.vertices)
        v = to_world(pose, v);
    return mesh;
}

Corners corners(const Mesh& mesh, std::size_t triangle)
{
    const auto& [a, b, c] = mesh.triangles[triangle];
    return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

namespace {

using Wide = std::array<long double, 3>;

long double distance_at(const Wide& from, const Wide& to, long double t, const Corners& triangle)
{
    // Seen from the segment's point: the corners relative to it, in long double.
    std::array<Wide, 3> relative;
    for (int i = 0; i < 3; i++)
        for (int axis = 0; axis < 3; axis++)
            relative[i][axis] = triangle[i][axis] - (from[axis] + t * (to[axis] - from[axis]));
    return true_distance_from_origin(relative);
}

/// Centre and radius of a sphere round a triangle.
std::pair<Point, double> sphere_round(const Corners& t)
{
    Point centre;
    double radius = 0;
    for (int axis = 0; axis < 3; axis++)
        centre[axis] = (t[0][axis] + t[1][axis] + t[2][axis]) / 3;
    for (const Point& corner : t)
        radius =
            std::max(radius, std::hypot(corner[0] - centre[0], corner[1] - centre[1], corner[2] - centre[2]));
    return {centre, radius};
}

} // namespace

long double true_distance(const Segment& segment, const Corners& triangle)
{
    const auto& [from, to] = segment;
    const Wide p = {from[0], from[1], from[2]}, q = {to[0], to[1], to[2]};
    // Golden section. Both values anew in each step: a reused place drifts from where it should lie.
    const long double part = (std::sqrt(5.0L) - 1) / 2;
    long double low = 0, high = 1;
    long double best = std::min(distance_at(p, q, 0, triangle), distance_at(p, q, 1, triangle));
    for (int i = 0; i < 92; i++) { // 0.618^92 is 6e-20
        const long double x = high - part * (high - low), y = low + part * (high - low);
        const long double at_x = distance_at(p, q, x, triangle), at_y = distance_at(p, q, y, triangle);
        best = std::min({best, at_x, at_y});
        (at_x < at_y ? high : low) = at_x < at_y ? y : x;
    }
    return best;
}

long double true_distance(const Corners& a, const Corners& b)
{
    long double best = INFINITY;
    for (int i = 0; i < 3; i++)
        best = std::min({best, true_distance(Segment{a[i], a[(i + 1) % 3]}, b),
                         true_distance(Segment{b[i], b[(i + 1) % 3]}, a)});
    return best;
}

double sphere_bound(const Corners& a, const Corners& b)
{
    const auto [p, r] = sphere_round(a);
    const auto [q, s] = sphere_round(b);
    return length(minus(p, q)) * (1 - 1e-12) - (r + s) * (1 + 1e-12);
}

long double true_distance(const Mesh& a, const Mesh& b, long double cutoff)
{
    long double best = cutoff;
    for (std::size_t i = 0; i < a.triangles.size(); i++)
        for (std::size_t j = 0; j < b.triangles.size(); j++) {
            const Corners s = corners(a, i), t = corners(b, j);
            if (sphere_bound(s, t) < best)
                best = std::min(best, true_distance(s, t));
        }
    return best;
}

} // namespace phantom::fdh::test
