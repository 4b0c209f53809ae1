// SPDX-License-Identifier: GPL-2.0-or-later
// peers_bench: the 64 nearest triangles, by this project's hulls and by other libraries, in one interleaved
// run. Writes peers.csv, peers.md and peers.svg, all or none. Exit status 0, 1 (a wrong answer, a mesh or
// file that cannot be had), 2 (usage).
#include <fmt/format.h>
#include <stdlib.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <thread>

#include "base/output_file.hpp"
#include "study/peers/measure.hpp"
#include "study/peers/report.hpp"

namespace {

using namespace phantom;
using namespace phantom::peers;

constexpr int exit_failed = 1, exit_usage = 2;

struct Options {
    std::vector<std::string> meshes;
    std::vector<std::string> contenders; ///< empty: all
    std::filesystem::path out = ".";
    bool quick = false;
    MeasureOptions measure;
};

int fail(const Error& error)
{
    std::fprintf(stderr, "peers_bench: %s\n", error.text().c_str());
    return exit_failed;
}

void add_options(CLI::App& app, Options& options)
{
    app.add_option("--meshes", options.meshes,
                   "sphere-20k, -200k, -2M, -20M or -F (20 F^2 triangles), spot-..., bunny, FILE; "
                   "default: sphere-20k,sphere-200k,sphere-2M,sphere-20M,spot-200k,bunny")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("MESH,...");
    app.add_option("--contenders", options.contenders, "FDH14 and these, e.g. FDH6,Embree; default: all")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("NAME,...");
    app.add_option("--out", options.out, "folder for peers.csv, peers.md and peers.svg")
        ->type_name("FOLDER")
        ->capture_default_str();
    app.add_option("--rounds", options.measure.rounds, "turns that every contender has on a path")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str();
    app.add_flag("--quick", options.quick, "meshes of up to 200,000 triangles, ten rounds");
}

void settle(Options& options, bool rounds_given)
{
    if (options.meshes.empty())
        options.meshes = options.quick ? std::vector<std::string>{"sphere-20k", "sphere-200k", "spot-200k"}
                                       : std::vector<std::string>{"sphere-20k", "sphere-200k", "sphere-2M",
                                                                  "sphere-20M", "spot-200k",   "bunny"};
    if (!options.quick)
        return;
    if (!rounds_given)
        options.measure.rounds = 10;
    options.measure.build_seconds = 2;
    options.measure.checked = 50;
}

/// What a run takes at its peak, everyone's hierarchy at once [byte per triangle].
constexpr double run_bytes_per_triangle = 450;

double free_bytes()
{
    std::ifstream file("/proc/meminfo");
    for (std::string word; file >> word;)
        if (double kib = 0; word == "MemAvailable:" && file >> kib)
            return 1024 * kib;
    return std::numeric_limits<double>::max();
}

/// Meshes that there is no memory for are left out, and `note` says so.
Result<std::vector<MeshFigures>> measure_all(Options& options, std::string& note)
{
    std::vector<MeshFigures> all;
    for (const std::string& name : options.meshes) {
        options.measure.progress = [&name](const std::string& what) {
            std::fprintf(stderr, "peers_bench: %s, %s\n", name.c_str(), what.c_str());
        };
        options.measure.progress("making");
        const Result<Mesh> mesh = make_mesh(name);
        if (!mesh)
            return mesh.error();
        const double needed = run_bytes_per_triangle * static_cast<double>(mesh->triangles.size());
        if (needed > free_bytes()) {
            note +=
                fmt::format("{} was left out: it needs {:.0f} GB of free memory.\n\n", name, 1e-9 * needed);
            continue;
        }
        Result<Field> field = field_for(*mesh, options.contenders);
        if (!field)
            return field.error();
        Result<MeshFigures> figures = measure(*mesh, std::move(*field), options.measure);
        if (!figures)
            return figures.error();
        all.push_back(std::move(*figures));
    }
    return all;
}

/// What else the machine is doing, if that matters.
std::string load_note()
{
    double load = 0;
    const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
    if (getloadavg(&load, 1) != 1 || load < 0.5 * processors)
        return "";
    return fmt::format(
        "The machine was not quiet: load {:.1f} on {} processors before the run. Ratios hold; rates "
        "on all threads are too low.\n\n",
        load, processors);
}

Status write(const std::vector<MeshFigures>& all, const std::string& words,
             const std::filesystem::path& folder)
{
    std::error_code code;
    std::filesystem::create_directories(folder, code);
    const std::pair<const char*, std::string> files[] = {
        {"peers.csv", csv(all)}, {"peers.md", words}, {"peers.svg", chart(all)}};
    std::vector<OutputFile> open;
    for (const auto& [name, text] : files) {
        Result<OutputFile> file = OutputFile::open(folder / name);
        if (!file)
            return file.error();
        if (Status status = file->append(text); !status)
            return status;
        open.push_back(std::move(*file));
    }
    for (OutputFile& file : open)
        if (Status status = file.commit(); !status)
            return status;
    return success();
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App app("peers_bench: the 64 nearest triangles, by this project's hulls and by other libraries");
    Options options;
    add_options(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        const int code = app.exit(error);
        return code == 0 ? 0 : exit_usage;
    }
    settle(options, app.count("--rounds") > 0);
    std::string note = load_note();
    const Result<std::vector<MeshFigures>> all = measure_all(options, note);
    if (!all)
        return fail(all.error());
    const std::string words = note + tables(*all);
    if (Status status = write(*all, words, options.out); !status)
        return fail(status.error());
    std::printf("%s\nwritten: %s\n", words.c_str(), (options.out / "peers.{csv,md,svg}").c_str());
    return 0;
}
