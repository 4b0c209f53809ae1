// SPDX-License-Identifier: GPL-2.0-or-later
#include "feeder/effect_tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "phantom_abi.h"

namespace phantom::feeder {

namespace {

constexpr double per_million = 1e6;

__u32 scaled(double value, double units)
{
    return static_cast<__u32>(std::llround(value * units));
}

/// The contact radius may have been replaced since the file was read: the range stays below it.
phantom_magnet entry_of(const scene::Magnet& magnet, double radius_mm)
{
    const __u32 most = std::max<__u32>(2, scaled(radius_mm, per_million)) - 1;
    return {std::clamp<__u32>(scaled(magnet.range_mm, per_million), 1, most),
            scaled(magnet.force_n, per_million)};
}

phantom_friction entry_of(const scene::Friction& friction)
{
    return {scaled(friction.statical, per_million), scaled(friction.dynamic, per_million),
            scaled(friction.stiffness_n_mm, 1e3), scaled(friction.stribeck_mm_s, 1e3)};
}

phantom_texture entry_of(const scene::Texture& texture)
{
    phantom_texture out{};
    out.amplitude_nm[0] = scaled(texture.amplitude_mm, per_million);
    for (std::size_t axis = 0; axis < 3; ++axis) // waves per km of waves that are so many mm long
        out.wave_per_km[0][axis] =
            static_cast<__s32>(std::llround(per_million * texture.direction[axis] / texture.wavelength_mm));
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

} // namespace

std::uint32_t table_effects(const scene::Material& material)
{
    return (material.magnet ? PHANTOM_EFFECT_MAGNET : 0U) |
           (material.friction ? PHANTOM_EFFECT_FRICTION : 0U) |
           (material.texture ? PHANTOM_EFFECT_TEXTURE : 0U);
}

std::vector<std::uint64_t> effect_tables(const scene::Scene& scene,
                                         const std::vector<std::uint32_t>& materials)
{
    std::vector<std::uint64_t> out;
    for (const std::uint32_t material : materials)
        if (const auto& of = scene.materials[material]; of.magnet)
            append(entry_of(*of.magnet, of.radius_mm), out);
    for (const std::uint32_t material : materials)
        if (const auto& friction = scene.materials[material].friction)
            append(entry_of(*friction), out);
    for (const std::uint32_t material : materials)
        if (const auto& texture = scene.materials[material].texture)
            append(entry_of(*texture), out);
    return out;
}

} // namespace phantom::feeder
