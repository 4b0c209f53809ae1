// SPDX-License-Identifier: GPL-2.0-or-later
#include "meshes.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

namespace phantom::fdh::test {

void Mesh::add(const Point& a, const Point& b, const Point& c)
{
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), {a, b, c});
    triangles.push_back({first, first + 1, first + 2});
}

Mesh sphere(int levels, double radius, const Point& centre)
{
    Mesh mesh;
    mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int level = 0; level < levels; level++) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [it, fresh] = middles.try_emplace(std::minmax(a, b), mesh.vertices.size());
            if (fresh) {
                Point m;
                for (int i = 0; i < 3; i++)
                    m[i] = mesh.vertices[a][i] + mesh.vertices[b][i];
                const double length = std::hypot(m[0], m[1], m[2]);
                mesh.vertices.push_back({m[0] / length, m[1] / length, m[2] / length});
            }
            return it->second;
        };
        std::vector<Triangle> finer;
        for (const auto& [a, b, c] : mesh.triangles) {
            const auto ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        mesh.triangles = std::move(finer);
    }
    return scaled(std::move(mesh), radius, centre);
}

Mesh flat_grid(int side)
{
    Mesh mesh;
    for (int y = 0; y <= side; y++)
        for (int x = 0; x <= side; x++)
            mesh.vertices.push_back({double(x), double(y), 0});
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            const auto a = static_cast<std::uint32_t>(y * (side + 1) + x), b = a + 1;
            const auto c = a + static_cast<std::uint32_t>(side) + 1, d = c + 1;
            mesh.triangles.push_back({a, b, d});
            mesh.triangles.push_back({a, d, c});
        }
    return mesh;
}

Mesh soup(std::size_t count, double half_side, std::mt19937_64& random)
{
    std::uniform_real_distribution<double> place(-half_side, half_side), decade(-4, 0);
    std::normal_distribution<double> normal;
    Mesh mesh;
    for (std::size_t i = 0; i < count; i++) {
        const Point centre = {place(random), place(random), place(random)};
        const double size = half_side * std::pow(10, decade(random));
        Point corners[3];
        for (auto& corner : corners)
            for (int axis = 0; axis < 3; axis++)
                corner[axis] = centre[axis] + size * normal(random);
        mesh.add(corners[0], corners[1], corners[2]);
    }
    return mesh;
}

Mesh degenerate_faces(std::mt19937_64& random)
{
    std::uniform_real_distribution<double> place(-50, 50);
    std::normal_distribution<double> normal;
    auto anywhere = [&] { return Point{place(random), place(random), place(random)}; };
    auto along = [](const Point& a, const Point& b, double t) {
        return Point{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
    };
    Mesh mesh;
    for (int i = 0; i < 60; i++) {
        const Point a = anywhere(), b = anywhere();
        mesh.add(a, a, a);                                        // a point
        mesh.add(a, b, b);                                        // a segment, two equal corners
        mesh.add(a, b, along(a, b, 0.3));                         // a segment, collinear to rounding
        mesh.add({a[0], a[1], 7}, {b[0], a[1], 7}, {3, a[1], 7}); // a segment, exactly collinear
        Point near_a = a, near_middle = along(a, b, 0.5);
        for (int axis = 0; axis < 3; axis++) {
            near_a[axis] += 1e-5 * normal(random);
            near_middle[axis] += 1e-5 * normal(random);
        }
        mesh.add(a, b, near_a);      // a needle, aspect about 1e7
        mesh.add(a, near_middle, b); // a cap
        mesh.add(a, near_middle, b); // and its duplicate
        mesh.add(b, near_middle, a); // and the same turned round
        mesh.add(a, b, anywhere());
    }
    return mesh;
}

std::optional<Mesh> read_obj(const std::string& path)
{
    std::ifstream file(path);
    if (!file)
        return std::nullopt;
    Mesh mesh;
    std::string line;
    while (std::getline(file, line)) {
        std::istringstream words(line);
        std::string keyword;
        words >> keyword;
        if (keyword == "v") {
            Point p;
            words >> p[0] >> p[1] >> p[2];
            mesh.vertices.push_back(p);
        } else if (keyword == "f") {
            std::vector<std::uint32_t> corners;
            for (std::string corner; words >> corner;)
                corners.push_back(static_cast<std::uint32_t>(std::stoul(corner)) -
                                  1); // up to the first slash
            for (std::size_t i = 2; i < corners.size(); i++)
                mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
        }
    }
    return mesh;
}

std::optional<Mesh> bunny()
{
    return read_obj("/usr/share/glmark2/models/bunny.obj");
}

Mesh scaled(Mesh mesh, double factor, const Point& shift)
{
    for (auto& v : mesh.vertices)
        for (int axis = 0; axis < 3; axis++)
            v[axis] = v[axis] * factor + shift[axis];
    return mesh;
}

} // namespace phantom::fdh::test
