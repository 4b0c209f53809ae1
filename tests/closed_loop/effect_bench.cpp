// SPDX-License-Identifier: GPL-2.0-or-later
// What each effect costs a tick of 64 patches, alone and all together, and how many bytes it takes in the
// set. By itself in ns, the median of many batches; under callgrind in instructions (tools/tick-instructions
// reads them).
//
//   effect_bench             a tick of each effect
//   effect_bench contact     a tick of contact alone, also by sections that know no effect
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <memory>
#include <string>

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#define COUNTING (RUNNING_ON_VALGRIND != 0)
#else
#define COUNTING false
#define CALLGRIND_ZERO_STATS
#define CALLGRIND_DUMP_STATS_AT(name) (void)(name)
#endif

#include "effects.hpp"

extern "C" {
#include "phantom_float.h"
extern const phantom_float_ops phantom_bare_sse2, phantom_bare_avx2;
}

namespace phantom::test {
namespace {

/// 8 x 4 squares of 1 mm, two faces each, in the plane z = 0.
std::vector<phantom_patch> sheet()
{
    constexpr std::int32_t mm = 1'000'000;
    std::vector<phantom_patch> out;
    for (std::int32_t i = 0; i < 64; ++i) {
        const std::int32_t x = (i / 2 % 8 - 4) * mm, y = (i / 16 - 2) * mm, half = i % 2;
        const std::int32_t corner[2][3][2] = {{{0, 0}, {mm, 0}, {mm, mm}}, {{0, 0}, {mm, mm}, {0, mm}}};
        phantom_patch patch{};
        for (int c = 0; c < 3; ++c) {
            patch.vertex_nm[c][0] = x + corner[half][c][0];
            patch.vertex_nm[c][1] = y + corner[half][c][1];
            patch.normal_q30[c][2] = PHANTOM_Q30_ONE;
            patch.vertex[c] =
                std::uint32_t((patch.vertex_nm[c][1] / mm + 2) * 9 + patch.vertex_nm[c][0] / mm);
            patch.neighbour[c] = PHANTOM_PATCH_NONE;
        }
        patch.face = std::uint32_t(i);
        out.push_back(patch);
    }
    return out;
}

/// A table with what follows it, kept as long as the program runs.
template <class Header, class T>
const std::vector<std::uint64_t>& kept(const Header& header, const std::vector<T>& entries)
{
    static std::deque<std::vector<std::uint64_t>> tables;
    tables.emplace_back((sizeof(Header) + entries.size() * sizeof(T) + 7) / 8);
    std::memcpy(tables.back().data(), &header, sizeof(Header));
    std::memcpy(reinterpret_cast<char*>(tables.back().data()) + sizeof(Header), entries.data(),
                entries.size() * sizeof(T));
    return tables.back();
}

/// What SUBMIT_SET makes of a feel with one material.
phantom_effects tables_of(const Feel& feel)
{
    phantom_effects out{};
    const auto take = [&](std::uint32_t effect, const auto& from, auto& to) {
        if (!from)
            return;
        out.mask |= effect;
        to = &*from;
    };
    take(PHANTOM_EFFECT_MAGNET, feel.magnet, out.magnet);
    take(PHANTOM_EFFECT_FRICTION, feel.friction, out.friction);
    take(PHANTOM_EFFECT_TEXTURE, feel.texture, out.texture);
    take(PHANTOM_EFFECT_IMPACT, feel.impact, out.impact);
    take(PHANTOM_EFFECT_CONSTANT, feel.constant, out.constant);
    if (feel.height_map) {
        out.mask |= PHANTOM_EFFECT_HEIGHT_MAP;
        out.height_map[0] = reinterpret_cast<const phantom_height_map*>(
            kept(feel.height_map->header, feel.height_map->height_nm).data());
    }
    if (feel.field) {
        out.mask |= PHANTOM_EFFECT_FIELD;
        out.field =
            reinterpret_cast<const phantom_field*>(kept(feel.field->header, feel.field->force_un).data());
    }
    out.viscosity = feel.viscosity.data();
    out.viscosity_count = std::uint32_t(feel.viscosity.size());
    out.guide = feel.guides.data();
    out.guide_count = std::uint32_t(feel.guides.size());
    out.mask |=
        (out.viscosity_count ? PHANTOM_EFFECT_VISCOSITY : 0) | (out.guide_count ? PHANTOM_EFFECT_GUIDE : 0);
    return out;
}

/// An impact that never ends: what a ring costs while there is one.
constexpr phantom_ring ringing{3'000'000, 10'000'000, 10'000'000, {0, 0, PHANTOM_Q30_ONE},
                               80,        20'000,     400'000,    100'000,
                               90'000,    10'000,     0};

class Bench {
  public:
    Bench(const phantom_float_ops& ops, std::uint32_t model, const Feel& feel, bool damped) : ops_(&ops)
    {
        static const std::vector<phantom_patch> patches = sheet();
        const phantom_effects effects = tables_of(feel);
        phantom_material material{};
        material.stiffness_mn_mm = 1000;
        material.radius_nm = 2'000'000 + (feel.tip ? feel.tip->radius_nm : 0);
        material.effects = (effects.mask & PHANTOM_EFFECTS_SURFACE) | (damped ? PHANTOM_EFFECT_DAMPING : 0);
        material.damping_mns_m = damped ? 500 : 0;
        bytes = effects.mask ? ops.effect_bytes(&effects, 1) : 0;
        const std::size_t room = ops.set_bytes(64) + (bytes + 63) / 64 * 64;
        memory_.reset(static_cast<phantom_float_set*>(std::aligned_alloc(PHANTOM_FLOAT_SET_ALIGN, room)));
        phantom_float_prepare prepare{};
        prepare.set = memory_.get();
        prepare.patches = patches.data();
        prepare.materials = &material;
        prepare.effects = effects.mask ? &effects : nullptr;
        prepare.patch_count = prepare.face_count = 64;
        prepare.material_count = 1;
        prepare.count = PHANTOM_FLOAT_PREPARE_MAX;
        for (; prepare.first < 64; prepare.first += prepare.count)
            ops.prepare(&prepare);
        job_.set = memory_.get();
        job_.model = {model,    2, PHANTOM_COMBINE_BOUNDED, PHANTOM_PROXY_CONSTRAINED, ops.integer ? 1u : 0u,
                      {0, 0, 0}};
        job_.effects = effects.mask | (damped ? PHANTOM_EFFECT_DAMPING : 0);
        job_.radius_nm = 2'000'000'000;
        job_.period_ns = 1'000'000;
        job_.proxy_face = PHANTOM_PATCH_NONE;
    }

    void tick(int i)
    {
        std::copy_n(job_.tip_nm, 3, job_.previous_nm);
        job_.tip_nm[0] = -2'345'678 + i * 37'000;
        job_.tip_nm[1] = 123'456 + i % 5 * 1000;
        job_.tip_nm[2] = 1'200'000 - i * 1000;
        job_.velocity_nm_s[0] = 37'000'000;
        job_.stick = job_.stick_next;
        job_.ring = ringing;
        while (ops_->tick(&job_))
            ;
        job_.path_valid = 1;
    }

    std::size_t bytes = 0;

  private:
    struct Free {
        void operator()(phantom_float_set* set) const { std::free(set); }
    };
    const phantom_float_ops* ops_;
    std::unique_ptr<phantom_float_set, Free> memory_;
    phantom_float_job job_{};
};

constexpr int ticks = 64;

struct Column {
    const char* name;
    std::uint32_t model;
};
constexpr Column columns[] = {{"paper", PHANTOM_MODEL_PAPER}, {"projected/2", PHANTOM_MODEL_PROJECTED}};

/// Of the tables, as they are submitted.
std::size_t sent_bytes(const Feel& feel)
{
    Plane plane(1);
    add_effects(plane, feel);
    return plane.tables.size() * sizeof(plane.tables[0]);
}

double median_ns(Bench& bench)
{
    std::vector<double> ns;
    for (int batch = 0; batch < 400; ++batch) {
        const auto begin = std::chrono::steady_clock::now();
        for (int i = 0; i < ticks; ++i)
            bench.tick(i);
        const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - begin;
        ns.push_back(took.count() / ticks);
    }
    std::nth_element(ns.begin(), ns.begin() + 200, ns.end());
    return ns[200];
}

void measure(const char* name, const phantom_float_ops& ops, const Feel& feel, bool damped)
{
    if (!COUNTING)
        std::printf("%-11s %-10s", name, ops.name);
    for (const Column& column : columns) {
        Bench bench(ops, column.model, feel, damped);
        for (int i = 0; i < ticks; ++i)
            bench.tick(i);
        if (!COUNTING) {
            std::printf("  %s %5.0f ns", column.name, median_ns(bench));
            if (&column == std::end(columns) - 1)
                std::printf("  %5zu B sent, %3zu B prepared\n", sent_bytes(feel), bench.bytes);
            continue;
        }
        const std::string label =
            std::to_string(ticks) + " / " + name + " / " + ops.name + " / " + column.name;
        CALLGRIND_ZERO_STATS;
        for (int i = 0; i < ticks; ++i)
            bench.tick(i);
        CALLGRIND_DUMP_STATS_AT(label.c_str());
    }
}

void measure(const char* name, const Feel& feel, bool damped = false)
{
    for (const phantom_float_ops* const* ops = phantom_um_sections(); *ops; ++ops)
        measure(name, **ops, feel, damped);
}

void measure_bare(const char* name)
{
    measure(name, phantom_bare_sse2, {}, false);
    if (__builtin_cpu_supports("avx2"))
        measure(name, phantom_bare_avx2, {}, false);
}

/// Everything there is.
Feel everything()
{
    HeightMap map{{64, 64, 200'000, 40'000}, std::vector<std::int32_t>(64 * 64)};
    for (std::size_t i = 0; i < map.height_nm.size(); ++i)
        map.height_nm[i] = std::int32_t(i * 7919 % 80'001) - 40'000;
    Field field{
        {{-8'000'000, -8'000'000, -8'000'000}, {1'000'000, 1'000'000, 1'000'000}, {16, 16, 16}, 2'000'000, 0},
        {}};
    for (std::int32_t i = 0; i < 4096; ++i)
        field.force_un.push_back({i % 16 * 1000, i / 16 % 16 * 1000, -1000});
    return {.magnet = phantom_magnet{200'000, 100'000},
            .friction = friction(0.6, 0.4, 2, 20),
            .texture = phantom_texture{{50'000, 20'000}, {{1'000'000, 0, 0}, {0, 900'000, 0}}},
            .height_map = map,
            .impact = phantom_impact{5000, 1'000'000, 80, 20'000},
            .constant = phantom_constant{{100'000, 0, -200'000}, 0},
            .viscosity = {{{0, 0, 0}, 20'000'000, 2'000'000, 2000, 300}},
            .guides = {{{0, 0, 0}, {PHANTOM_Q30_ONE, 0, 0}, PHANTOM_GUIDE_LINE, 50, 200'000, 30'000'000, 0}},
            .field = field,
            .tip = phantom_tip{500'000, 0}};
}

} // namespace
} // namespace phantom::test

int main(int argc, char** argv)
{
    using namespace phantom::test;
    const Feel all = everything();
    measure("contact", {});
    measure_bare("contact");
    if (argc > 1 && std::string(argv[1]) == "contact")
        return 0;
    measure("damping", {}, true);
    measure("magnet", {.magnet = all.magnet});
    measure("friction", {.friction = all.friction});
    measure("texture", {.texture = all.texture});
    measure("height map", {.height_map = all.height_map});
    measure("impact", {.impact = all.impact});
    measure("constant", {.constant = all.constant});
    measure("viscosity", {.viscosity = all.viscosity});
    measure("guide", {.guides = all.guides});
    measure("field", {.field = all.field});
    measure("tip", {.tip = all.tip});
    measure("all", all, true);
    return 0;
}
