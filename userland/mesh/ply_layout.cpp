// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/ply_layout.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <map>
#include <optional>
#include <sstream>

#include <fmt/format.h>

#include "mesh/bytes.hpp"

namespace phantom::mesh {

namespace {

std::optional<PlyType> type_named(const std::string& word)
{
    static const std::map<std::string, PlyType> types = {
        {"char", {1, false, true}},    {"int8", {1, false, true}},    {"uchar", {1, false, false}},
        {"uint8", {1, false, false}},  {"short", {2, false, true}},   {"int16", {2, false, true}},
        {"ushort", {2, false, false}}, {"uint16", {2, false, false}}, {"int", {4, false, true}},
        {"int32", {4, false, true}},   {"uint", {4, false, false}},   {"uint32", {4, false, false}},
        {"float", {4, true, true}},    {"float32", {4, true, true}},  {"double", {8, true, true}},
        {"float64", {8, true, true}},
    };
    const auto found = types.find(word);
    return found == types.end() ? std::nullopt : std::optional(found->second);
}

constexpr const char* expected_types = "expected char, uchar, short, ushort, int, uint, float or double";

/// One "property" line into the element before it; an empty text, or what is wrong.
std::string add_property(std::istringstream& words, std::vector<PlyElement>& elements)
{
    if (elements.empty())
        return "a property before the first element";
    PlyProperty property;
    std::string type;
    if (!(words >> type))
        return "expected \"property TYPE NAME\"";
    property.list = type == "list";
    if (property.list) {
        std::string count;
        if (!(words >> count >> type))
            return "expected \"property list TYPE TYPE NAME\"";
        const auto count_type = type_named(count);
        if (!count_type || count_type->real)
            return fmt::format("list length of type {}, expected an integer type", count);
        property.count = *count_type;
    }
    const auto value_type = type_named(type);
    if (!value_type)
        return fmt::format("unknown type {}, {}", type, expected_types);
    property.type = *value_type;
    if (!(words >> property.name))
        return "a property without a name";
    elements.back().properties.push_back(std::move(property));
    return {};
}

std::string set_format(std::istringstream& words, PlyLayout& layout)
{
    std::string format;
    words >> format;
    if (format == "ascii")
        layout.format = PlyFormat::ascii;
    else if (format == "binary_little_endian")
        layout.format = PlyFormat::little_endian;
    else if (format == "binary_big_endian")
        layout.format = PlyFormat::big_endian;
    else
        return fmt::format("format is \"{}\", expected ascii, binary_little_endian or binary_big_endian",
                           format);
    return {};
}

std::string add_element(std::istringstream& words, PlyLayout& layout)
{
    PlyElement element;
    std::string count;
    if (!(words >> element.name >> count))
        return "expected \"element NAME COUNT\"";
    const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (error != std::errc() || end != count.data() + count.size())
        return fmt::format("count of element {} is \"{}\", expected a whole number", element.name, count);
    layout.elements.push_back(std::move(element));
    return {};
}

/// One line after the first; an empty text, or what is wrong.
std::string header_line(const std::string& line, std::size_t number, PlyLayout& layout)
{
    std::istringstream words(line);
    std::string keyword;
    words >> keyword;
    if (number == 2)
        return keyword == "format" ? set_format(words, layout) : "expected \"format\" on line 2";
    if (keyword == "element")
        return add_element(words, layout);
    if (keyword == "property")
        return add_property(words, layout.elements);
    if (keyword == "comment" || keyword == "obj_info")
        return {};
    return fmt::format("unknown word \"{}\", expected element, property, comment or end_header",
                       keyword.substr(0, 20));
}

std::uint64_t little_or_big(const char* at, PlyType type, PlyFormat format)
{
    std::uint64_t value = 0;
    for (unsigned i = 0; i < type.bytes; ++i) {
        const unsigned byte = format == PlyFormat::little_endian ? type.bytes - 1 - i : i;
        value = value << 8 | static_cast<unsigned char>(at[byte]);
    }
    return value;
}

bool is_space(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/// Steps over the body, item by item.
class BodyWalk {
  public:
    BodyWalk(const PlyLayout& layout, const std::string& bytes, const std::string& name)
        : layout_(layout), bytes_(bytes), name_(name), at_(layout.body)
    {
    }

    Status element(const PlyElement& element)
    {
        const std::uint64_t least = least_bytes(element);
        const std::uint64_t left = bytes_.size() - at_;
        // An item without bytes would let a count of any size pass.
        if (element.count > 0 && (least == 0 || element.count > left / least + 1))
            return short_of(element, left / std::max<std::uint64_t>(least, 1));
        const bool lists = std::any_of(element.properties.begin(), element.properties.end(),
                                       [](const PlyProperty& p) { return p.list; });
        if (!lists && layout_.format != PlyFormat::ascii) {
            if (element.count * least > left)
                return short_of(element, left / least);
            at_ += element.count * least;
            return success();
        }
        for (std::uint64_t item = 0; item < element.count; ++item) {
            for (const PlyProperty& property : element.properties) {
                if (auto status = layout_.format == PlyFormat::ascii ? ascii(element, item, property)
                                                                     : binary(element, item, property);
                    !status)
                    return status;
            }
        }
        return success();
    }

  private:
    /// Bytes that one item takes at least: values, or one digit and one blank for each.
    [[nodiscard]] std::uint64_t least_bytes(const PlyElement& element) const
    {
        std::uint64_t bytes = 0;
        for (const PlyProperty& property : element.properties) {
            if (layout_.format == PlyFormat::ascii)
                bytes += 2;
            else
                bytes += property.list ? property.count.bytes : property.type.bytes;
        }
        return bytes;
    }

    [[nodiscard]] Error short_of(const PlyElement& element, std::uint64_t items) const
    {
        return Error{name_, fmt::format("ends early: the header promises {} of element {}, there is room for "
                                        "{} in {} bytes (truncated, or a false header)",
                                        element.count, element.name, items, bytes_.size())};
    }

    [[nodiscard]] Error ends_in(const PlyElement& element, std::uint64_t item) const
    {
        return Error{name_, fmt::format("ends early (truncated) in {} {} of {}, at byte {}", element.name,
                                        item, element.count, bytes_.size())};
    }

    /// The next word, or an empty one at the end of the file.
    std::string_view word()
    {
        while (at_ < bytes_.size() && is_space(bytes_[at_]))
            ++at_;
        const std::size_t first = at_;
        while (at_ < bytes_.size() && !is_space(bytes_[at_]))
            ++at_;
        return std::string_view(bytes_).substr(first, at_ - first);
    }

    Status ascii(const PlyElement& element, std::uint64_t item, const PlyProperty& property)
    {
        std::string_view text = word();
        if (text.empty())
            return ends_in(element, item);
        if (!property.list)
            return success();
        std::uint64_t values = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), values);
        if (error != std::errc() || end != text.data() + text.size())
            return Error{fmt::format("{}:{}", name_, line_of(bytes_, at_ - 1)),
                         fmt::format("{} {}: list length is \"{}\", expected a whole number", element.name,
                                     item, text.substr(0, 20))};
        for (; values > 0; --values) {
            if (word().empty())
                return ends_in(element, item);
        }
        return success();
    }

    Status binary(const PlyElement& element, std::uint64_t item, const PlyProperty& property)
    {
        const PlyType type = property.list ? property.count : property.type;
        if (bytes_.size() - at_ < type.bytes)
            return ends_in(element, item);
        const std::size_t value_at = at_;
        at_ += type.bytes;
        if (!property.list)
            return success();
        const std::uint64_t values = little_or_big(bytes_.data() + value_at, type, layout_.format);
        if (type.with_sign && values >> (8 * type.bytes - 1))
            return Error{name_, fmt::format("{} {}: list length is negative, at byte {}", element.name, item,
                                            value_at)};
        if ((bytes_.size() - at_) / property.type.bytes < values)
            return ends_in(element, item);
        at_ += values * property.type.bytes;
        return success();
    }

    const PlyLayout& layout_;
    const std::string& bytes_;
    const std::string& name_;
    std::size_t at_;
};

} // namespace

const PlyProperty* PlyElement::find(std::string_view property) const
{
    for (const PlyProperty& candidate : properties) {
        if (candidate.name == property)
            return &candidate;
    }
    return nullptr;
}

const PlyElement* PlyLayout::find(std::string_view element, std::string_view other_name) const
{
    for (const PlyElement& candidate : elements) {
        if (candidate.name == element || candidate.name == other_name)
            return &candidate;
    }
    return nullptr;
}

Result<PlyLayout> read_ply_header(const std::string& bytes, const std::string& name)
{
    PlyLayout layout;
    std::size_t at = 0;
    for (std::size_t number = 1;; ++number) {
        const std::size_t end = bytes.find('\n', at);
        if (end == std::string::npos)
            return Error{fmt::format("{}:{}", name, number), "the header ends without \"end_header\""};
        std::string line = bytes.substr(at, end - at);
        at = end + 1;
        while (!line.empty() && is_space(line.back()))
            line.pop_back();
        if (number == 1) {
            if (line != "ply")
                return Error{fmt::format("{}:1", name),
                             "is not a PLY file, expected \"ply\" on the first line"};
            continue;
        }
        if (line == "end_header")
            break;
        if (const std::string what = header_line(line, number, layout); !what.empty())
            return Error{fmt::format("{}:{}", name, number), what};
    }
    layout.body = at;
    return layout;
}

Status check_ply_body(const PlyLayout& layout, const std::string& bytes, const std::string& name)
{
    BodyWalk walk(layout, bytes, name);
    for (const PlyElement& element : layout.elements) {
        if (auto status = walk.element(element); !status)
            return status;
    }
    return success();
}

} // namespace phantom::mesh
