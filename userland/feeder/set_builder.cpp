// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "feeder/effect_tables.hpp"
#include "feeder/feeder.hpp"
#include "feeder/moving_objects.hpp"

namespace phantom::feeder {

namespace {

using Vector = std::array<double, 3>;

constexpr double nm_per_mm = 1e6;
constexpr std::uint32_t no_slot = std::numeric_limits<std::uint32_t>::max();

/// Centre and vertices are rounded to whole nm, each by at most sqrt(3)/2 nm. Their sum, rounded up: what a
/// distance in the set may differ from the scene's, and what the coverage is made smaller by.
constexpr double rounding_nm = 2.0;

/// And in a frame that moves: its place is rounded to nm as well, its rotation by 2^-30 a part, which is 2 nm
/// at PHANTOM_OBJECT_REACH_NM, and the servo rounds the centre that it carries there.
constexpr double moving_rounding_nm = 10.0;

/// Normals shorter than this have no direction left.
constexpr double normal_length_min = 1e-9;

Vector rotate(const fdh::Pose& pose, const Vector& v)
{
    const auto& r = pose.rotation;
    return {r[0] * v[0] + r[1] * v[1] + r[2] * v[2], r[3] * v[0] + r[4] * v[1] + r[5] * v[2],
            r[6] * v[0] + r[7] * v[1] + r[8] * v[2]};
}

Vector to_world(const fdh::Pose& pose, const Vector& v)
{
    const Vector r = rotate(pose, v);
    return {r[0] + pose.translation[0], r[1] + pose.translation[1], r[2] + pose.translation[2]};
}

Vector to_object(const fdh::Pose& pose, const Vector& v)
{
    const auto& r = pose.rotation;
    const Vector q = {v[0] - pose.translation[0], v[1] - pose.translation[1], v[2] - pose.translation[2]};
    return {r[0] * q[0] + r[3] * q[1] + r[6] * q[2], r[1] * q[0] + r[4] * q[1] + r[7] * q[2],
            r[2] * q[0] + r[5] * q[1] + r[8] * q[2]};
}

Vector cross(const Vector& a, const Vector& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double length(const Vector& v)
{
    return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

std::int64_t to_nm(double mm)
{
    return std::llround(mm * nm_per_mm);
}

std::uint32_t to_u32(double value)
{
    constexpr double most = std::numeric_limits<std::uint32_t>::max();
    return static_cast<std::uint32_t>(std::llround(std::clamp(value, 0.0, most)));
}

/// Unit vector in Q1.30. A vector without direction becomes `otherwise` (unit).
void store_normal(const Vector& normal, const Vector& otherwise, __s32 out[3])
{
    const double norm = length(normal);
    const bool usable = norm > normal_length_min;
    for (int axis = 0; axis < 3; ++axis) {
        const double component = usable ? normal[axis] / norm : otherwise[axis];
        out[axis] = static_cast<__s32>(std::llround(component * PHANTOM_Q30_ONE));
    }
}

/// Unit face normal; +z for a face without area (the servo refuses such a face and counts it).
Vector face_normal(const Vector& a, const Vector& b, const Vector& c)
{
    const Vector n = cross({b[0] - a[0], b[1] - a[1], b[2] - a[2]}, {c[0] - a[0], c[1] - a[1], c[2] - a[2]});
    const double norm = length(n);
    if (!(norm > 0.0))
        return {0.0, 0.0, 1.0};
    return {n[0] / norm, n[1] / norm, n[2] / norm};
}

__s32 to_s32(double value)
{
    constexpr double most = std::numeric_limits<__s32>::max();
    return static_cast<__s32>(std::llround(std::clamp(value, -most, most)));
}

/// Everything but the origin.
void store_placement(const scene::Placement& placement, phantom_object& out)
{
    out.flags = PHANTOM_OBJECT_MOVES;
    for (int axis = 0; axis < 3; ++axis) {
        out.translation_nm[axis] = to_nm(placement.centre_mm[axis] + placement.offset_mm[axis]);
        out.velocity_nm_s[axis] = to_s32(placement.velocity_mm_s[axis] * nm_per_mm);
        out.angular_velocity_urad_s[axis] = to_s32(placement.angular_velocity_rad_s[axis] * 1e6);
    }
    for (int part = 0; part < 4; ++part)
        out.rotation_q30[part] = to_s32(placement.quaternion[part] * PHANTOM_Q30_ONE);
}

/// Of an object's surface, unique in the scene; 0 stays 0.
std::uint32_t surface_number(const scene::Object& object, std::uint32_t surface)
{
    return surface == 0 ? 0 : object.first_face + surface;
}

} // namespace

SetBuilder::SetBuilder(const scene::Scene& scene, std::uint32_t patches_max,
                       std::shared_ptr<EffectTables> effects)
    : scene_(scene),
      patches_max_(patches_max),
      effects_(effects ? std::move(effects) : std::make_shared<EffectTables>(scene)),
      slot_(scene.triangles(), no_slot),
      material_slot_(scene.materials.size(), no_slot),
      object_slot_(scene.objects.size(), no_slot)
{
}

void SetBuilder::start_over(device::PatchSet& out)
{
    out.materials.clear();
    out.objects.clear();
    claimed_.clear();
    claimed_objects_.clear();
    frames_.clear();
    moving_ = 0;
}

void SetBuilder::begin(const std::array<double, 3>& centre_mm, const SetTime& when, device::PatchSet& out)
{
    out.header = {};
    for (int axis = 0; axis < 3; ++axis)
        out.header.origin_nm[axis] = to_nm(centre_mm[axis]);
    out.header.time_ns = when.moment ? when.time_ns : 0;
    out.patches.clear();
    centre_mm_ = centre_mm;
    when_ = when;
    start_over(out);
}

bool SetBuilder::claim_object(std::uint32_t object, device::PatchSet& out)
{
    if (object_slot_[object] != no_slot)
        return true;
    const scene::Object& owner = scene_.objects[object];
    const scene::Placement* placement = nullptr;
    phantom_object entry{};
    entry.object = object;
    if (when_.moment) {
        const scene::Moment::ObjectNow& now = when_.moment->objects[object];
        placement = now.placement ? &*now.placement : nullptr;
        entry.revision = now.revision;
    }
    if (out.objects.size() == PHANTOM_OBJECTS_MAX || (placement && moving_ == PHANTOM_MOVING_MAX))
        return false;
    Frame frame{owner.pose, {}};
    if (placement) {
        frame.pose.translation = owner.pose.translation - placement->centre_mm;
        store_placement(*placement, entry);
        const Vector centre = placement->to_frame(centre_mm_);
        for (int axis = 0; axis < 3; ++axis)
            frame.origin_nm[axis] = entry.origin_nm[axis] = to_nm(centre[axis]);
        ++moving_;
    } else {
        entry.rotation_q30[0] = PHANTOM_Q30_ONE;
        std::copy_n(out.header.origin_nm, 3, frame.origin_nm.begin());
    }
    object_slot_[object] = static_cast<std::uint32_t>(out.objects.size());
    claimed_objects_.push_back(object);
    frames_.push_back(frame);
    out.objects.push_back(entry);
    return true;
}

bool SetBuilder::claim(std::uint32_t object, std::uint32_t face, device::PatchSet& out)
{
    const std::uint32_t material = scene_.objects[object].material_of(face);
    const bool new_material = material_slot_[material] == no_slot;
    if ((new_material && out.materials.size() == PHANTOM_MATERIALS_MAX) || !claim_object(object, out))
        return false;
    if (new_material) {
        material_slot_[material] = static_cast<std::uint32_t>(out.materials.size());
        out.materials.push_back(effects_->material(material));
        claimed_.push_back(material);
    }
    return true;
}

phantom_patch SetBuilder::patch(std::uint32_t object, std::uint32_t face) const
{
    const scene::Object& owner = scene_.objects[object];
    const auto& [pose, origin_nm] = frame_of(object);
    const mesh::Triple& corners = owner.mesh.faces[face];
    const mesh::Triple& normals = owner.mesh.face_normals[face];
    std::array<Vector, 3> world;
    for (int corner = 0; corner < 3; ++corner)
        world[corner] = to_world(pose, owner.mesh.vertices[corners[corner]]);
    const Vector flat = face_normal(world[0], world[1], world[2]);

    phantom_patch out{};
    for (int corner = 0; corner < 3; ++corner) {
        for (int axis = 0; axis < 3; ++axis)
            out.vertex_nm[corner][axis] = static_cast<__s32>(to_nm(world[corner][axis]) - origin_nm[axis]);
        store_normal(rotate(pose, owner.mesh.normals[normals[corner]]), flat, out.normal_q30[corner]);
        out.vertex[corner] = owner.first_vertex + corners[corner];
    }
    out.face = owner.first_face + face;
    out.object = object_slot_[object];
    out.material = material_slot_[owner.material_of(face)];
    out.kind = PHANTOM_PATCH_FACE;
    out.surface = surface_number(owner, owner.rims.surface_of(face));
    return out;
}

void SetBuilder::add_fans(std::uint32_t object, std::uint32_t face, device::PatchSet& out) const
{
    const scene::Object& owner = scene_.objects[object];
    const auto& [pose, origin_nm] = frame_of(object);
    for (const mesh::Fan& fan : owner.fans.of(face)) {
        phantom_patch entry{};
        for (int corner = 0; corner < 3; ++corner) {
            const Vector at = to_world(pose, owner.mesh.vertices[fan.corners[corner]]);
            for (int axis = 0; axis < 3; ++axis)
                entry.vertex_nm[corner][axis] = static_cast<__s32>(to_nm(at[axis]) - origin_nm[axis]);
            const Vector normal = rotate(pose, fan.normals[corner]);
            store_normal(normal, normal, entry.normal_q30[corner]);
            entry.vertex[corner] = owner.first_vertex + fan.corners[corner];
            entry.neighbour[corner] = PHANTOM_PATCH_NONE;
        }
        entry.face = PHANTOM_PATCH_NONE;
        entry.object = object_slot_[object];
        entry.material = material_slot_[owner.material_of(face)];
        entry.kind = fan.over_vertex() ? PHANTOM_PATCH_CORNER : PHANTOM_PATCH_EDGE;
        entry.surface = surface_number(owner, owner.rims.surface_of(face));
        // An edge shorter than a nm is a point to the servo, and no fan.
        const auto& x = entry.vertex_nm;
        const bool point = std::equal(x[0], x[0] + 3, x[1]) && std::equal(x[1], x[1] + 3, x[2]);
        if (fan.over_vertex() || !point)
            out.patches.push_back(entry);
    }
}

void SetBuilder::add_rim(std::uint32_t object, std::uint32_t rim, device::PatchSet& out) const
{
    const scene::Object& owner = scene_.objects[object];
    const auto& [pose, origin_nm] = frame_of(object);
    const mesh::Rim& edge = owner.rims.edges[rim];
    phantom_patch entry = patch(object, edge.face);
    const std::array<std::uint32_t, 3> corners = {edge.from, edge.to, edge.to};
    for (int corner = 0; corner < 3; ++corner) {
        const Vector at = to_world(pose, owner.mesh.vertices[corners[corner]]);
        for (int axis = 0; axis < 3; ++axis)
            entry.vertex_nm[corner][axis] = static_cast<__s32>(to_nm(at[axis]) - origin_nm[axis]);
        entry.vertex[corner] = owner.first_vertex + corners[corner];
        entry.neighbour[corner] = PHANTOM_PATCH_NONE;
    }
    entry.face = PHANTOM_PATCH_NONE;
    entry.kind = PHANTOM_PATCH_RIM;
    // Shorter than a nm it is a point to the servo; the rims beside it end there.
    if (!std::equal(entry.vertex_nm[0], entry.vertex_nm[0] + 3, entry.vertex_nm[1]))
        out.patches.push_back(entry);
}

void SetBuilder::fill(const std::vector<std::array<std::uint32_t, 2>>& faces, device::PatchSet& out)
{
    effects_->fill(claimed_, out);
    out.patches.reserve(faces.size());
    for (const auto& [object, face] : faces) {
        const phantom_patch entry = patch(object, face);
        slot_[entry.face] = static_cast<std::uint32_t>(out.patches.size());
        out.patches.push_back(entry);
    }
    for (const auto& [object, face] : faces)
        add_fans(object, face, out);
    for (const NeededRim& needed : rims_)
        add_rim(needed.object, needed.rim, out);
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const scene::Object& owner = scene_.objects[faces[i][0]];
        const mesh::Triple& neighbours = owner.mesh.neighbours[faces[i][1]];
        for (int edge = 0; edge < 3; ++edge) {
            const std::uint32_t neighbour = neighbours[edge];
            const std::uint32_t slot =
                neighbour == mesh::no_neighbour ? no_slot : slot_[owner.first_face + neighbour];
            out.patches[i].neighbour[edge] = slot == no_slot ? PHANTOM_PATCH_NONE : slot;
        }
    }
    // Scratch is cleared entry by entry: a set is small, the scene may be large.
    for (std::size_t i = 0; i < faces.size(); ++i)
        slot_[out.patches[i].face] = no_slot;
    release(faces);
}

void SetBuilder::release(const std::vector<std::array<std::uint32_t, 2>>& faces)
{
    for (const std::uint32_t object : claimed_objects_)
        object_slot_[object] = no_slot;
    for (const auto& [object, face] : faces) {
        material_slot_[scene_.objects[object].material_of(face)] = no_slot;
    }
}

fdh::Pose SetBuilder::pose_now(std::uint32_t object) const
{
    return when_.moment ? when_.moment->pose(scene_, object) : scene_.objects[object].pose;
}

void SetBuilder::find_rims(const std::vector<fdh::Hit>& hits, const std::array<double, 3>& centre_mm,
                           double coverage_mm)
{
    rims_.clear();
    surfaces_.clear();
    for (std::size_t i = 0; i < hits.size(); ++i)
        if (const auto surface = scene_.objects[hits[i].object].rims.surface_of(hits[i].triangle))
            surfaces_.push_back({hits[i].object, surface, static_cast<std::uint32_t>(i)});
    std::sort(surfaces_.begin(), surfaces_.end());
    const auto same = [](const auto& a, const auto& b) { return a[0] == b[0] && a[1] == b[1]; };
    surfaces_.erase(std::unique(surfaces_.begin(), surfaces_.end(), same), surfaces_.end());
    for (std::size_t s = 0; s < surfaces_.size(); ++s) {
        const std::uint32_t object = surfaces_[s][0];
        if (s > 0 && surfaces_[s - 1][0] == object)
            continue;
        const scene::Object& owner = scene_.objects[object];
        const double radius_mm = scene_.max_radius_mm(owner);
        near_rims_.clear();
        owner.rims.within(owner.mesh, to_object(pose_now(object), centre_mm), coverage_mm + radius_mm,
                          near_rims_);
        for (const mesh::Rims::Near& near : near_rims_) {
            const std::array<std::uint32_t, 3> key = {object, owner.rims.edges[near.rim].surface, 0};
            const auto surface = std::lower_bound(surfaces_.begin(), surfaces_.end(), key);
            if (surface == surfaces_.end() || !same(*surface, key))
                continue;
            // A set of the first n hits covers the distance of the next one.
            const auto reaching = std::lower_bound(
                hits.begin(), hits.end(), near.distance - radius_mm,
                [](const fdh::Hit& hit, double distance) { return hit.distance < distance; });
            rims_.push_back(
                {object, near.rim, std::max<std::size_t>((*surface)[2] + 1, reaching - hits.begin())});
        }
    }
    std::sort(rims_.begin(), rims_.end(), [](const NeededRim& a, const NeededRim& b) {
        return a.object != b.object ? a.object < b.object : a.rim < b.rim;
    });
    rims_from_.assign(hits.size() + 1, 0);
    for (const NeededRim& needed : rims_)
        ++rims_from_[needed.hits];
}

void SetBuilder::build(const fdh::Nearest& nearest, const std::array<double, 3>& centre_mm,
                       device::PatchSet& out, const SetTime& when)
{
    const std::vector<fdh::Hit>& hits = nearest.hits;
    double coverage_mm = nearest.coverage;
    begin(centre_mm, when, out);
    faces_.clear();
    for (const fdh::Hit& hit : hits)
        faces_.push_back({hit.object, hit.triangle});
    find_rims(hits, centre_mm, coverage_mm);
    std::size_t patches = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        patches += 1 + scene_.objects[hits[i].object].fans.of(hits[i].triangle).size() + rims_from_[i + 1];
        if (patches > patches_max_ || !claim(hits[i].object, hits[i].triangle, out)) {
            coverage_mm = std::clamp(hits[i].distance - nearest.distance_error, 0.0, coverage_mm);
            faces_.resize(i);
            break;
        }
    }
    std::erase_if(rims_, [this](const NeededRim& needed) { return needed.hits > faces_.size(); });
    std::sort(faces_.begin(), faces_.end());
    // Claimed again in that order: numbers of materials and objects must not depend on who was nearest.
    release(faces_);
    start_over(out);
    for (const auto& [object, face] : faces_)
        claim(object, face, out);
    // What moves and is not in the set yet, as far as there is room for it.
    for (const std::uint32_t object : when_.near)
        claim_object(object, out);
    const bool moves = moving_ > 0;
    fill(faces_, out);
    const double covered_nm =
        std::floor(coverage_mm * nm_per_mm) - (moves ? moving_rounding_nm : rounding_nm);
    out.header.radius_nm = to_u32(covered_nm);
}

void SetBuilder::build_all(const std::array<double, 3>& centre_mm, device::PatchSet& out, const SetTime& when)
{
    begin(centre_mm, when, out);
    faces_.clear();
    rims_.clear();
    bool complete = true;
    for (std::uint32_t object = 0; object < scene_.objects.size(); ++object) {
        if (scene_.objects[object].mesh.faces.empty())
            continue;
        for (std::uint32_t face = 0; complete && face < scene_.objects[object].mesh.faces.size(); ++face) {
            complete = claim(object, face, out);
            if (complete)
                faces_.push_back({object, face});
        }
        if (!complete)
            break;
        for (std::uint32_t rim = 0; rim < scene_.objects[object].rims.edges.size(); ++rim)
            rims_.push_back({object, rim, 0});
    }
    fill(faces_, out);
    out.header.radius_nm = complete ? std::numeric_limits<__u32>::max() : 0;
}

double edge_max_mm(const FeederOptions& options)
{
    // The tip is at most search_radius from a triangle of its set, and the origin is the tip or between tip
    // and proxy.
    return PHANTOM_COORDINATE_MAX_NM / nm_per_mm - 2.0 * options.search_radius_mm;
}

Status check_reach(const scene::Scene& scene, const FeederOptions& options)
{
    constexpr double reach_mm = PHANTOM_COORDINATE_MAX_NM / nm_per_mm;
    const std::string file = scene.file.string();
    if (options.all) {
        const mesh::Bounds bounds = scene.bounds();
        if (bounds.extent() > 2.0 * reach_mm)
            return Error{
                file,
                fmt::format("the scene is {:.0f} mm long, a set with every triangle reaches {:.0f} mm",
                            bounds.extent(), 2.0 * reach_mm),
                "take a smaller budget than all, or --fit MM"};
        if (scene.objects.size() > PHANTOM_OBJECTS_MAX || scene.materials.size() > PHANTOM_MATERIALS_MAX)
            return Error{file,
                         fmt::format("a set carries at most {} objects and {} materials", PHANTOM_OBJECTS_MAX,
                                     PHANTOM_MATERIALS_MAX),
                         "take a smaller budget than all"};
        return success();
    }
    // The tip of a set is that near to what it touches, and where an object moves it is so in its frame.
    constexpr double frame_mm = PHANTOM_OBJECT_REACH_NM / nm_per_mm;
    const double frame_max_mm = frame_mm - 4.0 * options.search_radius_mm;
    if (const auto [object, mm] = MovingObjects(scene).farthest(); mm > frame_max_mm)
        return Error{
            fmt::format("{}: object {}", file, scene.objects[object].name),
            fmt::format("reaches {:.0f} mm from the centre of its motion, a set {:.0f} mm", mm, frame_max_mm),
            "take a centre_mm that is nearer to it, or --unit or --fit if it should be smaller"};
    const double longest_mm = edge_max_mm(options);
    for (const scene::Object& object : scene.objects) {
        // A hundredth for the rounding of what the report says.
        if (object.report.edge_max_mm > 0 && object.report.edge_max_mm < 0.99 * longest_mm)
            continue;
        for (std::size_t face = 0; face < object.mesh.faces.size(); ++face) {
            const mesh::Triple& corners = object.mesh.faces[face];
            for (int edge = 0; edge < 3; ++edge) {
                const Vector& a = object.mesh.vertices[corners[edge]];
                const Vector& b = object.mesh.vertices[corners[(edge + 1) % 3]];
                const double edge_mm = length({b[0] - a[0], b[1] - a[1], b[2] - a[2]});
                if (edge_mm > longest_mm)
                    return Error{
                        fmt::format("{}: object {}, face {}", file, object.name, face),
                        fmt::format("an edge is {:.0f} mm long, a set reaches {:.0f} mm from the tip",
                                    edge_mm, longest_mm),
                        "--split 500, or --unit or --fit if the mesh should be smaller"};
            }
        }
    }
    return success();
}

} // namespace phantom::feeder
