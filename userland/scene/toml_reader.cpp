// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/toml_reader.hpp"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "mesh/bytes.hpp"

namespace phantom::scene {

void Faults::add(const toml::source_region& at, std::string what)
{
    if (first_ && at.begin.line >= line_)
        return;
    first_ = Error{where(at), std::move(what)};
    line_ = at.begin.line;
}

std::string Faults::where(const toml::source_region& at) const
{
    return fmt::format("{}:{}", file_, at.begin.line);
}

std::string shown(const toml::node& node)
{
    if (node.is_table())
        return "a table";
    if (node.is_array())
        return fmt::format("an array of {}", node.as_array()->size());
    std::ostringstream text;
    node.visit([&text](const auto& value) {
        if constexpr (toml::is_string<decltype(value)>)
            text << '"' << value.get() << '"';
        else if constexpr (toml::is_floating_point<decltype(value)>)
            text << fmt::format("{}", value.get()); // as few digits as name it
        else if constexpr (toml::is_value<decltype(value)>)
            text << value;
    });
    return text.str();
}

Result<toml::table> parse_toml(const std::filesystem::path& file)
{
    const auto bytes = mesh::load_bytes(file);
    if (!bytes)
        return bytes.error();
    try {
        return toml::parse(*bytes, file.string());
    } catch (const toml::parse_error& error) {
        return Error{fmt::format("{}:{}", file.string(), error.source().begin.line),
                     std::string("is not TOML: ") + std::string(error.description())};
    }
}

TomlReader::TomlReader(const toml::table& table, std::string path, std::span<const std::string_view> known,
                       std::span<const std::string_view> expected, Faults& faults)
    : table_(table), path_(std::move(path)), faults_(faults)
{
    for (const auto& [key, value] : table) {
        if (std::find(known.begin(), known.end(), key.str()) == known.end())
            faults_.add(key.source(), fmt::format("{}{}: unknown key, expected {}", path_, key.str(),
                                                  fmt::join(expected, ", ")));
    }
}

const toml::source_region& TomlReader::source(std::string_view key) const
{
    const toml::node* node = table_.get(key);
    return node ? node->source() : table_.source();
}

void TomlReader::fault(std::string_view key, const std::string& what)
{
    faults_.add(source(key), fmt::format("{}{}: {}", path_, key, what));
}

std::optional<std::string> TomlReader::text(std::string_view key)
{
    const toml::node* node = table_.get(key);
    if (!node)
        return std::nullopt;
    if (!node->is_string() || node->as_string()->get().empty()) {
        fault(key, fmt::format("is {}, expected a text in quotes", shown(*node)));
        return std::nullopt;
    }
    return node->as_string()->get();
}

std::optional<std::string> TomlReader::word(std::string_view key, std::span<const std::string_view> words)
{
    auto value = text(key);
    if (value && std::find(words.begin(), words.end(), *value) == words.end()) {
        fault(key, fmt::format("is \"{}\", expected {}", *value, fmt::join(words, ", ")));
        return std::nullopt;
    }
    return value;
}

std::optional<double> TomlReader::number(std::string_view key, const Range& range)
{
    const toml::node* node = table_.get(key);
    if (!node)
        return std::nullopt;
    const auto value = node->is_number() ? node->value<double>() : std::nullopt;
    // contains() is false for NaN.
    if (!value || !range.contains(*value)) {
        fault(key, fmt::format("is {}, expected {}", shown(*node), range.text));
        return std::nullopt;
    }
    return value;
}

std::optional<int> TomlReader::whole_number(std::string_view key, int low, int high)
{
    const toml::node* node = table_.get(key);
    if (!node)
        return std::nullopt;
    const auto value = node->is_integer() ? node->value<std::int64_t>() : std::nullopt;
    if (!value || *value < low || *value > high) {
        fault(key, fmt::format("is {}, expected a whole number, {} ... {}", shown(*node), low, high));
        return std::nullopt;
    }
    return static_cast<int>(*value);
}

std::optional<bool> TomlReader::flag(std::string_view key)
{
    const toml::node* node = table_.get(key);
    if (!node)
        return std::nullopt;
    if (!node->is_boolean()) {
        fault(key, fmt::format("is {}, expected true or false", shown(*node)));
        return std::nullopt;
    }
    return node->as_boolean()->get();
}

bool TomlReader::numbers(std::string_view key, const Range& range, std::span<double> values)
{
    const toml::node* node = table_.get(key);
    if (!node)
        return false;
    const toml::array* array = node->as_array();
    if (!array || array->size() != values.size()) {
        fault(key, fmt::format("is {}, expected [{} numbers]", shown(*node), values.size()));
        return false;
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
        const toml::node& element = *array->get(i);
        const auto value = element.is_number() ? element.value<double>() : std::nullopt;
        if (!value || !range.contains(*value)) {
            fault(key, fmt::format("number {} is {}, expected {}", i + 1, shown(element), range.text));
            return false;
        }
        values[i] = *value;
    }
    return true;
}

bool TomlReader::append_numbers(std::string_view key, const toml::node& node, const Range& range,
                                std::size_t count, const std::string& at, std::vector<double>& values)
{
    const toml::array* array = node.as_array();
    if (!array || array->size() != count) {
        fault(key, fmt::format("{} is {}, expected [{} numbers]", at, shown(node), count));
        return false;
    }
    for (const toml::node& element : *array) {
        const auto value = element.is_number() ? element.value<double>() : std::nullopt;
        if (!value || !range.contains(*value)) {
            fault(key, fmt::format("{} has {}, expected {}", at, shown(element), range.text));
            return false;
        }
        values.push_back(*value);
    }
    return true;
}

std::vector<double> TomlReader::number_list(std::string_view key, const Range& range)
{
    const toml::node* node = table_.get(key);
    if (!node)
        return {};
    if (!node->is_array() || node->as_array()->empty()) {
        fault(key, fmt::format("is {}, expected [numbers]", shown(*node)));
        return {};
    }
    std::vector<double> values(node->as_array()->size());
    return numbers(key, range, values) ? values : std::vector<double>{};
}

std::vector<double> TomlReader::number_net(std::string_view key, const Range& range, std::size_t parts,
                                           std::size_t& columns)
{
    const toml::node* node = table_.get(key);
    if (!node)
        return {};
    const toml::array* rows = node->as_array();
    const toml::array* first = rows && !rows->empty() ? rows->get(0)->as_array() : nullptr;
    if (!first || first->empty()) {
        fault(key, fmt::format("is {}, expected an array of rows", shown(*node)));
        return {};
    }
    columns = first->size();
    std::vector<double> values;
    for (std::size_t r = 0; r < rows->size(); ++r) {
        const std::string at = fmt::format("row {}", r + 1);
        if (parts == 1) {
            if (!append_numbers(key, *rows->get(r), range, columns, at, values))
                return {};
            continue;
        }
        const toml::array* row = rows->get(r)->as_array();
        if (!row || row->size() != columns) {
            fault(key,
                  fmt::format("{} is {}, expected {} points like row 1", at, shown(*rows->get(r)), columns));
            return {};
        }
        for (std::size_t c = 0; c < columns; ++c)
            if (!append_numbers(key, *row->get(c), range, parts, fmt::format("{}, point {}", at, c + 1),
                                values))
                return {};
    }
    return values;
}

const toml::table* TomlReader::table(std::string_view key)
{
    const toml::node* node = table_.get(key);
    if (!node)
        return nullptr;
    if (!node->is_table())
        fault(key, fmt::format("is {}, expected a table", shown(*node)));
    return node->as_table();
}

} // namespace phantom::scene
