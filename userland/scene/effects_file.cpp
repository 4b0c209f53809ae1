// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/effects_file.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene/effect_parameters.hpp"

namespace phantom::scene {

namespace {

using Load = std::function<Status(const std::filesystem::path&)>;

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
    void file(std::string_view key, std::string&, const Load&) override { keys.push_back(key); }

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
    FileParameters(TomlReader& reader, const std::filesystem::path& scene) : reader_(reader), scene_(scene) {}
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

    void file(std::string_view key, std::string& name, const Load& load) override
    {
        if (!is_there(key, Need::required, "a file"))
            return;
        const auto given = reader_.text(key);
        if (given)
            name = *given;
        const Status status = given ? load(scene_.parent_path() / *given) : success();
        if (!status)
            reader_.fault(key, status.error().text());
        sound_ = sound_ && given && status;
    }

  private:
    bool is_there(std::string_view key, Need need, std::string_view expected)
    {
        if (reader_.has(key))
            return true;
        if (need != Need::optional) {
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
    const std::filesystem::path& scene_;
    bool sound_ = true;
};

/// A table of a scene file, and what messages call it.
struct Place {
    const toml::table& table;
    std::string path;
    const std::filesystem::path& scene;
    Faults& faults;
};

/// An effect's table, but for what `more` names. `check` is asked only if each parameter is sound by itself.
template <class Effect, class Check>
Effect read_effect(const Place& at, std::vector<std::string_view> more, Effect effect, Check&& check)
{
    const auto keys = keys_of(effect, std::move(more));
    TomlReader reader(at.table, at.path, keys, keys, at.faults);
    FileParameters from(reader, at.scene);
    parameters(effect, from);
    if (const auto wrong = from.sound() ? check(effect) : std::nullopt)
        reader.fault(wrong->key, wrong->what);
    return effect;
}

template <class Effect>
Effect read_effect(const Place& at, std::vector<std::string_view> more = {})
{
    return read_effect(at, std::move(more), Effect{},
                       [](const Effect& effect) { return contradiction(effect); });
}

Texture read_texture(const Place& at)
{
    Texture out;
    out.first = read_effect(at, {"second"}, Grating{},
                            [](const Grating& grating) { return contradiction(grating, nullptr); });
    const toml::node* second = at.table.get("second");
    if (second && !second->is_table())
        at.faults.add(second->source(), fmt::format("{}second: is {}, expected a table: another grating",
                                                    at.path, shown(*second)));
    else if (second)
        out.second =
            read_effect(Place{*second->as_table(), at.path + "second.", at.scene, at.faults}, {}, Grating{},
                        [&out](const Grating& grating) { return contradiction(grating, &out.first); });
    return out;
}

/// Without a kind that is known, nothing else can be looked at.
SpaceEffect read_space_effect(const std::string& name, const Place& at)
{
    const toml::table& table = at.table;
    const auto kind = table["kind"].value_or(std::string_view());
    if (std::find(space_kinds.begin(), space_kinds.end(), kind) == space_kinds.end()) {
        const auto what = table.contains("kind") ? "is " + shown(*table.get("kind")) : "is missing";
        const toml::node& node = table.contains("kind") ? *table.get("kind") : table;
        at.faults.add(node.source(), fmt::format("{}kind: {}, expected \"{}\"", at.path, what,
                                                 fmt::join(space_kinds, "\" or \"")));
        return make_space_effect(name, space_kinds.front());
    }
    SpaceEffect out = make_space_effect(name, kind);
    std::visit([&at](auto& law) { law = read_effect<std::decay_t<decltype(law)>>(at, {"kind"}); }, out.law);
    return out;
}

} // namespace

void read_surface_effects(TomlReader& reader, const std::string& path, const std::filesystem::path& scene,
                          Faults& faults, Material& material)
{
    const auto place = [&](const char* effect) -> std::optional<Place> {
        const toml::table* table = reader.table(effect);
        if (!table)
            return std::nullopt;
        return Place{*table, path + effect + ".", scene, faults};
    };
    if (const auto at = place("magnet"))
        material.magnet = read_effect(
            *at, {}, Magnet{}, [&material](const Magnet& magnet) { return contradiction(magnet, material); });
    if (const auto at = place("friction"))
        material.friction = read_effect<Friction>(*at);
    if (const auto at = place("texture"))
        material.texture = read_texture(*at);
    if (const auto at = place("height_map"))
        material.height_map = read_effect<HeightMap>(*at);
    if (const auto at = place("impact"))
        material.impact = read_effect<Impact>(*at);
}

void read_space_effects(const toml::table& effects, const std::filesystem::path& scene, Faults& faults,
                        const std::vector<Material>& materials, std::vector<SpaceEffect>& out)
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
        out.push_back(read_space_effect(name, {*table, "effect." + name + ".", scene, faults}));
        if (const auto wrong = contradiction(out)) {
            fault(wrong->what);
            out.pop_back();
        }
    }
}

} // namespace phantom::scene
