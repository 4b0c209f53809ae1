// SPDX-License-Identifier: GPL-2.0-or-later
// CGAL reads vertices and faces of an OBJ file, but no normals; it stops at words it does not know
// ("l") and takes an index of 0 or a broken corner for the end of a polygon. One walk over the
// lines before it checks faces, collects normals, and hides what CGAL need not see.
#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include <fmt/format.h>

#include "mesh/bytes.hpp"
#include "mesh/formats.hpp"
#include "mesh/read_cgal.hpp"

namespace phantom::mesh {

namespace {

constexpr std::uint32_t no_normal = 0xffffffffU;

bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

/// The words of one line.
class Words {
  public:
    Words(const char* at, const char* end) : at_(at), end_(end) {}

    /// The next word, or an empty one.
    std::string_view next()
    {
        while (at_ < end_ && is_blank(*at_))
            ++at_;
        const char* first = at_;
        while (at_ < end_ && !is_blank(*at_))
            ++at_;
        return {first, static_cast<std::size_t>(at_ - first)};
    }

  private:
    const char* at_;
    const char* end_;
};

/// Index from 0 of an OBJ reference: from 1, or negative and counted back from the last one so far.
std::optional<std::int64_t> reference(std::string_view& text, std::size_t so_far)
{
    std::int32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc())
        return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return value > 0 ? value - 1 : value == 0 ? -1 : static_cast<std::int64_t>(so_far) + value;
}

class LineWalk {
  public:
    LineWalk(std::string& bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    Status walk()
    {
        join_continued_lines();
        for (std::size_t at = 0; at < bytes_.size();) {
            at_ = at;
            const std::size_t end = std::min(bytes_.find('\n', at), bytes_.size());
            if (const std::string what = line(at, end); !what.empty())
                return Error{fmt::format("{}:{}", name_, line_number(at)), what};
            at = end + 1;
        }
        return check_last();
    }

    /// Physical line of a byte; joined lines count as they stand in the file.
    [[nodiscard]] std::size_t line_number(std::size_t offset) const
    {
        const auto joined = std::lower_bound(joined_.begin(), joined_.end(), offset) - joined_.begin();
        return line_of(bytes_, offset) + static_cast<std::size_t>(joined);
    }

    /// Normals into the soup that CGAL made of the same faces.
    void give_normals(PolygonSoup& soup)
    {
        if (normals_.empty() || !some_normal_used_)
            return;
        // Corners without a normal share one of no direction: prepare() repairs it.
        const auto none = static_cast<std::uint32_t>(normals_.size());
        normals_.push_back({0, 0, 0});
        std::replace(corner_normals_.begin(), corner_normals_.end(), no_normal, none);
        soup.normals = std::move(normals_);
        soup.corner_normals = std::move(corner_normals_);
    }

    /// The same for smoothing groups, one a face.
    void give_smoothing(PolygonSoup& soup)
    {
        if (std::any_of(smoothing_.begin(), smoothing_.end(), [](std::uint32_t group) { return group != 0; }))
            soup.smoothing = std::move(smoothing_);
    }

    /// Of usemtl where the file has it, else of g.
    FaceGroups& groups() { return with_materials_ ? by_material_ : by_group_; }

    [[nodiscard]] std::size_t corners() const { return corner_normals_.size(); }

  private:
    /// A backslash at the end of a line joins the next one to it.
    void join_continued_lines()
    {
        for (std::size_t at = bytes_.find('\\'); at != std::string::npos; at = bytes_.find('\\', at + 1)) {
            std::size_t end = at + 1;
            if (end < bytes_.size() && bytes_[end] == '\r')
                ++end;
            if (end < bytes_.size() && bytes_[end] == '\n') {
                std::fill(bytes_.begin() + static_cast<std::ptrdiff_t>(at),
                          bytes_.begin() + static_cast<std::ptrdiff_t>(end + 1), ' ');
                joined_.push_back(end);
            }
        }
    }

    /// An empty text, or what is wrong.
    std::string line(std::size_t at, std::size_t end)
    {
        while (at < end && is_blank(bytes_[at]))
            ++at;
        if (at == end || bytes_[at] == '#')
            return {};
        Words words(bytes_.data() + at, bytes_.data() + end);
        const std::string_view keyword = words.next();
        if (keyword == "v") {
            ++vertices_;
            return {};
        }
        if (keyword == "f")
            return face(words);
        std::string what;
        if (keyword == "vn")
            what = normal(words);
        else if (keyword == "s")
            what = smoothing_group(words);
        else if (keyword == "usemtl" || keyword == "g")
            name_faces(keyword == "g", words);
        else if (!is_known(keyword))
            what = fmt::format("unknown word \"{}\", expected v, vn, vt or f", keyword.substr(0, 20));
        bytes_[at] = '#';
        return what;
    }

    static bool is_known(std::string_view keyword)
    {
        static constexpr std::array words = {
            "vt",     "vp",       "g",        "o",     "s",          "l",         "p",      "usemtl",
            "mtllib", "usemap",   "maplib",   "mg",    "bevel",      "lod",       "cstype", "deg",
            "bmat",   "step",     "curv",     "curv2", "surf",       "parm",      "trim",   "hole",
            "scrv",   "sp",       "end",      "con",   "shadow_obj", "trace_obj", "ctech",  "stech",
            "call",   "c_interp", "d_interp", "bsp",   "bzp",        "cdc",       "cdp",    "res"};
        return std::find(words.begin(), words.end(), keyword) != words.end();
    }

    std::string normal(Words& words)
    {
        Vec3 value{};
        for (double& component : value) {
            const std::string_view word = words.next();
            const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), component);
            if (word.empty() || error == std::errc::invalid_argument)
                return "expected \"vn X Y Z\" in numbers";
        }
        normals_.push_back(value);
        return {};
    }

    /// "s 3" for the faces that follow; "s off" and "s 0" end it.
    std::string smoothing_group(Words& words)
    {
        const std::string_view word = words.next();
        group_ = 0;
        if (word == "off" || word == "on") {
            group_ = word == "on";
            return {};
        }
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), group_);
        if (word.empty() || error != std::errc() || end != word.data() + word.size())
            return "expected \"s off\" or \"s GROUP\" with a whole number";
        return {};
    }

    /// "usemtl NAME", "g NAME ..." for the faces that follow.
    void name_faces(bool group, Words& words)
    {
        std::string& name = group ? group_name_ : material_;
        name.clear();
        for (std::string_view word = words.next(); !word.empty(); word = words.next())
            name.append(name.empty() ? "" : " ").append(word);
        with_materials_ = with_materials_ || (!group && !name.empty());
    }

    std::string face(Words& words)
    {
        std::size_t corners = 0;
        for (std::string_view word = words.next(); !word.empty(); word = words.next(), ++corners) {
            if (word[0] == '#')
                break;
            if (std::string what = corner(word); !what.empty())
                return what;
        }
        if (corners < 3)
            return fmt::format("a face with {} corners, expected 3 or more", corners);
        smoothing_.push_back(group_);
        by_material_.add(material_);
        by_group_.add(group_name_);
        return {};
    }

    /// v, v/t, v//n or v/t/n
    std::string corner(std::string_view word)
    {
        const std::string_view whole = word;
        const auto vertex = reference(word, vertices_);
        if (!vertex)
            return fmt::format("a corner \"{}\", expected V, V/T, V//N or V/T/N", whole.substr(0, 30));
        if (*vertex < 0)
            return fmt::format("vertex {} of a face is out of range, expected 1 ... {} or -{} ... -1",
                               whole.substr(0, 30), vertices_, vertices_);
        note_largest(*vertex, largest_vertex_, largest_vertex_at_);
        std::uint32_t normal = no_normal;
        const std::size_t slash = word.find('/', word.empty() ? 0 : 1);
        if (slash != std::string_view::npos && slash + 1 < word.size()) {
            word.remove_prefix(slash + 1);
            const auto index = reference(word, normals_.size());
            if (!index || *index < 0)
                return fmt::format("normal of corner \"{}\" is out of range, expected 1 ... {}",
                                   whole.substr(0, 30), normals_.size());
            note_largest(*index, largest_normal_, largest_normal_at_);
            normal = static_cast<std::uint32_t>(*index);
            some_normal_used_ = true;
        }
        corner_normals_.push_back(normal);
        return {};
    }

    void note_largest(std::int64_t index, std::int64_t& largest, std::size_t& at) const
    {
        if (index > largest) {
            largest = index;
            at = at_;
        }
    }

    /// A face may name a vertex that comes later, so the upper end is known only now.
    Status check_last() const
    {
        if (vertices_ == 0)
            return Error{name_, "has no vertices, expected lines \"v X Y Z\""};
        if (corner_normals_.empty())
            return Error{name_, "has no faces, expected lines \"f I J K\""};
        if (largest_vertex_ >= static_cast<std::int64_t>(vertices_))
            return Error{
                fmt::format("{}:{}", name_, line_number(largest_vertex_at_)),
                fmt::format("a face names vertex {}, but there are {}", largest_vertex_ + 1, vertices_)};
        if (largest_normal_ >= static_cast<std::int64_t>(normals_.size()))
            return Error{fmt::format("{}:{}", name_, line_number(largest_normal_at_)),
                         fmt::format("a face names normal {}, but there are {}", largest_normal_ + 1,
                                     normals_.size())};
        return success();
    }

    std::string& bytes_;
    const std::string& name_;
    std::size_t at_ = 0; ///< first byte of the line in hand
    std::size_t vertices_ = 0;
    std::vector<Vec3> normals_;
    std::vector<std::uint32_t> corner_normals_;
    bool some_normal_used_ = false;
    std::uint32_t group_ = 0;              ///< smoothing group of the faces that follow; 0: none
    std::vector<std::uint32_t> smoothing_; ///< per face
    std::string material_, group_name_;    ///< of the faces that follow
    bool with_materials_ = false;          ///< some face may have one
    FaceGroups by_material_, by_group_;
    std::int64_t largest_vertex_ = -1, largest_normal_ = -1;
    std::size_t largest_vertex_at_ = 0, largest_normal_at_ = 0;
    std::vector<std::size_t> joined_; ///< offsets of line ends that were blanked
};

} // namespace

Result<PolygonSoup> read_obj(std::string& bytes, const std::string& name)
{
    LineWalk lines(bytes, name);
    if (const auto status = lines.walk(); !status)
        return status.error();
    ByteBuffer buffer(bytes);
    std::istream stream(&buffer);
    PolygonSoup soup;
    if (!cgal_read_obj(stream, soup)) {
        // CGAL has taken the offending line whole, its end included.
        const std::size_t stopped = std::max<std::size_t>(buffer.position(), 1) - 1;
        return Error{fmt::format("{}:{}", name, lines.line_number(stopped)),
                     "expected \"v X Y Z\" in numbers"};
    }
    if (soup.corners.size() != lines.corners())
        return Error{name, fmt::format("has faces that cannot be read: {} corners of {}", soup.corners.size(),
                                       lines.corners())};
    lines.give_normals(soup);
    lines.give_smoothing(soup);
    soup.groups = std::move(lines.groups());
    return soup;
}

} // namespace phantom::mesh
