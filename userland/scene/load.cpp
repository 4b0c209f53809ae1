// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "mesh/read.hpp"
#include "scene/cache.hpp"
#include "scene/deforming_surface.hpp"
#include "scene/ranges.hpp"
#include "scene/scene.hpp"
#include "scene/scene_file.hpp"
#include "scene/shapes/shape.hpp"
#include "scene/units.hpp"

namespace phantom::scene {

namespace {

bool is_scene_file(const std::filesystem::path& file)
{
    return file.extension() == ".toml" || file.extension() == ".TOML";
}

Status check_options(const LoadOptions& options)
{
    const auto refuse = [](const char* option, double value, const char* expected) {
        return Error{option, fmt::format("{:g} is out of range, expected {}", value, expected)};
    };
    if (options.unit && !millimetres_in(*options.unit))
        return Error{"--unit", fmt::format("\"{}\" is no unit, expected {}", *options.unit, unit_names)};
    if (options.stiffness_n_mm && !range::stiffness_n_mm.contains(*options.stiffness_n_mm))
        return refuse("--stiffness", *options.stiffness_n_mm, range::stiffness_n_mm.text);
    if (options.radius_mm && !range::radius_mm.contains(*options.radius_mm))
        return refuse("--radius", *options.radius_mm, range::radius_mm.text);
    return success();
}

/// A scene of one object round a mesh file.
SceneFile file_round(const std::filesystem::path& mesh)
{
    SceneFile scene;
    ObjectEntry object;
    object.name = mesh.stem().string();
    object.mesh = mesh;
    scene.objects.push_back(std::move(object));
    scene.materials.emplace_back();
    return scene;
}

/// The scene's unit and fit, unless the options name their own.
mesh::PrepareOptions prepare_options(const SceneFile& file, const ObjectEntry& object,
                                     const LoadOptions& options)
{
    mesh::PrepareOptions prepare = options.prepare;
    const char* const of_format = mesh::is_in_metres(object.mesh) ? "m" : "mm";
    const std::string unit = options.unit.value_or(object.unit.value_or(file.unit.value_or(of_format)));
    // A shape's sizes are in mm already.
    prepare.scale *= object.shape ? 1.0 : millimetres_in(unit).value_or(1.0);
    prepare.two_sided = object.two_sided;
    if (prepare.split_mm <= 0 && object.split_mm)
        prepare.split_mm = *object.split_mm;
    if (prepare.fit_mm <= 0 && object.fit_mm)
        prepare.fit_mm = *object.fit_mm;
    if (prepare.weld_mm <= 0 && object.weld_mm)
        prepare.weld_mm = *object.weld_mm;
    return prepare;
}

Result<mesh::Soup> geometry_of(const ObjectEntry& object)
{
    if (object.shape) {
        auto soup = triangulate(*object.shape, object.chord_mm);
        if (soup)
            return soup;
        const auto& [key, what, remedy] = soup.error();
        const auto place = object.shape_where.find(key);
        return Error{place == object.shape_where.end() ? object.where : place->second,
                     fmt::format("{}: {}: {}", object.name, key, what), remedy};
    }
    auto soup = mesh::read(object.mesh);
    if (!soup && !object.mesh_where.empty() && !std::filesystem::exists(object.mesh))
        return Error{object.mesh_where, "mesh: no such file: " + object.mesh.string()};
    return soup;
}

/// Reads and prepares.
Status fill(const ObjectEntry& entry, const mesh::PrepareOptions& prepare, double reach_mm, Object& object)
{
    auto soup = geometry_of(entry);
    if (!soup)
        return soup.error();
    const std::string name = entry.mesh.empty() ? entry.name : entry.mesh.string();
    auto prepared = mesh::prepare(std::move(*soup), prepare, name);
    if (!prepared)
        return prepared.error();
    object.mesh = std::move(prepared->mesh);
    object.fans = mesh::make_fans(object.mesh);
    object.rims = mesh::make_rims(object.mesh, reach_mm);
    object.report = std::move(prepared->report);
    return success();
}

/// As fill(), by way of the cache.
Status fill_cached(const ObjectEntry& entry, const CacheRequest& request,
                   const std::filesystem::path& directory, Object& object, Scene& scene)
{
    const Result<CacheTicket> ticket = ticket_for(request);
    // A file that cannot be read gets read()'s own words.
    if (!ticket)
        return fill(entry, request.prepare, request.reach_mm, object);
    const Result<bool> opened = open_cached(directory, *ticket, object);
    if (opened && *opened) {
        object.from_cache = true;
        object.cache_key = ticket->key;
        return success();
    }
    if (!opened)
        scene.notes.push_back(opened.error().text() + ": prepared again");
    if (Status status = fill(entry, request.prepare, request.reach_mm, object); !status)
        return status;
    const auto begin = std::chrono::steady_clock::now();
    object.build_hulls();
    scene.hulls_ms +=
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    const Result<bool> kept = keep(directory, *ticket, request, object);
    if (!kept)
        scene.notes.push_back(kept.error().text() + ": the next load will prepare it again");
    else if (*kept)
        object.cache_key = ticket->key;
    return success();
}

/// Materials of the groups that the scene file names.
Status assign_groups(const ObjectEntry& entry, Object& object)
{
    if (entry.group_materials.empty())
        return success();
    const std::vector<std::string>& names = object.mesh.group_names;
    object.group_materials.assign(names.size(), entry.material);
    for (const GroupMaterial& wanted : entry.group_materials) {
        const auto found = std::find(names.begin(), names.end(), wanted.group);
        if (found != names.end()) {
            object.group_materials[static_cast<std::size_t>(found - names.begin())] = wanted.material;
            continue;
        }
        constexpr std::size_t shown_max = 12;
        std::string expected;
        for (std::size_t i = 0; i < names.size() && i < shown_max; ++i)
            if (!names[i].empty())
                expected += (expected.empty() ? "expected " : ", ") + names[i];
        if (names.size() > shown_max)
            expected += " ...";
        return Error{wanted.where,
                     fmt::format("{}: materials.{}: the mesh has no such group of faces, {}", object.name,
                                 wanted.group, expected.empty() ? "and no group at all" : expected)};
    }
    return success();
}

/// A tip that touches must still be within the contact radius when the next shape comes, one that is late
/// included: so far the servo carries a proxy (phantom_abi.h, OTHER GEOMETRY).
Status check_rise(const ObjectEntry& entry, const Object& object, double radius_mm)
{
    if (!entry.deformation)
        return success();
    constexpr double late = 2;
    const double interval_s = late * revision_interval_s(object.mesh.faces.size());
    const double rise_mm = entry.deformation->speed_max_mm_s() * interval_s;
    if (rise_mm <= radius_mm)
        return success();
    return Error{entry.deform_where,
                 fmt::format("{}: deform: rises by {:.3g} mm in the {:.0f} ms between two shapes of {} "
                             "triangles, expected no more than the contact radius, {:g} mm (a smaller "
                             "amplitude_mm or frequency_hz)",
                             object.name, rise_mm, 1e3 * interval_s, object.mesh.faces.size(), radius_mm)};
}

/// The largest contact radius of the object's materials, with the tip's own.
double reach_mm(const ObjectEntry& entry, const Scene& scene)
{
    double reach = scene.materials[entry.material].radius_mm;
    for (const GroupMaterial& group : entry.group_materials)
        reach = std::max(reach, scene.materials[group.material].radius_mm);
    return reach + scene.tip_radius_mm();
}

Result<Object> make_object(const SceneFile& file, const ObjectEntry& entry, const LoadOptions& options,
                           Scene& scene)
{
    Object object;
    object.name = entry.name;
    object.file = entry.mesh;
    object.pose = entry.pose;
    object.material = entry.material;
    object.motion = entry.motion;
    object.deformation = entry.deformation;
    const CacheRequest request{entry.mesh, prepare_options(file, entry, options), reach_mm(entry, scene)};
    const Status status = options.cache && is_cacheable(entry.mesh)
                              ? fill_cached(entry, request, *options.cache, object, scene)
                              : fill(entry, request.prepare, request.reach_mm, object);
    if (!status)
        return status.error();
    if (const Status assigned = assign_groups(entry, object); !assigned)
        return assigned.error();
    if (const Status risen = check_rise(entry, object, request.reach_mm); !risen)
        return risen.error();
    return object;
}

} // namespace

Result<Scene> load(const std::filesystem::path& file, const LoadOptions& options)
{
    if (const auto status = check_options(options); !status)
        return status.error();
    std::error_code ignored;
    if (!is_scene_file(file) && !mesh::is_mesh_file(file) && std::filesystem::is_regular_file(file, ignored))
        return Error{file.string(),
                     fmt::format("unknown extension \"{}\", expected a scene file .toml or a mesh {}",
                                 file.extension().string(), mesh::mesh_extensions)};
    auto entries = is_scene_file(file) ? read_scene_file(file) : Result<SceneFile>(file_round(file));
    if (!entries)
        return entries.error();

    Scene scene;
    scene.file = file;
    scene.device = entries->device;
    scene.servo = entries->servo;
    scene.levels = entries->levels;
    scene.materials = entries->materials;
    scene.effects = entries->effects;
    for (Material& material : scene.materials) {
        material.stiffness_n_mm = options.stiffness_n_mm.value_or(material.stiffness_n_mm);
        material.radius_mm = options.radius_mm.value_or(material.radius_mm);
    }
    std::uint64_t first_face = 0, first_vertex = 0;
    for (const ObjectEntry& entry : entries->objects) {
        auto object = make_object(*entries, entry, options, scene);
        if (!object)
            return object.error();
        object->first_face = static_cast<std::uint32_t>(first_face);
        object->first_vertex = static_cast<std::uint32_t>(first_vertex);
        first_face += object->mesh.faces.size();
        first_vertex += object->mesh.vertices.size();
        if (first_face >= mesh::no_neighbour || first_vertex >= mesh::no_neighbour)
            return Error{file.string(), "has more than 2^32 - 2 triangles or vertices"};
        scene.objects.push_back(std::move(*object));
    }
    return scene;
}

} // namespace phantom::scene
