// SPDX-License-Identifier: GPL-2.0-or-later
// What a scene feels like while it is touched: materials and effects by name, changed by words.
//
//   MATERIAL                 stiffness_n_mm, damping_ns_m
//   MATERIAL.EFFECT          magnet, friction, texture, height_map, impact; texture.second is the other
//   grating NAME                     of an [effect.NAME]
//
// Keys, ranges and what belongs together are those of scene files (effect_parameters.hpp).
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/result.hpp"
#include "scene/scene.hpp"

namespace phantom::scene {

class EffectBook {
  public:
    explicit EffectBook(const Scene& scene);

    struct Value {
        std::string key;
        std::vector<double> numbers; ///< one, or three
        std::string word;            ///< instead of numbers
    };
    struct Entry {
        std::string name;
        std::string kind; ///< "material", "magnet", ..., "constant", ...
        bool on = true;
        std::vector<Value> values; ///< what is given or has a default of its own
    };
    /// Of materials that some object has, and of space.
    [[nodiscard]] std::vector<Entry> list() const;
    /// Errors: the names there are.
    [[nodiscard]] Result<Entry> entry(const std::string& name) const;

    using Words = std::vector<std::pair<std::string, std::string>>; ///< key, value: "0.3" or "0,0,-1"
    /// What is not named stays. An effect that a material has not yet, or that is off, comes on. Errors:
    /// name, key and what was expected; nothing is changed then.
    Status change(const std::string& name, const Words& words);
    /// Off it costs nothing; its values are kept for on.
    Status turn(const std::string& name, bool on);

    /// What is on.
    [[nodiscard]] std::vector<Material> materials() const;
    [[nodiscard]] std::vector<SpaceEffect> effects() const;

  private:
    /// Index of the material that the name begins with, and its effect ("friction", or empty).
    [[nodiscard]] std::optional<std::pair<std::size_t, std::string>> surface(const std::string& name) const;
    [[nodiscard]] Error unknown(const std::string& name) const;
    Status change_surface(Material& material, const std::string& effect, const std::string& name,
                          const Words& words);
    Status change_space(SpaceEffect& effect, const Words& words);

    std::vector<Material> materials_; ///< on or off
    std::vector<bool> used_;          ///< of materials_
    std::vector<SpaceEffect> effects_;
    std::set<std::string> off_; ///< names
};

} // namespace phantom::scene
