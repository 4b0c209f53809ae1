// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/soup.hpp"

#include <cmath>

#include <fmt/format.h>

#include "mesh/polygon.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

/// An empty text when all is well. What is no number is: scanners mark by it what they did not see, and
/// prepare() drops and counts the faces.
std::string bad_vertex(const std::vector<Vec3>& vertices, std::size_t& number)
{
    for (number = 0; number < vertices.size(); ++number) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double value = vertices[number][axis];
            if (std::isfinite(value) && std::abs(value) > coordinate_max)
                return fmt::format("{} is {}, expected a finite number within +-{:g}", "xyz"[axis], value,
                                   coordinate_max);
        }
    }
    return {};
}

/// Unit vectors; zero where the file's normal has no direction, which prepare() repairs.
void normalize_all(std::vector<Vec3>& normals)
{
    for (Vec3& normal : normals)
        normal = normalized(normal);
}

} // namespace

Result<Soup> triangles_of(PolygonSoup&& polygons, const std::string& name)
{
    if (polygons.vertices.empty())
        return Error{name, "has no vertices"};
    if (polygons.polygons() == 0)
        return Error{name, "has no faces, expected a triangle mesh"};
    if (polygons.vertices.size() >= no_neighbour)
        return Error{name, "has more than 2^32 - 2 vertices"};
    std::size_t number = 0;
    if (const std::string what = bad_vertex(polygons.vertices, number); !what.empty())
        return Error{fmt::format("{}: vertex {}", name, number), what};

    Soup soup;
    soup.vertices = std::move(polygons.vertices);
    const auto vertices = static_cast<std::uint32_t>(soup.vertices.size());
    const bool with_normals = !polygons.normals.empty();
    const std::vector<std::uint32_t>& normal_of =
        polygons.corner_normals.empty() ? polygons.corners : polygons.corner_normals;
    if (with_normals && polygons.corner_normals.empty() && polygons.normals.size() != soup.vertices.size())
        return Error{name, fmt::format("has {} vertices but {} normals", soup.vertices.size(),
                                       polygons.normals.size())};

    std::vector<std::uint8_t> groups;
    soup.too_many_groups = polygons.groups.too_many();
    polygons.groups.give(groups, soup.group_names);
    if (!groups.empty() && groups.size() != polygons.polygons())
        return Error{name, fmt::format("has {} faces but groups for {}", polygons.polygons(), groups.size())};

    soup.faces.reserve(polygons.corners.size() - 2 * polygons.polygons());
    if (with_normals)
        soup.face_normals.reserve(soup.faces.capacity());
    PolygonCutter cutter;
    std::vector<Vec3> outline;
    std::vector<Triple> triangles;
    for (std::size_t p = 0; p < polygons.polygons(); ++p) {
        const std::size_t first = polygons.first[p], last = polygons.first[p + 1];
        if (last - first < 3)
            return Error{fmt::format("{}: face {}", name, p),
                         fmt::format("has {} corners, expected 3 or more", last - first)};
        for (std::size_t corner = first; corner < last; ++corner) {
            const std::uint32_t vertex = polygons.corners[corner];
            if (vertex >= vertices)
                return Error{fmt::format("{}: face {}", name, p),
                             fmt::format("names vertex {}, expected 0 ... {}",
                                         static_cast<std::int32_t>(vertex), vertices - 1)};
        }
        outline.clear();
        for (std::size_t corner = first; corner < last; ++corner)
            outline.push_back(soup.vertices[polygons.corners[corner]]);
        triangles.clear();
        soup.polygons_crossed += !cutter.cut(outline, triangles);
        for (const Triple& t : triangles) {
            soup.faces.push_back({polygons.corners[first + t[0]], polygons.corners[first + t[1]],
                                  polygons.corners[first + t[2]]});
            if (with_normals)
                soup.face_normals.push_back(
                    {normal_of[first + t[0]], normal_of[first + t[1]], normal_of[first + t[2]]});
        }
        if (!polygons.smoothing.empty())
            soup.smoothing.insert(soup.smoothing.end(), triangles.size(), polygons.smoothing[p]);
        if (!groups.empty())
            soup.face_groups.insert(soup.face_groups.end(), triangles.size(), groups[p]);
    }
    soup.normals = std::move(polygons.normals);
    normalize_all(soup.normals);
    return soup;
}

} // namespace phantom::mesh
