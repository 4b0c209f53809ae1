// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/ply_groups.hpp"

#include <array>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <string_view>

#include <fmt/format.h>

namespace phantom::mesh {

namespace {

/// The values of a face that say its group: one, or three.
struct Wanted {
    std::array<std::string_view, 3> names;
    std::size_t count = 0;
};

std::optional<Wanted> wanted_of(const PlyElement& face)
{
    const auto is_whole = [&face](std::string_view name, unsigned bytes_max) {
        const PlyProperty* property = face.find(name);
        return property && !property->list && !property->type.real && property->type.bytes <= bytes_max;
    };
    for (const std::string_view name : {"material_index", "material_indices"})
        if (is_whole(name, 4))
            return Wanted{{name}, 1};
    if (is_whole("red", 1) && is_whole("green", 1) && is_whole("blue", 1))
        return Wanted{{"red", "green", "blue"}, 3};
    return std::nullopt;
}

/// Walks over a body whose lengths have been checked, and reads whole numbers.
class BodyReader {
  public:
    BodyReader(const PlyLayout& layout, const std::string& bytes)
        : format_(layout.format), bytes_(bytes), at_(layout.body)
    {
    }

    /// Of a list its length, after stepping over it.
    std::int64_t value(const PlyProperty& property)
    {
        if (!property.list)
            return one(property.type);
        const std::int64_t count = one(property.count);
        if (format_ != PlyFormat::ascii)
            at_ += static_cast<std::size_t>(count) * property.type.bytes;
        for (std::int64_t i = 0; format_ == PlyFormat::ascii && i < count; ++i)
            (void)word();
        return count;
    }

  private:
    std::string_view word()
    {
        constexpr std::string_view blanks = " \t\n\v\f\r";
        const std::size_t first = std::min(bytes_.find_first_not_of(blanks, at_), bytes_.size());
        at_ = std::min(bytes_.find_first_of(blanks, first), bytes_.size());
        return std::string_view(bytes_).substr(first, at_ - first);
    }

    std::int64_t one(const PlyType& type)
    {
        std::int64_t value = 0;
        if (format_ == PlyFormat::ascii) {
            const std::string_view text = word();
            (void)std::from_chars(text.data(), text.data() + text.size(), value);
            return value;
        }
        std::uint64_t raw = 0;
        for (unsigned i = 0; i < type.bytes; ++i) {
            const unsigned byte = format_ == PlyFormat::little_endian ? type.bytes - 1 - i : i;
            raw = raw << 8 | static_cast<unsigned char>(bytes_[at_ + byte]);
        }
        at_ += type.bytes;
        const unsigned shift = 64 - 8 * type.bytes;
        value = static_cast<std::int64_t>(raw << shift);
        return type.with_sign ? value >> shift : static_cast<std::int64_t>(raw);
    }

    PlyFormat format_;
    const std::string& bytes_;
    std::size_t at_;
};

} // namespace

FaceGroups ply_face_groups(const PlyLayout& layout, const std::string& bytes)
{
    FaceGroups groups;
    const PlyElement* face = layout.find("face", "faces");
    const auto wanted = face ? wanted_of(*face) : std::nullopt;
    if (!wanted)
        return groups;
    BodyReader reader(layout, bytes);
    std::string name;
    for (const PlyElement& element : layout.elements) {
        for (std::uint64_t item = 0; item < element.count; ++item) {
            std::array<std::int64_t, 3> values{};
            for (const PlyProperty& property : element.properties) {
                const std::int64_t value = reader.value(property);
                for (std::size_t i = 0; i < wanted->count; ++i)
                    if (property.name == wanted->names[i])
                        values[i] = value;
            }
            if (&element != face)
                continue;
            name = wanted->count == 1 ? fmt::format("{}", values[0])
                                      : fmt::format("#{:02x}{:02x}{:02x}", values[0] & 0xff, values[1] & 0xff,
                                                    values[2] & 0xff);
            groups.add(name);
        }
        if (&element == face)
            break;
    }
    return groups;
}

} // namespace phantom::mesh
