// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/effect_book.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene/effect_parameters.hpp"

namespace phantom::scene {

namespace {

using Words = EffectBook::Words;
using Load = std::function<Status(const std::filesystem::path&)>;

/// What is given, for a list.
class Listed : public Parameters {
  public:
    void number(std::string_view key, double& value, const Range&, Need) override
    {
        values.push_back({std::string(key), {value}, {}});
    }
    void number(std::string_view key, std::optional<double>& value, const Range&) override
    {
        if (value)
            values.push_back({std::string(key), {*value}, {}});
    }
    void vector(std::string_view key, std::array<double, 3>& value, const Range&, Need) override
    {
        values.push_back({std::string(key), {value.begin(), value.end()}, {}});
    }
    void direction(std::string_view key, std::array<double, 3>& value, Need) override
    {
        if (value != std::array<double, 3>{})
            values.push_back({std::string(key), {value.begin(), value.end()}, {}});
    }
    void word(std::string_view key, std::size_t& value, std::span<const std::string_view> words) override
    {
        values.push_back({std::string(key), {}, std::string(words[value])});
    }

    void file(std::string_view key, std::string& name, const Load&) override
    {
        values.push_back({std::string(key), {}, name});
    }

    std::vector<EffectBook::Value> values;
};

/// Changed by words; the first fault is kept.
class Changed : public Parameters {
  public:
    /// fresh: what is required must be there.
    Changed(const Words& words, bool fresh) : words_(words), fresh_(fresh) {}

    void number(std::string_view key, double& value, const Range& range, Need need) override
    {
        if (need == Need::fixed)
            return stays(key);
        take(key, {&value, 1}, range, need, range.text);
    }
    void number(std::string_view key, std::optional<double>& value, const Range& range) override
    {
        double given = 0;
        if (take(key, {&given, 1}, range, Need::optional, range.text))
            value = given;
    }
    void vector(std::string_view key, std::array<double, 3>& value, const Range& range, Need need) override
    {
        take(key, value, range, need, fmt::format("x,y,z, each {}", range.text));
    }
    void direction(std::string_view key, std::array<double, 3>& value, Need need) override
    {
        std::array<double, 3> given{};
        if (!take(key, given, range::position_mm, need, "x,y,z"))
            return;
        const double length = std::hypot(given[0], given[1], given[2]);
        if (!(length > 0))
            return add(key, "has no length, expected a direction");
        for (std::size_t axis = 0; axis < 3; ++axis)
            value[axis] = given[axis] / length;
    }
    void word(std::string_view key, std::size_t&, std::span<const std::string_view>) override { stays(key); }
    void file(std::string_view key, std::string&, const Load&) override
    {
        stays(key);
        if (fresh_)
            add(key, "is a file, expected in the scene's own");
    }

    void add(std::string_view key, const std::string& what)
    {
        if (!fault_)
            fault_ = fmt::format("{}: {}", key, what);
    }
    /// The first fault, and else a word that no parameter has asked for.
    [[nodiscard]] std::optional<std::string> fault() const
    {
        for (const auto& [key, value] : words_)
            if (!fault_ && std::find(keys_.begin(), keys_.end(), key) == keys_.end())
                return fmt::format("{}: unknown key, expected {}", key, fmt::join(keys_, ", "));
        return fault_;
    }

  private:
    void stays(std::string_view key)
    {
        if (find(key))
            add(key, "stays as the scene has it");
    }

    const std::string* find(std::string_view key)
    {
        keys_.emplace_back(key);
        for (const auto& [name, value] : words_)
            if (name == key)
                return &value;
        return nullptr;
    }

    /// Numbers between commas, exactly values.size(). False: none given, or at fault.
    bool take(std::string_view key, std::span<double> values, const Range& range, Need need,
              std::string_view expected)
    {
        const std::string* text = find(key);
        if (!text) {
            if (fresh_ && need == Need::required)
                add(key, fmt::format("is missing, expected {}", expected));
            return false;
        }
        const char* at = text->data();
        const char* const end = at + text->size();
        bool sound = true;
        for (std::size_t i = 0; i < values.size() && sound; ++i) {
            const auto [after, error] = std::from_chars(at, end, values[i]);
            const bool last = i + 1 == values.size();
            // contains() is false for NaN.
            sound = error == std::errc() && range.contains(values[i]) &&
                    (last ? after == end : after != end && *after == ',');
            at = after + (last ? 0 : 1);
        }
        if (!sound)
            add(key, fmt::format("is {}, expected {}", *text, expected));
        return sound;
    }

    const Words& words_;
    bool fresh_;
    std::vector<std::string> keys_;
    std::optional<std::string> fault_;
};

/// The effect with the words taken in; Errors: "effect NAME: key: ...".
template <class Effect, class Check>
Result<Effect> changed(const std::string& name, Effect effect, bool fresh, const Words& words, Check&& check)
{
    Changed from(words, fresh);
    parameters(effect, from);
    if (!from.fault())
        if (const auto wrong = check(effect))
            from.add(wrong->key, wrong->what);
    if (const auto fault = from.fault())
        return Error{"effect " + name, *fault};
    return effect;
}

template <class Effect, class Check>
Status change_slot(const std::string& name, std::optional<Effect>& slot, const Words& words, Check&& check)
{
    Result<Effect> effect = changed(name, slot.value_or(Effect{}), !slot, words, check);
    if (!effect)
        return effect.error();
    slot = std::move(*effect);
    return success();
}

constexpr auto nothing = [](const auto&) { return std::optional<Contradiction>(); };

constexpr std::array<std::string_view, 6> surface_effects = {"magnet",         "friction",   "texture",
                                                             "texture.second", "height_map", "impact"};

/// Calls with each of a material's effects that there are, by name.
template <class Material_, class Call>
void for_each_effect(Material_& material, Call&& call)
{
    if (material.magnet)
        call("magnet", *material.magnet);
    if (material.friction)
        call("friction", *material.friction);
    if (material.texture) {
        call("texture", material.texture->first);
        if (material.texture->second)
            call("texture.second", *material.texture->second);
    }
    if (material.height_map)
        call("height_map", *material.height_map);
    if (material.impact)
        call("impact", *material.impact);
}

template <class Effect>
EffectBook::Entry entry_of(std::string name, std::string kind, bool on, Effect effect)
{
    Listed list;
    parameters(effect, list);
    return {std::move(name), std::move(kind), on, std::move(list.values)};
}

} // namespace

EffectBook::EffectBook(const Scene& scene)
    : materials_(scene.materials), used_(scene.materials.size()), effects_(scene.effects)
{
    for (std::uint32_t i = 0; i < used_.size(); ++i)
        used_[i] = scene.uses(i);
}

std::vector<EffectBook::Entry> EffectBook::list() const
{
    std::vector<Entry> out;
    for (std::size_t i = 0; i < materials_.size(); ++i) {
        if (!used_[i])
            continue;
        out.push_back(entry_of(materials_[i].name, "material", true, materials_[i]));
        for_each_effect(materials_[i], [&](const char* effect, const auto& values) {
            const std::string name = materials_[i].name + "." + effect;
            out.push_back(entry_of(name, effect, !off_.contains(name), values));
        });
    }
    for (const SpaceEffect& effect : effects_)
        std::visit(
            [&](const auto& law) {
                out.push_back(entry_of(effect.name, effect.kind(), !off_.contains(effect.name), law));
            },
            effect.law);
    return out;
}

Result<EffectBook::Entry> EffectBook::entry(const std::string& name) const
{
    for (Entry& entry : list())
        if (entry.name == name)
            return std::move(entry);
    return unknown(name);
}

Error EffectBook::unknown(const std::string& name) const
{
    std::vector<std::string> names;
    for (const Entry& entry : list())
        names.push_back(entry.name);
    return {"effect " + name, fmt::format("there is none, expected {}", fmt::join(names, ", "))};
}

std::optional<std::pair<std::size_t, std::string>> EffectBook::surface(const std::string& name) const
{
    for (std::size_t i = 0; i < materials_.size(); ++i) {
        const std::string& material = materials_[i].name;
        if (!used_[i] || !name.starts_with(material))
            continue;
        if (name.size() == material.size())
            return std::pair(i, std::string());
        const std::string effect = name[material.size()] == '.' ? name.substr(material.size() + 1) : "";
        if (std::find(surface_effects.begin(), surface_effects.end(), effect) != surface_effects.end())
            return std::pair(i, effect);
    }
    return std::nullopt;
}

Status EffectBook::change_surface(Material& material, const std::string& effect, const std::string& name,
                                  const Words& words)
{
    if (effect.empty()) {
        Result<Material> other = changed(name, material, false, words, nothing);
        if (other)
            material = std::move(*other);
        return other ? success() : Status(other.error());
    }
    if (effect == "magnet")
        return change_slot(name, material.magnet, words,
                           [&](const Magnet& magnet) { return contradiction(magnet, material); });
    if (effect == "friction")
        return change_slot(name, material.friction, words,
                           [](const Friction& friction) { return contradiction(friction); });
    if (effect == "height_map")
        return change_slot(name, material.height_map, words,
                           [](const HeightMap& map) { return contradiction(map); });
    if (effect == "impact")
        return change_slot(name, material.impact, words,
                           [](const Impact& impact) { return contradiction(impact); });
    const bool is_first = effect == "texture";
    if (!is_first && !material.texture)
        return Error{"effect " + name, fmt::format("{0}.texture is missing, expected it before its second "
                                                   "grating",
                                                   material.name)};
    Texture texture = material.texture.value_or(Texture{});
    std::optional<Grating> first = material.texture ? std::optional(texture.first) : std::nullopt;
    const Grating* beside = is_first ? (texture.second ? &*texture.second : nullptr) : &texture.first;
    if (Status status =
            change_slot(name, is_first ? first : texture.second, words,
                        [beside](const Grating& grating) { return contradiction(grating, beside); });
        !status)
        return status;
    texture.first = *first;
    material.texture = texture;
    return success();
}

Status EffectBook::change_space(SpaceEffect& effect, const Words& words)
{
    SpaceEffect other = effect;
    Status status = std::visit(
        [&](auto& law) -> Status {
            auto result =
                changed(effect.name, law, false, words, [](const auto& it) { return contradiction(it); });
            if (!result)
                return result.error();
            law = std::move(*result);
            return success();
        },
        other.law);
    if (!status)
        return status;
    std::vector<SpaceEffect> all = effects_;
    all[static_cast<std::size_t>(&effect - effects_.data())] = other;
    if (const auto wrong = contradiction(all))
        return Error{"effect " + effect.name, wrong->what};
    effect = std::move(other);
    return success();
}

Status EffectBook::change(const std::string& name, const Words& words)
{
    Status status = success();
    const auto of_space = std::find_if(effects_.begin(), effects_.end(),
                                       [&name](const SpaceEffect& effect) { return effect.name == name; });
    if (of_space != effects_.end()) {
        status = change_space(*of_space, words);
    } else if (const auto place = surface(name)) {
        status = change_surface(materials_[place->first], place->second, name, words);
    } else {
        return unknown(name);
    }
    if (status)
        off_.erase(name);
    return status;
}

Status EffectBook::turn(const std::string& name, bool on)
{
    const Result<Entry> is = entry(name);
    if (!is)
        return is.error();
    if (is->kind == "material")
        return Error{"effect " + name, "is a material, which is always on; its damping_ns_m = 0 is none"};
    if (on)
        off_.erase(name);
    else
        off_.insert(name);
    return success();
}

std::vector<Material> EffectBook::materials() const
{
    std::vector<Material> out = materials_;
    const auto is_off = [this](const Material& material, const char* effect) {
        return off_.contains(material.name + "." + effect);
    };
    for (Material& material : out) {
        if (is_off(material, "magnet"))
            material.magnet.reset();
        if (is_off(material, "friction"))
            material.friction.reset();
        if (material.texture && is_off(material, "texture.second"))
            material.texture->second.reset();
        if (is_off(material, "texture"))
            material.texture.reset();
        if (is_off(material, "height_map"))
            material.height_map.reset();
        if (is_off(material, "impact"))
            material.impact.reset();
    }
    return out;
}

std::vector<SpaceEffect> EffectBook::effects() const
{
    std::vector<SpaceEffect> out = effects_;
    std::erase_if(out, [this](const SpaceEffect& effect) { return off_.contains(effect.name); });
    return out;
}

} // namespace phantom::scene
