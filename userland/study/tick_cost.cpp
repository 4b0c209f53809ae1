// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/tick_cost.hpp"

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <random>

#include <fmt/format.h>

#include "device/device.hpp"
#include "feeder/feeder.hpp"
#include "feeder/path.hpp"
#include "phantom_usermode.h"
#include "study/surface_point.hpp"

extern "C" {
#include "phantom_float.h"
}

namespace phantom::study {

namespace {

constexpr std::size_t sets = 64;
constexpr std::size_t tips_per_set = 128;

/// The tip moves this far between ticks: a hand at 50 mm/s, sampled at 1 kHz.
constexpr double tip_step_mm = 0.05;

/// nullptr: this processor has it not.
const phantom_float_ops* ops_of(std::uint32_t isa)
{
    for (const phantom_float_ops* const* at = phantom_um_sections(); *at; ++at)
        if ((*at)->isa == isa)
            return *at;
    return nullptr;
}

struct FreeSet {
    void operator()(phantom_float_set* set) const { std::free(set); }
};
using FloatSet = std::unique_ptr<phantom_float_set, FreeSet>;

FloatSet prepared(const phantom_float_ops& ops, const device::PatchSet& set, double& microseconds)
{
    const std::size_t bytes =
        (ops.set_bytes(static_cast<u32>(set.patches.size())) + PHANTOM_FLOAT_SET_ALIGN - 1) /
        PHANTOM_FLOAT_SET_ALIGN * PHANTOM_FLOAT_SET_ALIGN;
    FloatSet out(static_cast<phantom_float_set*>(std::aligned_alloc(PHANTOM_FLOAT_SET_ALIGN, bytes)));
    phantom_float_prepare piece{};
    piece.set = out.get();
    piece.patches = set.patches.data();
    piece.materials = set.materials.data();
    piece.patch_count = static_cast<u32>(set.patches.size());
    piece.material_count = static_cast<u32>(set.materials.size());
    const auto count = [&set](std::uint32_t kind) {
        return static_cast<u32>(std::count_if(set.patches.begin(), set.patches.end(),
                                              [kind](const phantom_patch& p) { return p.kind == kind; }));
    };
    piece.face_count = count(PHANTOM_PATCH_FACE);
    piece.rim_count = count(PHANTOM_PATCH_RIM);
    microseconds = 1e-3 * nanoseconds_of([&] {
                       do {
                           piece.count =
                               std::min<u32>(PHANTOM_FLOAT_PREPARE_MAX, piece.patch_count - piece.first);
                           ops.prepare(&piece);
                           piece.first += piece.count;
                       } while (piece.first < piece.patch_count);
                   });
    return out;
}

/// Times ops.tick() over the tips; adds to samples and contacts.
void time_float_ticks(const phantom_float_ops& ops, const phantom_model& model, const device::PatchSet& set,
                      const FloatSet& floats, const std::vector<Vec3>& tips, std::vector<double>& samples,
                      double& contacts)
{
    phantom_float_job job{};
    job.set = floats.get();
    job.model = model;
    job.proxy_face = PHANTOM_PATCH_NONE;
    std::copy_n(set.header.centre_nm, 3, job.centre_nm);
    job.radius_nm = set.header.radius_nm;
    for (const Vec3& tip : tips) {
        const std::array<std::int64_t, 3> tip_nm = feeder::to_nanometres(tip);
        for (int axis = 0; axis < 3; ++axis) {
            job.previous_nm[axis] = job.tip_nm[axis];
            job.tip_nm[axis] = static_cast<s32>(tip_nm[axis] - set.header.origin_nm[axis]);
        }
        samples.push_back(nanoseconds_of([&] {
            while (ops.tick(&job))
                ;
        }));
        contacts += job.contacts;
        job.path_valid = 1;
    }
}

/// Large faces one under the other, 10 um apart, their normals turned outward: a tip 1 mm over the
/// first is in contact with all of them.
device::PatchSet stacked_set(std::uint32_t count)
{
    device::PatchSet set;
    phantom_material material{};
    material.stiffness_mn_mm = 1000;
    material.radius_nm = 3'000'000;
    set.materials.push_back(material);
    for (std::uint32_t i = 0; i < count; ++i) {
        phantom_patch patch{};
        const std::array<Vec3, 3> corners{Vec3{2, 0, -0.01 * i}, Vec3{-1, 1.7, -0.01 * i},
                                          Vec3{-1, -1.7, -0.01 * i}};
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 normal = unit(Vec3{0.1 * corners[k][0], 0.1 * corners[k][1], 1.0});
            for (int axis = 0; axis < 3; ++axis) {
                patch.vertex_nm[k][axis] = static_cast<s32>(std::llround(corners[k][axis] * 1e6));
                patch.normal_q30[k][axis] = static_cast<s32>(std::llround(normal[axis] * PHANTOM_Q30_ONE));
            }
            patch.vertex[k] = 3 * i + static_cast<std::uint32_t>(k);
            patch.neighbour[k] = PHANTOM_PATCH_NONE;
        }
        patch.face = i;
        set.patches.push_back(patch);
    }
    set.header.radius_nm = 100'000'000;
    return set;
}

Distribution time_stacked(const phantom_float_ops& ops, const phantom_model& model, std::uint32_t count)
{
    const device::PatchSet set = stacked_set(count);
    double microseconds = 0, contacts = 0;
    const FloatSet floats = prepared(ops, set, microseconds);
    std::mt19937_64 random(3);
    std::vector<double> samples;
    for (std::size_t i = 0; i < sets; ++i)
        time_float_ticks(ops, model, set, floats, wander({0, 0, 1}, random), samples, contacts);
    return Distribution::of(std::move(samples));
}

} // namespace

std::vector<Vec3> wander(const Vec3& around, std::mt19937_64& random)
{
    std::normal_distribution<double> normal;
    std::vector<Vec3> tips;
    Vec3 tip = around;
    for (std::size_t i = 0; i < tips_per_set; ++i) {
        const Vec3 step = tip_step_mm * unit({normal(random), normal(random), normal(random)});
        // Back to where it came from every other time: it stays within the set.
        tip = i % 2 ? around : around + step;
        tips.push_back(tip);
    }
    return tips;
}

Status time_whole_ticks(device::Device& device, const std::vector<Vec3>& tips, std::vector<double>& samples)
{
    for (const Vec3& tip : tips) {
        if (Status status = device.move_simulated_tip(feeder::to_nanometres(tip)); !status)
            return status;
        Status stepped = success();
        samples.push_back(nanoseconds_of([&] { stepped = device.step(1); }));
        if (!stepped)
            return stepped;
    }
    return success();
}

std::vector<Vec3> points_near_surface(const scene::Scene& scene, std::size_t count, std::uint64_t seed)
{
    const fdh::SceneTree<14> no_tree;
    const Surface surface(scene, no_tree);
    std::mt19937_64 random(seed);
    std::uniform_int_distribution<std::uint64_t> pick(0, scene.triangles() - 1);
    std::vector<Vec3> points;
    while (points.size() < count) {
        std::uint64_t face = pick(random);
        std::uint32_t object = 0;
        while (face >= scene.objects[object].mesh.faces.size())
            face -= scene.objects[object++].mesh.faces.size();
        const SurfacePoint at =
            surface.on_face(object, static_cast<std::uint32_t>(face), {1 / 3.0, 1 / 3.0, 1 / 3.0});
        const double radius_mm =
            scene.materials[scene.objects[object].material_of(static_cast<std::uint32_t>(face))].radius_mm;
        points.push_back(at.position_mm + 0.5 * radius_mm * at.normal);
    }
    return points;
}

std::vector<std::uint32_t> tick_sections()
{
    std::vector<std::uint32_t> out;
    for (const phantom_float_ops* const* at = phantom_um_sections(); *at; ++at)
        if ((*at)->isa != PHANTOM_ISA_DOUBLE)
            out.push_back((*at)->isa);
    return out;
}

Result<device::Device> open_to_measure(phantom_model model, std::uint32_t isa)
{
    device::UsermodeOptions usermode;
    usermode.virtual_clock = true;
    usermode.isa = isa == PHANTOM_ISA_FIXED ? PHANTOM_ISA_NONE : isa;
    model.arith = isa == PHANTOM_ISA_FIXED ? PHANTOM_ARITH_FIXED : PHANTOM_ARITH_FLOAT;
    Result<device::Device> device = device::Device::open_usermode(usermode);
    if (!device)
        return device.error();
    if (Status status = device->set_model(model); !status)
        return status.error();
    return device;
}

Result<TickCost> measure_tick(const scene::Scene& scene, const fdh::SceneTree<14>& tree, phantom_model model,
                              std::uint32_t isa, std::uint32_t budget)
{
    const phantom_float_ops* const ops = ops_of(isa);
    if (!ops)
        return Error{"", fmt::format("this processor has no {}", device::isa_name(isa))};
    Result<device::Device> device = open_to_measure(model, isa);
    if (!device)
        return device.error();
    phantom_start start{};
    start.flags = PHANTOM_START_LIMITS_OFF;

    const feeder::FeederOptions search;
    feeder::SetBuilder builder(scene);
    device::PatchSet set;
    fdh::Nearest near;
    std::mt19937_64 random(2);
    std::vector<double> float_ns, tick_ns, prepare_us;
    TickCost cost;
    cost.isa = isa;
    bool started = false;
    for (const Vec3& point : points_near_surface(scene, sets, 1)) {
        near.clear();
        tree.nearest(point, budget, search.search_radius_mm, near);
        near.sort();
        builder.build(near, point, set);
        if (set.patches.empty())
            continue;
        cost.patches = std::max(cost.patches, static_cast<std::uint32_t>(set.patches.size()));
        double microseconds = 0;
        const FloatSet floats = prepared(*ops, set, microseconds);
        prepare_us.push_back(microseconds);
        const std::vector<Vec3> tips = wander(point, random);
        time_float_ticks(*ops, model, set, floats, tips, float_ns, cost.contacts);
        if (Result<bool> taken = device->try_submit(set); !taken)
            return taken.error();
        if (!started) {
            if (Status status = device->start(start); !status)
                return status.error();
            started = true;
        }
        if (Status status = time_whole_ticks(*device, tips, tick_ns); !status)
            return status.error();
    }
    cost.contacts /= std::max<std::size_t>(1, float_ns.size());
    cost.float_ns = Distribution::of(std::move(float_ns));
    cost.stacked_ns = time_stacked(*ops, model, cost.patches);
    cost.set_bytes = ops->set_bytes(cost.patches);
    cost.tick_ns = Distribution::of(std::move(tick_ns));
    cost.prepare_us = Distribution::of(std::move(prepare_us));
    return cost;
}

} // namespace phantom::study
