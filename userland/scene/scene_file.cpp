// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/scene_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "mesh/read.hpp"
#include "mesh/vector.hpp"
#include "scene/device_file.hpp"
#include "scene/effect_parameters.hpp"
#include "scene/effects_file.hpp"
#include "scene/motion_file.hpp"
#include "scene/shapes/shape_keys.hpp"
#include "scene/toml_reader.hpp"
#include "scene/units.hpp"

namespace phantom::scene {

namespace {

constexpr std::array<std::string_view, 5> unit_words = {"um", "mm", "cm", "m", "in"};
constexpr std::array<std::string_view, 3> model_words = {"paper", "projected", "off"};
constexpr std::array<std::string_view, 2> combine_words = {"paper", "bounded"};
constexpr std::array<std::string_view, 3> proxy_words = {"paper", "constrained", "off"};
constexpr std::array<std::string_view, 3> arith_words = {"float", "fixed", "double"};
constexpr std::array<std::string_view, 2> level_words = {"auto", "off"};
constexpr int newton_steps_max = 3; ///< PHANTOM_NEWTON_STEPS_MAX

/// Rotation by an angle about a unit axis (Rodrigues), row-major.
std::array<double, 9> rotation_about(const mesh::Vec3& u, double angle)
{
    const double c = std::cos(angle), s = std::sin(angle), d = 1.0 - c;
    return {c + u[0] * u[0] * d,        u[0] * u[1] * d - u[2] * s, u[0] * u[2] * d + u[1] * s,
            u[1] * u[0] * d + u[2] * s, c + u[1] * u[1] * d,        u[1] * u[2] * d - u[0] * s,
            u[2] * u[0] * d - u[1] * s, u[2] * u[1] * d + u[0] * s, c + u[2] * u[2] * d};
}

void read_axis_angle(TomlReader& pose, fdh::Pose& out)
{
    mesh::Vec3 axis{};
    const bool has_axis = pose.numbers("axis", range::position_mm, axis);
    const auto angle = pose.number("angle_deg", range::angle_deg);
    if (pose.has("axis") != pose.has("angle_deg"))
        pose.fault(pose.has("axis") ? "axis" : "angle_deg",
                   "axis and angle_deg belong together, one is missing");
    if (!has_axis || !angle)
        return;
    const mesh::Vec3 unit = mesh::normalized(axis);
    if (mesh::dot(unit, unit) == 0)
        pose.fault("axis", "is zero, expected a direction");
    out.rotation = rotation_about(unit, *angle * std::numbers::pi / 180.0);
}

void read_quaternion(TomlReader& pose, fdh::Pose& out)
{
    std::array<double, 4> q{};
    if (!pose.numbers("quaternion", {-1.01, 1.01, "a part of a unit quaternion"}, q))
        return;
    const double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    // Written with three digits it is still a rotation; farther off it is a mistake.
    if (std::abs(size - 1.0) > 0.01)
        pose.fault("quaternion", fmt::format("has the length {:g}, expected [w, x, y, z] of length 1", size));
    for (double& part : q)
        part /= size;
    out.rotation = rotation_of(q);
}

fdh::Pose read_pose(const toml::table& table, const std::string& path, Faults& faults)
{
    TomlReader pose(table, path, {"translation_mm", "axis", "angle_deg", "quaternion"}, faults);
    fdh::Pose out;
    pose.numbers("translation_mm", range::position_mm, out.translation);
    if (pose.has("quaternion") && (pose.has("axis") || pose.has("angle_deg")))
        pose.fault("quaternion", "stands beside axis and angle_deg, expected one of the two");
    else if (pose.has("quaternion"))
        read_quaternion(pose, out);
    else
        read_axis_angle(pose, out);
    return out;
}

using Keys = std::vector<std::string_view>;

Keys joined(std::initializer_list<std::string_view> keys, std::span<const std::string_view> more)
{
    Keys all(keys);
    all.insert(all.end(), more.begin(), more.end());
    return all;
}

/// Every key that some [[object]] may have, and what this one may.
struct ObjectKeys {
    Keys known, expected;

    explicit ObjectKeys(const toml::table& object)
        : known(joined({"name", "mesh", "shape", "unit", "fit_mm", "weld_mm", "split_mm", "two_sided", "pose",
                        "material", "materials", "motion", "deform"},
                       shape_keys()))
    {
        const auto own = shape_keys(object["shape"].value_or(std::string_view()));
        expected =
            own.empty()
                ? Keys{"name",      "mesh", "shape",    "unit",      "fit_mm", "weld_mm", "split_mm",
                       "two_sided", "pose", "material", "materials", "motion", "deform"}
                : joined({"name", "shape", "split_mm", "pose", "material", "two_sided", "motion", "deform"},
                         own);
    }
};

/// A key that has no meaning beside another.
void refuse_beside(TomlReader& object, std::string_view key, std::string_view other)
{
    if (object.has(key))
        object.fault(key, fmt::format("has no meaning with {}", other));
}

void read_shape_object(TomlReader& object, const std::filesystem::path& scene, Faults& faults,
                       ObjectEntry& out)
{
    refuse_beside(object, "unit", "shape: sizes are in mm");
    refuse_beside(object, "fit_mm", "shape: sizes are in mm");
    refuse_beside(object, "weld_mm", "shape: it is welded");
    refuse_beside(object, "materials", "shape: it has no groups of faces");
    auto entry = read_shape(object, scene);
    if (!entry)
        return;
    if (!entry->open)
        refuse_beside(object, "two_sided", "shape: it is closed");
    out.shape = std::move(entry->shape);
    out.two_sided = object.flag("two_sided").value_or(false);
    out.chord_mm = object.number("chord_mm", range::chord_mm);
    for (const std::string_view key : shape_keys())
        out.shape_where.emplace(key, faults.where(object.source(object.has(key) ? key : "shape")));
}

void read_mesh(TomlReader& object, const std::filesystem::path& scene, Faults& faults, ObjectEntry& out)
{
    const auto mesh = object.text("mesh");
    if (!mesh)
        return;
    out.mesh = scene.parent_path() / *mesh;
    out.mesh_where = faults.where(object.source("mesh"));
    if (!std::filesystem::exists(out.mesh))
        object.fault("mesh", "no such file: " + out.mesh.string());
    else if (!mesh::is_mesh_file(out.mesh))
        object.fault("mesh", fmt::format("is \"{}\", expected a file {}", *mesh, mesh::mesh_extensions));
    out.unit = object.word("unit", unit_words);
    out.fit_mm = object.number("fit_mm", range::length_mm);
    out.weld_mm = object.number("weld_mm", range::length_mm);
    out.two_sided = object.flag("two_sided").value_or(false);
    for (const std::string_view key : shape_keys())
        refuse_beside(object, key, "mesh");
}

/// One [[object]], but for its material.
ObjectEntry read_object(TomlReader& object, const std::string& path, const std::filesystem::path& scene,
                        Faults& faults)
{
    ObjectEntry out;
    if (object.has("mesh") == object.has("shape"))
        object.fault(object.has("mesh") ? "shape" : "mesh",
                     object.has("mesh")
                         ? "stands beside mesh, expected one of the two"
                         : fmt::format("is missing, expected mesh = \"FILE\" or shape = \"{}\"",
                                       fmt::join(shape_words(), "\" or \"")));
    else if (object.has("mesh"))
        read_mesh(object, scene, faults, out);
    else
        read_shape_object(object, scene, faults, out);
    out.name = object.text("name").value_or(
        object.has("shape") ? object.word("shape", shape_words()).value_or("") : out.mesh.stem().string());
    if (const toml::table* pose = object.table("pose"))
        out.pose = read_pose(*pose, path + "pose.", faults);
    out.split_mm = object.number("split_mm", range::length_mm);
    out.motion = read_motion(object, path, out.pose.translation, faults);
    out.deformation = read_deformation(object, path, faults);
    if (out.deformation)
        out.deform_where = faults.where(object.source("deform"));
    return out;
}

Material read_material(const std::string& name, const toml::table& table, const std::filesystem::path& scene,
                       Faults& faults)
{
    const std::string path = "material." + name + ".";
    TomlReader reader(table, path,
                      {"stiffness_n_mm", "radius_mm", "damping_ns_m", "magnet", "friction", "texture",
                       "height_map", "impact"},
                      faults);
    Material material;
    material.name = name;
    material.stiffness_n_mm =
        reader.number("stiffness_n_mm", range::stiffness_n_mm).value_or(material.stiffness_n_mm);
    material.radius_mm = reader.number("radius_mm", range::radius_mm).value_or(material.radius_mm);
    material.damping_ns_m = reader.number("damping_ns_m", range::damping_ns_m);
    read_surface_effects(reader, path, scene, faults, material);
    return material;
}

void read_materials(TomlReader& root, const std::filesystem::path& scene, Faults& faults, SceneFile& out)
{
    const toml::table* materials = root.table("material");
    if (!materials)
        return;
    std::size_t samples = 0;
    for (const auto& [key, value] : *materials) {
        const std::string name(key.str());
        const toml::table* table = value.as_table();
        if (!table) {
            faults.add(value.source(), fmt::format("material.{}: is {}, expected a table [material.NAME]",
                                                   name, shown(value)));
            continue;
        }
        out.materials.push_back(read_material(name, *table, scene, faults));
        if (const auto& map = out.materials.back().height_map)
            samples += map->samples.samples.size();
        if (samples > map_samples_max)
            faults.add(value.source(), fmt::format("material.{}.height_map: all height maps together have {} "
                                                   "samples, expected at most {}",
                                                   name, samples, map_samples_max));
    }
}

/// Index of the named material, or nothing.
std::optional<std::uint32_t> find_material(const std::string& name, const SceneFile& scene)
{
    const auto found = std::find_if(scene.materials.begin(), scene.materials.end(),
                                    [&name](const Material& material) { return material.name == name; });
    if (found == scene.materials.end())
        return std::nullopt;
    return static_cast<std::uint32_t>(found - scene.materials.begin());
}

/// The key materials: of groups of faces. What groups there are only the mesh knows.
void read_group_materials(TomlReader& object, const std::string& path, Faults& faults, const SceneFile& scene,
                          ObjectEntry& out)
{
    const toml::table* table = object.table("materials");
    if (!table)
        return;
    for (const auto& [key, value] : *table) {
        const std::string group(key.str());
        const std::string at = fmt::format("{}materials.{}: ", path, group);
        const auto name = value.value<std::string>();
        const auto material = name ? find_material(*name, scene) : std::nullopt;
        if (!name || !value.is_string())
            faults.add(value.source(),
                       at + fmt::format("is {}, expected the name of a [material.NAME]", shown(value)));
        else if (!material)
            faults.add(value.source(), at + fmt::format("no [material.{}] in this file", *name));
        else
            out.group_materials.push_back({group, *material, faults.where(value.source())});
    }
}

/// Index of the named material; the default one is made when it is first needed.
std::uint32_t material_index(TomlReader& object, SceneFile& out)
{
    const auto wanted = object.text("material");
    const std::string name = wanted.value_or("default");
    if (const auto found = find_material(name, out))
        return *found;
    if (wanted) {
        object.fault("material", fmt::format("no [material.{}] in this file", name));
        return 0;
    }
    out.materials.emplace_back();
    return static_cast<std::uint32_t>(out.materials.size() - 1);
}

void read_objects(TomlReader& root, const toml::table& table, const std::filesystem::path& scene,
                  Faults& faults, SceneFile& out)
{
    const toml::array* objects = table["object"].as_array();
    if (!objects || objects->empty()) {
        root.fault("object", "expected at least one [[object]]");
        return;
    }
    for (std::size_t i = 0; i < objects->size(); ++i) {
        const std::string path = fmt::format("object {}: ", i + 1);
        const toml::table* entry = objects->get(i)->as_table();
        if (!entry) {
            faults.add(objects->get(i)->source(), path + "expected a table [[object]]");
            return;
        }
        const ObjectKeys keys(*entry);
        TomlReader reader(*entry, path, keys.known, keys.expected, faults);
        ObjectEntry object = read_object(reader, path, scene, faults);
        object.where = faults.where(entry->source());
        object.material = material_index(reader, out);
        read_group_materials(reader, path, faults, out, object);
        for (const ObjectEntry& other : out.objects) {
            if (other.name == object.name)
                reader.fault("name", fmt::format("\"{}\" is taken by the object at {}, expected another name",
                                                 object.name, other.where));
        }
        out.objects.push_back(std::move(object));
    }
}

void read_servo(const toml::table& table, Faults& faults, ServoSettings& out)
{
    TomlReader servo(table, "servo.",
                     {"rate_hz", "model", "combine", "proxy", "arith", "steps", "crossfade_ms"}, faults);
    out.rate_hz = servo.number("rate_hz", range::rate_hz);
    out.model = servo.word("model", model_words);
    out.combine = servo.word("combine", combine_words);
    out.proxy = servo.word("proxy", proxy_words);
    out.arith = servo.word("arith", arith_words);
    out.steps = servo.whole_number("steps", 0, newton_steps_max);
    out.crossfade_ms = servo.number("crossfade_ms", range::crossfade_ms);
}

} // namespace

Result<SceneFile> read_scene_file(const std::filesystem::path& file)
{
    const auto table = parse_toml(file);
    if (!table)
        return table.error();
    Faults faults(file.string());
    SceneFile out;
    TomlReader root(*table, "", {"unit", "levels", "object", "material", "effect", "device", "servo"},
                    faults);
    out.unit = root.word("unit", unit_words);
    if (const auto word = root.word("levels", level_words))
        out.levels = *word == "auto";
    read_materials(root, file, faults, out);
    read_objects(root, *table, file, faults, out);
    if (const toml::table* effects = root.table("effect"))
        read_space_effects(*effects, file, faults, out.materials, out.effects);
    if (const toml::table* device = root.table("device"))
        out.device = read_device(*device, faults);
    if (const toml::table* servo = root.table("servo"))
        read_servo(*servo, faults, out.servo);
    if (faults.first())
        return *faults.first();
    return out;
}

} // namespace phantom::scene
