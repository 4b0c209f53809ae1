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

Reader reader_for(const std::filesystem::path& file)
{
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
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

} // namespace

bool is_mesh_file(const std::filesystem::path& file)
{
    return reader_for(file) != nullptr;
}

Result<Soup> read(const std::filesystem::path& file)
{
    const std::string name = file.string();
    const Reader reader = reader_for(file);
    std::error_code ignored;
    if (!reader && std::filesystem::is_regular_file(file, ignored))
        return Error{name, "unknown extension \"" + file.extension().string() +
                               "\", expected .ply, .obj, .stl or .off"};
    // The library behind the readers throws on damage; nothing of it leaves this function.
    try {
        auto bytes = load_bytes(file);
        if (!bytes)
            return bytes.error();
        auto polygons = reader(*bytes, name);
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
