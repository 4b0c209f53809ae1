// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl: the command line of phantom_rt. One table, one file per command.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iterator>
#include <string>
#include <string_view>

#include "fdhctl/command_line.hpp"

namespace {

using namespace phantom::fdhctl;

constexpr Command commands[] = {
    {"load", "touch a scene: prepare, build, feed; Ctrl-C ramps down and stops", add_load},
    {"status", "what the running servo does", add_status},
    {"rate", "change the running servo's rate", add_rate},
    {"model", "change the running servo's contact model", add_model},
    {"effect", "list and change what the running scene feels like", add_effect},
    {"stop", "ramp down and end what runs", add_stop},
    {"info", "triangles, defects, effects and predicted cost of a scene", add_info},
    {"prepare", "the preprocessing alone, with its report", add_prepare},
    {"cache", "list, check and prune the prepared meshes that are kept", add_cache},
    {"stroke", "make a path over a scene's surface for the simulated device", add_stroke},
    {"trace", "the module's code on a virtual clock, one tick per row of a path", add_trace},
    {"record", "write down the ticks of a device that somebody else feeds", add_record},
    {"replay", "compute a recording again and compare every tick, bit for bit", add_replay},
    {"bench", "query and tick times of a scene", add_bench},
    {"devices", "what can be driven here, and how", add_devices},
    {"view", "see and touch a scene in a window (fdhview)", add_view},
};

int usage_error(const CLI::App& app, const CLI::ParseError& error)
{
    std::string line = error.what();
    std::replace(line.begin(), line.end(), '\n', ' ');
    const auto chosen = app.get_subcommands();
    const std::string help =
        chosen.empty() ? "fdhctl --help" : "fdhctl " + chosen.front()->get_name() + " --help";
    std::fprintf(stderr, "fdhctl: %s (see %s)\n", line.c_str(), help.c_str());
    return exit_usage;
}

int run(int argc, char** argv)
{
    CLI::App app("fdhctl: haptic rendering of triangle meshes with fixed direction hulls", "fdhctl");
    app.set_version_flag("--version", "fdhctl " PHANTOM_VERSION);
    app.require_subcommand(1);
    Run runs[std::size(commands)];
    CLI::App* apps[std::size(commands)];
    for (std::size_t i = 0; i < std::size(commands); ++i) {
        apps[i] = app.add_subcommand(commands[i].name, commands[i].description);
        runs[i] = commands[i].add(*apps[i]);
    }
    // CLI11 would only say that a command is missing.
    const auto is_named = [argv](const Command& command) {
        return std::string_view(command.name) == argv[1];
    };
    if (argc > 1 && argv[1][0] != '-' && std::none_of(std::begin(commands), std::end(commands), is_named)) {
        std::fprintf(stderr, "fdhctl: unknown command '%s' (see fdhctl --help)\n", argv[1]);
        return exit_usage;
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success))
            return app.exit(error);
        return usage_error(app, error);
    }
    for (std::size_t i = 0; i < std::size(commands); ++i)
        if (apps[i]->parsed())
            return runs[i]();
    return exit_usage;
}

} // namespace

int main(int argc, char** argv)
{
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        return fail({"", error.what()});
    }
}
