// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/bench.hpp"

#include <algorithm>
#include <random>
#include <thread>

#include "feeder/path.hpp"
#include "study/surface_point.hpp"

namespace phantom::study {

namespace {

/// A walk moves by this part of the scene's diagonal between queries.
constexpr double walk_step_part = 5e-4;

/// Median of so many builds.
constexpr int builds = 5;

double build_mtri_s(const scene::Scene& scene, unsigned threads)
{
    std::vector<double> ns;
    ns.reserve(builds);
    for (int i = 0; i < builds; ++i)
        ns.push_back(nanoseconds_of([&] { (void)scene::build_tree<14>(scene, threads); }));
    return static_cast<double>(scene.triangles()) * 1e3 / Distribution::of(std::move(ns)).median;
}

/// Points along the surface, half a contact radius above it, one walk step apart: from face to neighbouring
/// face at random, to a new place where there is no neighbour.
std::vector<Vec3> walk_points(const scene::Scene& scene, std::size_t count)
{
    const fdh::SceneTree<14> no_tree;
    const Surface surface(scene, no_tree);
    const double step_mm = scene.bounds().diagonal() * walk_step_part;
    std::mt19937_64 random(3);
    const scene::Object& object =
        *std::max_element(scene.objects.begin(), scene.objects.end(), [](const auto& a, const auto& b) {
            return a.mesh.faces.size() < b.mesh.faces.size();
        });
    const auto number = static_cast<std::uint32_t>(&object - scene.objects.data());
    const double height_mm = 0.5 * scene.max_radius_mm(object);
    const auto above = [&](std::uint32_t face) {
        const SurfacePoint at = surface.on_face(number, face, {1 / 3.0, 1 / 3.0, 1 / 3.0});
        return at.position_mm + height_mm * at.normal;
    };
    std::uint32_t face = 0;
    Vec3 from = above(face);
    std::vector<Vec3> points{from};
    while (points.size() < count) {
        const std::uint32_t next = object.mesh.neighbours[face][random() % 3];
        face = next == mesh::no_neighbour ? static_cast<std::uint32_t>(random() % object.mesh.faces.size())
                                          : next;
        const Vec3 to = above(face);
        const int pieces =
            next == mesh::no_neighbour ? 1 : std::max(1, static_cast<int>(length(to - from) / step_mm));
        for (int i = 1; i <= pieces && points.size() < count; ++i)
            points.push_back(from + (static_cast<double>(i) / pieces) * (to - from));
        from = to;
    }
    return points;
}

Distribution query_us(const fdh::SceneTree<14>& tree, const std::vector<Vec3>& points, std::uint32_t budget)
{
    const double radius_mm = feeder::FeederOptions{}.search_radius_mm;
    fdh::Nearest near;
    std::vector<double> us;
    us.reserve(points.size());
    for (const Vec3& point : points)
        us.push_back(1e-3 * nanoseconds_of([&] {
                         near.clear();
                         tree.nearest(point, budget, radius_mm, near);
                     }));
    return Distribution::of(std::move(us));
}

Result<Distribution> feed_us(const scene::Scene& scene, const fdh::SceneTree<14>& tree,
                             const std::vector<Vec3>& points, std::uint32_t budget)
{
    device::UsermodeOptions usermode;
    usermode.virtual_clock = true;
    Result<device::Device> device = device::Device::open_usermode(usermode);
    if (!device)
        return device.error();
    feeder::FeederOptions options;
    options.budget = budget;
    feeder::Feeder feeder(scene, tree, *device, options);
    std::vector<double> us;
    for (const Vec3& point : points) {
        Result<feeder::FeedReport> report = Error{"", "not fed"};
        us.push_back(1e-3 * nanoseconds_of([&] { report = feeder.feed(point, point, false); }));
        if (!report)
            return report.error();
    }
    return Distribution::of(std::move(us));
}

Status measure_ticks(const scene::Scene& scene, const fdh::SceneTree<14>& tree, const BenchOptions& options,
                     BenchReport& report)
{
    for (const char* model : {"paper", "projected"}) {
        for (const std::uint32_t isa : tick_sections()) {
            const Result<phantom_model> words =
                device::model_from_words(model, "bounded", "paper", "float", 2);
            if (!words)
                return words.error();
            Result<TickCost> cost = measure_tick(scene, tree, *words, isa, options.budget);
            if (!cost)
                return cost.error();
            report.ticks.push_back({model, *cost});
        }
    }
    return success();
}

Status measure_session(const BenchOptions& options, BenchReport& report)
{
    feeder::SessionOptions session;
    session.scene = options.scene;
    session.load = options.load;
    session.force_usermode = true;
    session.control_socket = false;
    Result<feeder::Session> running = feeder::Session::open(session);
    if (!running)
        return running.error();
    if (Status status = running->start(); !status)
        return status;
    report.read_prepare_ms = running->timings().read_prepare_ms;
    report.build_ms = running->timings().build_ms;
    report.first_force_ms = running->timings().first_force_ms;
    return running->stop();
}

} // namespace

Result<BenchReport> run_bench(const BenchOptions& options)
{
    const auto progress = [&options](double done) {
        if (options.progress)
            options.progress(done);
    };
    BenchReport report;
    // First, as a user would: what follows finds everything warm.
    if (Status status = measure_session(options, report); !status)
        return status.error();
    progress(0.3);
    const Result<scene::Scene> scene = scene::load(options.scene, options.load);
    if (!scene)
        return scene.error();
    const fdh::SceneTree<14> tree = scene::build_tree<14>(*scene);
    report.triangles = scene->triangles();
    report.tree_bytes = tree.bytes();
    report.threads = std::max(1U, std::thread::hardware_concurrency());
    report.build_one_mtri_s = build_mtri_s(*scene, 1);
    report.build_all_mtri_s = build_mtri_s(*scene, report.threads);
    progress(0.7);
    const std::vector<Vec3> walk = walk_points(*scene, options.queries);
    report.walk_us = query_us(tree, walk, options.budget);
    report.jump_us = query_us(tree, points_near_surface(*scene, options.queries, 4), options.budget);
    const Result<Distribution> feed = feed_us(*scene, tree, walk, options.budget);
    if (!feed)
        return feed.error();
    report.feed_us = *feed;
    progress(0.9);
    if (Status status = measure_ticks(*scene, tree, options, report); !status)
        return status.error();
    return report;
}

} // namespace phantom::study
