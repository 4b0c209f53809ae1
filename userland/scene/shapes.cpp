// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "mesh/vector.hpp"

namespace phantom::scene {

namespace {

using mesh::Triple;
using mesh::Vec3;

/// Refinements of the icosahedron; each divides the chord error by about four, to 0.11% of the radius.
constexpr int refinements = 4;

/// Every face into four; the midpoint of an edge is made once.
void refine(mesh::Soup& soup)
{
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [found, fresh] =
            middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(soup.vertices.size()));
        if (fresh)
            soup.vertices.push_back(mesh::normalized(mesh::add(soup.vertices[a], soup.vertices[b])));
        return found->second;
    };
    std::vector<Triple> finer;
    finer.reserve(4 * soup.faces.size());
    for (const auto& [a, b, c] : soup.faces) {
        const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        for (const Triple& part :
             {Triple{a, ab, ca}, Triple{b, bc, ab}, Triple{c, ca, bc}, Triple{ab, bc, ca}})
            finer.push_back(part);
    }
    soup.faces = std::move(finer);
}

} // namespace

mesh::Soup sphere_soup(double radius_mm)
{
    const double t = (1.0 + std::sqrt(5.0)) / 2.0;
    mesh::Soup soup;
    soup.vertices = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                     {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
    soup.faces = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                  {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                  {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (Vec3& vertex : soup.vertices)
        vertex = mesh::normalized(vertex);
    for (int i = 0; i < refinements; ++i)
        refine(soup);
    soup.normals = soup.vertices;
    soup.face_normals = soup.faces;
    for (Vec3& vertex : soup.vertices)
        vertex = mesh::scaled(vertex, radius_mm);
    return soup;
}

mesh::Soup box_soup(const Vec3& size_mm)
{
    mesh::Soup soup;
    for (int corner = 0; corner < 8; ++corner)
        soup.vertices.push_back({(corner & 1 ? 0.5 : -0.5) * size_mm[0],
                                 (corner & 2 ? 0.5 : -0.5) * size_mm[1],
                                 (corner & 4 ? 0.5 : -0.5) * size_mm[2]});
    soup.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                  {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return soup;
}

} // namespace phantom::scene
