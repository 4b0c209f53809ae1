// SPDX-License-Identifier: GPL-2.0-or-later
// What the subcommands share: their table's type, options that several have, and how they fail.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "base/result.hpp"
#include "feeder/feeder.hpp"
#include "scene/levels.hpp"
#include "scene/scene.hpp"

namespace phantom::fdhctl {

inline constexpr int exit_success = 0, exit_failed = 1, exit_usage = 2;

/// Runs the command after the command line was parsed; gives the exit status.
using Run = std::function<int()>;

/// One line of the table in main.cpp. add() declares options on `app` and gives what runs them.
struct Command {
    const char* name;
    const char* description;
    Run (*add)(CLI::App& app);
};

Run add_bench(CLI::App& app);
Run add_cache(CLI::App& app);
Run add_devices(CLI::App& app);
Run add_effect(CLI::App& app);
Run add_info(CLI::App& app);
Run add_load(CLI::App& app);
Run add_model(CLI::App& app);
Run add_prepare(CLI::App& app);
Run add_rate(CLI::App& app);
Run add_record(CLI::App& app);
Run add_replay(CLI::App& app);
Run add_status(CLI::App& app);
Run add_stop(CLI::App& app);
Run add_stroke(CLI::App& app);
Run add_trace(CLI::App& app);
Run add_view(CLI::App& app);

/// "fdhctl: ..." on stderr, one line; gives exit_failed.
int fail(const Error& error);

/// Checks for numbers: finite and > 0, or finite and >= 0.
CLI::Validator positive();
CLI::Validator not_negative();

/// SCENE and how it is read; the same for every command that reads one.
struct SceneOptions {
    std::string scene;
    std::optional<std::string> unit;
    std::optional<double> stiffness_n_mm, radius_mm;
    double fit_mm = 0, weld_mm = 0, crease_deg = 60, split_mm = 0;
    std::string prepare = "full";
    std::optional<mesh::SimplifyOptions> simplify; ///< of `fdhctl prepare`
    bool use_cache = true;

    void add(CLI::App& app);
    /// The preparation alone: --unit, --fit, --weld, --crease, --prepare, --split.
    /// Whoever calls only this prepares anew every time.
    void add_preparation(CLI::App& app);
    [[nodiscard]] scene::LoadOptions load_options() const;
    /// The same as command line words, for a program that takes over.
    [[nodiscard]] std::vector<std::string> arguments() const;
};

/// Reads a scene with a progress bar, warnings of the preparation on stderr.
Result<scene::Scene> load_scene(const SceneOptions& options);
/// Warnings of every object's preparation and what went wrong beside it, on stderr.
void print_warnings(const scene::Scene& scene);

/// --model, --steps, --combine, --proxy, --arith.
struct ServoOptions {
    scene::ServoSettings words;

    /// positional: MODEL stands without its option's name.
    void add(CLI::App& app, bool positional = false);
};

/// --budget N|all, --fixed-budget.
struct BudgetOptions {
    std::string budget = "64";
    bool fixed = false;

    void add(CLI::App& app, bool allow_all);
    void apply(feeder::FeederOptions& options) const;
};

/// --levels auto|off|N.
struct LevelsOption {
    std::string word; ///< empty: not given

    void add(CLI::App& app, const char* otherwise);
    [[nodiscard]] std::optional<scene::LevelWish> wish() const;
};

/// --device: NODE of the kernel's device, empty for the first there is.
CLI::Option* add_device_option(CLI::App& app, std::string& node);

/// "hand, encoder", or "none".
std::string listed(const std::vector<std::string>& words);

/// A line to the running session; the answer, or its refusal as an Error.
Result<std::string> ask_session(const std::string& request);

} // namespace phantom::fdhctl
