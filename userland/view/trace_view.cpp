// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/trace_view.hpp"

#include <algorithm>
#include <iostream>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkRenderWindowInteractor.h>

#include "scene/live_scene.hpp"
#include "view/chart_picture.hpp"
#include "view/path_actors.hpp"
#include "view/scene_words.hpp"
#include "view/stage.hpp"
#include "view/trace.hpp"

namespace phantom::view {

namespace {

constexpr std::size_t selected_triangles = 64; ///< the feeder's budget
constexpr double search_radius_mm = 50;        ///< as the feeder's

struct Moment {
    std::size_t row = 0;
    Touch touch;
    fdh::Nearest nearest;
    std::shared_ptr<const scene::Moment> places; ///< of what moves; nothing where nothing does
    Vec3 normal{0, 1, 0};
    double radius_mm = 1;
};

Vec3 outward_normal(const Touch& touch, const SelectedTriangles& selected)
{
    // The force points out of the surface; without one, the triangles below say where out is.
    return touch.force_norm_n() > 1e-6 ? unit_or(touch.force_n, {0, 1, 0}) : selected.facing({0, 1, 0});
}

Result<Moment> moment_of(const Trace& trace, const Options& options, const scene::Scene& scene)
{
    Moment moment;
    moment.row = options.at_row.value_or(trace.strongest());
    if (moment.row >= trace.rows.size())
        return Error{trace.file.string(), fmt::format("--at-row {}: the trace has {} rows, counted from 0",
                                                      moment.row, trace.rows.size())};
    moment.touch = trace.rows[moment.row];
    const auto tree = scene::build_tree<14>(scene);
    std::optional<scene::LiveScene> live;
    if (scene::LiveScene::is_called_for(scene)) {
        live.emplace(scene, tree);
        live->advance(moment.touch.time_s - trace.rows.front().time_s);
        moment.places = live->moment();
    }
    (live ? live->tree() : tree)
        .nearest(moment.touch.query_centre_mm(), selected_triangles, search_radius_mm, moment.nearest);
    moment.nearest.sort();
    SelectedTriangles selected;
    selected.show(moment.nearest.hits, scene, moment.places.get());
    moment.normal = outward_normal(moment.touch, selected);
    moment.radius_mm = scene.max_radius_mm();
    if (!moment.nearest.hits.empty()) {
        const fdh::Hit& nearest = moment.nearest.hits.front();
        moment.radius_mm =
            scene.materials[scene.objects[nearest.object].material_of(nearest.triangle)].radius_mm;
    }
    return moment;
}

Panel panel_of(const scene::Scene& scene, const Trace& trace, const Moment& moment)
{
    const Touch& touch = moment.touch;
    Panel panel;
    panel.title = scene.file.filename().string();
    panel.subtitle = scene_size_text(scene);
    panel.rows = {
        {"trace", fmt::format("{} ticks, {:.2f} s", trace.rows.size(),
                              trace.rows.back().time_s - trace.rows.front().time_s)},
        {"shown", fmt::format("t = {:.3f} s", touch.time_s)},
        {"force", fmt::format("{:.3f} N", touch.force_norm_n())},
        {"contacts", fmt::format("{}{}", touch.contacts, touch.inside ? ", held by the proxy" : "")},
    };
    return panel;
}

void print_summary(const Trace& trace, const Moment& moment)
{
    nlohmann::json summary;
    summary["rows"] = trace.rows.size();
    summary["row"] = moment.row;
    summary["time_s"] = moment.touch.time_s;
    summary["max_force_n"] = trace.max_force_n();
    summary["force_n"] = moment.touch.force_norm_n();
    summary["selected"] = moment.nearest.hits.size();
    std::cout << summary.dump(2) << '\n';
}

void interact(Stage& stage)
{
    vtkNew<vtkRenderWindowInteractor> interactor;
    interactor->SetRenderWindow(stage.window());
    vtkNew<vtkInteractorStyleTrackballCamera> style;
    interactor->SetInteractorStyle(style);
    interactor->Initialize();
    stage.render();
    interactor->Start();
}

} // namespace

Status run_trace_view(const Options& options)
{
    auto trace = read_trace(*options.trace);
    if (!trace)
        return trace.error();
    auto scene = scene::load(options.scene, options.load);
    if (!scene)
        return scene.error();
    auto moment = moment_of(*trace, options, *scene);
    if (!moment)
        return moment.error();

    const double max_force_n = std::max(trace->max_force_n(), 1e-3);
    const std::deque<Touch> history(trace->rows.begin(), trace->rows.end());
    if (options.chart) {
        auto saved = save_chart(history, moment->touch.time_s, options, *options.chart);
        if (!saved)
            return saved;
    }
    if (options.screenshot || !options.chart) {
        Stage stage(*scene, options.width, options.height, options.offscreen());
        stage.set_camera(options.camera.value_or(CameraAngles::facing(moment->normal)));
        stage.set_full_scale(max_force_n);
        stage.set_colour_bar(max_force_n);
        add_path(stage.whole(), *trace, 0.0036 * stage.extent_mm(), max_force_n);
        stage.show(moment->touch, moment->nearest.hits, *scene, moment->places.get(), moment->normal,
                   moment->radius_mm, 1);
        stage.set_panel(panel_of(*scene, *trace, *moment));
        stage.chart().mark(moment->touch.time_s);
        stage.chart().show(history, history.front().time_s, history.back().time_s, max_force_n);
        if (!options.offscreen())
            interact(stage);
        if (options.screenshot) {
            auto saved = stage.save_png(*options.screenshot);
            if (!saved)
                return saved;
        }
    }
    if (options.json)
        print_summary(*trace, *moment);
    return success();
}

} // namespace phantom::view
