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

} // namespace

std::uint32_t surface_effects(std::uint8_t feel, std::uint32_t radius_nm)
{
    return (feel & magnet_bit && radius_nm > 1 ? PHANTOM_EFFECT_MAGNET : 0) |
           (feel & friction_bit ? PHANTOM_EFFECT_FRICTION : 0) |
           (feel & texture_bit ? PHANTOM_EFFECT_TEXTURE : 0);
}

std::uint32_t space_effects(std::uint8_t feel)
{
    return (feel & constant_bit ? PHANTOM_EFFECT_CONSTANT : 0) |
           (feel & viscosity_bit ? PHANTOM_EFFECT_VISCOSITY : 0) |
           (feel & guide_bit ? PHANTOM_EFFECT_GUIDE : 0);
}

std::vector<std::uint8_t> effect_tables(const std::vector<phantom_material>& materials,
                                        const std::vector<std::uint8_t>& feels, const __s64 (&origin_nm)[3])
{
    Table out;
    std::uint8_t space = 0;
    const auto each = [&](std::uint32_t effect, auto&& entry) {
        for (std::size_t i = 0; i < materials.size(); ++i)
            if (materials[i].effects & effect)
                append(out, entry(feels[i] & most_bit, materials[i].radius_nm));
    };
    each(PHANTOM_EFFECT_MAGNET, magnet);
    each(PHANTOM_EFFECT_FRICTION, [](bool most, std::uint32_t) { return friction(most); });
    each(PHANTOM_EFFECT_TEXTURE, [](bool most, std::uint32_t) { return texture(most); });
    for (const std::uint8_t feel : feels)
        space |= feel;
    const bool most = space & most_bit;
    if (space & constant_bit)
        append(out, constant(most));
    if (space & viscosity_bit) {
        append(out, phantom_effect_count{1, 0});
        append(out, viscosity(most, origin_nm));
    }
    if (space & guide_bit) {
        append(out, phantom_effect_count{1, 0});
        append(out, guide(most, origin_nm));
    }
    return out;
}

} // namespace phantom::fuzz
