// SPDX-License-Identifier: GPL-2.0-or-later
// What each effect costs a tick of 64 patches, alone and all together, and how long its table is. By itself
// in ns, the median of many batches; under callgrind in instructions (tools/tick-instructions reads them). No
// test.
#include <chrono>
#include <cstdio>
#include <cstdlib>
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
    out.viscosity = feel.viscosity.data();
    out.viscosity_count = std::uint32_t(feel.viscosity.size());
    out.guide = feel.guides.data();
    out.guide_count = std::uint32_t(feel.guides.size());
    out.mask |=
        (out.viscosity_count ? PHANTOM_EFFECT_VISCOSITY : 0) | (out.guide_count ? PHANTOM_EFFECT_GUIDE : 0);
    return out;
}

class Bench {
  public:
    Bench(const phantom_float_ops& ops, const Feel& feel, bool damped) : ops_(&ops)
    {
        static const std::vector<phantom_patch> patches = sheet();
        const phantom_effects effects = tables_of(feel);
        phantom_material material{};
        material.stiffness_mn_mm = 1000;
        material.radius_nm = 2'000'000;
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
        job_.model = {PHANTOM_MODEL_PROJECTED, 2,        PHANTOM_COMBINE_BOUNDED, PHANTOM_PROXY_CONSTRAINED,
                      ops.integer ? 1u : 0u,   {0, 0, 0}};
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

void measure(const char* name, const Feel& feel, bool damped = false)
{
    if (!COUNTING)
        std::printf("%-10s", name);
    for (const phantom_float_ops* const* ops = phantom_um_sections(); *ops; ++ops) {
        Bench bench(**ops, feel, damped);
        for (int i = 0; i < ticks; ++i)
            bench.tick(i);
        if (COUNTING) {
            const std::string label =
                std::to_string(ticks) + " / " + name + " / " + (*ops)->name + " / projected/2";
            CALLGRIND_ZERO_STATS;
            for (int i = 0; i < ticks; ++i)
                bench.tick(i);
            CALLGRIND_DUMP_STATS_AT(label.c_str());
            continue;
        }
        std::vector<double> ns;
        for (int batch = 0; batch < 400; ++batch) {
            const auto begin = std::chrono::steady_clock::now();
            for (int i = 0; i < ticks; ++i)
                bench.tick(i);
            const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - begin;
            ns.push_back(took.count() / ticks);
        }
        std::nth_element(ns.begin(), ns.begin() + 200, ns.end());
        std::printf("  %s %5.0f ns %4zu B", (*ops)->name, ns[200], bench.bytes);
    }
    if (!COUNTING)
        std::printf("\n");
}

} // namespace
} // namespace phantom::test

int main()
{
    using namespace phantom::test;
    Feel all{
        .magnet = phantom_magnet{200'000, 100'000},
        .friction = friction(0.6, 0.4, 2, 20),
        .texture = phantom_texture{{50'000, 20'000}, {{1'000'000, 0, 0}, {0, 900'000, 0}}},
        .constant = phantom_constant{{100'000, 0, -200'000}, 0},
        .viscosity = {{{0, 0, 0}, 20'000'000, 2'000'000, 2000, 300}},
        .guides = {{{0, 0, 0}, {PHANTOM_Q30_ONE, 0, 0}, PHANTOM_GUIDE_LINE, 50, 200'000, 30'000'000, 0}}};
    measure("contact", {});
    measure("damping", {}, true);
    measure("magnet", {.magnet = all.magnet});
    measure("friction", {.friction = all.friction});
    measure("texture", {.texture = all.texture});
    measure("constant", {.constant = all.constant});
    measure("viscosity", {.viscosity = all.viscosity});
    measure("guide", {.guides = all.guides});
    measure("all", all, true);
    return 0;
}
