// SPDX-License-Identifier: GPL-2.0-or-later
// Every exchange of sets of whole traces: real queries and the module on its virtual clock; at each swap the
// float section is evaluated on the old and on the new set from the same state. Where both cover what contact
// needs, the force is the same but for rounding.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "base/vector.hpp"
#include "device/device.hpp"
#include "feeder/feeder.hpp"
#include "feeder/path.hpp"
#include "feeder/servo_choice.hpp"
#include "phantom_float.h"
#include "phantom_usermode.h"
#include "scene/scene.hpp"
#include "study/penetration_surface.hpp"
#include "study/stroke.hpp"

namespace phantom::test {
namespace {

const std::filesystem::path root = PHANTOM_ROOT;

void check(const Status& status)
{
    if (!status)
        throw std::runtime_error(status.error().text());
}

/// A set as the float section has it, prepared as SUBMIT_SET does.
class FloatSet {
  public:
    FloatSet(const phantom_float_ops& ops, const device::PatchSet& set) : header(set.header)
    {
        for (const phantom_material& material : set.materials)
            reach_nm = std::max(reach_nm, material.radius_nm);
        memory_.reset(std::aligned_alloc(PHANTOM_FLOAT_SET_ALIGN, ops.set_bytes(header.patch_count)));
        phantom_float_prepare prepare{};
        prepare.set = static_cast<phantom_float_set*>(memory_.get());
        prepare.patches = set.patches.data();
        prepare.materials = set.materials.data();
        prepare.patch_count = header.patch_count;
        const auto count = [&set](std::uint32_t kind) {
            return static_cast<std::uint32_t>(
                std::count_if(set.patches.begin(), set.patches.end(),
                              [kind](const phantom_patch& patch) { return patch.kind == kind; }));
        };
        prepare.face_count = count(PHANTOM_PATCH_FACE);
        prepare.rim_count = count(PHANTOM_PATCH_RIM);
        prepare.material_count = header.material_count;
        do {
            prepare.count =
                std::min<std::uint32_t>(PHANTOM_FLOAT_PREPARE_MAX, header.patch_count - prepare.first);
            ops.prepare(&prepare);
            prepare.first += prepare.count;
        } while (prepare.first < header.patch_count);
    }

    [[nodiscard]] phantom_float_set* floats() const { return static_cast<phantom_float_set*>(memory_.get()); }
    [[nodiscard]] bool covers(const __s64 (&point_nm)[3], double ball_nm) const
    {
        double square = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const auto away = static_cast<double>(point_nm[axis] - header.origin_nm[axis]) -
                              static_cast<double>(header.centre_nm[axis]);
            square += away * away;
        }
        return std::sqrt(square) + ball_nm <= header.radius_nm;
    }

    phantom_set header;
    std::uint32_t reach_nm = 0;

  private:
    struct Free {
        void operator()(void* p) const { std::free(p); } // NOLINT: from std::aligned_alloc
    };
    std::unique_ptr<void, Free> memory_;
};

/// What a tick begins with and what comes out, in world coordinates.
struct State {
    __s64 tip_nm[3]{}, previous_nm[3]{}, proxy_nm[3]{};
    bool inside = false;
};

struct Outcome {
    bool inside = false;
    Vec3 force{}, proxy{};
    std::uint32_t contacts = 0;
};

Outcome evaluate(const phantom_float_ops& ops, const phantom_model& model, const FloatSet& set,
                 const State& state)
{
    phantom_float_job job{};
    const auto relative = [&set](const __s64(&from)[3], s32(&to)[3]) {
        for (int axis = 0; axis < 3; ++axis)
            to[axis] = static_cast<s32>(from[axis] - set.header.origin_nm[axis]);
    };
    job.set = set.floats();
    job.model = model;
    relative(state.tip_nm, job.tip_nm);
    relative(state.previous_nm, job.previous_nm);
    relative(state.proxy_nm, job.proxy_nm);
    std::copy_n(set.header.centre_nm, 3, job.centre_nm);
    job.radius_nm = set.header.radius_nm;
    job.path_valid = 1;
    job.inside = state.inside;
    job.proxy_face = PHANTOM_PATCH_NONE; // V tells the face
    while (ops.tick(&job)) {
    }
    Outcome out;
    out.inside = job.inside != 0;
    out.contacts = job.contacts;
    for (int axis = 0; axis < 3; ++axis) {
        out.force[axis] = 1e-6 * job.force_un[axis];
        out.proxy[axis] = 1e-6 * static_cast<double>(set.header.origin_nm[axis] + job.proxy_nm[axis]);
    }
    return out;
}

/// Keeps the sets that are submitted.
class Listener : public device::Device::Listener {
  public:
    void started(const phantom_start& /*start*/, std::uint64_t /*start_ns*/) override {}
    void submitting(const device::PatchSet& set) override { last = set; }
    device::PatchSet last;
};

/// What a whole trace's swaps did.
struct Swaps {
    unsigned all = 0, covered = 0, in_contact = 0, inside = 0;
    double shell_max_n = 0, inside_max_n = 0; ///< largest difference of force
    unsigned sides = 0;                       ///< inside on one set and outside on the other
    double machine_max_n = 0;                 ///< the machine's own force from the one evaluated here
};

class Trace {
  public:
    Trace(const scene::Scene& scene, std::uint32_t rate_hz)
        : scene_(scene), tree_(scene::build_tree<14>(scene))
    {
        device::UsermodeOptions options;
        options.virtual_clock = true;
        options.rate_hz = rate_hz;
        Result<device::Device> device = device::Device::open_usermode(options);
        if (!device)
            throw std::runtime_error(device.error().text());
        device_.emplace(std::move(*device));
        const Result<phantom_model> model = feeder::choose_model({}, scene.servo, device_->info().features);
        if (!model)
            throw std::runtime_error(model.error().text());
        model_ = *model;
        check(device_->set_model(model_));
        device_->listen(&listener_);
        feeder_.emplace(scene_, tree_, *device_, feeder::FeederOptions{});
    }

    Swaps run(const feeder::Path& path, unsigned feed_every)
    {
        for (std::size_t i = 0; i < path.size(); ++i) {
            if (i % feed_every == 0)
                feed(path[i].tip_mm);
            check(device_->move_simulated_tip(feeder::to_nanometres(path[i].tip_mm)));
            if (i == 0)
                begin();
            check(device_->step(1));
            const auto ticks = device_->read_ticks();
            if (!ticks || ticks->size() != 1)
                throw std::runtime_error("expected one record a tick");
            take(ticks->front(), i);
        }
        return swaps_;
    }

    [[nodiscard]] const fdh::SceneTree<14>& tree() const { return tree_; }

  private:
    void begin()
    {
        phantom_start start{};
        start.flags = PHANTOM_START_LIMITS_OFF;
        check(device_->start(start));
    }
    void feed(const Vec3& tip)
    {
        Vec3 proxy = tip;
        if (state_.inside)
            for (int axis = 0; axis < 3; ++axis)
                proxy[axis] = 1e-6 * static_cast<double>(state_.proxy_nm[axis]);
        const Result<feeder::FeedReport> report = feeder_->feed(tip, proxy, state_.inside);
        if (!report || report->set_id == 0)
            throw std::runtime_error("a set was not taken");
        next_ = std::make_unique<FloatSet>(ops_, listener_.last);
    }
    void take(const phantom_tick& tick, std::size_t index)
    {
        std::copy_n(tick.tip_nm, 3, state_.tip_nm);
        if (!state_.inside)
            std::copy_n(tick.tip_nm, 3, state_.proxy_nm);
        if (next_) {
            if (now_ && index > 0)
                compare(tick);
            now_ = std::move(next_);
        }
        std::copy_n(tick.tip_nm, 3, state_.previous_nm);
        std::copy_n(tick.proxy_nm, 3, state_.proxy_nm);
        state_.inside = (tick.flags & PHANTOM_TICK_INSIDE) != 0;
    }
    [[nodiscard]] bool covered(const FloatSet& set) const
    {
        if (!set.covers(state_.previous_nm, 0))
            return false;
        return state_.inside ? set.covers(state_.tip_nm, 0) && set.covers(state_.proxy_nm, 0)
                             : set.covers(state_.tip_nm, set.reach_nm);
    }
    void compare(const phantom_tick& tick)
    {
        ++swaps_.all;
        if (!covered(*now_) || !covered(*next_))
            return;
        ++swaps_.covered;
        const Outcome before = evaluate(ops_, model_, *now_, state_);
        const Outcome after = evaluate(ops_, model_, *next_, state_);
        const double apart = length(after.force - before.force);
        swaps_.in_contact += after.contacts > 0;
        swaps_.inside += after.inside;
        swaps_.sides += after.inside != before.inside;
        double& most = after.inside ? swaps_.inside_max_n : swaps_.shell_max_n;
        most = std::max(most, apart);
        if ((tick.flags & PHANTOM_TICK_FADING) == 0) {
            const Vec3 force{1e-6 * tick.force_un[0], 1e-6 * tick.force_un[1], 1e-6 * tick.force_un[2]};
            swaps_.machine_max_n = std::max(swaps_.machine_max_n, length(force - after.force));
        }
    }

    const scene::Scene& scene_;
    const phantom_float_ops& ops_ = *phantom_um_sections()[0];
    fdh::SceneTree<14> tree_;
    std::optional<device::Device> device_;
    std::optional<feeder::Feeder> feeder_;
    phantom_model model_{};
    Listener listener_;
    std::unique_ptr<FloatSet> now_, next_;
    State state_;
    Swaps swaps_;
};

scene::Scene load(const char* file)
{
    Result<scene::Scene> scene = scene::load(root / "scenes" / file, {});
    if (!scene)
        throw std::runtime_error(scene.error().text());
    return std::move(*scene);
}

/// With the demo's path: over the surface in sweeps, pressing in now and then.
Swaps stroke(const scene::Scene& scene, unsigned feed_every)
{
    Trace trace(scene, 1000);
    const Result<feeder::Path> path = study::make_stroke(
        scene, trace.tree(),
        {.seconds = 1.5, .rate_hz = 1000, .depth_mm = 0.5 * scene.max_radius_mm(), .speed_limit_mm_s = 400});
    if (!path)
        throw std::runtime_error(path.error().text());
    return trace.run(*path, feed_every);
}

/// Vertices of a set are whole nm in the world, so seen from the tip every set gives a triangle the same
/// bits. What may differ is how wide the walls between shells are soft (by the largest triangle of the set),
/// some nm to either side of a wall: there two neighbours share a force that each finds to a few units in
/// the last place of float32. Rounding to uN comes on top.
double rounding_n(const scene::Scene& scene)
{
    double most = 0;
    for (const scene::Material& material : scene.materials)
        most = std::max(most, material.stiffness_n_mm * material.radius_mm);
    return 1e-5 * most + 2e-6;
}

void expect_rounding_only(const scene::Scene& scene, const Swaps& swaps)
{
    EXPECT_GT(swaps.all, 300U);
    EXPECT_EQ(swaps.covered, swaps.all) << "the feeder covers the way to the next set";
    EXPECT_GT(swaps.in_contact, swaps.all / 3);
    EXPECT_GT(swaps.inside, swaps.all / 20);
    EXPECT_LE(swaps.shell_max_n, rounding_n(scene));
    EXPECT_LE(swaps.inside_max_n, rounding_n(scene));
    EXPECT_EQ(swaps.sides, 0U);
    EXPECT_LE(swaps.machine_max_n, rounding_n(scene)) << "what was sent is what was evaluated here";
}

class Swap : public ::testing::TestWithParam<unsigned> {};

TEST_P(Swap, OfTheSpheresStrokeChangesTheForceByRounding)
{
    const scene::Scene scene = load("sphere.toml");
    expect_rounding_only(scene, stroke(scene, GetParam()));
}

TEST_P(Swap, OfTheBoxsStrokeChangesTheForceByRounding)
{
    const scene::Scene scene = load("box.toml");
    expect_rounding_only(scene, stroke(scene, GetParam()));
}

TEST_P(Swap, OfTheDemosStrokeChangesTheForceByRounding)
{
    if (!std::filesystem::exists("/usr/share/glmark2/models/bunny.obj"))
        GTEST_SKIP() << "the bunny is not installed";
    const scene::Scene scene = load("bunny.toml");
    expect_rounding_only(scene, stroke(scene, GetParam()));
}

TEST_P(Swap, UnderABumpySphereChangesTheForceByRounding)
{
    const auto surface = study::PenetrationSurface::build({50});
    ASSERT_TRUE(surface);
    const scene::Scene& scene = surface->scene();
    Trace trace(scene, 1000);
    expect_rounding_only(
        scene, trace.run(study::spiral_path({.seconds = 1.5, .lift_s = 0.75, .lifting_s = 0.1}), GetParam()));
}

INSTANTIATE_TEST_SUITE_P(TicksPerSet, Swap, ::testing::Values(1U, 4U));

/// The worst place for a swap: a tip on the wall between two shells, over an edge or a vertex. 64 triangles
/// round the tip against 256 round a place beside it.
void expect_rounding_only_on_walls(const scene::Scene& scene)
{
    const phantom_float_ops& ops = *phantom_um_sections()[0];
    const phantom_model model{PHANTOM_MODEL_PROJECTED,   2, PHANTOM_COMBINE_BOUNDED,
                              PHANTOM_PROXY_CONSTRAINED, 0, {}};
    const fdh::SceneTree<14> tree = scene::build_tree<14>(scene);
    feeder::SetBuilder builder(scene);
    const mesh::Mesh& mesh = scene.objects[0].mesh;
    const double radius = scene.max_radius_mm();
    std::mt19937 random(6);
    std::uniform_real_distribution<double> any(0, 1);
    const auto set_round = [&](const Vec3& centre, std::size_t count) {
        fdh::Nearest nearest;
        device::PatchSet set;
        tree.nearest(centre, count, 50, nearest);
        nearest.sort();
        builder.build(nearest, centre, set);
        set.header.patch_count = static_cast<std::uint32_t>(set.patches.size());
        set.header.material_count = static_cast<std::uint32_t>(set.materials.size());
        return FloatSet(ops, set);
    };
    unsigned compared = 0;
    for (unsigned i = 0; i < 600; ++i) {
        const auto face = static_cast<std::size_t>(any(random) * static_cast<double>(mesh.faces.size()));
        const double along = i % 3 ? any(random) : 0.0, height = radius * any(random);
        const auto over = [&](int corner) {
            return mesh.vertices[mesh.faces[face][corner]] +
                   height * mesh.normals[mesh.face_normals[face][corner]];
        };
        const Vec3 tip = (1 - along) * over(0) + along * over(1);
        const Vec3 aside{any(random) - 0.5, any(random) - 0.5, any(random) - 0.5};
        State state;
        const auto nm = feeder::to_nanometres(tip);
        for (int axis = 0; axis < 3; ++axis)
            state.tip_nm[axis] = state.previous_nm[axis] = state.proxy_nm[axis] = nm[axis];
        const FloatSet here = set_round(tip, 64), there = set_round(tip + 0.3 * radius * aside, 256);
        if (!here.covers(state.tip_nm, here.reach_nm) || !there.covers(state.tip_nm, there.reach_nm))
            continue;
        ++compared;
        const Outcome a = evaluate(ops, model, here, state), b = evaluate(ops, model, there, state);
        EXPECT_GT(a.contacts, 0U);
        EXPECT_LE(length(a.force - b.force), rounding_n(scene)) << "place " << i;
    }
    EXPECT_GT(compared, 300U);
}

TEST(SwapOnAWall, ChangesTheForceByRounding)
{
    expect_rounding_only_on_walls(load("sphere.toml"));
    expect_rounding_only_on_walls(load("box.toml"));
    expect_rounding_only_on_walls(load("bunny.toml"));
}

} // namespace
} // namespace phantom::test
