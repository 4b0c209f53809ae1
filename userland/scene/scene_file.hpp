// SPDX-License-Identifier: GPL-2.0-or-later
// A scene file as written: every key checked, nothing read but the TOML itself.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "scene/scene.hpp"
#include "scene/shapes/shape.hpp"

namespace phantom::scene {

/// `materials = { GROUP = "NAME" }` of an object.
struct GroupMaterial {
    std::string group;
    std::uint32_t material = 0;
    std::string where; ///< "file:line" of it
};

struct ObjectEntry {
    std::string where; ///< "file:line" of the [[object]]
    std::string name;
    std::filesystem::path mesh; ///< as the file is to be opened; empty with a shape
    std::string mesh_where;     ///< "file:line" of the key mesh
    std::optional<Shape> shape;
    std::optional<double> chord_mm;                              ///< of a shape
    std::map<std::string, std::string, std::less<>> shape_where; ///< "file:line" of the shape's keys
    std::optional<std::string> unit;
    std::optional<double> fit_mm, weld_mm;
    fdh::Pose pose;
    bool two_sided = false;
    std::uint32_t material = 0;
    std::optional<Motion> motion;
    std::optional<Deformation> deformation;
    std::string deform_where;         ///< "file:line" of the key deform
    std::optional<double> split_mm{}; ///< edges longer than this are bisected
    /// Of faces of a group other than `material`, as the file writes it.
    std::vector<GroupMaterial> group_materials;
};

struct SceneFile {
    std::optional<std::string> unit;
    std::vector<ObjectEntry> objects;
    std::vector<Material> materials; ///< at least one
    std::vector<SpaceEffect> effects;
    DeviceSettings device;
    ServoSettings servo;
    std::optional<bool> levels; ///< nothing: as the program likes
};

/// Errors: "file:line: key: what was expected".
Result<SceneFile> read_scene_file(const std::filesystem::path& file);

} // namespace phantom::scene
