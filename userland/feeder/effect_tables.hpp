// SPDX-License-Identifier: GPL-2.0-or-later
// Materials and effects as the module takes them: made once, copied into every set. Of the feeder's thread.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "device/device.hpp"
#include "scene/scene.hpp"

namespace phantom::feeder {

class EffectTables {
  public:
    /// Of the scene as it is now.
    explicit EffectTables(const scene::Scene& scene);

    /// As many materials, by the same numbers. Stiffness and damping go there within the next ramp_rounds
    /// rounds; for the rest the servo has a fade (phantom_abi.h, EFFECTS).
    void change(std::vector<scene::Material> materials, std::vector<scene::SpaceEffect> effects);
    /// Once before each round's set.
    void begin_round();

    [[nodiscard]] const phantom_material& material(std::uint32_t material) const
    {
        return surfaces_[material].contact;
    }
    /// Tables of a set of these materials, in the order of the effects' bits, and its effects of space.
    void fill(std::span<const std::uint32_t> materials, device::PatchSet& out);

    /// 0.1 s at 250 sets a second.
    static constexpr std::uint32_t ramp_rounds = 25;

  private:
    /// A material, and each of its effects' tables.
    struct Surface {
        phantom_material contact{};
        std::vector<std::uint64_t> magnet, friction, texture, height_map, impact;
    };
    struct Ramp {
        double from = 0, to = 0; ///< mN/mm, mN s/m
        [[nodiscard]] double at(std::uint32_t round) const
        {
            return from + (to - from) * round / ramp_rounds;
        }
    };
    void make_surfaces();
    /// Places beyond what a set can name stand at its border, or are left out: see effect_tables.cpp.
    void make_space(const std::array<std::int64_t, 3>& origin_nm);
    void store_ramp();

    std::vector<scene::Material> materials_;
    std::vector<scene::SpaceEffect> effects_;
    std::vector<Surface> surfaces_;
    std::vector<Ramp> stiffness_, damping_;
    std::uint32_t round_ = ramp_rounds; ///< of the ramp
    std::uint32_t space_mask_ = 0;      ///< PHANTOM_EFFECT_...
    std::vector<std::uint64_t> space_;
    std::array<std::int64_t, 3> space_origin_nm_{}; ///< that space_ was made for
    bool space_made_ = false;
};

} // namespace phantom::feeder
