// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl info: what a scene is made of and what touching it will cost.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "fdhctl/command_line.hpp"
#include "fdhctl/level_report.hpp"
#include "fdhctl/mesh_report.hpp"
#include "fdhctl/view.hpp"
#include "feeder/servo_choice.hpp"
#include "scene/deforming_surface.hpp"
#include "study/effect_cost.hpp"
#include "study/tick_cost.hpp"

namespace phantom::fdhctl {

namespace {

/// The budget that the prediction is for: the feeder's own.
constexpr std::uint32_t budget = feeder::FeederOptions{}.budget;

struct Options {
    SceneOptions scene;
    LevelsOption levels;
    double feed_rate_hz = feeder::FeederOptions{}.rate_hz;
    std::optional<std::string> picture;
    bool json = false;
};

struct Facts {
    scene::Scene scene;
    scene::Levels levels; ///< only the scene's own when they are off
    FeedPace pace;
    double build_ms = 0;
    std::size_t tree_bytes = 0;
    std::uint32_t rate_hz = 0;
    phantom_model model{};
    study::TickCost cost;                   ///< with all effects
    std::vector<study::EffectCost> effects; ///< contact alone, then each effect alone
};

/// As a session would have them; always what sets of the scene itself cover.
scene::Levels levels_of(const scene::Scene& scene, const fdh::SceneTree<14>& tree, const Options& options)
{
    const auto wish = options.levels.wish();
    if (!(wish ? wish->on : scene.levels.value_or(true))) {
        scene::Levels off;
        off.finest = scene::measure_coverage(scene, tree, budget);
        return off;
    }
    scene::LevelOptions wanted;
    wanted.budget = budget;
    wanted.delay_s = std::max(scene::slow_feed_s, 1.0 / options.feed_rate_hz);
    wanted.edge_max_mm = feeder::edge_max_mm({});
    wanted.cache = options.scene.load_options().cache;
    return scene::build_levels(scene, tree, wanted);
}

Result<Facts> gather(const Options& options)
{
    Result<scene::Scene> scene = load_scene(options.scene);
    if (!scene)
        return scene.error();
    Facts facts;
    facts.scene = std::move(*scene);
    if (Status status = feeder::check_reach(facts.scene, {}); !status)
        return status.error();
    const auto begin = std::chrono::steady_clock::now();
    const fdh::SceneTree<14> tree = scene::build_tree<14>(facts.scene);
    facts.build_ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    facts.tree_bytes = tree.bytes();
    facts.levels = levels_of(facts.scene, tree, options);
    facts.pace = {options.feed_rate_hz, facts.scene.max_radius_mm()};
    const Result<std::uint32_t> rate = feeder::choose_rate({}, facts.scene.servo);
    if (!rate)
        return rate.error();
    facts.rate_hz = *rate;
    device::UsermodeOptions usermode;
    usermode.virtual_clock = true;
    const Result<device::Device> device = device::Device::open_usermode(usermode);
    if (!device)
        return device.error();
    const Result<phantom_model> model = feeder::choose_model({}, facts.scene.servo, device->info().features);
    if (!model)
        return model.error();
    facts.model = *model;
    const std::uint32_t isa = study::tick_sections().front();
    Result<study::TickCost> cost = study::measure_tick(facts.scene, tree, facts.model, isa, budget);
    if (!cost)
        return cost.error();
    facts.cost = *cost;
    Result<std::vector<study::EffectCost>> effects =
        study::measure_effects(facts.scene, tree, facts.model, isa, budget);
    if (!effects)
        return effects.error();
    facts.effects = std::move(*effects);
    return facts;
}

/// Faces of every group of a mesh, in the order of their numbers.
std::vector<std::uint64_t> group_sizes(const mesh::Mesh& mesh)
{
    std::vector<std::uint64_t> sizes(mesh.group_names.size(), 0);
    for (const std::uint8_t group : mesh.face_groups)
        ++sizes[group];
    return sizes;
}

const std::string& group_material(const scene::Scene& scene, const scene::Object& object, std::size_t group)
{
    return scene.materials[object.group_materials.empty() ? object.material : object.group_materials[group]]
        .name;
}

nlohmann::json groups_json(const scene::Scene& scene, const scene::Object& object)
{
    nlohmann::json out = nlohmann::json::array();
    const std::vector<std::uint64_t> sizes = group_sizes(object.mesh);
    for (std::size_t group = 0; group < sizes.size(); ++group)
        out.push_back({{"name", object.mesh.group_names[group]},
                       {"triangles", sizes[group]},
                       {"material", group_material(scene, object, group)}});
    return out;
}

std::string groups_text(const scene::Scene& scene, const scene::Object& object)
{
    std::string text;
    const std::vector<std::uint64_t> sizes = group_sizes(object.mesh);
    for (std::size_t group = 0; group < sizes.size(); ++group) {
        const std::string& name = object.mesh.group_names[group];
        text += fmt::format("{:<11} {}: {} triangles, material {}\n", group == 0 ? "groups" : "",
                            name.empty() ? "(no name)" : name, sizes[group],
                            group_material(scene, object, group));
    }
    return text;
}

std::string effect_text(const study::EffectCost& effect)
{
    return fmt::format("{:<11} {} {:>5.0f} ns a tick, {} bytes a set", effect.name,
                       effect.name == study::contact_alone ? " " : "+", effect.tick_ns, effect.set_bytes);
}

nlohmann::json effects_json(const Facts& facts)
{
    nlohmann::json costs = nlohmann::json::array();
    for (const study::EffectCost& effect : facts.effects)
        costs.push_back(
            {{"name", effect.name}, {"tick_ns", effect.tick_ns}, {"set_bytes", effect.set_bytes}});
    return {{"called_for", facts.scene.effects_called_for()},
            {"not_called_for", facts.scene.effects_not_called_for()},
            {"costs", costs}};
}

std::string motion_text(const scene::Object& object)
{
    std::string text;
    if (object.motion && object.motion->kind == scene::Motion::Kind::turntable)
        text += fmt::format("{:<11} turntable, {:g} revolutions per second\n", "motion",
                            object.motion->frequency);
    else if (object.motion)
        text += fmt::format("{:<11} oscillation, {:g} mm, {:g} times a second\n", "motion",
                            object.motion->amplitude_mm, object.motion->frequency);
    if (object.deformation)
        text +=
            fmt::format("{:<11} {}, {:g} mm, {:g} times a second: a new shape every {:.0f} ms\n", "deform",
                        object.deformation->kind == scene::Deformation::Kind::drum ? "drum" : "wave",
                        object.deformation->amplitude_mm, object.deformation->frequency_hz,
                        1e3 * scene::revision_interval_s(object.mesh.faces.size()));
    return text;
}

nlohmann::json json_of(const Facts& facts)
{
    const scene::Scene& scene = facts.scene;
    const mesh::Bounds bounds = scene.bounds();
    nlohmann::json objects = nlohmann::json::array(), materials = nlohmann::json::array();
    for (const scene::Object& object : scene.objects)
        objects.push_back({{"name", object.name},
                           {"file", object.file.string()},
                           {"triangles", object.mesh.faces.size()},
                           {"fans", object.fans.fans.size()},
                           {"rims", object.rims.edges.size()},
                           {"material", scene.materials[object.material].name},
                           {"groups", groups_json(scene, object)},
                           {"moves", object.motion.has_value()},
                           {"deforms", object.deformation.has_value()},
                           {"report", report_json(object)}});
    for (const scene::Material& material : scene.materials) {
        nlohmann::json entry = {{"name", material.name},
                                {"stiffness_n_mm", material.stiffness_n_mm},
                                {"radius_mm", material.radius_mm}};
        if (material.damping_ns_m)
            entry["damping_ns_m"] = *material.damping_ns_m;
        materials.push_back(entry);
    }
    return {{"scene", scene.file.string()},
            {"triangles", scene.triangles()},
            {"bounds_mm", {{"low", bounds.low}, {"high", bounds.high}}},
            {"objects", objects},
            {"materials", materials},
            {"effects", effects_json(facts)},
            {"device",
             {{"simulated", scene.device.simulated()}, {"not_simulated", scene.device.not_simulated()}}},
            {"rate_hz", facts.rate_hz},
            {"model", device::model_text(facts.model)},
            {"tick",
             {{"isa", device::isa_name(facts.cost.isa)},
              {"patches", facts.cost.patches},
              {"median_ns", facts.cost.tick_ns.median},
              {"p99_ns", facts.cost.tick_ns.p99},
              {"period_percent", facts.cost.tick_ns.median * 1e-7 * facts.rate_hz}}},
            {"tree", {{"build_ms", facts.build_ms}, {"bytes", facts.tree_bytes}}},
            {"coverage", coverage_json(facts.levels.finest, facts.pace)},
            {"levels", levels_json(scene, facts.levels, facts.pace)}};
}

std::string text_of(const Facts& facts)
{
    const scene::Scene& scene = facts.scene;
    const mesh::Bounds bounds = scene.bounds();
    std::string text;
    const auto add = [&text](const char* name, const std::string& value) {
        text += fmt::format("{:<11} {}\n", name, value);
    };
    add("scene", fmt::format("{}: {} triangles in {} object{}, {:.4g} x {:.4g} x {:.4g} mm",
                             scene.file.string(), scene.triangles(), scene.objects.size(),
                             scene.objects.size() == 1 ? "" : "s", bounds.high[0] - bounds.low[0],
                             bounds.high[1] - bounds.low[1], bounds.high[2] - bounds.low[2]));
    for (const scene::Object& object : scene.objects) {
        text += fmt::format("\n{:<11} {} ({}), material {}\n", "object", object.name,
                            object.file.empty() ? "shape" : object.file.string(),
                            scene.materials[object.material].name);
        text += report_text(object);
        text += groups_text(scene, object) + motion_text(object);
        if (!object.fans.fans.empty())
            add("fans", fmt::format("{} over creases and their corners", object.fans.fans.size()));
        if (!object.rims.edges.empty())
            add("rims",
                fmt::format("{} edges in {} rim{}: open, so the force fades over the last {:g} mm before "
                            "them (two_sided = true closes it)",
                            object.rims.edges.size(), object.rims.loops, object.rims.loops == 1 ? "" : "s",
                            scene.max_radius_mm(object)));
    }
    text += "\n";
    for (const scene::Material& material : scene.materials)
        add("material",
            fmt::format("{}: stiffness {:g} N/mm, radius {:g} mm{}", material.name, material.stiffness_n_mm,
                        material.radius_mm,
                        material.damping_ns_m ? fmt::format(", damping {:g} N*s/m", *material.damping_ns_m)
                                              : ""));
    add("effects", "called for: " + listed(scene.effects_called_for()) +
                       "; not called for, and costing nothing: " + listed(scene.effects_not_called_for()));
    for (const study::EffectCost& effect : facts.effects)
        add("", effect_text(effect));
    add("device", "simulated by trace: " + listed(scene.device.simulated()) +
                      "; not named, and not simulated: " + listed(scene.device.not_simulated()));
    add("hierarchy", fmt::format("FDH14, {:.1f} MB, built in {:.0f} ms",
                                 static_cast<double>(facts.tree_bytes) * 1e-6, facts.build_ms));
    add("coverage", coverage_text(facts.levels.finest, facts.pace));
    text += levels_text(scene, facts.levels, facts.pace);
    add("model", device::model_text(facts.model));
    add("tick",
        fmt::format(
            "{:.0f} ns (median), {:.0f} ns (p99) with {} patches and {}: {:.2f} % of a period at {} Hz "
            "(measured here, on a virtual clock)",
            facts.cost.tick_ns.median, facts.cost.tick_ns.p99, facts.cost.patches,
            device::isa_name(facts.cost.isa), facts.cost.tick_ns.median * 1e-7 * facts.rate_hz,
            facts.rate_hz));
    return text;
}

} // namespace

Run add_info(CLI::App& app)
{
    auto options = std::make_shared<Options>();
    options->scene.add(app);
    options->levels.add(app, "auto, or the scene's");
    add_feed_rate(app, options->feed_rate_hz, "sets per second that speeds are reckoned with");
    add_picture(app, options->picture);
    app.add_flag("--json", options->json, "as one line of JSON");
    return [options] {
        const Result<Facts> facts = gather(*options);
        if (!facts)
            return fail(facts.error());
        const FeedPace& pace = facts->pace;
        const scene::Levels& levels = facts->levels;
        if (const auto warning = coverage_warning(levels.coverage(levels.size() - 1), pace))
            std::fprintf(stderr, "fdhctl: warning: %s: %s\n", options->scene.scene.c_str(), warning->c_str());
        if (options->json)
            std::printf("%s\n", json_of(*facts).dump().c_str());
        else
            std::printf("%s", text_of(*facts).c_str());
        return draw_picture(options->picture, options->scene.arguments(), options->feed_rate_hz);
    };
}

} // namespace phantom::fdhctl
