// SPDX-License-Identifier: GPL-2.0-or-later
// Small meshes whose properties are known, and files made of them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/mesh.hpp"
#include "mesh/prepare.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh::test {

/// A cube of side 2 * half round a centre, faces outward.
inline Soup cube(double half = 50, const Vec3& centre = {0, 0, 0})
{
    Soup soup;
    for (int c = 0; c < 8; ++c)
        soup.vertices.push_back(
            add(centre, {c & 1 ? half : -half, c & 2 ? half : -half, c & 4 ? half : -half}));
    soup.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                  {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return soup;
}

/// Parallels and meridians, faces outward, poles at +-z.
inline Soup globe(double radius, std::uint32_t columns, std::uint32_t rows)
{
    Soup soup;
    soup.vertices.push_back({0, 0, -radius});
    for (std::uint32_t j = 1; j < rows; ++j) {
        const double latitude = std::numbers::pi * (static_cast<double>(j) / rows - 0.5);
        for (std::uint32_t i = 0; i < columns; ++i) {
            const double longitude = 2 * std::numbers::pi * i / columns;
            soup.vertices.push_back({radius * std::cos(latitude) * std::cos(longitude),
                                     radius * std::cos(latitude) * std::sin(longitude),
                                     radius * std::sin(latitude)});
        }
    }
    soup.vertices.push_back({0, 0, radius});
    const auto number = [columns](std::uint32_t i, std::uint32_t j) {
        return 1 + (j - 1) * columns + i % columns;
    };
    const auto north = static_cast<std::uint32_t>(soup.vertices.size() - 1);
    for (std::uint32_t i = 0; i < columns; ++i) {
        soup.faces.push_back({0, number(i + 1, 1), number(i, 1)});
        soup.faces.push_back({number(i, rows - 1), number(i + 1, rows - 1), north});
        for (std::uint32_t j = 1; j + 1 < rows; ++j) {
            soup.faces.push_back({number(i, j), number(i + 1, j), number(i + 1, j + 1)});
            soup.faces.push_back({number(i, j), number(i + 1, j + 1), number(i, j + 1)});
        }
    }
    return soup;
}

/// An open sheet in the plane z = 0, normals up, cells of 10 mm.
inline Soup sheet(std::uint32_t columns, std::uint32_t rows)
{
    Soup soup;
    for (std::uint32_t j = 0; j <= rows; ++j) {
        for (std::uint32_t i = 0; i <= columns; ++i)
            soup.vertices.push_back({10.0 * i, 10.0 * j, 0});
    }
    for (std::uint32_t j = 0; j < rows; ++j) {
        for (std::uint32_t i = 0; i < columns; ++i) {
            const std::uint32_t a = j * (columns + 1) + i, c = a + columns + 1;
            soup.faces.push_back({a, a + 1, c + 1});
            soup.faces.push_back({a, c + 1, c});
        }
    }
    return soup;
}

/// A strip with a half turn: no consistent orientation exists.
inline Soup moebius(std::uint32_t cells)
{
    Soup soup;
    for (std::uint32_t i = 0; i < cells; ++i) {
        const double t = 2 * std::numbers::pi * i / cells;
        for (const double side : {-10.0, 10.0}) {
            const double r = 50 + side * std::cos(t / 2);
            soup.vertices.push_back({r * std::cos(t), r * std::sin(t), side * std::sin(t / 2)});
        }
    }
    for (std::uint32_t i = 0; i < cells; ++i) {
        const bool last = i + 1 == cells;
        const std::uint32_t a = 2 * i, b = 2 * i + 1;
        const std::uint32_t c = last ? 1 : 2 * i + 2, d = last ? 0 : 2 * i + 3;
        soup.faces.push_back({a, c, b});
        soup.faces.push_back({b, c, d});
    }
    return soup;
}

/// Every face with vertices of its own, as STL stores them.
inline Soup unwelded(const Soup& soup)
{
    Soup out;
    for (const Triple& face : soup.faces) {
        const auto first = static_cast<std::uint32_t>(out.vertices.size());
        for (const std::uint32_t v : face)
            out.vertices.push_back(soup.vertices[v]);
        out.faces.push_back({first, first + 1, first + 2});
    }
    return out;
}

/// Prepared; the test fails if it cannot be.
inline Prepared prepared(Soup soup, const PrepareOptions& options = {})
{
    auto result = prepare(std::move(soup), options, "test");
    EXPECT_TRUE(result.ok()) << result.error().text();
    return result.ok() ? *std::move(result) : Prepared{};
}

/// What a mesh came to, to be prepared once more.
inline Soup soup_of(const Mesh& mesh)
{
    Soup soup;
    soup.vertices.assign(mesh.vertices.begin(), mesh.vertices.end());
    soup.faces.assign(mesh.faces.begin(), mesh.faces.end());
    soup.normals.assign(mesh.normals.begin(), mesh.normals.end());
    soup.face_normals.assign(mesh.face_normals.begin(), mesh.face_normals.end());
    return soup;
}

/// Adds another part. Without normals.
inline void append(Soup& soup, const Soup& part)
{
    const auto base = static_cast<std::uint32_t>(soup.vertices.size());
    soup.vertices.insert(soup.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const Triple& f : part.faces)
        soup.faces.push_back({f[0] + base, f[1] + base, f[2] + base});
}

inline void turn(Soup& soup, std::size_t face)
{
    std::swap(soup.faces[face][1], soup.faces[face][2]);
}

inline double signed_volume(std::span<const Vec3> vertices, std::span<const Triple> faces)
{
    double sum = 0;
    for (const Triple& f : faces)
        sum += dot(vertices[f[0]], cross(vertices[f[1]], vertices[f[2]]));
    return sum / 6;
}

inline double area(std::span<const Vec3> vertices, std::span<const Triple> faces)
{
    double sum = 0;
    for (const Triple& f : faces)
        sum += length(cross(subtract(vertices[f[1]], vertices[f[0]]),
                            subtract(vertices[f[2]], vertices[f[0]]))) /
               2;
    return sum;
}

inline Vec3 normal_of(const Mesh& mesh, std::size_t face)
{
    const Triple& f = mesh.faces[face];
    return normalized(cross(subtract(mesh.vertices[f[1]], mesh.vertices[f[0]]),
                            subtract(mesh.vertices[f[2]], mesh.vertices[f[0]])));
}

/// Edges (low vertex, high vertex) with the faces on them, found the slow and plain way.
inline std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>>
edges_of(std::span<const Triple> faces)
{
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> edges;
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = faces[f][i], b = faces[f][(i + 1) % 3];
            edges[{std::min(a, b), std::max(a, b)}].push_back(f);
        }
    }
    return edges;
}

/// A folder that goes with the test.
class Folder {
  public:
    Folder()
    {
        std::string name = (std::filesystem::temp_directory_path() / "phantom-test-XXXXXX").string();
        path_ = ::mkdtemp(name.data());
    }
    ~Folder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    std::filesystem::path write(const std::string& name, const std::string& bytes) const
    {
        const auto file = path_ / name;
        // Truncating an old file and closing it makes some file systems write it out at once.
        std::filesystem::remove(file);
        std::ofstream(file, std::ios::binary) << bytes;
        return file;
    }

  private:
    std::filesystem::path path_;
};

/// Bytes of a value in either byte order.
template <typename T>
std::string raw(T value, bool big_endian = false)
{
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &value, sizeof(T));
    if (big_endian)
        std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

/// The soup as a PLY file. `format` is the header's word.
inline std::string ply_of(const Soup& soup, const std::string& format, bool normals = false)
{
    std::string out = "ply\nformat " + format + " 1.0\ncomment made by a test\nelement vertex " +
                      std::to_string(soup.vertices.size()) +
                      "\nproperty double x\nproperty double y\nproperty double z\n";
    if (normals)
        out += "property float nx\nproperty float ny\nproperty float nz\n";
    out += "element face " + std::to_string(soup.faces.size()) +
           "\nproperty list uchar int vertex_indices\nend_header\n";
    const bool big = format == "binary_big_endian";
    char line[200];
    for (std::size_t v = 0; v < soup.vertices.size(); ++v) {
        const Vec3& p = soup.vertices[v];
        if (format == "ascii") {
            std::snprintf(line, sizeof line, "%.17g %.17g %.17g", p[0], p[1], p[2]);
            out += line;
            if (normals) {
                std::snprintf(line, sizeof line, " %.9g %.9g %.9g", soup.normals[v][0], soup.normals[v][1],
                              soup.normals[v][2]);
                out += line;
            }
            out += '\n';
            continue;
        }
        for (const double x : p)
            out += raw(x, big);
        for (std::size_t i = 0; normals && i < 3; ++i)
            out += raw(static_cast<float>(soup.normals[v][i]), big);
    }
    for (const Triple& f : soup.faces) {
        if (format == "ascii") {
            out +=
                "3 " + std::to_string(f[0]) + ' ' + std::to_string(f[1]) + ' ' + std::to_string(f[2]) + '\n';
            continue;
        }
        out += '\3';
        for (const std::uint32_t v : f)
            out += raw(v, big);
    }
    return out;
}

inline std::string obj_of(const Soup& soup)
{
    std::string out = "# made by a test\n";
    char line[200];
    for (const Vec3& p : soup.vertices) {
        std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", p[0], p[1], p[2]);
        out += line;
    }
    for (const Triple& f : soup.faces)
        out += "f " + std::to_string(f[0] + 1) + ' ' + std::to_string(f[1] + 1) + ' ' +
               std::to_string(f[2] + 1) + '\n';
    return out;
}

inline std::string off_of(const Soup& soup)
{
    std::string out =
        "OFF\n" + std::to_string(soup.vertices.size()) + ' ' + std::to_string(soup.faces.size()) + " 0\n";
    char line[200];
    for (const Vec3& p : soup.vertices) {
        std::snprintf(line, sizeof line, "%.17g %.17g %.17g\n", p[0], p[1], p[2]);
        out += line;
    }
    for (const Triple& f : soup.faces)
        out += "3 " + std::to_string(f[0]) + ' ' + std::to_string(f[1]) + ' ' + std::to_string(f[2]) + '\n';
    return out;
}

inline std::string stl_text_of(const Soup& soup)
{
    std::string out = "solid test\n";
    char line[200];
    for (const Triple& f : soup.faces) {
        out += "facet normal 0 0 0\nouter loop\n";
        for (const std::uint32_t v : f) {
            const Vec3& p = soup.vertices[v];
            std::snprintf(line, sizeof line, "vertex %.17g %.17g %.17g\n", p[0], p[1], p[2]);
            out += line;
        }
        out += "endloop\nendfacet\n";
    }
    return out + "endsolid test\n";
}

/// The header begins with "solid" on purpose: some writers do that.
inline std::string stl_binary_of(const Soup& soup)
{
    std::string out = "solid but binary";
    out.resize(80, ' ');
    out += raw(static_cast<std::uint32_t>(soup.faces.size()));
    for (const Triple& f : soup.faces) {
        out += std::string(12, '\0');
        for (const std::uint32_t v : f) {
            for (const double x : soup.vertices[v])
                out += raw(static_cast<float>(x));
        }
        out += std::string(2, '\0');
    }
    return out;
}

} // namespace phantom::mesh::test
