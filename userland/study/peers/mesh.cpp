// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/peers/mesh.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "base/vector.hpp"
#include "mesh/read.hpp"

namespace phantom::peers {

namespace {

constexpr double radius_mm = 50;
constexpr unsigned finest = 2000;
/// Coarse triangles that the spot takes up.
constexpr double spot_triangles = 40;
constexpr const char* bunny_file = "/usr/share/glmark2/models/bunny.obj";

/// Bumps in six octaves, some 17% of the radius in all: a surface without symmetries or flat places.
double bumps(const Vec3& n)
{
    double sum = 1, frequency = 3, amplitude = 0.08;
    for (int octave = 0; octave < 6; ++octave) {
        sum += amplitude * std::sin(frequency * n[0] + 1.3 * octave) *
               std::sin(1.1 * frequency * n[1] + 0.7 * octave) *
               std::sin(0.9 * frequency * n[2] + 2.1 * octave + 0.5);
        frequency *= 2.1;
        amplitude *= 0.48;
    }
    return sum;
}

constexpr double golden = 1.618033988749895;
constexpr Vec3 icosahedron[12] = {{-1, golden, 0}, {1, golden, 0}, {-1, -golden, 0}, {1, -golden, 0},
                                  {0, -1, golden}, {0, 1, golden}, {0, -1, -golden}, {0, 1, -golden},
                                  {golden, 0, -1}, {golden, 0, 1}, {-golden, 0, -1}, {-golden, 0, 1}};
constexpr int icosahedron_faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                          {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                          {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                          {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};

/// Room for `count` elements, in large pages where the system has them: a callback that looks up a corner
/// shall not be charged for the page tables of a mesh of 20 million triangles.
template <typename T>
void reserve_large_pages(std::vector<T>& elements, std::size_t count)
{
    constexpr std::size_t page = std::size_t{2} << 20;
    elements.reserve(count);
    void* begin = elements.data();
    std::size_t bytes = count * sizeof(T);
    if (std::align(page, page, begin, bytes))
        madvise(begin, bytes / page * page, MADV_HUGEPAGE); // advice: may be declined
}

/// One triangle of the unit sphere, cut into f^2, with the bumps.
void add_patch(Mesh& mesh, const std::array<Vec3, 3>& x, unsigned f)
{
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (unsigned row = 0; row <= f; ++row) {
        for (unsigned i = 0; i <= row; ++i) {
            const double b1 = double(row - i) / f, b2 = double(i) / f, b0 = double(f - row) / f;
            const Vec3 n = unit(b0 * x[0] + b1 * x[1] + b2 * x[2]);
            mesh.vertices.push_back(radius_mm * bumps(n) * n);
        }
    }
    const auto at = [first](unsigned row, unsigned i) { return first + row * (row + 1) / 2 + i; };
    for (unsigned row = 0; row < f; ++row) {
        for (unsigned i = 0; i <= row; ++i) {
            mesh.triangles.push_back({at(row, i), at(row + 1, i), at(row + 1, i + 1)});
            if (i < row)
                mesh.triangles.push_back({at(row, i), at(row + 1, i + 1), at(row, i + 1)});
        }
    }
}

/// Each of the 20 faces cut into f^2. Vertices on the 30 edges are there twice; no contender looks at
/// connectivity.
Mesh sphere(unsigned f)
{
    Mesh mesh;
    mesh.vertices.reserve(std::size_t{10} * (f + 1) * (f + 2));
    reserve_large_pages(mesh.triangles, std::size_t{20} * f * f);
    for (const auto& face : icosahedron_faces)
        add_patch(mesh, {icosahedron[face[0]], icosahedron[face[1]], icosahedron[face[2]]}, f);
    return mesh;
}

/// As many triangles, but two fifths of them lie in a spot that forty of the others would fill.
Mesh sphere_with_spot(unsigned f)
{
    const Mesh coarse = sphere(std::max(2U, f * 4 / 5));
    const unsigned finer = std::max(1U, static_cast<unsigned>(std::lround(f / std::sqrt(5.0))));
    const double cosine = 1 - 2 * spot_triangles / static_cast<double>(coarse.triangles.size());
    Mesh mesh;
    mesh.vertices = coarse.vertices;
    for (std::size_t i = 0; i < coarse.triangles.size(); ++i) {
        const auto x = coarse.corners(i);
        if (unit(x[0] + x[1] + x[2])[2] > cosine)
            add_patch(mesh, {unit(x[0]), unit(x[1]), unit(x[2])}, finer);
        else
            mesh.triangles.push_back(coarse.triangles[i]);
    }
    return mesh;
}

/// Rounds all coordinates to float and fills in what follows from them.
Mesh finished(Mesh mesh, std::string name)
{
    mesh.name = std::move(name);
    reserve_large_pages(mesh.points, mesh.vertices.size());
    Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    for (fdh::Point& vertex : mesh.vertices) {
        std::array<float, 4> point{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            point[axis] = static_cast<float>(vertex[axis]);
            vertex[axis] = point[axis];
            low[axis] = std::min(low[axis], vertex[axis]);
            high[axis] = std::max(high[axis], vertex[axis]);
        }
        mesh.points.push_back(point);
    }
    mesh.diagonal = mesh.vertices.empty() ? 0 : length(high - low);
    return mesh;
}

/// The number f that a generated mesh's name asks for.
std::optional<unsigned> fineness(std::string_view word)
{
    constexpr std::pair<std::string_view, unsigned> sizes[] = {
        {"20k", 32}, {"200k", 100}, {"2M", 316}, {"20M", 1000}};
    for (const auto& [size, f] : sizes)
        if (word == size)
            return f;
    unsigned f = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), f);
    if (error != std::errc{} || end != word.data() + word.size() || f < 1 || f > finest)
        return std::nullopt;
    return f;
}

} // namespace

Result<Mesh> make_mesh(const std::string& name)
{
    for (const std::string_view kind : {"sphere-", "spot-"}) {
        if (name.starts_with(kind)) {
            if (const auto f = fineness(std::string_view(name).substr(kind.size())))
                return finished(kind == "spot-" ? sphere_with_spot(*f) : sphere(*f), name);
            return Error{name, "expected 20k, 200k, 2M, 20M or a number from 1 to 2000 after the dash"};
        }
    }
    if (name != "bunny" && !mesh::is_mesh_file(name))
        return Error{name, "no such mesh", "sphere-20k, spot-200k, bunny or a mesh file"};
    Result<mesh::Soup> soup = mesh::read(name == "bunny" ? bunny_file : name);
    if (!soup) {
        Error error = soup.error();
        if (name == "bunny")
            error.remedy = "it comes with Debian's glmark2-data";
        return error;
    }
    Mesh mesh;
    mesh.vertices = std::move(soup->vertices);
    mesh.triangles = std::move(soup->faces);
    const std::string file = std::filesystem::path(name).stem().string();
    return finished(std::move(mesh), file);
}

Mesh waved(const Mesh& mesh, double amplitude)
{
    Mesh moved;
    moved.triangles = mesh.triangles;
    moved.vertices = mesh.vertices;
    const double wave = 6 / std::max(mesh.diagonal, std::numeric_limits<double>::min());
    for (fdh::Point& v : moved.vertices)
        v = v + amplitude * Vec3{std::sin(wave * v[1]), std::sin(wave * v[2]), std::sin(wave * v[0])};
    return finished(std::move(moved), mesh.name);
}

} // namespace phantom::peers
