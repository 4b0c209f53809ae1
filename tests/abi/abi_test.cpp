// SPDX-License-Identifier: GPL-2.0-or-later
// The ABI header against its golden layout, and against its own rules.
#include <cstddef>
#include <fstream>
#include <regex>
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

/// Every field of every structure, by the header's own text.
std::vector<Field> fields_of_header()
{
    std::vector<Field> fields;
    std::istringstream header(text_of(PHANTOM_ABI_HEADER));
    const std::regex opening(R"(^struct (phantom_\w+) \{)");
    const std::regex member(R"(^\t((?:struct )?\w+) (\w+)(?:\[\w+\])*;)");
    std::string line, structure;
    std::smatch match;
    while (std::getline(header, line)) {
        if (std::regex_search(line, match, opening))
            structure = match[1];
        else if (line == "};")
            structure.clear();
        else if (!structure.empty() && std::regex_search(line, match, member))
            fields.push_back({structure, match[1], match[2]});
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
    const std::regex allowed(R"(__u32|__s32|__u64|__s64|struct phantom_\w+)");
    for (const Field& field : fields_of_header())
        EXPECT_TRUE(std::regex_match(field.type, allowed)) << field.structure << "." << field.name;
}

TEST(Abi, StructuresHaveNoHolesAndNoTail)
{
    // sizes of the fields add up to the size of the structure
    EXPECT_EQ(sizeof(phantom_patch), 3 * 12 + 3 * 12 + 3 * 4 + 4 + 3 * 4 + 4 + 4 + 4 + 2 * 4);
    EXPECT_EQ(sizeof(phantom_set), 8 + 3 * 8 + 3 * 4 + 4 + 8 * 4 + 3 * 8);
    EXPECT_EQ(sizeof(phantom_tick), 3 * 8 + 2 * 24 + 12 + 5 * 4);
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
