// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/read.hpp"

#include <algorithm>
#include <cctype>
#include <exception>
#include <new>

#include "mesh/bytes.hpp"
#include "mesh/formats.hpp"

namespace phantom::mesh {

namespace {

using Reader = Result<PolygonSoup> (*)(std::string& bytes, const std::string& name);

std::string extension_of(const std::filesystem::path& file)
{
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

Reader reader_for(const std::filesystem::path& file)
{
    const std::string extension = extension_of(file);
    if (extension == ".ply")
        return read_ply;
    if (extension == ".obj")
        return read_obj;
    if (extension == ".stl")
        return read_stl;
    if (extension == ".off")
        return read_off;
    return nullptr;
}

/// Formats that another program reads.
bool is_for_vtk(const std::filesystem::path& file)
{
    const std::string extension = extension_of(file);
    return extension == ".vtp" || extension == ".vtk" || extension == ".3ds" || is_in_metres(file);
}

Result<PolygonSoup> polygons_of(const std::filesystem::path& file, Reader reader)
{
    const std::string name = file.string();
    if (!reader) {
        if (const auto size = size_of(file); !size)
            return size.error();
        return read_vtk(name);
    }
    auto bytes = load_bytes(file);
    if (!bytes)
        return bytes.error();
    return reader(*bytes, name);
}

} // namespace

bool is_mesh_file(const std::filesystem::path& file)
{
    return reader_for(file) != nullptr || is_for_vtk(file);
}

bool is_in_metres(const std::filesystem::path& file)
{
    const std::string extension = extension_of(file);
    return extension == ".gltf" || extension == ".glb";
}

Result<Soup> read(const std::filesystem::path& file)
{
    const std::string name = file.string();
    const Reader reader = reader_for(file);
    std::error_code ignored;
    if (!is_mesh_file(file) && std::filesystem::is_regular_file(file, ignored))
        return Error{name,
                     "unknown extension \"" + file.extension().string() + "\", expected " + mesh_extensions};
    // The library behind the readers throws on damage; nothing of it leaves this function.
    try {
        auto polygons = polygons_of(file, reader);
        if (!polygons)
            return polygons.error();
        return triangles_of(std::move(*polygons), name);
    } catch (const std::bad_alloc&) {
        return Error{name, "does not fit into memory"};
    } catch (const std::exception& failure) {
        const std::string what = failure.what();
        return Error{name, "cannot be read: " + what.substr(0, what.find('\n'))};
    }
}

} // namespace phantom::mesh
