// SPDX-License-Identifier: GPL-2.0-or-later
// The header of a PLY file and a walk over its body that reads no value but list lengths: it finds
// truncation and false counts, with their place, before a reader allocates for them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"

namespace phantom::mesh {

enum class PlyFormat { ascii, little_endian, big_endian };

struct PlyType {
    unsigned bytes = 0;
    bool real = false;      ///< float or double
    bool with_sign = false; ///< of an integer
};

struct PlyProperty {
    std::string name;
    PlyType type;  ///< of the value, or of each value of a list
    PlyType count; ///< of a list's length
    bool list = false;
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;

    [[nodiscard]] const PlyProperty* find(std::string_view property) const;
};

struct PlyLayout {
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements;
    std::size_t body = 0; ///< first byte after the header

    [[nodiscard]] const PlyElement* find(std::string_view element, std::string_view other_name) const;
};

/// `name` is the file. Errors name the line of the header and what was expected.
Result<PlyLayout> read_ply_header(const std::string& bytes, const std::string& name);

/// Every element's items are there in full. Errors name element, item (from 0), byte or line.
Status check_ply_body(const PlyLayout& layout, const std::string& bytes, const std::string& name);

} // namespace phantom::mesh
