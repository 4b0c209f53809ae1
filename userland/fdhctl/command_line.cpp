// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdhctl/command_line.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/progress_bar.hpp"
#include "feeder/control_socket.hpp"
#include "scene/cache.hpp"

namespace phantom::fdhctl {

namespace {

std::optional<double> parsed_number(const std::string& text)
{
    double value = 0;
    const char* end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    if (result.ec != std::errc() || result.ptr != end || !std::isfinite(value))
        return std::nullopt;
    return value;
}

CLI::Validator number_check(const char* description, bool (*holds)(double))
{
    return CLI::Validator(
        [description, holds](std::string& text) {
            const std::optional<double> value = parsed_number(text);
            return value && holds(*value) ? std::string()
                                          : fmt::format("expected {}, found '{}'", description, text);
        },
        "");
}

} // namespace

CLI::Validator positive()
{
    return number_check("a number above 0", [](double value) { return value > 0; });
}

CLI::Validator not_negative()
{
    return number_check("a number of 0 or more", [](double value) { return value >= 0; });
}

int fail(const Error& error)
{
    std::string line = error.text();
    std::replace(line.begin(), line.end(), '\n', ' ');
    std::fprintf(stderr, "fdhctl: %s\n", line.c_str());
    return exit_failed;
}

void SceneOptions::add_preparation(CLI::App& app)
{
    app.add_option("--unit", unit,
                   "unit of the file's coordinates: mm, cm, m, in, um [the scene's; else mm, glTF m]")
        ->check(CLI::IsMember({"mm", "cm", "m", "in", "um"}))
        ->type_name("UNIT");
    app.add_option("--fit", fit_mm, "scale the longest side to this and centre at the origin")
        ->check(positive())
        ->type_name("MM");
    app.add_option("--weld", weld_mm,
                   "vertices, and edges at cracks, no farther apart than this are one [0, or the scene's]")
        ->check(not_negative())
        ->type_name("MM");
    app.add_option("--crease", crease_deg, "edges sharper than this keep two normals")
        ->check(not_negative())
        ->type_name("DEG")
        ->capture_default_str();
    app.add_option("--prepare", prepare, "none: faces and normals as the file gives them")
        ->check(CLI::IsMember({"none", "full"}))
        ->type_name("none|full")
        ->capture_default_str();
    app.add_option("--split", split_mm, "bisect edges longer than this")->check(positive())->type_name("MM");
}

void SceneOptions::add(CLI::App& app)
{
    app.add_option("scene", scene, "a mesh (PLY, OBJ, STL, OFF, VTP, VTK, 3DS, glTF) or a scene file (TOML)")
        ->required()
        ->type_name("SCENE");
    add_preparation(app);
    app.add_option("--stiffness", stiffness_n_mm, "stiffness of every material [1, or the scene's]")
        ->check(positive())
        ->type_name("N_PER_MM");
    app.add_option("--radius", radius_mm, "contact radius of every material [1, or the scene's]")
        ->check(positive())
        ->type_name("MM");
    app.add_flag("!--no-cache", use_cache, "prepare the meshes anew (fdhctl cache shows what is kept)");
}

scene::LoadOptions SceneOptions::load_options() const
{
    scene::LoadOptions options;
    options.prepare.full = prepare == "full";
    options.prepare.fit_mm = fit_mm;
    options.prepare.weld_mm = weld_mm;
    options.prepare.crease_deg = crease_deg;
    options.prepare.split_mm = split_mm;
    options.prepare.simplify = simplify;
    options.unit = unit;
    options.stiffness_n_mm = stiffness_n_mm;
    options.radius_mm = radius_mm;
    if (use_cache)
        options.cache = scene::cache_directory();
    return options;
}

std::vector<std::string> SceneOptions::arguments() const
{
    std::vector<std::string> words{scene};
    const auto add_number = [&words](const char* name, double value) {
        words.emplace_back(name);
        words.push_back(fmt::format("{}", value));
    };
    if (unit)
        words.insert(words.end(), {"--unit", *unit});
    if (fit_mm > 0)
        add_number("--fit", fit_mm);
    if (stiffness_n_mm)
        add_number("--stiffness", *stiffness_n_mm);
    if (radius_mm)
        add_number("--radius", *radius_mm);
    if (weld_mm > 0)
        add_number("--weld", weld_mm);
    if (crease_deg != SceneOptions{}.crease_deg)
        add_number("--crease", crease_deg);
    if (prepare != SceneOptions{}.prepare)
        words.insert(words.end(), {"--prepare", prepare});
    if (split_mm > 0)
        add_number("--split", split_mm);
    if (!use_cache)
        words.emplace_back("--no-cache");
    return words;
}

void print_warnings(const scene::Scene& scene)
{
    for (const scene::Object& object : scene.objects)
        for (const std::string& warning : object.report.warnings)
            std::fprintf(stderr, "fdhctl: warning: %s: %s\n", object.file.string().c_str(), warning.c_str());
    for (const std::string& note : scene.notes)
        std::fprintf(stderr, "fdhctl: %s\n", note.c_str());
}

Result<scene::Scene> load_scene(const SceneOptions& options)
{
    Result<scene::Scene> scene = [&] {
        ProgressBar bar("preparing");
        scene::LoadOptions load = options.load_options();
        load.prepare.progress = bar.callback();
        return scene::load(options.scene, load);
    }();
    if (scene)
        print_warnings(*scene);
    return scene;
}

void ServoOptions::add(CLI::App& app, bool positional)
{
    app.add_option(positional ? "model,--model" : "--model", words.model, "contact model")
        ->check(CLI::IsMember({"paper", "projected", "off"}))
        ->type_name("paper|projected|off");
    app.add_option("--steps", words.steps, "Newton steps of the projected model")
        ->check(CLI::Range(0, PHANTOM_NEWTON_STEPS_MAX))
        ->type_name("N");
    app.add_option("--combine", words.combine, "how contacts add up")
        ->check(CLI::IsMember({"paper", "bounded"}))
        ->type_name("paper|bounded");
    app.add_option("--proxy", words.proxy, "what holds a tip below the surface")
        ->check(CLI::IsMember({"paper", "constrained", "off"}))
        ->type_name("paper|constrained|off");
    app.add_option("--arith", words.arith, "arithmetic of the tick")
        ->check(CLI::IsMember({"float", "fixed", "double"}))
        ->type_name("float|fixed|double");
}

void BudgetOptions::add(CLI::App& app, bool allow_all)
{
    const auto check = [allow_all](std::string& text) {
        unsigned value = 0;
        const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool number = result.ec == std::errc() && result.ptr == text.data() + text.size();
        if ((allow_all && text == "all") || (number && value >= 1 && value <= PHANTOM_PATCHES_MAX))
            return std::string();
        return fmt::format("expected 1 to {}{}, found '{}'", PHANTOM_PATCHES_MAX, allow_all ? " or all" : "",
                           text);
    };
    app.add_option("--budget", budget,
                   allow_all ? "triangles in a set; all: every triangle of the scene, without sets"
                             : "triangles in a set")
        ->check(CLI::Validator(check, ""))
        ->type_name(allow_all ? "N|all" : "N")
        ->capture_default_str();
    app.add_flag("--fixed-budget", fixed, "never more triangles, even where they do not cover the tip");
}

void BudgetOptions::apply(feeder::FeederOptions& options) const
{
    options.all = budget == "all";
    options.grow_budget = !fixed;
    if (!options.all)
        options.budget = static_cast<std::uint32_t>(std::stoul(budget));
}

void LevelsOption::add(CLI::App& app, const char* otherwise)
{
    const auto check = [](std::string& text) {
        return scene::level_wish(text) ? std::string()
                                       : fmt::format("expected auto, off or a number, found '{}'", text);
    };
    app.add_option("--levels", word,
                   fmt::format("of detail, simplified, for a fast tip; auto: where the mesh is too fine for "
                               "the budget, which takes about as long and as much memory as preparing it; N: "
                               "that one alone [{}]",
                               otherwise))
        ->check(CLI::Validator(check, ""))
        ->type_name("auto|off|N");
}

std::optional<scene::LevelWish> LevelsOption::wish() const
{
    return scene::level_wish(word);
}

CLI::Option* add_device_option(CLI::App& app, std::string& node)
{
    return app.add_option("--device", node, "the kernel's device [the first there is]")
        ->type_name("/dev/phantom_rtN");
}

std::string listed(const std::vector<std::string>& words)
{
    std::string text;
    for (const std::string& word : words)
        text += (text.empty() ? "" : ", ") + word;
    return text.empty() ? "none" : text;
}

Result<std::string> ask_session(const std::string& request)
{
    Result<std::string> answer = feeder::control::request(request);
    if (!answer)
        return answer;
    const nlohmann::json reply = nlohmann::json::parse(*answer, nullptr, false);
    if (!reply.is_object() || !reply.contains("ok"))
        return Error{"", "the running session answered something that is not understood"};
    if (!reply["ok"].get<bool>())
        return Error{"", reply.value("error", "refused")};
    return answer;
}

} // namespace phantom::fdhctl
