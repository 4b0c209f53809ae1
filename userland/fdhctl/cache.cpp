// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl cache: what is kept of prepared meshes.
#include "scene/cache.hpp"

#include <cstdio>
#include <memory>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "fdhctl/command_line.hpp"

namespace phantom::fdhctl {

namespace {

using nlohmann::json;
using scene::CacheEntry;

struct Options {
    std::string action = "list";
    double keep_gib = static_cast<double>(scene::cache_bytes_max) / (1U << 30);
    bool all = false;
    bool json = false;
};

std::string used_text(const CacheEntry& entry)
{
    const auto time = std::chrono::file_clock::to_sys(entry.used);
    return fmt::format("{:%Y-%m-%d %H:%M}",
                       fmt::localtime(std::chrono::system_clock::to_time_t(
                           std::chrono::time_point_cast<std::chrono::system_clock::duration>(time))));
}

json entry_json(const CacheEntry& entry)
{
    return {{"file", entry.file.string()}, {"bytes", entry.bytes},         {"used", used_text(entry)},
            {"source", entry.source},      {"triangles", entry.triangles}, {"fault", entry.fault}};
}

void print(const Options& options, const std::filesystem::path& directory,
           const std::vector<CacheEntry>& entries)
{
    std::uint64_t bytes = 0, faulty = 0;
    for (const CacheEntry& entry : entries) {
        bytes += entry.bytes;
        faulty += !entry.fault.empty();
    }
    if (options.json) {
        json list = json::array();
        for (const CacheEntry& entry : entries)
            list.push_back(entry_json(entry));
        std::printf("%s\n", json{{"directory", directory.string()},
                                 {"action", options.action},
                                 {"bytes", bytes},
                                 {"entries", list}}
                                .dump()
                                .c_str());
        return;
    }
    for (const CacheEntry& entry : entries)
        std::printf("%9.1f MB  %10llu triangles  %s  %s%s\n", static_cast<double>(entry.bytes) * 1e-6,
                    static_cast<unsigned long long>(entry.triangles), used_text(entry).c_str(),
                    entry.source.empty() ? entry.file.c_str() : entry.source.c_str(),
                    entry.fault.empty() ? "" : (": " + entry.fault).c_str());
    const char* what = options.action == "prune" ? "removed" : "kept";
    std::printf("%zu meshes %s, %.1f MB, in %s", entries.size(), what, static_cast<double>(bytes) * 1e-6,
                directory.c_str());
    if (options.action != "prune" && faulty > 0)
        std::printf("; %llu of no use any more (fdhctl cache prune removes them)",
                    static_cast<unsigned long long>(faulty));
    std::printf("\n");
}

int run(const Options& options)
{
    const auto directory = scene::cache_directory();
    if (!directory)
        return fail({"", "there is no cache: neither XDG_CACHE_HOME nor HOME is set"});
    std::vector<CacheEntry> entries;
    if (options.action == "prune")
        entries = scene::prune_cache(
            *directory, options.all ? 0 : static_cast<std::uint64_t>(options.keep_gib * (1U << 30)));
    else
        entries = scene::list_cache(*directory, options.action == "check");
    print(options, *directory, entries);
    const bool sound = std::all_of(entries.begin(), entries.end(),
                                   [](const CacheEntry& entry) { return entry.fault.empty(); });
    return options.action == "check" && !sound ? exit_failed : exit_success;
}

} // namespace

Run add_cache(CLI::App& app)
{
    auto options = std::make_shared<Options>();
    app.add_option("action", options->action,
                   "list; check: reads every byte, exit status 1 if something is of no use any more; prune: "
                   "removes that, and what was used longest ago beyond --keep")
        ->check(CLI::IsMember({"list", "check", "prune"}))
        ->type_name("list|check|prune")
        ->capture_default_str();
    app.add_option("--keep", options->keep_gib, "prune: how much may stay")
        ->check(not_negative())
        ->type_name("GIB")
        ->capture_default_str();
    app.add_flag("--all", options->all, "prune: removes everything");
    app.add_flag("--json", options->json, "one line of JSON");
    return [options] { return run(*options); };
}

} // namespace phantom::fdhctl
