// SPDX-License-Identifier: GPL-2.0-or-later
// A scene: objects with poses and materials, and what the device and the servo shall do.
// Read from a TOML scene file, or made round a single mesh file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "fdh/scene_tree.hpp"
#include "mesh/fans.hpp"
#include "mesh/mesh.hpp"
#include "mesh/prepare.hpp"
#include "mesh/rims.hpp"
#include "scene/cache_key.hpp"
#include "scene/deformation.hpp"
#include "scene/device_settings.hpp"
#include "scene/effects.hpp"
#include "scene/motion.hpp"

namespace phantom::scene {

struct Material {
    std::string name = "default";
    double stiffness_n_mm = 1.0; ///< k
    double radius_mm = 1.0;      ///< R, contact radius
    /// Effects are called for only when named.
    std::optional<double> damping_ns_m{}; ///< N*s/m
    std::optional<Magnet> magnet{};
    std::optional<Friction> friction{};
    std::optional<Texture> texture{};
    std::optional<HeightMap> height_map{};
    std::optional<Impact> impact{};
};

/// What can be touched of an object: its mesh, and what was made of it. A copy shares all arrays.
struct Surface {
    mesh::Mesh mesh;     ///< object frame, mm
    mesh::Fans fans;     ///< of the mesh's creases
    mesh::Rims rims;     ///< where the mesh is open, for the material's contact radius
    double error_mm = 0; ///< how far it is from what was read, where it is a simplification
    std::optional<fdh::TriangleTree<14>>
        tree; ///< hulls over the mesh's faces; build_tree() makes them if not

    /// Makes the hulls where there are none.
    void build_hulls();
};

struct Object : Surface {
    std::string name;
    std::filesystem::path file;
    mesh::Report report;
    bool from_cache = false;
    std::optional<CacheKey> cache_key{}; ///< of the file that it is kept in
    fdh::Pose pose;
    std::uint32_t material = 0; ///< index into Scene::materials
    /// Of every group of the mesh's faces; empty when all have `material`.
    std::vector<std::uint32_t> group_materials{};
    std::uint32_t first_face = 0, first_vertex = 0; ///< scene-wide numbers of face 0 and vertex 0
    /// From `pose` and the mesh as they are here, which is at rest.
    std::optional<Motion> motion{};
    std::optional<Deformation> deformation{};

    [[nodiscard]] std::uint32_t material_of(std::uint32_t face) const
    {
        return group_materials.empty() ? material : group_materials[mesh.face_groups[face]];
    }
};

struct ServoSettings {
    std::optional<double> rate_hz;
    std::optional<std::string> model, combine, proxy, arith; ///< words as on the command line
    std::optional<int> steps;
    std::optional<double> crossfade_ms; ///< to another level of detail or revision
};

struct Scene {
    std::filesystem::path file;
    std::vector<Object> objects;
    std::vector<Material> materials; ///< at least one
    std::vector<SpaceEffect> effects;
    DeviceSettings device;
    ServoSettings servo;
    double hulls_ms = 0;            ///< what building hulls took of loading, for the cache
    std::optional<bool> levels;     ///< of detail (levels.hpp): whether there shall be any
    std::vector<std::string> notes; ///< what went wrong beside the loading itself, one line each

    [[nodiscard]] std::uint64_t triangles() const;
    /// Patches of a set that holds everything: triangles, the fans of their creases and
    /// their rims.
    [[nodiscard]] std::uint64_t patches() const;
    [[nodiscard]] mesh::Bounds bounds() const; ///< world, mm
    /// Of the ball that a scene may call for as tip; else 0.
    [[nodiscard]] double tip_radius_mm() const;
    /// The largest contact radius, the tip's own included.
    [[nodiscard]] double max_radius_mm() const;
    /// Of an object's materials the largest.
    [[nodiscard]] double max_radius_mm(const Object& object) const;
    /// Whether some face is of that material.
    [[nodiscard]] bool uses(std::uint32_t material) const;
    /// Names of the effects that a used material or space calls for ("damping", "guide"), and of the others.
    [[nodiscard]] std::vector<std::string> effects_called_for() const;
    [[nodiscard]] std::vector<std::string> effects_not_called_for() const;
};

struct LoadOptions {
    mesh::PrepareOptions prepare;
    /// Where prepared objects are kept, see cache.hpp; nothing: they are prepared every time.
    std::optional<std::filesystem::path> cache;
    std::optional<std::string> unit;      ///< "mm", "m", "cm", "in", "um"; default mm, or the scene's
    std::optional<double> stiffness_n_mm; ///< replaces every material's
    std::optional<double> radius_mm;
};

/// SCENE is a mesh file or a .toml scene file. Errors: file, line, key and what was expected.
Result<Scene> load(const std::filesystem::path& file, const LoadOptions& options);

/// The two-level hierarchy of a scene.
template <int K>
fdh::SceneTree<K> build_tree(const Scene& scene, unsigned threads = 0);

} // namespace phantom::scene
