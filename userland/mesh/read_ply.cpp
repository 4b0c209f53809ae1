// SPDX-License-Identifier: GPL-2.0-or-later
#include <fmt/format.h>

#include "mesh/bytes.hpp"
#include "mesh/formats.hpp"
#include "mesh/ply_groups.hpp"
#include "mesh/ply_layout.hpp"
#include "mesh/read_cgal.hpp"

namespace phantom::mesh {

namespace {

bool has_real(const PlyElement& element, std::string_view name)
{
    const PlyProperty* property = element.find(name);
    return property && !property->list && property->type.real;
}

/// What CGAL takes for granted about the two elements of a mesh.
Status check_elements(const PlyLayout& layout, const std::string& name)
{
    const PlyElement* vertex = layout.find("vertex", "vertices");
    if (!vertex || vertex->count == 0)
        return Error{name, "has no vertices, expected \"element vertex COUNT\" in the header"};
    for (const char* axis : {"x", "y", "z"}) {
        if (!has_real(*vertex, axis))
            return Error{name, fmt::format("vertices have no property {} of type float or double", axis)};
    }
    const PlyElement* face = layout.find("face", "faces");
    if (!face || face->count == 0)
        return Error{name, "has no faces, expected a triangle mesh"};
    const PlyProperty* indices = face->find("vertex_indices");
    if (!indices)
        indices = face->find("vertex_index");
    if (!indices || !indices->list || indices->type.real || indices->type.bytes != 4)
        return Error{name, "faces have no \"property list uchar int vertex_indices\" (int or uint)"};
    return success();
}

} // namespace

Result<PolygonSoup> read_ply(std::string& bytes, const std::string& name)
{
    const auto layout = read_ply_header(bytes, name);
    if (!layout)
        return layout.error();
    if (const auto status = check_elements(*layout, name); !status)
        return status.error();
    if (const auto status = check_ply_body(*layout, bytes, name); !status)
        return status.error();

    const PlyElement& vertex = *layout->find("vertex", "vertices");
    const bool with_normals = has_real(vertex, "nx") && has_real(vertex, "ny") && has_real(vertex, "nz");
    ByteBuffer buffer(bytes);
    std::istream stream(&buffer);
    PolygonSoup soup;
    if (!cgal_read_ply(stream, with_normals, soup)) {
        if (layout->format == PlyFormat::ascii)
            return Error{fmt::format("{}:{}", name, line_of(bytes, buffer.position())),
                         "cannot be read as a number, expected the values that the header announces"};
        return Error{name, fmt::format("cannot be read beyond byte {}", buffer.position())};
    }
    soup.groups = ply_face_groups(*layout, bytes);
    return soup;
}

} // namespace phantom::mesh
