// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl stroke: a path over a scene's surface for the simulated device.
#include "study/stroke.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/output_file.hpp"
#include "fdhctl/command_line.hpp"

namespace phantom::fdhctl {

namespace {

struct Options {
    SceneOptions scene;
    study::StrokeOptions stroke;
    std::string output;
    bool json = false;
};

/// Largest speed between two rows, in mm/s.
double speed_max(const feeder::Path& path)
{
    double most = 0;
    for (std::size_t i = 1; i < path.size(); ++i) {
        const auto &a = path[i - 1].tip_mm, &b = path[i].tip_mm;
        most = std::max(most, std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]) /
                                  (path[i].time_s - path[i - 1].time_s));
    }
    return most;
}

int run(const Options& options)
{
    const Result<scene::Scene> scene = load_scene(options.scene);
    if (!scene)
        return fail(scene.error());
    const Result<feeder::Path> path =
        study::make_stroke(*scene, scene::build_tree<14>(*scene), options.stroke);
    if (!path)
        return fail({options.scene.scene, path.error().what, path.error().remedy});
    if (Status status = write_file(options.output, feeder::path_text(*path)); !status)
        return fail(status.error());
    if (options.json) {
        const nlohmann::json answer = {{"file", options.output},
                                       {"rows", path->size()},
                                       {"seconds", path->back().time_s},
                                       {"speed_max_mm_s", speed_max(*path)}};
        std::printf("%s\n", answer.dump().c_str());
    } else {
        std::printf("%s: %zu rows, %.3g s, at most %.1f mm/s\n", options.output.c_str(), path->size(),
                    path->back().time_s, speed_max(*path));
    }
    return exit_success;
}

} // namespace

Run add_stroke(CLI::App& app)
{
    auto options = std::make_shared<Options>();
    options->scene.add(app);
    app.add_option("-o,--output", options->output, "the path, for trace and load")
        ->required()
        ->type_name("P.csv");
    app.add_option("--seconds", options->stroke.seconds, "how long the stroke takes")
        ->check(CLI::Range(0.1, 3600.0))
        ->type_name("S")
        ->capture_default_str();
    app.add_option("--rate", options->stroke.rate_hz, "rows per second")
        ->check(CLI::Range(10.0, double{PHANTOM_RATE_MAX_HZ}))
        ->type_name("HZ")
        ->capture_default_str();
    app.add_option("--depth", options->stroke.depth_mm,
                   "how deep it presses in, at six places; 0: nowhere [half the contact radius]")
        ->check(CLI::Range(0.0, 1e3))
        ->type_name("MM");
    app.add_option("--height", options->stroke.height_mm,
                   "how high above the surface the sweeps are, negative below it "
                   "[between 0.1 and 0.8 of the contact radius]")
        ->check(CLI::Range(-1e3, 1e3))
        ->type_name("MM");
    app.add_option("--speed-limit", options->stroke.speed_limit_mm_s, "the tip is never faster")
        ->check(positive())
        ->type_name("MM_PER_S")
        ->capture_default_str();
    app.add_flag("--json", options->json, "what was made as one line of JSON");
    return [options] { return run(*options); };
}

} // namespace phantom::fdhctl
