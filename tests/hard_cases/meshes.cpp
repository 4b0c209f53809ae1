// SPDX-License-Identifier: GPL-2.0-or-later
#include "meshes.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

namespace phantom::hard {

Vec3 add(const Vec3& a, const Vec3& b)
{
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vec3 subtract(const Vec3& a, const Vec3& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vec3 scale(double s, const Vec3& a)
{
    return {s * a[0], s * a[1], s * a[2]};
}
double dot(const Vec3& a, const Vec3& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vec3 cross(const Vec3& a, const Vec3& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Vec3& a)
{
    return std::sqrt(dot(a, a));
}
Vec3 unit(const Vec3& a)
{
    return scale(1 / length(a), a);
}
Vec3 on_grid(const Vec3& mm)
{
    return {std::round(mm[0] * 1e6) / 1e6, std::round(mm[1] * 1e6) / 1e6, std::round(mm[2] * 1e6) / 1e6};
}
Vec3 on_unit_grid(const Vec3& n)
{
    constexpr double one = 1 << 30;
    return {std::round(n[0] * one) / one, std::round(n[1] * one) / one, std::round(n[2] * one) / one};
}

std::vector<reference::Triangle> Shape::triangles(double stiffness, double radius) const
{
    std::vector<reference::Triangle> out;
    for (const auto& face : faces) {
        reference::Triangle t;
        for (std::size_t i = 0; i < 3; ++i) {
            t.corner[i] = vertices[face[i]];
            t.normal[i] = normals[face[i]];
            t.vertex[i] = face[i];
        }
        t.stiffness = stiffness;
        t.radius = radius;
        out.push_back(t);
    }
    return out;
}

void smooth_normals(Shape& shape)
{
    shape.normals.assign(shape.vertices.size(), Vec3{});
    for (const auto& face : shape.faces) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 at = shape.vertices[face[i]];
            const Vec3 a = subtract(shape.vertices[face[(i + 1) % 3]], at);
            const Vec3 b = subtract(shape.vertices[face[(i + 2) % 3]], at);
            const Vec3 c = cross(a, b);
            if (!(length(c) > 0))
                continue;
            const double angle = std::atan2(length(c), dot(a, b));
            Vec3& n = shape.normals[face[i]];
            n = add(n, scale(angle, unit(c)));
        }
    }
    for (Vec3& n : shape.normals)
        n = on_unit_grid(length(n) > 0 ? unit(n) : Vec3{0, 0, 1});
}

Shape star(unsigned subdivisions, const std::function<double(const Vec3&)>& radius)
{
    Shape s;
    s.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    s.faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (unsigned level = 0; level < subdivisions; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
        const auto split = [&](std::uint32_t a, std::uint32_t b) {
            const auto [at, fresh] = middle.try_emplace(std::minmax(a, b), s.vertices.size());
            if (fresh)
                s.vertices.push_back(unit(add(s.vertices[a], s.vertices[b])));
            return at->second;
        };
        std::vector<std::array<std::uint32_t, 3>> faces;
        for (const auto& [a, b, c] : s.faces) {
            const std::uint32_t ab = split(a, b), bc = split(b, c), ca = split(c, a);
            faces.insert(faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        s.faces = std::move(faces);
    }
    for (Vec3& v : s.vertices)
        v = on_grid(scale(radius(v), v));
    smooth_normals(s);
    return s;
}

Shape sphere(unsigned subdivisions, double radius)
{
    Shape s = star(subdivisions, [radius](const Vec3&) { return radius; });
    for (std::size_t i = 0; i < s.vertices.size(); ++i)
        s.normals[i] = on_unit_grid(unit(s.vertices[i]));
    return s;
}

Shape field(unsigned cells, double half, const std::function<double(double, double)>& z)
{
    Shape s;
    for (unsigned j = 0; j <= cells; ++j) {
        for (unsigned i = 0; i <= cells; ++i) {
            const double x = half * (2.0 * i / cells - 1), y = half * (2.0 * j / cells - 1);
            s.vertices.push_back(on_grid({x, y, z(x, y)}));
        }
    }
    const auto at = [cells](unsigned i, unsigned j) { return j * (cells + 1) + i; };
    for (unsigned j = 0; j < cells; ++j) {
        for (unsigned i = 0; i < cells; ++i) {
            s.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            s.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    smooth_normals(s);
    return s;
}

Shape box(const Vec3& half)
{
    Shape s;
    for (unsigned i = 0; i < 8; ++i)
        s.vertices.push_back(
            on_grid({(i & 1 ? 1 : -1) * half[0], (i & 2 ? 1 : -1) * half[1], (i & 4 ? 1 : -1) * half[2]}));
    s.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
               {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    smooth_normals(s);
    return s;
}

Shape fan(unsigned valence, double radius, double height)
{
    Shape s;
    s.vertices.push_back(on_grid({0, 0, height}));
    for (unsigned i = 0; i < valence; ++i) {
        const double angle = 2 * std::numbers::pi * i / valence;
        s.vertices.push_back(on_grid({radius * std::cos(angle), radius * std::sin(angle), 0}));
        s.faces.push_back({0, 1 + i, 1 + (i + 1) % valence});
    }
    smooth_normals(s);
    return s;
}

Shape bunny(double size)
{
    Shape s;
    std::ifstream in("/usr/share/glmark2/models/bunny.obj");
    std::string line, word;
    while (std::getline(in, line)) {
        std::istringstream row(line);
        row >> word;
        if (word == "v") {
            Vec3 v{};
            row >> v[0] >> v[1] >> v[2];
            s.vertices.push_back(v);
        } else if (word == "f") {
            std::array<std::uint32_t, 3> face{};
            for (auto& index : face) {
                row >> word; // "7", "7/1" or "7//3"
                index = static_cast<std::uint32_t>(std::stoul(word) - 1);
            }
            s.faces.push_back(face);
        }
    }
    if (s.vertices.empty())
        return s;
    Vec3 low = s.vertices[0], high = low;
    for (const Vec3& v : s.vertices) {
        for (std::size_t a = 0; a < 3; ++a) {
            low[a] = std::min(low[a], v[a]);
            high[a] = std::max(high[a], v[a]);
        }
    }
    const Vec3 sides = subtract(high, low);
    const double factor = size / std::max({sides[0], sides[1], sides[2]});
    // corners that coincide become one vertex: the file repeats them for every face
    std::map<Vec3, std::uint32_t> welded;
    std::vector<std::uint32_t> number;
    std::vector<Vec3> vertices;
    for (const Vec3& v : s.vertices) {
        const Vec3 at = on_grid(scale(factor, subtract(v, scale(0.5, add(low, high)))));
        const auto [entry, fresh] = welded.try_emplace(at, vertices.size());
        if (fresh)
            vertices.push_back(at);
        number.push_back(entry->second);
    }
    for (auto& face : s.faces)
        for (auto& index : face)
            index = number[index];
    s.vertices = std::move(vertices);
    smooth_normals(s);
    return s;
}

} // namespace phantom::hard
