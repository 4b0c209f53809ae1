// SPDX-License-Identifier: GPL-2.0-or-later
#include "vtk_files.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include <fmt/format.h>

namespace phantom::mesh::test {

namespace {

template <typename T>
std::string little(const T& value)
{
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &value, sizeof(T));
    return bytes;
}

template <typename T>
std::string big(const T& value)
{
    std::string bytes = little(value);
    std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

std::string text_of(const std::vector<Vec3>& points)
{
    std::string text;
    for (const Vec3& p : points)
        text += fmt::format("{} {} {}\n", p[0], p[1], p[2]);
    return text;
}

std::string text_of(const std::vector<Triple>& faces)
{
    std::string text;
    for (const Triple& f : faces)
        text += fmt::format("{} {} {}\n", f[0], f[1], f[2]);
    return text;
}

std::string floats_of(const std::vector<Vec3>& points)
{
    std::string bytes;
    for (const Vec3& p : points)
        for (const double x : p)
            bytes += little(static_cast<float>(x));
    return bytes;
}

std::string gltf_json(const std::string& uri)
{
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"children":[1],"translation":[10,0,0],"scale":[2,2,2]},
         {"mesh":0,"translation":[0,1,0],"rotation":[0,0,0.70710678118654757,0.70710678118654757]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1},"indices":2}]}],
"buffers":[{"byteLength":120)" +
           uri + R"(}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":48},
               {"buffer":0,"byteOffset":96,"byteLength":24}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},
             {"bufferView":1,"componentType":5126,"count":4,"type":"VEC3"},
             {"bufferView":2,"componentType":5123,"count":12,"type":"SCALAR"}]})";
}

std::string chunk(std::uint16_t id, const std::string& data)
{
    return little(id) + little(static_cast<std::uint32_t>(data.size() + 6)) + data;
}

constexpr const char* vtk_header = "# vtk DataFile Version 3.0\na tetrahedron\n";

} // namespace

std::string vtp_text(bool with_normals)
{
    const std::string normals = with_normals
                                    ? "<PointData Normals=\"N\"><DataArray type=\"Float64\" Name=\"N\" "
                                      "NumberOfComponents=\"3\" format=\"ascii\">\n" +
                                          text_of(tetrahedron_normals) + "</DataArray></PointData>\n"
                                    : "";
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
           "byte_order=\"LittleEndian\">\n"
           "<PolyData><Piece NumberOfPoints=\"4\" NumberOfPolys=\"4\">\n" +
           normals + "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n" +
           text_of(tetrahedron_points) +
           "</DataArray></Points>\n<Polys><DataArray type=\"Int32\" Name=\"connectivity\" "
           "format=\"ascii\">\n" +
           text_of(tetrahedron_faces) +
           "</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3 6 9 "
           "12</DataArray></Polys>\n"
           "</Piece></PolyData></VTKFile>\n";
}

std::string vtk_text(bool with_normals)
{
    std::string text = std::string(vtk_header) + "ASCII\nDATASET POLYDATA\nPOINTS 4 double\n" +
                       text_of(tetrahedron_points) + "POLYGONS 4 16\n";
    for (const Triple& f : tetrahedron_faces)
        text += fmt::format("3 {} {} {}\n", f[0], f[1], f[2]);
    if (with_normals)
        text += "POINT_DATA 4\nNORMALS n double\n" + text_of(tetrahedron_normals);
    return text;
}

std::string vtk_binary()
{
    std::string bytes = std::string(vtk_header) + "BINARY\nDATASET POLYDATA\nPOINTS 4 double\n";
    for (const Vec3& p : tetrahedron_points)
        for (const double x : p)
            bytes += big(x);
    bytes += "\nPOLYGONS 4 16\n";
    for (const Triple& f : tetrahedron_faces)
        bytes += big(std::int32_t{3}) + big(static_cast<std::int32_t>(f[0])) +
                 big(static_cast<std::int32_t>(f[1])) + big(static_cast<std::int32_t>(f[2]));
    return bytes + "\n";
}

std::string vtk_strip()
{
    return std::string(vtk_header) + "ASCII\nDATASET POLYDATA\nPOINTS 4 double\n" +
           text_of(tetrahedron_points) + "TRIANGLE_STRIPS 1 7\n6 1 0 2 3 1 0\n";
}

std::string vtk_grid()
{
    std::string text = std::string(vtk_header) + "ASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n";
    for (int i = 0; i < 8; ++i)
        text += fmt::format("{} {} {}\n", i & 1, i >> 1 & 1, i >> 2);
    return text + "CELLS 5 25\n4 1 2 4 7\n4 0 1 2 4\n4 3 2 1 7\n4 5 1 4 7\n4 6 4 2 7\n"
                  "CELL_TYPES 5\n10 10 10 10 10\n";
}

std::string gltf_bytes()
{
    std::string bytes = floats_of(tetrahedron_points) + floats_of(tetrahedron_normals);
    for (const Triple& f : tetrahedron_faces)
        for (const std::uint32_t corner : f)
            bytes += little(static_cast<std::uint16_t>(corner));
    return bytes;
}

std::string gltf_text(const std::string& bin)
{
    return gltf_json(",\"uri\":\"" + bin + "\"");
}

std::string glb()
{
    std::string json = gltf_json("");
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::string bytes = gltf_bytes();
    const auto size = [](const std::string& part) { return little(static_cast<std::uint32_t>(part.size())); };
    const std::string chunks = size(json) + "JSON" + json + size(bytes) + std::string("BIN\0", 4) + bytes;
    return "glTF" + little(std::uint32_t{2}) + little(static_cast<std::uint32_t>(12 + chunks.size())) +
           chunks;
}

Vec3 direction_in_gltf_scene(const Vec3& n)
{
    return {-n[1], n[0], n[2]};
}

Vec3 in_gltf_scene(const Vec3& p)
{
    const Vec3 turned = direction_in_gltf_scene(p);
    return {10 + 2 * turned[0], 2 * (turned[1] + 1), 2 * turned[2]};
}

std::string max_3ds()
{
    std::string faces = little(static_cast<std::uint16_t>(tetrahedron_faces.size()));
    for (const Triple& f : tetrahedron_faces) {
        for (const std::uint32_t corner : f)
            faces += little(static_cast<std::uint16_t>(corner));
        faces += little(std::uint16_t{7});
    }
    const std::string points =
        little(static_cast<std::uint16_t>(tetrahedron_points.size())) + floats_of(tetrahedron_points);
    // The object's own axes: the points are in the world's all the same.
    const std::string axes = floats_of({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {5, 6, 7}});
    const std::string object =
        chunk(0x4100, chunk(0x4110, points) + chunk(0x4160, axes) + chunk(0x4120, faces));
    return chunk(0x4D4D, chunk(0x0002, little(std::uint32_t{3})) +
                             chunk(0x3D3D, chunk(0x4000, std::string("part\0", 5) + object)));
}

} // namespace phantom::mesh::test
