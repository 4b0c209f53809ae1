// SPDX-License-Identifier: GPL-2.0-or-later
#include "oracle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace phantom::fdh::test {

namespace {

using Real = long double;
using Vector = std::array<Real, 3>;

Vector minus(const Vector& a, const Vector& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Real dot(const Vector& a, const Vector& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Real length(const Vector& a)
{
    return std::sqrt(dot(a, a));
}

/// From the origin.
Real segment_distance(const Vector& a, const Vector& b)
{
    const Vector e = minus(b, a);
    const Real ee = dot(e, e);
    const Real t = ee > 0 ? std::clamp(-dot(a, e) / ee, Real(0), Real(1)) : 0;
    return length({a[0] + t * e[0], a[1] + t * e[1], a[2] + t * e[2]});
}

} // namespace

long double true_distance(const Point& p, const Point& a, const Point& b, const Point& c)
{
    std::array<Vector, 3> corner;
    for (int axis = 0; axis < 3; axis++) {
        corner[0][axis] = Real(a[axis]) - p[axis];
        corner[1][axis] = Real(b[axis]) - p[axis];
        corner[2][axis] = Real(c[axis]) - p[axis];
    }
    return true_distance_from_origin(corner);
}

long double true_distance_from_origin(std::array<std::array<long double, 3>, 3> corner)
{
    Real best = INFINITY;
    int longest = 0;
    std::array<Real, 3> lengths;
    for (int i = 0; i < 3; i++) {
        best = std::min(best, segment_distance(corner[i], corner[(i + 1) % 3]));
        lengths[i] = length(minus(corner[(i + 1) % 3], corner[i]));
        if (lengths[i] > lengths[longest])
            longest = i;
    }
    std::rotate(corner.begin(), corner.begin() + longest, corner.end());
    if (lengths[longest] == 0)
        return best;
    Vector x = minus(corner[1], corner[0]);
    for (auto& component : x)
        component /= lengths[longest];
    Vector y = minus(corner[2], corner[0]);
    const Real cx = dot(y, x);
    for (int times = 0; times < 2; times++) { // of a needle, what is left the first time is mostly rounding
        const Real along = dot(y, x);
        for (int i = 0; i < 3; i++)
            y[i] -= along * x[i];
    }
    const Real cy = length(y);
    if (cy == 0)
        return best;
    for (auto& component : y)
        component /= cy;
    // In the plane: corners (0, 0), (length, 0), (cx, cy); the point's foot at (px, py).
    const Vector to_p = minus({0, 0, 0}, corner[0]);
    const Real px = dot(to_p, x), py = dot(to_p, y), l = lengths[longest];
    const bool inside = py >= 0 && cx * py - cy * px <= 0 && (cx - l) * py - cy * (px - l) >= 0;
    if (!inside)
        return best;
    const Vector foot = {to_p[0] - px * x[0] - py * y[0], to_p[1] - px * x[1] - py * y[1],
                         to_p[2] - px * x[2] - py * y[2]};
    return std::min(best, length(foot));
}

std::vector<Truth> true_distances(const Mesh& mesh, const Point& p)
{
    std::vector<Truth> truth;
    truth.reserve(mesh.triangles.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); i++) {
        const auto& [a, b, c] = mesh.triangles[i];
        truth.push_back({0, i, true_distance(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c])});
    }
    return truth;
}

std::vector<Point> probes(const Mesh& mesh, std::size_t each, std::mt19937_64& random)
{
    Point low = mesh.vertices.at(0), high = low;
    for (const auto& v : mesh.vertices)
        for (int axis = 0; axis < 3; axis++) {
            low[axis] = std::min(low[axis], v[axis]);
            high[axis] = std::max(high[axis], v[axis]);
        }
    double size = 0;
    for (int axis = 0; axis < 3; axis++)
        size = std::max(size, high[axis] - low[axis]);
    std::uniform_real_distribution<double> unit(0, 1);
    std::normal_distribution<double> normal;
    std::uniform_int_distribution<std::size_t> any(0, mesh.triangles.size() - 1);
    std::vector<Point> points;
    for (std::size_t i = 0; i < each; i++) {
        const auto& t = mesh.triangles[any(random)];
        const auto &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
        double s = unit(random), r = unit(random);
        if (s + r > 1) {
            s = 1 - s;
            r = 1 - r;
        }
        Point face, edge, near, outside, box, far;
        for (int axis = 0; axis < 3; axis++) {
            face[axis] = a[axis] + s * (b[axis] - a[axis]) + r * (c[axis] - a[axis]);
            edge[axis] = a[axis] + s * (b[axis] - a[axis]);
            near[axis] = face[axis] + 0.02 * size * normal(random);
            box[axis] = low[axis] + unit(random) * (high[axis] - low[axis]);
            outside[axis] = low[axis] + (high[axis] - low[axis]) * (5 * unit(random) - 2);
            far[axis] = 1e6 * normal(random);
        }
        points.insert(points.end(), {a, face, edge, near, outside, box, far});
    }
    return points;
}

namespace {

std::set<std::pair<std::uint32_t, std::uint32_t>> identities(const std::vector<Hit>& hits)
{
    std::set<std::pair<std::uint32_t, std::uint32_t>> result;
    for (const auto& hit : hits)
        EXPECT_TRUE(result.emplace(hit.object, hit.triangle).second)
            << "triangle " << hit.triangle << " twice";
    return result;
}

void expect_distances(const std::vector<Truth>& truth, const std::vector<Hit>& hits, const Accuracy& accuracy)
{
    for (const auto& hit : hits) {
        const auto it = std::lower_bound(truth.begin(), truth.end(), hit, [](const Truth& t, const Hit& h) {
            return std::pair(t.object, t.triangle) < std::pair(h.object, h.triangle);
        });
        ASSERT_TRUE(it != truth.end() && it->object == hit.object && it->triangle == hit.triangle);
        EXPECT_LE(std::abs(hit.distance - it->distance), accuracy(hit.distance))
            << "triangle " << hit.triangle;
    }
}

} // namespace

void expect_nearest(std::vector<Truth> truth, const Nearest& found, std::size_t count, double radius,
                    const Accuracy& accuracy)
{
    ASSERT_LE(found.hits.size(), count);
    double farthest = 0;
    for (const Hit& hit : found.hits)
        farthest = std::max(farthest, hit.distance);
    expect_distances(truth, found.hits, accuracy);
    expect_distances(truth, found.hits, [&](double) { return found.distance_error; });
    const auto present = identities(found.hits);

    // The promise itself, without any tolerance.
    ASSERT_GE(found.coverage, 0);
    ASSERT_LE(found.coverage, radius);
    long double nearest_left_out = INFINITY;
    for (const auto& t : truth)
        if (!present.contains({t.object, t.triangle}))
            nearest_left_out = std::min(nearest_left_out, t.distance);
    EXPECT_GE(nearest_left_out, found.coverage);

    // As much as can be had: the N nearest, none beyond the radius, and a coverage that reaches the next one.
    std::sort(truth.begin(), truth.end(),
              [](const Truth& a, const Truth& b) { return a.distance < b.distance; });
    if (found.hits.size() < count) {
        EXPECT_EQ(found.coverage, radius);
    }
    if (!found.hits.empty()) {
        EXPECT_LE(farthest, radius + 2 * accuracy(farthest));
        EXPECT_LE(farthest, truth[found.hits.size() - 1].distance + 2 * accuracy(farthest));
    }
    const long double reachable = count < truth.size() ? truth[count].distance : INFINITY;
    if (reachable < INFINITY) {
        EXPECT_GE(found.coverage,
                  std::min<long double>(radius, reachable - 2 * accuracy(static_cast<double>(reachable))));
    }
}

void expect_within(const std::vector<Truth>& truth, const std::vector<Hit>& found, double radius,
                   const Accuracy& accuracy)
{
    expect_distances(truth, found, accuracy);
    const auto present = identities(found);
    for (const auto& t : truth) {
        if (t.distance <= radius) {
            EXPECT_TRUE(present.contains({t.object, t.triangle})) << "missed at " << t.distance;
        } else if (t.distance > radius + 2 * accuracy(static_cast<double>(t.distance))) {
            EXPECT_FALSE(present.contains({t.object, t.triangle})) << "included at " << t.distance;
        }
    }
}

} // namespace phantom::fdh::test
