// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl prepare: the preprocessing alone, a mesh file in, a mesh file out.
#include "mesh/prepare.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/progress_bar.hpp"
#include "fdhctl/command_line.hpp"
#include "fdhctl/level_report.hpp"
#include "fdhctl/mesh_report.hpp"
#include "fdhctl/view.hpp"

namespace phantom::fdhctl {

namespace {

/// --simplify: a number of triangles, or a distance.
struct SimplifyWish {
    std::string word;
    mesh::SimplifyOptions options;
};

/// A whole number is one of triangles; "0.05" and "5mm" are distances. False when it is neither.
bool read_simplify(std::string word, mesh::SimplifyOptions& out)
{
    const bool has_unit = word.size() > 2 && word.ends_with("mm");
    if (has_unit)
        word.resize(word.size() - 2);
    const char* last = word.data() + word.size();
    if (!has_unit && word.find('.') == std::string::npos) {
        const auto [end, error] = std::from_chars(word.data(), last, out.faces);
        return error == std::errc() && end == last && out.faces >= 1;
    }
    const auto [end, error] = std::from_chars(word.data(), last, out.error_mm);
    return error == std::errc() && end == last && out.error_mm > 0 && std::isfinite(out.error_mm);
}

struct Options {
    SceneOptions scene;
    SimplifyWish simplify;
    std::string output;
    double feed_rate_hz = feeder::FeederOptions{}.rate_hz;
    std::optional<std::string> picture;
    bool json = false;
};

int run(const Options& options)
{
    SceneOptions wanted = options.scene;
    if (!options.simplify.word.empty()) {
        wanted.simplify = options.simplify.options;
        (void)read_simplify(options.simplify.word, *wanted.simplify);
    }
    const Result<scene::Scene> scene = load_scene(wanted);
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
        nlohmann::json report = report_json(object);
        report["coverage"] = coverage_json(coverage, pace);
        std::printf("%s\n", report.dump().c_str());
    } else {
        std::printf("%scoverage    %s\nwritten to  %s\n", report_text(object).c_str(),
                    coverage_text(coverage, pace).c_str(), options.output.c_str());
    }
    // Drawn from the input, so that the legend tells its faults; fdhview leaves no triangles out.
    std::vector<std::string> drawn = options.scene.arguments();
    if (wanted.simplify)
        drawn = {options.output, "--no-cache"};
    return draw_picture(options.picture, std::move(drawn), options.feed_rate_hz);
}

void add_simplify(CLI::App& app, SimplifyWish& wish)
{
    const auto check = [](std::string& text) {
        mesh::SimplifyOptions ignored;
        return read_simplify(text, ignored)
                   ? std::string()
                   : fmt::format("expected a number of triangles, or a distance as 0.05 or 5mm, found '{}'",
                                 text);
    };
    CLI::Option* simplify =
        app.add_option("--simplify", wish.word,
                       "leave out triangles: down to so many, or as long as the surface stays within that "
                       "distance; creases and borders are kept")
            ->check(CLI::Validator(check, ""))
            ->type_name("N|MM");
    app.add_option("--simplify-error", wish.options.error_mm,
                   "no point of the surface farther from the other than this, by samples [no bound with N]")
        ->check(positive())
        ->type_name("MM")
        ->needs(simplify);
    app.add_option("--simplify-normal", wish.options.normal_deg, "no triangle turns by more")
        ->check(CLI::Range(1.0, 89.0))
        ->type_name("DEG")
        ->capture_default_str()
        ->needs(simplify);
    app.add_option("--simplify-aspect", wish.options.aspect,
                   "no triangle becomes longer than so many of its heights")
        ->check(CLI::Range(2.0, 1e6))
        ->type_name("R")
        ->capture_default_str()
        ->needs(simplify);
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
    add_simplify(app, options->simplify);
    add_feed_rate(app, options->feed_rate_hz, "sets per second that the tip's speed is reckoned with");
    add_picture(app, options->picture);
    app.add_flag("--json", options->json, "the report as one line of JSON");
    return [options] { return run(*options); };
}

} // namespace phantom::fdhctl
