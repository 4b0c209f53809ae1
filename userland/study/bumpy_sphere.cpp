// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/bumpy_sphere.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <unordered_map>
#include <vector>

#include "base/vector.hpp"
#include "mesh/prepare.hpp"

namespace phantom::study {

namespace {

constexpr double waves = 12.0;
constexpr double bump_mm = 1.0;

double radius_at(const Vec3& d)
{
    return bumpy_radius_mm +
           bump_mm * std::sin(waves * d[0]) * std::sin(waves * d[1]) * std::sin(waves * d[2]);
}

struct Icosahedron {
    std::array<Vec3, 12> vertices;
    std::array<mesh::Triple, 20> faces{{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                        {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                        {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                        {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}}};
    Icosahedron()
    {
        const double t = std::numbers::phi;
        vertices = {{{-1, t, 0},
                     {1, t, 0},
                     {-1, -t, 0},
                     {1, -t, 0},
                     {0, -1, t},
                     {0, 1, t},
                     {0, -1, -t},
                     {0, 1, -t},
                     {t, 0, -1},
                     {t, 0, 1},
                     {-t, 0, -1},
                     {-t, 0, 1}}};
    }
};

/// Vertices on the unit sphere, each once, and faces.
mesh::Soup subdivide(unsigned f)
{
    const Icosahedron base;
    mesh::Soup soup;
    std::map<std::array<std::int64_t, 3>, std::uint32_t> known;
    const auto vertex = [&](const mesh::Triple& corners, unsigned i, unsigned j) {
        const double w = 1.0 / f;
        const Vec3 flat = (f - i - j) * w * base.vertices[corners[0]] + i * w * base.vertices[corners[1]] +
                          j * w * base.vertices[corners[2]];
        const Vec3 d = (1.0 / length(flat)) * flat;
        std::array<std::int64_t, 3> key{};
        for (int axis = 0; axis < 3; ++axis)
            key[axis] = std::llround(d[axis] * 1e7);
        const auto [at, added] = known.try_emplace(key, static_cast<std::uint32_t>(soup.vertices.size()));
        if (added)
            soup.vertices.push_back(radius_at(d) * d);
        return at->second;
    };
    for (const mesh::Triple& corners : base.faces) {
        std::vector<std::vector<std::uint32_t>> rows(f + 1);
        for (unsigned i = 0; i <= f; ++i)
            for (unsigned j = 0; i + j <= f; ++j)
                rows[i].push_back(vertex(corners, i, j));
        for (unsigned i = 0; i < f; ++i) {
            for (unsigned j = 0; i + j < f; ++j) {
                soup.faces.push_back({rows[i][j], rows[i + 1][j], rows[i][j + 1]});
                if (i + j + 1 < f)
                    soup.faces.push_back({rows[i + 1][j], rows[i + 1][j + 1], rows[i][j + 1]});
            }
        }
    }
    return soup;
}

Vec3 nearest_of_segment(const Vec3& p, const Vec3& a, const Vec3& b)
{
    const Vec3 e = b - a;
    return a + std::clamp(dot(e, p - a) / dot(e, e), 0.0, 1.0) * e;
}

/// Over the face, or on the nearest of its edges.
Vec3 nearest_of_triangle(const Vec3& p, const std::array<Vec3, 3>& x)
{
    const Vec3 area = cross(x[1] - x[0], x[2] - x[0]);
    bool over = true;
    Vec3 best{};
    double least = 1e300;
    for (int i = 0; i < 3; ++i) {
        const Vec3 &a = x[i], &b = x[(i + 1) % 3];
        over = over && dot(cross(area, b - a), p - a) >= 0;
        const Vec3 at = nearest_of_segment(p, a, b);
        if (length(at - p) < least) {
            least = length(at - p);
            best = at;
        }
    }
    return over ? p - (dot(area, p - x[0]) / dot(area, area)) * area : best;
}

} // namespace

Result<mesh::Mesh> bumpy_sphere(unsigned frequency)
{
    mesh::PrepareOptions options;
    options.crease_deg = 180.0;
    Result<mesh::Prepared> prepared = mesh::prepare(subdivide(frequency), options, "bumpy sphere");
    if (!prepared)
        return prepared.error();
    return std::move(prepared->mesh);
}

feeder::Path spiral_path(const SpiralOptions& options)
{
    // the length of the spiral, by pieces
    constexpr std::size_t pieces = 200000;
    constexpr double pole = 0.3; // rad that are left out at either end
    const auto direction = [&](double s) {
        const double polar = pole + (std::numbers::pi - 2 * pole) * s;
        const double turn = 2 * std::numbers::pi * options.turns * s;
        return Vec3{std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar)};
    };
    std::vector<double> way(pieces + 1, 0.0);
    for (std::size_t i = 1; i <= pieces; ++i)
        way[i] = way[i - 1] + bumpy_radius_mm * length(direction(static_cast<double>(i) / pieces) -
                                                       direction(static_cast<double>(i - 1) / pieces));
    feeder::Path path;
    const auto ticks = static_cast<std::size_t>(options.seconds * options.rate_hz);
    for (std::size_t i = 0; i < ticks; ++i) {
        const double time_s = static_cast<double>(i) / options.rate_hz;
        const double swung = options.swing * (1 - std::cos(2 * std::numbers::pi * time_s / options.swing_s)) *
                             options.swing_s / (2 * std::numbers::pi);
        double gone = std::fmod(options.speed_mm_s * (time_s + swung), 2 * way.back());
        gone = std::min(gone, 2 * way.back() - gone);
        const auto at =
            static_cast<std::size_t>(std::upper_bound(way.begin(), way.end() - 1, gone) - way.begin());
        const double part = (gone - way[at - 1]) / (way[at] - way[at - 1]);
        const double cycle = std::fmod(time_s, options.lift_s);
        const double out =
            std::max({1 - cycle / options.lifting_s, 1 - (options.lift_s - cycle) / options.lifting_s, 0.0});
        const double r =
            bumpy_radius_mm - options.depth_mm + (options.depth_mm + 3) * out * out * (3 - 2 * out);
        path.push_back({time_s, r * direction((static_cast<double>(at - 1) + part) / pieces)});
    }
    return path;
}

struct BruteForce::Cells {
    static constexpr double side_mm = 1.0;
    static constexpr int rings_max = 16;

    static std::int64_t key(const std::array<int, 3>& cell)
    {
        constexpr std::int64_t most = 1 << 20;
        return ((cell[0] + most / 2) * most + cell[1] + most / 2) * most + cell[2] + most / 2;
    }
    static std::array<int, 3> cell(const Vec3& p)
    {
        return {static_cast<int>(std::floor(p[0] / side_mm)), static_cast<int>(std::floor(p[1] / side_mm)),
                static_cast<int>(std::floor(p[2] / side_mm))};
    }

    const mesh::Mesh* mesh = nullptr;
    double reach_mm = 0; ///< from a triangle's centroid to a corner
    std::unordered_map<std::int64_t, std::vector<std::uint32_t>> faces;

    [[nodiscard]] std::array<Vec3, 3> corners(std::uint32_t face) const
    {
        const mesh::Triple& v = mesh->faces[face];
        return {mesh->vertices[v[0]], mesh->vertices[v[1]], mesh->vertices[v[2]]};
    }
    /// The vertex normals, interpolated at a point of the face.
    [[nodiscard]] Vec3 normal(std::uint32_t face, const Vec3& at) const
    {
        const std::array<Vec3, 3> x = corners(face);
        const Vec3 area = cross(x[1] - x[0], x[2] - x[0]);
        Vec3 sum{};
        for (int i = 0; i < 3; ++i) {
            const Vec3 &a = x[(i + 1) % 3], &b = x[(i + 2) % 3];
            const double part = dot(cross(b - a, at - a), area) / dot(area, area);
            sum = sum + part * mesh->normals[mesh->face_normals[face][i]];
        }
        return unit(sum);
    }
    /// Returns the face that the nearest point is on when it is nearer than `best`, else `otherwise`.
    std::uint32_t look(const std::vector<std::uint32_t>& near, const Vec3& from, Point& best,
                       std::uint32_t otherwise) const
    {
        for (const std::uint32_t face : near) {
            const std::array<Vec3, 3> x = corners(face);
            const Vec3 at = nearest_of_triangle(from, x);
            const double distance = length(at - from);
            if (distance < best.distance_mm) {
                best = {at, distance, dot(cross(x[1] - x[0], x[2] - x[0]), from - x[0]) < 0, {}};
                otherwise = face;
            }
        }
        return otherwise;
    }
};

BruteForce::BruteForce(const mesh::Mesh& mesh) : cells_(std::make_unique<Cells>())
{
    cells_->mesh = &mesh;
    for (std::uint32_t face = 0; face < mesh.faces.size(); ++face) {
        const std::array<Vec3, 3> x = cells_->corners(face);
        const Vec3 centre = (1.0 / 3) * (x[0] + x[1] + x[2]);
        for (const Vec3& corner : x)
            cells_->reach_mm = std::max(cells_->reach_mm, length(corner - centre));
        cells_->faces[Cells::key(Cells::cell(centre))].push_back(face);
    }
}

BruteForce::~BruteForce() = default;

BruteForce::Point BruteForce::nearest(const std::array<double, 3>& from) const
{
    Point best;
    best.distance_mm = 1e300;
    std::uint32_t face = 0;
    const std::array<int, 3> middle = Cells::cell(from);
    for (int ring = 0; ring < Cells::rings_max; ++ring) {
        if ((ring - 1) * Cells::side_mm > best.distance_mm + cells_->reach_mm)
            break;
        for (int x = -ring; x <= ring; ++x)
            for (int y = -ring; y <= ring; ++y)
                for (int z = -ring; z <= ring;
                     z += std::max({std::abs(x), std::abs(y)}) == ring || ring == 0 ? 1 : 2 * ring) {
                    const auto at =
                        cells_->faces.find(Cells::key({middle[0] + x, middle[1] + y, middle[2] + z}));
                    if (at != cells_->faces.end())
                        face = cells_->look(at->second, from, best, face);
                }
    }
    if (best.distance_mm < 1e300)
        best.normal = cells_->normal(face, best.at);
    return best;
}

} // namespace phantom::study
