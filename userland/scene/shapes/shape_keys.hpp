// SPDX-License-Identifier: GPL-2.0-or-later
// The keys of an [[object]] that describe a shape.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

#include "scene/shapes/shape.hpp"
#include "scene/toml_reader.hpp"

namespace phantom::scene {

/// Every word that `shape` may be.
std::span<const std::string_view> shape_words();
/// Every key that belongs to some shape, but for `shape` itself.
std::span<const std::string_view> shape_keys();
/// Those of one shape; none for a word that is no shape.
std::span<const std::string_view> shape_keys(std::string_view word);

struct ShapeEntry {
    Shape shape;
    bool open = false; ///< may have a rim, so that two_sided has a meaning
};

/// Reads `shape` and the keys that it takes; a relative file starts at the folder of the scene. Faults: a key
/// that is missing, out of range, or of another shape. Nothing when there was one.
std::optional<ShapeEntry> read_shape(TomlReader& object, const std::filesystem::path& scene);

} // namespace phantom::scene
