// SPDX-License-Identifier: GPL-2.0-or-later
// The ABI header against its golden layout, and against its own rules.
#include <cstddef>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "phantom_abi.h"

#define SIZE(type, bytes) static_assert(sizeof(type) == (bytes));
#define OFFSET(type, field, bytes) static_assert(offsetof(type, field) == (bytes));
#define NUMBER(name, value) static_assert((name) == (value));
#include "layout.inc"
#undef SIZE
#undef OFFSET
#undef NUMBER

namespace {

std::string text_of(const std::string& path)
{
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

struct Field {
    std::string structure, type, name;
};

/// Every field of every structure, by the header's own text: "\t[struct ]TYPE NAME[...];" between braces.
std::vector<Field> fields_of_header()
{
    std::vector<Field> fields;
    std::istringstream header(text_of(PHANTOM_ABI_HEADER));
    std::string line, structure;
    while (std::getline(header, line)) {
        if (line.starts_with("struct phantom_") && line.ends_with(" {")) {
            structure = line.substr(7, line.size() - 9);
        } else if (line == "};") {
            structure.clear();
        } else if (!structure.empty() && line.starts_with('\t') && line.find(';') != std::string::npos) {
            std::istringstream words(line);
            std::string type, name;
            words >> type;
            if (type == "struct") {
                words >> name;
                type += " " + name;
            }
            words >> name;
            fields.push_back({structure, type, name.substr(0, name.find_first_of("[;"))});
        }
    }
    return fields;
}

TEST(Abi, EveryFieldHasAGoldenOffset)
{
    const std::string layout = text_of(PHANTOM_ABI_LAYOUT);
    const auto fields = fields_of_header();
    ASSERT_GT(fields.size(), 100u) << "the header was not understood";
    for (const Field& field : fields) {
        EXPECT_NE(layout.find("OFFSET(" + field.structure + ", " + field.name + ","), std::string::npos)
            << field.structure << "." << field.name;
        EXPECT_NE(layout.find("SIZE(" + field.structure + ","), std::string::npos) << field.structure;
    }
}

TEST(Abi, FieldsAreFixedWidthIntegersOrStructuresOfThem)
{
    const std::set<std::string> integers{"__u32", "__s32", "__u64", "__s64"};
    for (const Field& field : fields_of_header())
        EXPECT_TRUE(integers.contains(field.type) || field.type.starts_with("struct phantom_"))
            << field.structure << "." << field.name << " is " << field.type;
}

TEST(Abi, StructuresHaveNoHolesAndNoTail)
{
    // sizes of the fields add up to the size of the structure
    EXPECT_EQ(sizeof(phantom_patch), 3 * 12 + 3 * 12 + 3 * 4 + 4 + 3 * 4 + 4 + 4 + 4 + 2 * 4);
    EXPECT_EQ(sizeof(phantom_set), 8 + 3 * 8 + 3 * 4 + 4 + 8 * 4 + 8 + 3 * 8);
    EXPECT_EQ(sizeof(phantom_object), 2 * 4 + 3 * 8 + (4 + 3 + 3) * 4 + 2 * 4 + 3 * 8);
    EXPECT_EQ(sizeof(phantom_magnet), 2 * 4);
    EXPECT_EQ(sizeof(phantom_friction), 4 * 4);
    EXPECT_EQ(sizeof(phantom_texture), 2 * 4 + 2 * 3 * 4);
    EXPECT_EQ(sizeof(phantom_height_map), 4 * 4);
    EXPECT_EQ(sizeof(phantom_impact), 4 * 4);
    EXPECT_EQ(sizeof(phantom_constant), 3 * 4 + 4);
    EXPECT_EQ(sizeof(phantom_viscosity), 3 * 8 + 4 * 4);
    EXPECT_EQ(sizeof(phantom_guide), 3 * 8 + 3 * 4 + 5 * 4);
    EXPECT_EQ(sizeof(phantom_field), 3 * 8 + 3 * 4 + 3 * 4 + 2 * 4);
    EXPECT_EQ(sizeof(phantom_tip), 2 * 4);
    EXPECT_EQ(sizeof(phantom_tick), 3 * 8 + 2 * 24 + 12 + 7 * 4);
    EXPECT_EQ(offsetof(phantom_status, latency) + 3 * sizeof(phantom_histogram), sizeof(phantom_status));
}

TEST(Abi, IoctlNumbersAreUnique)
{
    const std::vector<unsigned long> numbers{PHANTOM_GET_INFO, PHANTOM_SET_RATE,   PHANTOM_SET_MODEL,
                                             PHANTOM_START,    PHANTOM_STOP,       PHANTOM_SUBMIT_SET,
                                             PHANTOM_SIM_MOVE, PHANTOM_CLEAR_FAULT};
    for (std::size_t i = 0; i < numbers.size(); ++i)
        EXPECT_EQ(numbers[i] & 0xff, i);
}

} // namespace
