// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl trace: the module's code on a virtual clock, one tick per row of a path.
#include "study/trace.hpp"

#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/output_file.hpp"
#include "base/progress_bar.hpp"
#include "fdhctl/command_line.hpp"

namespace phantom::fdhctl {

namespace {

struct Options {
    SceneOptions scene;
    ServoOptions servo;
    BudgetOptions budget;
    LevelsOption levels;
    std::string path, output, limits = "off", isa = "best";
    std::uint32_t feed_every = 1;
    bool verbose = false, json = false;
};

nlohmann::json summary_json(const study::TraceSummary& sum)
{
    return {{"model", sum.model},
            {"isa", sum.isa},
            {"ticks", sum.ticks},
            {"contact_ticks", sum.contact_ticks},
            {"inside_ticks", sum.inside_ticks},
            {"uncovered_ticks", sum.uncovered_ticks},
            {"sets", sum.sets},
            {"patches_max", sum.patches_max},
            {"level_sets", sum.level_sets},
            {"level_changes", sum.level_changes},
            {"level_error_mm", sum.level_error_mm},
            {"refused", sum.refused},
            {"saturated", sum.saturated},
            {"force_max_n", sum.force_max_n},
            {"force_step_max_n", sum.force_step_max_n},
            {"query_median_us", sum.query_median_us},
            {"tick_median_ns", sum.tick_median_ns},
            {"simulated", sum.simulated},
            {"faults", sum.faults}};
}

std::string summary_text(const study::TraceSummary& sum)
{
    return fmt::format("model     {}, {}\n"
                       "ticks     {}, in contact {}, inside {}, not covered {}\n"
                       "sets      {}, at most {} patches, {} patches refused, {} values saturated\n"
                       "force     at most {:.4g} N, largest step between ticks {:.4g} N, faults: {}\n"
                       "device    simulated: {}\n"
                       "median    query {:.2f} us, tick {:.0f} ns (the whole tick, from outside)\n",
                       sum.model, sum.isa, sum.ticks, sum.contact_ticks, sum.inside_ticks,
                       sum.uncovered_ticks, sum.sets, sum.patches_max, sum.refused, sum.saturated,
                       sum.force_max_n, sum.force_step_max_n, sum.faults, listed(sum.simulated),
                       sum.query_median_us, sum.tick_median_ns);
}

std::uint32_t isa_number(const std::string& word)
{
    return word == "sse2"     ? PHANTOM_ISA_SSE2
           : word == "avx2"   ? PHANTOM_ISA_AVX2
           : word == "avx512" ? PHANTOM_ISA_AVX512
                              : PHANTOM_ISA_NONE;
}

/// To the file whole or not at all, or to stdout.
Status write_output(const std::string& output, const std::string& text)
{
    if (!output.empty() && output != "-")
        return write_file(output, text);
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
        return Error{"stdout", "cannot be written"};
    return success();
}

int run(const Options& options)
{
    // The path first: a bad row shows before a large mesh is read.
    const Result<feeder::Path> path = feeder::read_path(options.path);
    if (!path)
        return fail(path.error());
    const Result<scene::Scene> scene = load_scene(options.scene);
    if (!scene)
        return fail(scene.error());

    study::TraceOptions trace;
    trace.servo = options.servo.words;
    options.budget.apply(trace.feeder);
    trace.feed_every = options.feed_every;
    if (const auto wish = options.levels.wish())
        trace.levels = *wish;
    trace.limits = options.limits == "on";
    trace.isa = isa_number(options.isa);
    Result<study::TraceRun> result = [&] {
        ProgressBar bar("tracing");
        trace.progress = bar.callback();
        return study::run_trace(*scene, *path, trace);
    }();
    if (!result)
        return fail(result.error());
    if (Status status = write_output(options.output, result->csv); !status)
        return fail(status.error());
    if (options.json) {
        // Where the trace itself goes to stdout, the summary must not.
        std::FILE* out = options.output.empty() || options.output == "-" ? stderr : stdout;
        std::fprintf(out, "%s\n", summary_json(result->summary).dump().c_str());
    } else if (options.verbose) {
        std::fprintf(stderr, "%s", summary_text(result->summary).c_str());
    }
    return exit_success;
}

} // namespace

Run add_trace(CLI::App& app)
{
    auto options = std::make_shared<Options>();
    options->scene.add(app);
    app.add_option("--path", options->path, "CSV with the columns time_s,x_mm,y_mm,z_mm")
        ->required()
        ->type_name("P.csv");
    app.add_option("-o,--output", options->output, "the trace, written whole or not at all [stdout]")
        ->type_name("T.csv");
    options->servo.add(app);
    options->budget.add(app, true);
    options->levels.add(app, "off");
    app.add_option("--feed-every", options->feed_every, "query before every K-th tick")
        ->check(CLI::Range(1U, 1000000000U))
        ->type_name("K")
        ->capture_default_str();
    app.add_option("--rate", options->servo.words.rate_hz, "servo rate; a row of the path is one tick [1000]")
        ->check(CLI::Range(double{PHANTOM_RATE_MIN_HZ}, double{PHANTOM_RATE_MAX_HZ}))
        ->type_name("HZ");
    app.add_option("--limits", options->limits, "clamp, slew, ramp, speed and staleness as on a real device")
        ->check(CLI::IsMember({"on", "off"}))
        ->type_name("on|off")
        ->capture_default_str();
    app.add_option("--isa", options->isa, "instruction set of the tick")
        ->check(CLI::IsMember({"best", "sse2", "avx2", "avx512"}))
        ->type_name("best|sse2|avx2")
        ->capture_default_str();
    app.add_flag("-v,--verbose", options->verbose, "a summary on stderr");
    app.add_flag("--json", options->json, "a summary as JSON: on stdout with -o, else on stderr");
    return [options] { return run(*options); };
}

} // namespace phantom::fdhctl
