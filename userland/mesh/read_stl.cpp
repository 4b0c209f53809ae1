// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>

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
    return bytes.substr(0, 512).find('\0') == bytes.npos;
}

/// CGAL looks corners up in an ordered map, where a NaN would be taken for another vertex.
Status check_binary(const std::string& bytes, const std::string& name)
{
    if (bytes.size() < binary_header)
        return Error{name,
                     fmt::format("is not an STL file: {} bytes, expected \"solid\" or a binary header of "
                                 "84 bytes",
                                 bytes.size())};
    const std::uint64_t facets = facet_count(bytes);
    if (facets == 0)
        return Error{name, "has no faces, expected a triangle mesh"};
    if (promised_bytes(bytes) > bytes.size())
        return Error{name,
                     fmt::format("ends early (truncated): the header promises {} facets, {} bytes; it ends "
                                 "at byte {}",
                                 facets, promised_bytes(bytes), bytes.size())};
    for (std::uint64_t facet = 0; facet < facets; ++facet) {
        std::array<float, 9> corners{};
        // After the three floats of the normal.
        std::memcpy(corners.data(), bytes.data() + binary_header + facet * binary_facet + 12, sizeof corners);
        for (std::size_t i = 0; i < corners.size(); ++i) {
            if (!std::isfinite(corners[i]))
                return Error{fmt::format("{}: face {}", name, facet),
                             fmt::format("{} of corner {} is {}, expected a finite number", "xyz"[i % 3],
                                         i / 3, corners[i])};
        }
    }
    return success();
}

bool is_number(std::string_view word)
{
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return !word.empty() && error != std::errc::invalid_argument && end == word.data() + word.size() &&
           std::isfinite(value);
}

/// Words of the text with their place, to find what CGAL stumbled over: it reads the file anew
/// as binary after that, and its own place is lost.
class TextWalk {
  public:
    explicit TextWalk(const std::string& bytes) : bytes_(bytes) {}

    /// What is wrong; position() is where.
    std::string fault()
    {
        while (!(word_ = next()).empty()) {
            if (word_ == "endsolid")
                return "expected nothing but further solids after \"endsolid\"";
            if (word_ != "facet")
                continue;
            if (std::string what = facet(); !what.empty())
                return what;
        }
        return "ends early (truncated), expected \"facet\" or \"endsolid\"";
    }

    [[nodiscard]] std::size_t position() const { return first_; }

  private:
    std::string_view next()
    {
        constexpr const char* blanks = " \t\r\n\v\f";
        first_ = std::min(bytes_.find_first_not_of(blanks, at_), bytes_.size());
        at_ = std::min(bytes_.find_first_of(blanks, first_), bytes_.size());
        return std::string_view(bytes_).substr(first_, at_ - first_);
    }

    std::string facet()
    {
        int vertices = 0;
        while ((word_ = next()) != "endfacet") {
            if (word_.empty())
                return "ends early (truncated), expected \"endfacet\"";
            if (word_ != "vertex")
                continue;
            ++vertices;
            for (int axis = 0; axis < 3; ++axis) {
                if (const std::string_view word = next(); !is_number(word))
                    return fmt::format("\"{}\", expected \"vertex X Y Z\" in numbers", word.substr(0, 30));
            }
        }
        return vertices == 3 ? "" : fmt::format("a facet with {} corners, expected 3", vertices);
    }

    const std::string& bytes_;
    std::size_t at_ = 0, first_ = 0;
    std::string_view word_;
};

} // namespace

Result<PolygonSoup> read_stl(std::string& bytes, const std::string& name)
{
    const bool text = is_text(bytes);
    if (!text) {
        if (const auto status = check_binary(bytes, name); !status)
            return status.error();
        // A header that starts like text would send CGAL the wrong way.
        bytes.replace(0, 5, "BINAR");
    }
    ByteBuffer buffer(bytes);
    std::istream stream(&buffer);
    PolygonSoup soup;
    if (!cgal_read_stl(stream, soup)) {
        if (!text)
            return Error{name, fmt::format("cannot be read beyond byte {}", buffer.position())};
        TextWalk walk(bytes);
        const std::string what = walk.fault();
        return Error{fmt::format("{}:{}", name, line_of(bytes, walk.position())), what};
    }
    return soup;
}

} // namespace phantom::mesh
