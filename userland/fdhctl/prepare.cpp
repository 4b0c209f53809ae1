// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl prepare: the preprocessing alone, a mesh file in, a mesh file out.
#include "mesh/prepare.hpp"

#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "base/progress_bar.hpp"
#include "fdhctl/command_line.hpp"
#include "fdhctl/level_report.hpp"
#include "fdhctl/mesh_report.hpp"

namespace phantom::fdhctl {

namespace {

struct Options {
    SceneOptions scene;
    std::string output;
    double feed_rate_hz = feeder::FeederOptions{}.rate_hz;
    bool json = false;
};

int run(const Options& options)
{
    const Result<scene::Scene> scene = load_scene(options.scene);
    if (!scene)
        return fail(scene.error());
    if (scene->objects.size() != 1)
        return fail({options.scene.scene, "prepare takes one mesh, not a scene of several"});
    const scene::Object& object = scene->objects.front();
    if (Status status = mesh::write_ply(object.mesh, options.output); !status)
        return fail(status.error());
    const scene::Coverage coverage =
        scene::measure_coverage(*scene, scene::build_tree<14>(*scene), feeder::FeederOptions{}.budget);
    const FeedPace pace{options.feed_rate_hz, scene->max_radius_mm()};
    if (const auto warning = coverage_warning(coverage, pace))
        std::fprintf(stderr, "fdhctl: warning: %s: %s\n", options.scene.scene.c_str(), warning->c_str());
    if (options.json) {
        nlohmann::json report = report_json(object.report);
        report["coverage"] = coverage_json(coverage, pace);
        std::printf("%s\n", report.dump().c_str());
    } else {
        std::printf("%scoverage    %s\nwritten to  %s\n", report_text(object.report).c_str(),
                    coverage_text(coverage, pace).c_str(), options.output.c_str());
    }
    return exit_success;
}

} // namespace

Run add_prepare(CLI::App& app)
{
    auto options = std::make_shared<Options>();
    options->scene.use_cache = false;
    app.add_option("mesh", options->scene.scene, "PLY, OBJ, STL, OFF, VTP, VTK, 3DS or glTF")
        ->required()
        ->type_name("MESH");
    app.add_option("-o,--output", options->output, "binary PLY in mm with vertex normals")
        ->required()
        ->type_name("OUT.ply");
    options->scene.add_preparation(app);
    add_feed_rate(app, options->feed_rate_hz, "sets per second that the tip's speed is reckoned with");
    app.add_flag("--json", options->json, "the report as one line of JSON");
    return [options] { return run(*options); };
}

} // namespace phantom::fdhctl
