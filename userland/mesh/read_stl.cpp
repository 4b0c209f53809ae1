// SPDX-License-Identifier: GPL-2.0-or-later
#include <cctype>
#include <cstring>

#include <fmt/format.h>

#include "mesh/bytes.hpp"
#include "mesh/formats.hpp"
#include "mesh/read_cgal.hpp"

namespace phantom::mesh {

namespace {

constexpr std::size_t binary_header = 84; ///< 80 bytes of text and the number of triangles
constexpr std::size_t binary_facet = 50;  ///< normal and three corners as float, two bytes of attributes

std::uint64_t facet_count(const std::string& bytes)
{
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < 4; ++i)
        count |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[80 + i])) << (8 * i);
    return count;
}

/// Size of a binary file, as its header promises.
std::uint64_t promised_bytes(const std::string& bytes)
{
    return binary_header + binary_facet * facet_count(bytes);
}

/// Text starts with "solid", but some binary writers put that into their header too: there the
/// size tells, and bytes that no text has.
bool is_text(const std::string& bytes)
{
    const std::size_t first = bytes.find_first_not_of(" \t\r\n");
    if (first == std::string::npos || bytes.compare(first, 5, "solid") != 0)
        return false;
    if (bytes.size() >= binary_header && promised_bytes(bytes) == bytes.size())
        return false;
    return std::memchr(bytes.data(), '\0', std::min<std::size_t>(bytes.size(), 512)) == nullptr;
}

} // namespace

Result<PolygonSoup> read_stl(std::string& bytes, const std::string& name)
{
    const bool text = is_text(bytes);
    if (!text) {
        if (bytes.size() < binary_header)
            return Error{name, fmt::format("is not an STL file: {} bytes, expected \"solid\" or a binary "
                                           "header of 84 bytes",
                                           bytes.size())};
        if (facet_count(bytes) == 0)
            return Error{name, "has no faces, expected a triangle mesh"};
        if (promised_bytes(bytes) > bytes.size())
            return Error{name, fmt::format("ends early (truncated): the header promises {} facets, {} bytes; "
                                           "it ends at byte {}",
                                           facet_count(bytes), promised_bytes(bytes), bytes.size())};
        // A header that starts like text would send CGAL the wrong way.
        bytes.replace(0, 5, "BINAR");
    }
    ByteBuffer buffer(bytes);
    std::istream stream(&buffer);
    PolygonSoup soup;
    if (!cgal_read_stl(stream, soup)) {
        if (!text)
            return Error{name, fmt::format("cannot be read beyond byte {}", buffer.position())};
        const std::size_t stopped = buffer.position();
        return Error{fmt::format("{}:{}", name, line_of(bytes, stopped)),
                     stopped >= bytes.size()
                         ? "ends early (truncated), expected \"endfacet\" and \"endsolid\""
                         : "expected \"facet\" with three times \"vertex X Y Z\" in numbers"};
    }
    return soup;
}

} // namespace phantom::mesh
