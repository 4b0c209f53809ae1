// SPDX-License-Identifier: GPL-2.0-or-later
// Places of effects are absolute, and a set names only those within PHANTOM_EFFECT_REACH_MAX_NM of its
// origin. The tables are made for all origins within `window` of one, and again when a set's origin leaves
// that:
//
//   a line or plane      is named by its place nearest to the origin
//   within `named`       exact
//   beyond, with an end  left out: it ends (scene::range::region_mm) before the tip's part of space begins
//   beyond, without one  a guide is named in that direction at that distance; it pulls at its most from there
#include "feeder/effect_tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "base/vector.hpp"
#include "feeder/path.hpp"
#include "scene/ranges.hpp"

namespace phantom::feeder {

namespace {

constexpr double nm_per_mm = 1e6;
constexpr double window_mm = 500.0; ///< along each axis
constexpr double window_corner_mm = 867.0;
constexpr double named_mm = 3100.0;
static_assert(window_corner_mm + named_mm < PHANTOM_EFFECT_REACH_MAX_NM / nm_per_mm);
// A tip is nearer to its set's origin than half a metre, sets are made round it. Where one set holds
// everything the origin stays, and the tip is at most 1.147 m from it along each axis.
static_assert(named_mm - window_corner_mm - 500.0 > scene::range::region_mm.high);
static_assert(named_mm - 1.733 * 1147.0 > scene::range::region_mm.high);

/// Effects that have tables, of one material.
constexpr std::uint32_t surface_tables = PHANTOM_EFFECT_MAGNET | PHANTOM_EFFECT_FRICTION |
                                         PHANTOM_EFFECT_TEXTURE | PHANTOM_EFFECT_HEIGHT_MAP |
                                         PHANTOM_EFFECT_IMPACT;

__u32 scaled(double value, double units)
{
    return static_cast<__u32>(std::llround(value * units));
}

/// The contact radius may have been replaced since the file was read: the range stays below it.
phantom_magnet entry_of(const scene::Magnet& magnet, double radius_mm)
{
    const __u32 most = std::max<__u32>(2, scaled(radius_mm, nm_per_mm)) - 1;
    return {std::clamp<__u32>(scaled(magnet.range_mm, nm_per_mm), 1, most), scaled(magnet.force_n, 1e6)};
}

phantom_friction entry_of(const scene::Friction& friction, double stiffness_n_mm)
{
    const double spring =
        friction.stiffness_n_mm.value_or(std::min(stiffness_n_mm, scene::range::effect_stiffness_n_mm.high));
    return {scaled(friction.statical, 1e6), scaled(friction.dynamic.value_or(friction.statical), 1e6),
            scaled(spring, 1e3), scaled(friction.stribeck_mm_s, 1e3)};
}

void store(const scene::Grating& grating, std::size_t index, phantom_texture& out)
{
    out.amplitude_nm[index] = scaled(grating.amplitude_mm, nm_per_mm);
    for (std::size_t axis = 0; axis < 3; ++axis) // waves per km of waves that are so many mm long
        out.wave_per_km[index][axis] =
            static_cast<__s32>(std::llround(1e6 * grating.direction[axis] / grating.wavelength_mm));
}

phantom_texture entry_of(const scene::Texture& texture)
{
    phantom_texture out{};
    store(texture.first, 0, out);
    if (texture.second)
        store(*texture.second, 1, out);
    return out;
}

template <class T>
void append(const T& entry, std::vector<std::uint64_t>& tables)
{
    static_assert(sizeof entry % sizeof(std::uint64_t) == 0);
    const std::size_t before = tables.size();
    tables.resize(before + sizeof entry / sizeof(std::uint64_t));
    std::memcpy(&tables[before], &entry, sizeof entry);
}

/// Numbers behind a struct, filled up to whole words.
void append_numbers(const std::vector<__s32>& numbers, std::vector<std::uint64_t>& tables)
{
    const std::size_t before = tables.size();
    tables.resize(before + (numbers.size() + 1) / 2);
    std::memcpy(&tables[before], numbers.data(), numbers.size() * sizeof(__s32));
}

void append_map(const scene::HeightMap& map, std::vector<std::uint64_t>& tables)
{
    const scene::GreyImage& image = map.samples;
    phantom_height_map out{};
    out.columns = image.width;
    out.rows = image.height;
    out.spacing_nm = scaled(map.spacing_mm, nm_per_mm);
    out.amplitude_nm = scaled(0.5 * map.height_mm, nm_per_mm);
    std::vector<__s32> heights;
    for (std::uint32_t row = image.height; row-- > 0;) // an image begins at its upper edge
        for (std::uint32_t column = 0; column < image.width; ++column)
            heights.push_back(static_cast<__s32>(
                std::lround((image.at(column, row) - 0.5) * 2.0 * static_cast<double>(out.amplitude_nm))));
    append(out, tables);
    append_numbers(heights, tables);
}

phantom_impact entry_of(const scene::Impact& impact)
{
    return {scaled(impact.gain_ns_m, 1e3), scaled(impact.force_n, 1e6), scaled(impact.frequency_hz, 1.0),
            scaled(impact.decay_ms, 1e3)};
}

template <class T>
void append_counted(const std::vector<T>& entries, std::vector<std::uint64_t>& tables)
{
    if (entries.empty())
        return;
    append(phantom_effect_count{static_cast<__u32>(entries.size()), 0}, tables);
    for (const T& entry : entries)
        append(entry, tables);
}

phantom_material contact_of(const scene::Material& material)
{
    phantom_material out{};
    out.stiffness_mn_mm = scaled(material.stiffness_n_mm, 1e3);
    out.radius_nm = std::max<__u32>(1, scaled(material.radius_mm, nm_per_mm));
    out.damping_mns_m = scaled(material.damping_ns_m.value_or(0), 1e3);
    out.effects = (material.damping_ns_m ? PHANTOM_EFFECT_DAMPING : 0U) |
                  (material.magnet ? PHANTOM_EFFECT_MAGNET : 0U) |
                  (material.friction ? PHANTOM_EFFECT_FRICTION : 0U) |
                  (material.texture ? PHANTOM_EFFECT_TEXTURE : 0U) |
                  (material.height_map ? PHANTOM_EFFECT_HEIGHT_MAP : 0U) |
                  (material.impact ? PHANTOM_EFFECT_IMPACT : 0U);
    return out;
}

/// As it is named in a set near the origin; nothing: it is out of reach.
std::optional<Vec3> named(const Vec3& place, const Vec3& origin, bool ends)
{
    const Vec3 way = place - origin;
    const double distance = length(way);
    if (distance <= named_mm)
        return place;
    if (ends)
        return std::nullopt;
    return origin + named_mm / distance * way;
}

std::optional<phantom_viscosity> entry_of(const scene::Viscosity& viscosity, const Vec3& origin)
{
    phantom_viscosity out{};
    out.viscosity_mns_m = scaled(viscosity.viscosity_ns_m, 1e3);
    out.drag_mns2_m2 = scaled(viscosity.drag_ns2_m2, 1e3);
    if (!viscosity.radius_mm)
        return out;
    const auto centre = named(viscosity.centre_mm, origin, true);
    if (!centre)
        return std::nullopt;
    const auto at = to_nanometres(*centre);
    std::copy(at.begin(), at.end(), out.centre_nm);
    out.radius_nm = scaled(*viscosity.radius_mm, nm_per_mm);
    const double border = viscosity.border_mm.value_or(0.25 * *viscosity.radius_mm);
    out.border_nm = std::clamp<__u32>(scaled(border, nm_per_mm), PHANTOM_BORDER_MIN_NM, out.radius_nm);
    return out;
}

std::optional<phantom_guide> entry_of(const scene::Guide& guide, const Vec3& origin)
{
    phantom_guide out{};
    // The kinds have the same order.
    static_assert(static_cast<int>(scene::Guide::Place::point) == PHANTOM_GUIDE_POINT &&
                  static_cast<int>(scene::Guide::Place::line) == PHANTOM_GUIDE_LINE &&
                  static_cast<int>(scene::Guide::Place::plane) == PHANTOM_GUIDE_PLANE);
    out.kind = static_cast<__u32>(guide.to);
    Vec3 point = guide.point_mm;
    const double along = dot(origin - point, guide.direction);
    if (guide.to == scene::Guide::Place::line)
        point = point + along * guide.direction;
    else if (guide.to == scene::Guide::Place::plane)
        point = origin - along * guide.direction;
    const auto place = named(point, origin, guide.reach_mm.has_value());
    if (!place)
        return std::nullopt;
    // Where it needs not be moved it stays: the same numbers whatever the set's origin.
    const bool near = length(guide.point_mm - origin) <= named_mm;
    const auto at = to_nanometres(near ? guide.point_mm : *place);
    std::copy(at.begin(), at.end(), out.point_nm);
    for (std::size_t axis = 0; axis < 3; ++axis)
        out.direction_q30[axis] = static_cast<__s32>(std::llround(guide.direction[axis] * PHANTOM_Q30_ONE));
    out.stiffness_mn_mm = scaled(guide.stiffness_n_mm, 1e3);
    out.force_un = scaled(guide.force_n, 1e6);
    out.reach_nm = scaled(guide.reach_mm.value_or(0), nm_per_mm);
    return out;
}

/// Nothing where it is out of reach.
void append_field(const scene::ForceField& field, const Vec3& origin, std::vector<std::uint64_t>& tables)
{
    const scene::ForceGrid& grid = field.grid;
    const auto corner = named(grid.corner_mm, origin, true);
    if (!corner)
        return;
    phantom_field out{};
    const auto at = to_nanometres(*corner);
    std::copy(at.begin(), at.end(), out.corner_nm);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out.spacing_nm[axis] = scaled(grid.spacing_mm[axis], nm_per_mm);
        out.nodes[axis] = grid.nodes[axis];
    }
    const double side = grid.shortest_side_mm();
    // Half a nm per step of the grid is what the module's own side may be shorter by.
    out.border_nm =
        std::max<__u32>(scaled(std::min(field.border_mm.value_or(0.25 * side), 0.4999 * side), nm_per_mm),
                        PHANTOM_BORDER_MIN_NM);
    std::vector<__s32> forces;
    for (const auto& force : grid.force_n)
        for (const double part : force)
            forces.push_back(static_cast<__s32>(std::lround(part * field.scale * 1e6)));
    append(out, tables);
    append_numbers(forces, tables);
}

} // namespace

EffectTables::EffectTables(const scene::Scene& scene)
    : materials_(scene.materials),
      effects_(scene.effects),
      stiffness_(materials_.size()),
      damping_(materials_.size())
{
    make_surfaces();
}

void EffectTables::make_surfaces()
{
    surfaces_.clear();
    for (const scene::Material& material : materials_) {
        Surface surface;
        surface.contact = contact_of(material);
        if (material.magnet)
            append(entry_of(*material.magnet, material.radius_mm), surface.magnet);
        if (material.friction)
            append(entry_of(*material.friction, material.stiffness_n_mm), surface.friction);
        if (material.texture)
            append(entry_of(*material.texture), surface.texture);
        if (material.height_map)
            append_map(*material.height_map, surface.height_map);
        if (material.impact)
            append(entry_of(*material.impact), surface.impact);
        surfaces_.push_back(std::move(surface));
    }
}

void EffectTables::change(std::vector<scene::Material> materials, std::vector<scene::SpaceEffect> effects)
{
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
        stiffness_[i] = {static_cast<double>(surfaces_[i].contact.stiffness_mn_mm),
                         1e3 * materials[i].stiffness_n_mm};
        damping_[i] = {static_cast<double>(surfaces_[i].contact.damping_mns_m),
                       1e3 * materials[i].damping_ns_m.value_or(0)};
    }
    materials_ = std::move(materials);
    effects_ = std::move(effects);
    make_surfaces();
    space_made_ = false;
    round_ = 0;
    store_ramp();
}

void EffectTables::begin_round()
{
    if (round_ == ramp_rounds)
        return;
    ++round_;
    store_ramp();
}

void EffectTables::store_ramp()
{
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
        phantom_material& contact = surfaces_[i].contact;
        contact.stiffness_mn_mm = std::max<__u32>(1, scaled(stiffness_[i].at(round_), 1.0));
        contact.damping_mns_m = scaled(damping_[i].at(round_), 1.0);
        // Damping that goes away goes when it is nothing any more.
        if (contact.damping_mns_m > 0 || materials_[i].damping_ns_m)
            contact.effects |= PHANTOM_EFFECT_DAMPING;
        else
            contact.effects &= ~PHANTOM_EFFECT_DAMPING;
    }
}

void EffectTables::make_space(const std::array<std::int64_t, 3>& origin_nm)
{
    Vec3 origin;
    for (std::size_t axis = 0; axis < 3; ++axis)
        origin[axis] = static_cast<double>(origin_nm[axis]) / nm_per_mm;
    std::optional<Vec3> force;
    std::vector<phantom_viscosity> regions;
    std::vector<phantom_guide> guides;
    std::vector<std::uint64_t> field, tip;
    for (const scene::SpaceEffect& effect : effects_) {
        if (const auto* constant = std::get_if<scene::ConstantForce>(&effect.law)) {
            force = force.value_or(Vec3{}) + constant->force_n;
        } else if (const auto* viscosity = std::get_if<scene::Viscosity>(&effect.law)) {
            if (const auto entry = entry_of(*viscosity, origin))
                regions.push_back(*entry);
        } else if (const auto* guide = std::get_if<scene::Guide>(&effect.law)) {
            if (const auto entry = entry_of(*guide, origin))
                guides.push_back(*entry);
        } else if (const auto* grid = std::get_if<scene::ForceField>(&effect.law)) {
            append_field(*grid, origin, field);
        } else {
            append(phantom_tip{scaled(std::get<scene::BallTip>(effect.law).radius_mm, nm_per_mm), 0}, tip);
        }
    }
    space_mask_ = (force ? PHANTOM_EFFECT_CONSTANT : 0U) | (regions.empty() ? 0U : PHANTOM_EFFECT_VISCOSITY) |
                  (guides.empty() ? 0U : PHANTOM_EFFECT_GUIDE) | (field.empty() ? 0U : PHANTOM_EFFECT_FIELD) |
                  (tip.empty() ? 0U : PHANTOM_EFFECT_TIP);
    space_.clear();
    if (force) {
        phantom_constant constant{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            constant.force_un[axis] = static_cast<__s32>(std::llround((*force)[axis] * 1e6));
        append(constant, space_);
    }
    append_counted(regions, space_);
    append_counted(guides, space_);
    space_.insert(space_.end(), field.begin(), field.end());
    space_.insert(space_.end(), tip.begin(), tip.end());
    space_origin_nm_ = origin_nm;
    space_made_ = true;
}

void EffectTables::fill(std::span<const std::uint32_t> materials, device::PatchSet& out)
{
    out.effect_tables.clear();
    std::uint32_t named = 0;
    for (const std::uint32_t material : materials)
        named |= surfaces_[material].contact.effects;
    if (named & surface_tables) {
        for (const auto table : {&Surface::magnet, &Surface::friction, &Surface::texture,
                                 &Surface::height_map, &Surface::impact})
            for (const std::uint32_t material : materials) {
                const auto& entry = surfaces_[material].*table;
                out.effect_tables.insert(out.effect_tables.end(), entry.begin(), entry.end());
            }
    }
    if (effects_.empty())
        return;
    const std::array<std::int64_t, 3> origin_nm = {out.header.origin_nm[0], out.header.origin_nm[1],
                                                   out.header.origin_nm[2]};
    const auto near = [](std::int64_t a, std::int64_t b) {
        return std::abs(a - b) <= static_cast<std::int64_t>(window_mm * nm_per_mm);
    };
    if (!space_made_ || !std::equal(origin_nm.begin(), origin_nm.end(), space_origin_nm_.begin(), near))
        make_space(origin_nm);
    out.header.effects |= space_mask_;
    out.effect_tables.insert(out.effect_tables.end(), space_.begin(), space_.end());
}

} // namespace phantom::feeder
