// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/shapes/geodesic.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "mesh/vector.hpp"

namespace phantom::scene {

namespace {

using mesh::Triple;
using mesh::Vec3;

mesh::Soup icosahedron()
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
    return soup;
}

/// i, j and k parts from corners a, b and c, on the sphere.
Vec3 lattice_point(const Vec3& a, const Vec3& b, const Vec3& c, const Triple& parts)
{
    return mesh::normalized(mesh::add(mesh::add(mesh::scaled(a, parts[0]), mesh::scaled(b, parts[1])),
                                      mesh::scaled(c, parts[2])));
}

/// Calls each(p, q, r) with the lattice points of every small face, counter-clockwise as the large one.
template <typename Each>
void for_each_small_face(std::uint32_t frequency, Each&& each)
{
    for (std::uint32_t j = 0; j < frequency; ++j) {
        for (std::uint32_t k = 0; j + k < frequency; ++k) {
            const std::uint32_t i = frequency - j - k;
            each(Triple{i, j, k}, Triple{i - 1, j + 1, k}, Triple{i - 1, j, k + 1});
            if (i >= 2)
                each(Triple{i - 1, j + 1, k}, Triple{i - 2, j + 1, k + 1}, Triple{i - 1, j, k + 1});
        }
    }
}

/// Numbers of lattice points; those on an edge are made by the first of its two faces.
class Lattice {
  public:
    Lattice(mesh::Soup& soup, std::uint32_t frequency) : soup_(soup), frequency_(frequency) {}

    void face(const Triple& corners, std::vector<Triple>& out)
    {
        const auto place = [this](const Triple& p) { return p[1] * (frequency_ + 1) + p[2]; };
        std::vector<std::uint32_t> number(static_cast<std::size_t>(frequency_ + 1) * (frequency_ + 1));
        for (std::uint32_t j = 0; j <= frequency_; ++j) {
            for (std::uint32_t k = 0; j + k <= frequency_; ++k) {
                const Triple parts{frequency_ - j - k, j, k};
                number[place(parts)] = point(corners, parts);
            }
        }
        for_each_small_face(frequency_, [&](const Triple& p, const Triple& q, const Triple& r) {
            out.push_back({number[place(p)], number[place(q)], number[place(r)]});
        });
    }

  private:
    std::uint32_t point(const Triple& corners, const Triple& parts)
    {
        for (std::size_t i = 0; i < 3; ++i) {
            if (parts[i] == frequency_)
                return corners[i];
        }
        for (std::size_t i = 0; i < 3; ++i) {
            if (parts[i] == 0)
                return on_edge(corners[(i + 1) % 3], corners[(i + 2) % 3], parts[(i + 2) % 3]);
        }
        return made(corners, parts);
    }

    /// `part` of the way from a to b.
    std::uint32_t on_edge(std::uint32_t a, std::uint32_t b, std::uint32_t part)
    {
        if (a > b)
            return on_edge(b, a, frequency_ - part);
        const auto [found, fresh] =
            edges_.try_emplace({a, b}, static_cast<std::uint32_t>(soup_.vertices.size()));
        for (std::uint32_t i = 1; fresh && i < frequency_; ++i)
            made({a, b, b}, {frequency_ - i, i, 0});
        return found->second + part - 1;
    }

    std::uint32_t made(const Triple& corners, const Triple& parts)
    {
        soup_.vertices.push_back(lattice_point(soup_.vertices[corners[0]], soup_.vertices[corners[1]],
                                               soup_.vertices[corners[2]], parts));
        return static_cast<std::uint32_t>(soup_.vertices.size() - 1);
    }

    mesh::Soup& soup_;
    std::uint32_t frequency_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edges_; ///< to its first inner point
};

} // namespace

mesh::Soup geodesic_sphere(std::uint32_t frequency)
{
    mesh::Soup soup = icosahedron();
    const std::vector<Triple> large = std::move(soup.faces);
    soup.faces.clear();
    soup.faces.reserve(large.size() * frequency * frequency);
    Lattice lattice(soup, frequency);
    for (const Triple& face : large)
        lattice.face(face, soup.faces);
    return soup;
}

double geodesic_error(std::uint32_t frequency)
{
    // All twenty faces are alike. No point of a face is nearer to the centre than the face's plane.
    const mesh::Soup soup = icosahedron();
    const Triple face = soup.faces.front();
    const auto at = [&](const Triple& parts) {
        return lattice_point(soup.vertices[face[0]], soup.vertices[face[1]], soup.vertices[face[2]], parts);
    };
    double nearest = 1;
    for_each_small_face(frequency, [&](const Triple& p, const Triple& q, const Triple& r) {
        const Vec3 x = at(p);
        const Vec3 normal = mesh::normalized(mesh::cross(mesh::subtract(at(q), x), mesh::subtract(at(r), x)));
        nearest = std::min(nearest, mesh::dot(normal, x));
    });
    return 1 - nearest;
}

} // namespace phantom::scene
