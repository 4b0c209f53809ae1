// SPDX-License-Identifier: GPL-2.0-or-later
#include "feel.hpp"

#include <algorithm>
#include <cstddef>

namespace phantom::fuzz {

namespace {

constexpr std::uint8_t magnet_bit = 2, friction_bit = 4, texture_bit = 8;
constexpr std::uint8_t constant_bit = 16, viscosity_bit = 32, guide_bit = 64, most_bit = 128;

using Table = std::vector<std::uint8_t>;

template <class T>
void append(Table& to, const T& entry)
{
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&entry);
    to.insert(to.end(), bytes, bytes + sizeof(T));
}

phantom_magnet magnet(bool most, std::uint32_t radius_nm)
{
    return most ? phantom_magnet{radius_nm - 1, PHANTOM_EFFECT_FORCE_MAX_UN}
                : phantom_magnet{std::max<std::uint32_t>(1, radius_nm / 4), 300'000};
}

phantom_friction friction(bool most)
{
    return most ? phantom_friction{PHANTOM_FRICTION_MAX_PPM, 0, PHANTOM_EFFECT_STIFFNESS_MAX_MN_MM, 1}
                : phantom_friction{600'000, 400'000, 800, 20'000};
}

phantom_texture texture(bool most)
{
    return most ? phantom_texture{{0xffffffff, 1},
                                  {{37, 0, 0}, {0, -PHANTOM_WAVE_MAX_PER_KM / 2, PHANTOM_WAVE_MAX_PER_KM}}}
                : phantom_texture{{50'000, 0}, {{1'000'000, -300'000, 700'000}, {0, 0, 0}}};
}

phantom_constant constant(bool most)
{
    constexpr std::int32_t force_un = PHANTOM_EFFECT_FORCE_MAX_UN;
    return most ? phantom_constant{{force_un, -force_un, force_un}, 0}
                : phantom_constant{{100'000, 0, -500'000}, 0};
}

phantom_viscosity viscosity(bool most, const __s64 (&origin_nm)[3])
{
    phantom_viscosity out{};
    out.viscosity_mns_m = most ? PHANTOM_VISCOSITY_MAX_MNS_M : 2000;
    out.drag_mns2_m2 = most ? PHANTOM_DRAG_MAX_MNS2_M2 : 500;
    if (most)
        return out;
    std::copy_n(origin_nm, 3, out.centre_nm);
    out.radius_nm = 5'000'000;
    out.border_nm = PHANTOM_BORDER_MIN_NM;
    return out;
}

phantom_guide guide(bool most, const __s64 (&origin_nm)[3])
{
    phantom_guide out{};
    std::copy_n(origin_nm, 3, out.point_nm);
    out.stiffness_mn_mm = most ? PHANTOM_EFFECT_STIFFNESS_MAX_MN_MM : 200;
    out.force_un = most ? PHANTOM_EFFECT_FORCE_MAX_UN : 1'000'000;
    out.reach_nm = most ? 1 : 20'000'000;
    out.kind = most ? PHANTOM_GUIDE_PLANE : PHANTOM_GUIDE_POINT;
    out.direction_q30[1] = most ? PHANTOM_Q30_ONE : 0;
    return out;
}

phantom_impact impact(bool most)
{
    return most ? phantom_impact{PHANTOM_IMPACT_GAIN_MAX_MNS_M_PER_HZ * PHANTOM_IMPACT_FREQUENCY_MAX_HZ,
                                 PHANTOM_EFFECT_FORCE_MAX_UN, PHANTOM_IMPACT_FREQUENCY_MAX_HZ,
                                 PHANTOM_IMPACT_DECAY_MAX_US}
                : phantom_impact{5000, 1'000'000, 150, 15'000};
}

/// A chessboard along x, full of slope, or gentle bumps.
void append_map(Table& to, bool most)
{
    const phantom_height_map map{8, 4, most ? 0xffffffffU : 300'000, most ? 0x7fffffffU : 40'000};
    append(to, map);
    for (std::uint32_t i = 0; i < map.columns * map.rows; ++i) {
        const auto height = std::int32_t(map.amplitude_nm);
        append(to, i % 2 ? height : most ? -height : 0);
    }
}

/// Thrice 3 x 3 nodes round the origin: the middle pulls.
void append_field(Table& to, bool most, const __s64 (&origin_nm)[3])
{
    phantom_field field{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        field.spacing_nm[axis] = most ? 1'000'000 : 4'000'000;
        field.nodes[axis] = 3;
        field.corner_nm[axis] = std::clamp<std::int64_t>(origin_nm[axis] - field.spacing_nm[axis],
                                                         -PHANTOM_POSITION_MAX_NM, PHANTOM_POSITION_MAX_NM);
    }
    field.border_nm = most ? PHANTOM_BORDER_MIN_NM : 2'000'000;
    append(to, field);
    for (int node = 0; node < 27; ++node)
        for (int part = 0; part < 3; ++part)
            append(to, std::int32_t(node != 13 ? 0 : most ? PHANTOM_EFFECT_FORCE_MAX_UN : 200'000));
    append(to, std::int32_t(0));
}

bool has(std::uint8_t feel, std::uint8_t bits)
{
    return (feel & bits) == bits;
}

} // namespace

std::uint32_t surface_effects(std::uint8_t feel, std::uint32_t radius_nm)
{
    return (feel & magnet_bit && radius_nm > 1 ? PHANTOM_EFFECT_MAGNET : 0) |
           (feel & friction_bit ? PHANTOM_EFFECT_FRICTION : 0) |
           (feel & texture_bit ? PHANTOM_EFFECT_TEXTURE : 0) |
           (has(feel, friction_bit | texture_bit) ? PHANTOM_EFFECT_HEIGHT_MAP : 0) |
           (has(feel, magnet_bit | friction_bit) ? PHANTOM_EFFECT_IMPACT : 0);
}

std::uint32_t space_effects(std::uint8_t feel)
{
    return (feel & constant_bit ? PHANTOM_EFFECT_CONSTANT : 0) |
           (feel & viscosity_bit ? PHANTOM_EFFECT_VISCOSITY : 0) |
           (feel & guide_bit ? PHANTOM_EFFECT_GUIDE : 0) |
           (has(feel, constant_bit | viscosity_bit) ? PHANTOM_EFFECT_FIELD : 0) |
           (has(feel, viscosity_bit | guide_bit) ? PHANTOM_EFFECT_TIP : 0);
}

std::vector<std::uint8_t> effect_tables(const std::vector<phantom_material>& materials,
                                        const std::vector<std::uint8_t>& feels, const __s64 (&origin_nm)[3])
{
    Table out;
    std::uint32_t space = 0;
    const auto each = [&](std::uint32_t effect, auto&& entry) {
        for (std::size_t i = 0; i < materials.size(); ++i)
            if (materials[i].effects & effect)
                append(out, entry(feels[i] & most_bit, materials[i].radius_nm));
    };
    each(PHANTOM_EFFECT_MAGNET, magnet);
    each(PHANTOM_EFFECT_FRICTION, [](bool most, std::uint32_t) { return friction(most); });
    each(PHANTOM_EFFECT_TEXTURE, [](bool most, std::uint32_t) { return texture(most); });
    for (std::size_t i = 0; i < materials.size(); ++i)
        if (materials[i].effects & PHANTOM_EFFECT_HEIGHT_MAP)
            append_map(out, feels[i] & most_bit);
    each(PHANTOM_EFFECT_IMPACT, [](bool most, std::uint32_t) { return impact(most); });
    bool most = false;
    for (const std::uint8_t feel : feels) {
        space |= space_effects(feel);
        most |= feel & most_bit;
    }
    if (space & PHANTOM_EFFECT_CONSTANT)
        append(out, constant(most));
    if (space & PHANTOM_EFFECT_VISCOSITY) {
        append(out, phantom_effect_count{1, 0});
        append(out, viscosity(most, origin_nm));
    }
    if (space & PHANTOM_EFFECT_GUIDE) {
        append(out, phantom_effect_count{1, 0});
        append(out, guide(most, origin_nm));
    }
    if (space & PHANTOM_EFFECT_FIELD)
        append_field(out, most, origin_nm);
    if (space & PHANTOM_EFFECT_TIP)
        append(out, phantom_tip{std::uint32_t(most ? PHANTOM_TIP_RADIUS_MAX_NM : 1'000'000), 0});
    return out;
}

} // namespace phantom::fuzz
