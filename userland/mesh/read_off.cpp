// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>

#include <fmt/format.h>

#include "mesh/bytes.hpp"
#include "mesh/formats.hpp"
#include "mesh/read_cgal.hpp"

namespace phantom::mesh {

namespace {

/// Words of the header, over comments and line ends.
class Words {
  public:
    explicit Words(const std::string& bytes) : bytes_(bytes) {}

    std::string_view next()
    {
        while (at_ < bytes_.size() && (is_space() || bytes_[at_] == '#')) {
            if (bytes_[at_] == '#')
                at_ = std::min(bytes_.find('\n', at_), bytes_.size());
            else
                ++at_;
        }
        first_ = at_;
        while (at_ < bytes_.size() && !is_space() && bytes_[at_] != '#')
            ++at_;
        return std::string_view(bytes_).substr(first_, at_ - first_);
    }

    [[nodiscard]] std::size_t first() const { return first_; }
    [[nodiscard]] std::size_t end() const { return at_; }

  private:
    [[nodiscard]] bool is_space() const { return std::isspace(static_cast<unsigned char>(bytes_[at_])); }

    const std::string& bytes_;
    std::size_t at_ = 0, first_ = 0;
};

struct Header {
    std::uint64_t vertices = 0, faces = 0;
    std::size_t body = 0; ///< first byte after the counts
};

std::optional<std::uint64_t> whole_number(std::string_view word)
{
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || error != std::errc() || end != word.data() + word.size())
        return std::nullopt;
    return value;
}

/// The header; colours and textures are hidden from CGAL, which then takes the first numbers of a line.
Result<Header> header_of(std::string& bytes, const std::string& name)
{
    Words words(bytes);
    const std::string keyword(words.next());
    const std::size_t at = words.first();
    const std::string where = fmt::format("{}:{}", name, line_of(bytes, at));
    if (keyword == "COFF" || keyword == "CNOFF" || keyword == "STOFF" || keyword == "STNOFF") {
        const std::size_t flags = keyword.rfind("ST", 0) == 0 ? 2 : 1;
        bytes.replace(at, flags, flags, ' ');
    } else if (keyword != "OFF" && keyword != "NOFF") {
        return Error{where, fmt::format("first word is \"{}\", expected OFF, NOFF, COFF or STOFF in text",
                                        keyword.substr(0, 20))};
    }
    const auto vertices = whole_number(words.next());
    const std::size_t counts = words.first();
    const auto faces = whole_number(words.next());
    const auto edges = whole_number(words.next());
    const std::string line = fmt::format("{}:{}", name, line_of(bytes, counts));
    if (!vertices || !faces || !edges)
        return Error{line, "expected three numbers: vertices, faces, edges"};
    // At least "0 0 0\n" for a vertex and "3 0 0 0\n" for a face.
    const std::uint64_t left = bytes.size() - words.end();
    if (*vertices > left / 6 + 1 || *faces > left / 6 + 1)
        return Error{line, fmt::format("promises {} vertices and {} faces, more than {} bytes can hold "
                                       "(truncated, or a false header)",
                                       *vertices, *faces, bytes.size())};
    return Header{*vertices, *faces, words.end()};
}

/// Lines with something on them that is no comment.
std::uint64_t data_lines(const std::string& bytes, std::size_t at)
{
    std::uint64_t lines = 0;
    for (; at < bytes.size(); ++at) {
        at = bytes.find_first_not_of(" \t\r\n", at);
        if (at == std::string::npos)
            break;
        lines += bytes[at] != '#';
        at = std::min(bytes.find('\n', at), bytes.size());
    }
    return lines;
}

} // namespace

Result<PolygonSoup> read_off(std::string& bytes, const std::string& name)
{
    const auto header = header_of(bytes, name);
    if (!header)
        return header.error();
    if (header->vertices == 0)
        return Error{name, "has no vertices"};
    if (header->faces == 0)
        return Error{name, "has no faces, expected a triangle mesh"};
    ByteBuffer buffer(bytes);
    std::istream stream(&buffer);
    PolygonSoup soup;
    if (!cgal_read_off(stream, soup)) {
        const std::size_t stopped = buffer.position();
        if (data_lines(bytes, header->body) < header->vertices + header->faces)
            return Error{name,
                         fmt::format("ends early (truncated) at byte {}: the header promises {} vertices "
                                     "and {} faces, one a line",
                                     bytes.size(), header->vertices, header->faces)};
        // The reader has taken the offending line whole.
        return Error{fmt::format("{}:{}", name, line_of(bytes, std::max<std::size_t>(stopped, 1) - 1)),
                     fmt::format("expected a vertex \"X Y Z\" or a face \"N I1 ... IN\" with 0 <= I < {}",
                                 header->vertices)};
    }
    return soup;
}

} // namespace phantom::mesh
