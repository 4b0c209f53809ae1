// SPDX-License-Identifier: GPL-2.0-or-later
// A scene file as written: every key checked, nothing read but the TOML itself.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "scene/scene.hpp"

namespace phantom::scene {

enum class Shape { none, sphere, box };

struct ObjectEntry {
    std::string where; ///< "file:line" of the [[object]]
    std::string name;
    std::filesystem::path mesh; ///< as the file is to be opened; empty with a shape
    std::string mesh_where;     ///< "file:line" of the key mesh
    Shape shape = Shape::none;
    double sphere_radius_mm = 0;
    mesh::Vec3 box_size_mm{0, 0, 0};
    std::optional<std::string> unit;
    std::optional<double> fit_mm;
    fdh::Pose pose;
    bool two_sided = false;
    std::uint32_t material = 0;
};

struct SceneFile {
    std::optional<std::string> unit;
    std::vector<ObjectEntry> objects;
    std::vector<Material> materials; ///< at least one
    DeviceSettings device;
    ServoSettings servo;
};

/// Errors: "file:line: key: what was expected".
Result<SceneFile> read_scene_file(const std::filesystem::path& file);

} // namespace phantom::scene
