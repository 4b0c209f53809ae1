// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/toml_reader.hpp"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

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
        else if constexpr (toml::is_value<decltype(value)>)
            text << value;
    });
    return text.str();
}

TomlReader::TomlReader(const toml::table& table, std::string path,
                       std::initializer_list<std::string_view> keys, Faults& faults)
    : table_(table), path_(std::move(path)), faults_(faults)
{
    for (const auto& [key, value] : table) {
        if (std::find(keys.begin(), keys.end(), key.str()) == keys.end())
            faults_.add(key.source(), fmt::format("{}{}: unknown key, expected {}", path_, key.str(),
                                                  fmt::join(keys, ", ")));
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
