// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/effects_file.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene/effect_parameters.hpp"

namespace phantom::scene {

namespace {

/// The names alone.
class KeyList : public Parameters {
  public:
    void number(std::string_view key, double&, const Range&, Need) override { keys.push_back(key); }
    void number(std::string_view key, std::optional<double>&, const Range&) override { keys.push_back(key); }
    void vector(std::string_view key, std::array<double, 3>&, const Range&, Need) override
    {
        keys.push_back(key);
    }
    void direction(std::string_view key, std::array<double, 3>&, Need) override { keys.push_back(key); }
    void word(std::string_view key, std::size_t&, std::span<const std::string_view>) override
    {
        keys.push_back(key);
    }

    std::vector<std::string_view> keys;
};

template <class Effect>
std::vector<std::string_view> keys_of(const Effect& effect, std::vector<std::string_view> more = {})
{
    Effect any = effect;
    KeyList list;
    list.keys = std::move(more);
    parameters(any, list);
    return list.keys;
}

/// From a table; whatever is at fault is told, and counted.
class FileParameters : public Parameters {
  public:
    explicit FileParameters(TomlReader& reader) : reader_(reader) {}
    [[nodiscard]] bool sound() const { return sound_; }

    void number(std::string_view key, double& value, const Range& range, Need need) override
    {
        if (is_there(key, need, range.text))
            take(reader_.number(key, range), value);
    }
    void number(std::string_view key, std::optional<double>& value, const Range& range) override
    {
        if (is_there(key, Need::optional, range.text))
            take(reader_.number(key, range), value);
    }
    void vector(std::string_view key, std::array<double, 3>& value, const Range& range, Need need) override
    {
        if (is_there(key, need, fmt::format("[x, y, z], each {}", range.text)))
            sound_ = reader_.numbers(key, range, value) && sound_;
    }
    void direction(std::string_view key, std::array<double, 3>& value, Need need) override
    {
        std::array<double, 3> given{};
        if (!is_there(key, need, "[x, y, z]"))
            return;
        if (!reader_.numbers(key, range::position_mm, given)) {
            sound_ = false;
        } else if (const double length = std::hypot(given[0], given[1], given[2]); length > 0) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                value[axis] = given[axis] / length;
        } else {
            reader_.fault(key, "has no length, expected a direction");
            sound_ = false;
        }
    }
    void word(std::string_view key, std::size_t& value, std::span<const std::string_view> words) override
    {
        if (!is_there(key, Need::required, fmt::format("\"{}\"", fmt::join(words, "\" or \""))))
            return;
        if (const auto given = reader_.word(key, words))
            value = static_cast<std::size_t>(std::find(words.begin(), words.end(), *given) - words.begin());
        else
            sound_ = false;
    }

  private:
    bool is_there(std::string_view key, Need need, std::string_view expected)
    {
        if (reader_.has(key))
            return true;
        if (need == Need::required) {
            reader_.fault(key, fmt::format("is missing, expected {}", expected));
            sound_ = false;
        }
        return false;
    }
    template <class Value>
    void take(const std::optional<double>& given, Value& value)
    {
        if (given)
            value = *given;
        else
            sound_ = false;
    }

    TomlReader& reader_;
    bool sound_ = true;
};

/// An effect's table, but for what `more` names. `check` is asked only if each parameter is sound by itself.
template <class Effect, class Check>
Effect read_effect(const toml::table& table, const std::string& path, Faults& faults,
                   std::vector<std::string_view> more, Effect effect, Check&& check)
{
    const auto keys = keys_of(effect, std::move(more));
    TomlReader reader(table, path, keys, keys, faults);
    FileParameters from(reader);
    parameters(effect, from);
    if (const auto wrong = from.sound() ? check(effect) : std::nullopt)
        reader.fault(wrong->key, wrong->what);
    return effect;
}

template <class Effect>
Effect read_effect(const toml::table& table, const std::string& path, Faults& faults,
                   std::vector<std::string_view> more = {})
{
    return read_effect(table, path, faults, std::move(more), Effect{},
                       [](const Effect& effect) { return contradiction(effect); });
}

Texture read_texture(const toml::table& table, const std::string& path, Faults& faults)
{
    Texture out;
    out.first = read_effect(table, path, faults, {"second"}, Grating{},
                            [](const Grating& grating) { return contradiction(grating, nullptr); });
    const toml::node* second = table.get("second");
    if (second && !second->is_table())
        faults.add(second->source(),
                   fmt::format("{}second: is {}, expected a table: another grating", path, shown(*second)));
    else if (second)
        out.second =
            read_effect(*second->as_table(), path + "second.", faults, {}, Grating{},
                        [&out](const Grating& grating) { return contradiction(grating, &out.first); });
    return out;
}

/// Without a kind that is known, nothing else can be looked at.
SpaceEffect read_space_effect(const std::string& name, const toml::table& table, Faults& faults)
{
    const std::string path = "effect." + name + ".";
    const auto kind = table["kind"].value_or(std::string_view());
    if (std::find(space_kinds.begin(), space_kinds.end(), kind) == space_kinds.end()) {
        const auto what = table.contains("kind") ? "is " + shown(*table.get("kind")) : "is missing";
        const toml::node& at = table.contains("kind") ? *table.get("kind") : table;
        faults.add(at.source(), fmt::format("{}kind: {}, expected \"{}\"", path, what,
                                            fmt::join(space_kinds, "\" or \"")));
        return make_space_effect(name, space_kinds.front());
    }
    SpaceEffect out = make_space_effect(name, kind);
    std::visit(
        [&](auto& law) { law = read_effect<std::decay_t<decltype(law)>>(table, path, faults, {"kind"}); },
        out.law);
    return out;
}

} // namespace

void read_surface_effects(TomlReader& reader, const std::string& path, Faults& faults, Material& material)
{
    if (const toml::table* table = reader.table("magnet"))
        material.magnet =
            read_effect(*table, path + "magnet.", faults, {}, Magnet{},
                        [&material](const Magnet& magnet) { return contradiction(magnet, material); });
    if (const toml::table* table = reader.table("friction"))
        material.friction = read_effect<Friction>(*table, path + "friction.", faults);
    if (const toml::table* table = reader.table("texture"))
        material.texture = read_texture(*table, path + "texture.", faults);
}

void read_space_effects(const toml::table& effects, Faults& faults, const std::vector<Material>& materials,
                        std::vector<SpaceEffect>& out)
{
    for (const auto& [key, value] : effects) {
        const std::string name(key.str());
        const auto fault = [&faults, &name, at = value.source()](const std::string& what) {
            faults.add(at, fmt::format("effect.{}: {}", name, what));
        };
        const toml::table* table = value.as_table();
        if (!table) {
            fault(fmt::format("is {}, expected a table [effect.NAME]", shown(value)));
            continue;
        }
        if (std::any_of(materials.begin(), materials.end(),
                        [&name](const Material& material) { return material.name == name; }))
            fault("is the name of a material, expected another");
        out.push_back(read_space_effect(name, *table, faults));
        if (const auto wrong = contradiction(out)) {
            fault(wrong->what);
            out.pop_back();
        }
    }
}

} // namespace phantom::scene
