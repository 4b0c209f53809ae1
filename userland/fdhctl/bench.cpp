// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl bench: query and tick times of a scene on this machine.
#include "study/bench.hpp"

#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/progress_bar.hpp"
#include "fdhctl/command_line.hpp"

namespace phantom::fdhctl {

namespace {

struct Options {
    SceneOptions scene;
    BudgetOptions budget;
    std::size_t queries = study::BenchOptions{}.queries;
    bool json = false;
};

nlohmann::json json_of(const study::Distribution& times)
{
    return {{"count", times.count}, {"median", times.median}, {"p99", times.p99}, {"max", times.max}};
}

nlohmann::json json_of(const study::BenchReport& report, const std::string& scene)
{
    nlohmann::json ticks = nlohmann::json::array();
    for (const study::NamedTickCost& tick : report.ticks)
        ticks.push_back({{"model", tick.model},
                         {"isa", device::isa_name(tick.cost.isa)},
                         {"patches", tick.cost.patches},
                         {"contacts", tick.cost.contacts},
                         {"float_section_ns", json_of(tick.cost.float_ns)},
                         {"all_in_contact_ns", json_of(tick.cost.stacked_ns)},
                         {"set_bytes", tick.cost.set_bytes},
                         {"tick_ns", json_of(tick.cost.tick_ns)},
                         {"prepare_us", json_of(tick.cost.prepare_us)}});
    return {
        {"scene", scene},
        {"triangles", report.triangles},
        {"tree_bytes", report.tree_bytes},
        {"build_mtri_s", {{"one_thread", report.build_one_mtri_s}, {"all_threads", report.build_all_mtri_s}}},
        {"threads", report.threads},
        {"query_us", {{"walk", json_of(report.walk_us)}, {"jump", json_of(report.jump_us)}}},
        {"feed_us", json_of(report.feed_us)},
        {"ticks", ticks},
        {"load_ms",
         {{"read_and_prepare", report.read_prepare_ms},
          {"build", report.build_ms},
          {"first_force", report.first_force_ms}}}};
}

std::string row(const std::string& name, const study::Distribution& times, const char* unit)
{
    return fmt::format("{:<44} {:>9.2f} {:>9.2f} {:>9.2f} {}\n", name, times.median, times.p99, times.max,
                       unit);
}

std::string text_of(const study::BenchReport& report, const std::string& budget)
{
    const double triangles = static_cast<double>(report.triangles);
    std::string text = fmt::format("{} triangles, hierarchy of {:.1f} MB ({:.0f} bytes a triangle)\n\n",
                                   report.triangles, static_cast<double>(report.tree_bytes) * 1e-6,
                                   static_cast<double>(report.tree_bytes) / triangles);
    text += fmt::format("{:<44} {:>9} {:>9} {:>9}\n", "", "median", "p99", "max");
    text += row("query of the " + budget + " nearest, walk", report.walk_us, "us");
    text += row("query of the " + budget + " nearest, jump", report.jump_us, "us");
    text += row("feed: query, set, submission", report.feed_us, "us");
    for (const study::NamedTickCost& tick : report.ticks) {
        const std::string name =
            fmt::format("{} {}, {} patches", tick.model, device::isa_name(tick.cost.isa), tick.cost.patches);
        text += row(name + ", contact", tick.cost.float_ns, "ns");
        text += row(name + ", all in contact", tick.cost.stacked_ns, "ns");
        text += row(name + ", whole tick", tick.cost.tick_ns, "ns");
    }
    text += fmt::format("\nbuild      {:.2f} Mtri/s with one thread, {:.2f} with {}\n",
                        report.build_one_mtri_s, report.build_all_mtri_s, report.threads);
    text +=
        fmt::format("load       {:.0f} ms to the first force: read and prepared {:.0f}, hierarchy {:.0f}\n",
                    report.first_force_ms, report.read_prepare_ms, report.build_ms);
    text += "measured on this machine, each call by itself with the clock's 20 to 30 ns in it; ticks on a "
            "virtual "
            "clock,\nwithout a timer's lateness\n";
    return text;
}

int run(const Options& options)
{
    study::BenchOptions bench;
    bench.scene = options.scene.scene;
    bench.load = options.scene.load_options();
    bench.load.cache.reset(); // it times the preparation
    bench.budget = static_cast<std::uint32_t>(std::stoul(options.budget.budget));
    bench.queries = options.queries;
    Result<study::BenchReport> report = [&] {
        ProgressBar bar("measuring");
        bench.progress = bar.callback();
        return study::run_bench(bench);
    }();
    if (!report)
        return fail(report.error());
    if (options.json)
        std::printf("%s\n", json_of(*report, options.scene.scene).dump().c_str());
    else
        std::printf("%s", text_of(*report, options.budget.budget).c_str());
    return exit_success;
}

} // namespace

Run add_bench(CLI::App& app)
{
    auto options = std::make_shared<Options>();
    options->scene.add(app);
    options->budget.add(app, false);
    app.add_option("--queries", options->queries, "how many of each kind")
        ->check(CLI::Range(std::size_t{100}, std::size_t{10000000}))
        ->type_name("N")
        ->capture_default_str();
    app.add_flag("--json", options->json, "as one line of JSON");
    return [options] { return run(*options); };
}

} // namespace phantom::fdhctl
