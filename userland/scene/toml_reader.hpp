// SPDX-License-Identifier: GPL-2.0-or-later
// One TOML table, read key by key: type, range and spelling are checked, and the fault nearest to the
// top of the file is kept with its line. Private to the scene unit: includes toml++.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "base/result.hpp"
#include "scene/ranges.hpp"

namespace phantom::scene {

/// Where faults of one file go; the one nearest to the top counts.
class Faults {
  public:
    explicit Faults(std::string file) : file_(std::move(file)) {}
    void add(const toml::source_region& at, std::string what);
    [[nodiscard]] const std::optional<Error>& first() const { return first_; }
    [[nodiscard]] std::string where(const toml::source_region& at) const;

  private:
    std::string file_;
    std::optional<Error> first_;
    std::uint32_t line_ = 0; ///< of first_
};

/// Errors: what load_bytes() says, or "file:line: is not TOML: why".
Result<toml::table> parse_toml(const std::filesystem::path& file);

/// A view of a table; every getter returns nullopt when the key is absent or at fault (then in Faults).
class TomlReader {
  public:
    /// `path` stands before keys in messages ("material.soft."), `keys` is every key that may be there.
    TomlReader(const toml::table& table, std::string path, std::initializer_list<std::string_view> keys,
               Faults& faults)
        : TomlReader(table, std::move(path), {keys.begin(), keys.size()}, {keys.begin(), keys.size()}, faults)
    {
    }
    /// `known` is every key that may be there, `expected` what a message names instead of another.
    TomlReader(const toml::table& table, std::string path, std::span<const std::string_view> known,
               std::span<const std::string_view> expected, Faults& faults);

    [[nodiscard]] bool has(std::string_view key) const { return table_.contains(key); }
    /// Line of the key's value, or of the table when the key is absent.
    [[nodiscard]] const toml::source_region& source(std::string_view key) const;

    std::optional<std::string> text(std::string_view key);
    /// One of the words.
    std::optional<std::string> word(std::string_view key, std::span<const std::string_view> words);
    std::optional<double> number(std::string_view key, const Range& range);
    std::optional<int> whole_number(std::string_view key, int low, int high);
    std::optional<bool> flag(std::string_view key);
    /// Exactly values.size() numbers; false when absent or at fault.
    bool numbers(std::string_view key, const Range& range, std::span<double> values);
    /// As many numbers as there are, at least one; empty when absent or at fault.
    std::vector<double> number_list(std::string_view key, const Range& range);
    /// An array of `rows` arrays of as many values each; a value is a number or, with `parts` above 1, an
    /// array of that many. Row by row, value by value; empty when absent or at fault. `columns` is what was
    /// found.
    std::vector<double> number_net(std::string_view key, const Range& range, std::size_t parts,
                                   std::size_t& columns);
    /// A sub-table, or nullptr.
    const toml::table* table(std::string_view key);

    /// "key: what"
    void fault(std::string_view key, const std::string& what);

  private:
    /// Appends the numbers of an array of `count`; `at` names it in messages ("number 3", "row 2").
    bool append_numbers(std::string_view key, const toml::node& node, const Range& range, std::size_t count,
                        const std::string& at, std::vector<double>& values);

    const toml::table& table_;
    std::string path_;
    Faults& faults_;
};

/// What stands there, for messages: "\"soft\"", "12", "a table".
std::string shown(const toml::node& node);

} // namespace phantom::scene
