// SPDX-License-Identifier: GPL-2.0-or-later
// Surfaces whose simplifications can be judged.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "mesh/nearest_on_triangle.hpp"
#include "mesh/prepare.hpp"
#include "mesh/vector.hpp"

namespace phantom::test {

inline mesh::Mesh prepared(mesh::Soup soup, const mesh::PrepareOptions& options = {})
{
    auto result = mesh::prepare(std::move(soup), options, "test");
    if (!result)
        throw std::runtime_error(result.error().text());
    return std::move(result->mesh);
}

/// A sheet over a square of 100 mm round the origin, cells^2 squares of two faces; height(x, y) in mm.
inline mesh::Soup sheet(std::uint32_t cells, const std::function<double(double, double)>& height)
{
    mesh::Soup soup;
    for (std::uint32_t j = 0; j <= cells; ++j)
        for (std::uint32_t i = 0; i <= cells; ++i) {
            const double x = 100.0 * i / cells - 50, y = 100.0 * j / cells - 50;
            soup.vertices.push_back({x, y, height(x, y)});
        }
    for (std::uint32_t j = 0; j < cells; ++j)
        for (std::uint32_t i = 0; i < cells; ++i) {
            const std::uint32_t a = j * (cells + 1) + i, c = a + cells + 1;
            soup.faces.push_back({a, a + 1, c + 1});
            soup.faces.push_back({a, c + 1, c});
        }
    return soup;
}

inline mesh::Soup waves(std::uint32_t cells)
{
    return sheet(cells, [](double x, double y) { return 2 * std::sin(x / 8) * std::cos(y / 9); });
}

/// A cube of 40 mm, each side cut into cells^2 squares of two faces.
inline mesh::Soup cut_cube(std::uint32_t cells, const mesh::Vec3& centre = {0, 0, 0})
{
    mesh::Soup soup;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const double side : {-20.0, 20.0}) {
            const auto first = static_cast<std::uint32_t>(soup.vertices.size());
            for (std::uint32_t j = 0; j <= cells; ++j)
                for (std::uint32_t i = 0; i <= cells; ++i) {
                    mesh::Vec3 at{};
                    at[axis] = side;
                    at[(axis + 1) % 3] = 40.0 * i / cells - 20;
                    at[(axis + 2) % 3] = 40.0 * j / cells - 20;
                    soup.vertices.push_back(mesh::add(at, centre));
                }
            for (std::uint32_t j = 0; j < cells; ++j)
                for (std::uint32_t i = 0; i < cells; ++i) {
                    const std::uint32_t a = first + j * (cells + 1) + i, b = a + 1, c = a + cells + 1;
                    if (side > 0)
                        soup.faces.insert(soup.faces.end(), {{a, b, c + 1}, {a, c + 1, c}});
                    else
                        soup.faces.insert(soup.faces.end(), {{a, c + 1, b}, {a, c, c + 1}});
                }
        }
    }
    return soup;
}

inline std::array<mesh::Vec3, 3> corners(const mesh::Mesh& mesh, std::size_t face)
{
    const mesh::Triple& at = mesh.faces[face];
    return {mesh.vertices[at[0]], mesh.vertices[at[1]], mesh.vertices[at[2]]};
}

/// By looking at every face.
inline double distance_to(const mesh::Mesh& mesh, const mesh::Vec3& point)
{
    double least = INFINITY;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        least = std::min(least, mesh::distance_to_triangle(point, corners(mesh, f)));
    return least;
}

inline double area_mm2(const mesh::Mesh& mesh)
{
    double sum = 0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto x = corners(mesh, f);
        sum += 0.5 * mesh::length(mesh::cross(mesh::subtract(x[1], x[0]), mesh::subtract(x[2], x[0])));
    }
    return sum;
}

inline std::size_t open_edges(const mesh::Mesh& mesh)
{
    std::size_t count = 0;
    for (const mesh::Triple& at : mesh.neighbours)
        for (const std::uint32_t other : at)
            count += other == mesh::no_neighbour;
    return count;
}

} // namespace phantom::test
