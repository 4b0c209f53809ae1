// SPDX-License-Identifier: GPL-2.0-or-later
// A plane with effects, and a tip that is led over it. Units of the tests of effects: mm, N, s.
#pragma once

#include <optional>

#include "machine.hpp"

namespace phantom::test {

using Place = std::array<double, 3>;

inline double dot(const Place& a, const Place& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline double length(const Place& a)
{
    return std::sqrt(dot(a, a));
}

inline Place minus(const Place& a, const Place& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// A height map and its samples, row by row.
struct HeightMap {
    phantom_height_map header{};
    std::vector<std::int32_t> height_nm{};
};

/// A force field and the forces at its nodes, x first.
struct Field {
    phantom_field header{};
    std::vector<std::array<std::int32_t, 3>> force_un{};
};

/// Parameters by effect; what is not there is not named. Surface effects go to the plane's first material.
struct Feel {
    std::uint32_t damping_mns_m = 0;
    std::optional<phantom_magnet> magnet{};
    std::optional<phantom_friction> friction{};
    std::optional<phantom_texture> texture{};
    std::optional<HeightMap> height_map{};
    std::optional<phantom_impact> impact{};
    std::optional<phantom_constant> constant{};
    std::vector<phantom_viscosity> viscosity{};
    std::vector<phantom_guide> guides{};
    std::optional<Field> field{};
    std::optional<phantom_tip> tip{};
};

template <class T>
void add_regions(Plane& plane, std::uint32_t effect, const std::vector<T>& entries)
{
    if (entries.empty())
        return;
    plane.header.effects |= effect;
    plane.add_table(phantom_effect_count{std::uint32_t(entries.size()), 0});
    for (const T& entry : entries)
        plane.add_table(entry);
}

/// Names the effects in the plane and lays their tables out, in the order of the bits.
inline void add_effects(Plane& plane, const Feel& feel)
{
    std::uint32_t named = 0;
    const auto add = [&](std::uint32_t effect, const auto& parameters) {
        if (!parameters)
            return;
        named |= effect;
        plane.add_table(*parameters);
    };
    if (feel.damping_mns_m) {
        named |= PHANTOM_EFFECT_DAMPING;
        plane.materials[0].damping_mns_m = feel.damping_mns_m;
    }
    add(PHANTOM_EFFECT_MAGNET, feel.magnet);
    add(PHANTOM_EFFECT_FRICTION, feel.friction);
    add(PHANTOM_EFFECT_TEXTURE, feel.texture);
    if (feel.height_map) {
        add(PHANTOM_EFFECT_HEIGHT_MAP, std::optional(feel.height_map->header));
        plane.add_integers(feel.height_map->height_nm.data(), feel.height_map->height_nm.size());
    }
    add(PHANTOM_EFFECT_IMPACT, feel.impact);
    if (named)
        plane.materials[0].effects |= named;
    add(PHANTOM_EFFECT_CONSTANT, feel.constant);
    add_regions(plane, PHANTOM_EFFECT_VISCOSITY, feel.viscosity);
    add_regions(plane, PHANTOM_EFFECT_GUIDE, feel.guides);
    if (feel.field) {
        add(PHANTOM_EFFECT_FIELD, std::optional(feel.field->header));
        if (!feel.field->force_un.empty())
            plane.add_integers(feel.field->force_un[0].data(), 3 * feel.field->force_un.size());
    }
    add(PHANTOM_EFFECT_TIP, feel.tip);
    plane.header.effects |= named;
}

inline phantom_friction friction(double statical, double dynamic, double stiffness_n_mm,
                                 double stribeck_mm_s = 0)
{
    return {std::uint32_t(std::lround(statical * 1e6)), std::uint32_t(std::lround(dynamic * 1e6)),
            std::uint32_t(std::lround(stiffness_n_mm * 1e3)),
            std::uint32_t(std::lround(stribeck_mm_s * 1e3))};
}

/// A machine on a virtual clock whose tip goes where it is told, a tick each time. k = 1 N/mm, R = 3 mm.
class EffectTest : public MachineTest {
  protected:
    void TearDown() override
    {
        feeder.reset();
        MachineTest::TearDown();
    }

    /// The plane z = 0, felt with these effects from now on; settled, limits off.
    void feel(const Feel& what, Place tip = {0, 0, 2}, Config config = {},
              std::uint32_t arith = PHANTOM_ARITH_FLOAT, std::array<std::int64_t, 3> origin = {0, 0, 0})
    {
        feeder.reset();
        if (arith == PHANTOM_ARITH_DOUBLE)
            config.isa = PHANTOM_ISA_DOUBLE;
        create(config);
        feeder.emplace(machine);
        phantom_model model{PHANTOM_MODEL_PROJECTED,   2,     PHANTOM_COMBINE_BOUNDED,
                            PHANTOM_PROXY_CONSTRAINED, arith, {0, 0, 0}};
        ASSERT_EQ(feeder->ioctl(PHANTOM_SET_MODEL, &model), 0);
        if (config.rate_hz) {
            ASSERT_EQ(feeder->rate(config.rate_hz), 0);
        }
        set_id = 0;
        submit(what, origin);
        place(tip);
        ASSERT_EQ(feeder->start_unlimited(), 0);
        step(30);
    }

    void submit(const Feel& what, std::array<std::int64_t, 3> origin = {0, 0, 0})
    {
        Plane plane(++set_id, 500'000'000, 450'000'000, origin);
        add_effects(plane, what);
        ASSERT_EQ(feeder->submit(plane), 0);
    }

    void place(const Place& tip)
    {
        feeder->move(std::llround(tip[0] * 1e6), std::llround(tip[1] * 1e6), std::llround(tip[2] * 1e6));
    }

    /// The force of the next tick, there.
    Place force(const Place& tip)
    {
        place(tip);
        step();
        const auto status = feeder->status();
        const auto& f = status.force_un;
        flags = status.flags;
        return {f[0] * 1e-6, f[1] * 1e-6, f[2] * 1e-6};
    }

    /// What the servo does to the tip on the way from..to in that many ticks, N mm, by the mean of the forces
    /// at both ends of each step; `last` keeps the force at the end.
    double work(const Place& from, const Place& to, int ticks)
    {
        double sum = 0;
        Place before = force(from), at = from;
        for (int i = 1; i <= ticks; ++i) {
            Place next;
            for (int axis = 0; axis < 3; ++axis)
                next[axis] = from[axis] + (to[axis] - from[axis]) * i / ticks;
            last = force(next);
            sum += 0.5 * (dot(before, minus(next, at)) + dot(last, minus(next, at)));
            before = last;
            at = next;
        }
        return sum;
    }

    std::optional<File> feeder;
    std::uint64_t set_id = 0;
    std::uint32_t flags = 0;
    Place last{};
};

} // namespace phantom::test
