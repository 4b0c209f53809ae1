// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/stage.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <vtkCamera.h>
#include <vtkLightKit.h>

#include "view/colour.hpp"

namespace phantom::view {

namespace {

constexpr double right_part = 0.37;   ///< of the width: close-up and chart
constexpr double chart_part = 0.40;   ///< of the height
constexpr int gap_px = 10;            ///< between the cards on the right
constexpr double spot_opacity = 0.62; ///< of the surface in the close-up: a tip inside is seen

void light(vtkRenderer* renderer)
{
    // A warm key light over the left shoulder, fill and back lights that leave no black.
    vtkNew<vtkLightKit> kit;
    kit->SetKeyLightIntensity(0.82);
    kit->SetKeyLightAngle(42, -28);
    kit->SetKeyToFillRatio(2.6);
    kit->SetKeyToBackRatio(3.2);
    kit->SetKeyToHeadRatio(3.4);
    kit->SetKeyLightWarmth(0.54);
    kit->SetFillLightWarmth(0.46);
    kit->AddLightsToRenderer(renderer);
}

/// The largest of 1, 2, 5 times a power of ten not above x.
double round_down(double x)
{
    const double decade = std::pow(10.0, std::floor(std::log10(x)));
    for (const double step : {5.0, 2.0})
        if (step * decade <= x)
            return step * decade;
    return decade;
}

} // namespace

Stage::Stage(const scene::Scene& scene, int width, int height, bool offscreen)
    : scene_(scene),
      surfaces_(scene),
      selected_(scene),
      whole_probe_(whole_),
      spot_probe_(spot_),
      chart_(graph_, ForceChart::Lines::norm),
      base_shapes_(base_),
      whole_shapes_(whole_),
      spot_shapes_(spot_)
{
    extent_mm_ = std::max(scene_.bounds().diagonal(), 1e-3);
    window_->SetWindowName("fdhview");
    window_->SetOffScreenRendering(offscreen);
    window_->SetSize(width, height);
    window_->SetMultiSamples(8);

    for (vtkRenderer* renderer : {base_.Get(), whole_.Get(), spot_.Get(), graph_.Get()}) {
        renderer->SetBackground(palette::panel[0], palette::panel[1], palette::panel[2]);
        window_->AddRenderer(renderer);
    }
    base_->InteractiveOff();
    spot_->InteractiveOff();
    graph_->InteractiveOff();
    whole_->GradientBackgroundOn();
    whole_->SetBackground(palette::background_bottom[0], palette::background_bottom[1],
                          palette::background_bottom[2]);
    whole_->SetBackground2(palette::background_top[0], palette::background_top[1],
                           palette::background_top[2]);
    light(whole_);
    light(spot_);

    surfaces_.add_to(whole_, 1);
    surfaces_.add_to(spot_, spot_opacity);
    selected_.add_to(whole_, 0.9, 1.0);
    selected_.add_to(spot_, 0.55, 1.6);
    whole_probe_.set_label_visible(true);
    arrange();
}

int Stage::font(double factor) const
{
    const double base = std::clamp(arranged_[1] / 800.0 * 15, 10.0, 40.0);
    return static_cast<int>(std::lround(factor * base));
}

void Stage::arrange()
{
    const int* size = window_->GetSize();
    if (size[0] == arranged_[0] && size[1] == arranged_[1])
        return;
    arranged_ = {size[0], size[1]};
    const double width = size[0], height = size[1];
    const double left = std::round(width * (1 - right_part));
    const double chart_top = std::round(height * chart_part);
    const auto place = [&](vtkRenderer* renderer, double x0, double y0, double x1, double y1) {
        renderer->SetViewport(x0 / width, y0 / height, x1 / width, y1 / height);
        return std::array<int, 2>{static_cast<int>(x1 - x0), static_cast<int>(y1 - y0)};
    };
    place(base_, 0, 0, width, height);
    whole_px_ = place(whole_, 0, 0, left, height);
    spot_px_ = place(spot_, left + gap_px, chart_top + gap_px, width - gap_px, height - gap_px);
    const auto graph = place(graph_, left + gap_px, gap_px, width - gap_px, chart_top - gap_px);
    chart_.set_size(graph[0], graph[1]);
    chart_.set_font_size(font(0.87));
    whole_probe_.set_font_size(font(1.05));
    spot_probe_.set_font_size(font(1.2));

    base_shapes_.clear();
    base_shapes_.rectangle(left, 0, 1, height, palette::rule);
    base_shapes_.rectangle(left + gap_px, chart_top, width - left - 2 * gap_px, 1, palette::rule);
}

void Stage::set_camera(const CameraAngles& angles)
{
    angles_ = angles;
    frame_all(whole_, surfaces_.outline(), angles,
              static_cast<double>(whole_px_[0]) / std::max(whole_px_[1], 1));
    whole_->ResetCameraClippingRange();
}

void Stage::aim_spot(const Touch& touch, const Vec3& normal, double radius_mm, double blend)
{
    // Half of the selection's corners lie within `reach`. On coarse meshes that is most of the
    // scene, on fine ones less than the tip's ball: keep the ball between a third and a tenth.
    const double reach = selected_.reach_mm(touch.proxy_mm);
    const double wanted = std::clamp(1.5 * reach, 2.6 * radius_mm, 10 * radius_mm);
    if (looked_.half_height_mm <= 0)
        blend = 1;
    looked_.half_height_mm += blend * (wanted - looked_.half_height_mm);
    looked_.normal = unit_or((1 - blend) * looked_.normal + blend * normal, normal);
    // The arrow needs the room above.
    const Vec3 centre = touch.proxy_mm + 0.38 * looked_.half_height_mm * looked_.normal;
    looked_.centre = (1 - blend) * looked_.centre + blend * centre;

    Vec3 viewer{};
    whole_->GetActiveCamera()->GetDirectionOfProjection(viewer.data());
    frame_spot(spot_, looked_.centre, looked_.normal, -1.0 * viewer, looked_.half_height_mm);
    spot_->ResetCameraClippingRange();
}

void Stage::size_probes(const Touch& touch, double radius_mm)
{
    full_scale_n_ = std::max(full_scale_n_, touch.force_norm_n());
    ProbeSizes sizes;
    sizes.radius_mm = radius_mm;
    sizes.point_mm = std::min(0.12 * radius_mm, 0.05 * looked_.half_height_mm);
    sizes.arrow_mm_per_n = 1.0 * looked_.half_height_mm / full_scale_n_;
    sizes.arrow_width_mm = 0.018 * looked_.half_height_mm;
    spot_probe_.show(touch, sizes);

    sizes.point_mm = std::max(0.5 * radius_mm, 0.0022 * extent_mm_);
    sizes.arrow_mm_per_n = 0.22 * extent_mm_ / full_scale_n_;
    sizes.arrow_width_mm = 0.0042 * extent_mm_;
    whole_probe_.show(touch, sizes);
}

void Stage::show(const Touch& touch, std::span<const fdh::Hit> selected, const Vec3& normal, double radius_mm,
                 double blend)
{
    touch_ = touch;
    radius_mm_ = radius_mm;
    selected_.show(selected);
    aim_spot(touch, normal, radius_mm, blend);
    size_probes(touch, radius_mm);
}

void Stage::draw_whole_overlay()
{
    whole_shapes_.clear();
    const double line = 1.55 * font(), x = 1.3 * font();
    double y = whole_px_[1] - 1.7 * font();
    whole_shapes_.text(x, y, panel_.title, {font(1.35), palette::ink, true});
    y -= 1.1 * line;
    whole_shapes_.text(x, y, panel_.subtitle, {font(0.93), palette::faint_ink});
    y -= 0.4 * line;
    for (const PanelRow& row : panel_.rows) {
        y -= 0.92 * line;
        whole_shapes_.text(x, y, row.name, {font(0.93), palette::faint_ink});
        whole_shapes_.text(x + 5.6 * font(), y, row.value,
                           {font(0.93), row.warning ? palette::warning : palette::ink, row.warning});
    }
    y = 1.1 * font() + 0.85 * line * (static_cast<double>(panel_.hints.size()) - 1);
    for (const std::string& hint : panel_.hints) {
        whole_shapes_.text(x, y, hint, {font(0.87), palette::faint_ink});
        y -= 0.85 * line;
    }
    draw_region_marker();
    if (colour_bar_n_)
        draw_colour_bar();
}

void Stage::draw_colour_bar()
{
    constexpr int steps = 128;
    const double x = 1.3 * font(), width = 15.0 * font(), height = 0.8 * font();
    const double y = 2.6 * font() + (panel_.hints.empty() ? 0.0 : 1.5 * font());
    for (int i = 0; i < steps; ++i)
        whole_shapes_.rectangle(x + width * i / steps, y, width / steps, height, viridis((i + 0.5) / steps));
    whole_shapes_.text(x, y + 1.75 * font(), "|F| along the path, N", {font(0.93), palette::ink});
    for (const double part : {0.0, 0.5, 1.0}) {
        const Align align = part < 0.25 ? Align::left : part > 0.75 ? Align::right : Align::centre;
        whole_shapes_.text(x + part * width, y - 0.95 * font(), fmt::format("{:.2f}", part * *colour_bar_n_),
                           {font(0.87), palette::ink, false, align});
    }
}

void Stage::draw_region_marker()
{
    // The square that the close-up shows, as far as the eye can tell: seen from elsewhere.
    const auto to_pixels = [&](const Vec3& point) {
        whole_->SetWorldPoint(point[0], point[1], point[2], 1);
        whole_->WorldToDisplay();
        Vec3 at{};
        whole_->GetDisplayPoint(at.data());
        return at;
    };
    vtkCamera* camera = whole_->GetActiveCamera();
    const Vec3 up =
        unit_or({camera->GetViewUp()[0], camera->GetViewUp()[1], camera->GetViewUp()[2]}, {0, 1, 0});
    const Vec3 middle = to_pixels(touch_.proxy_mm);
    const Vec3 edge = to_pixels(touch_.proxy_mm + looked_.half_height_mm * up);
    const double half = std::max(length({edge[0] - middle[0], edge[1] - middle[1], 0}), 0.8 * font());
    if (half > 0.3 * whole_px_[1])
        return;
    whole_shapes_.frame(middle[0] - half, middle[1] - half, 2 * half, 2 * half, 1.5, palette::ink);
}

void Stage::draw_spot_overlay(double radius_mm, bool apart)
{
    spot_shapes_.clear();
    const double x = 1.0 * font(), width = spot_px_[0], height = spot_px_[1];
    spot_shapes_.text(x, height - 1.3 * font(), "Contact", {font(1.1), palette::ink, true});

    const double px_per_mm = height / (2 * looked_.half_height_mm);
    const double bar_mm = round_down(0.28 * width / px_per_mm);
    const double bar_x = width - x - bar_mm * px_per_mm, bar_y = height - 1.9 * font();
    spot_shapes_.rectangle(bar_x, bar_y, bar_mm * px_per_mm, 2, palette::ink);
    for (const double end : {bar_x, bar_x + bar_mm * px_per_mm - 2})
        spot_shapes_.rectangle(end, bar_y - 4, 2, 10, palette::ink);
    spot_shapes_.text(bar_x + 0.5 * bar_mm * px_per_mm, bar_y + 1.1 * font(), fmt::format("{:g} mm", bar_mm),
                      {font(0.87), palette::ink, false, Align::centre});

    struct Entry {
        Colour colour;
        std::string words;
    };
    const std::array<Entry, 4> entries{
        Entry{palette::tip, fmt::format("tip, R = {:g} mm", radius_mm)},
        Entry{palette::proxy, apart ? "proxy" : "proxy (= tip)"},
        Entry{palette::selected, fmt::format("{} selected triangles", selected_.count())},
        Entry{palette::force, "force on the hand"}};
    spot_shapes_.rectangle(0, 0, width, 4.0 * font(), palette::panel);
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const double left = x + (i < 2 ? 0.0 : 0.46 * width);
        const double y = (i % 2 == 0 ? 2.8 : 1.2) * font();
        spot_shapes_.disc(left + 0.4 * font(), y, 0.42 * font(), entries[i].colour);
        spot_shapes_.text(left + 1.4 * font(), y, entries[i].words, {font(0.93), palette::ink});
    }
}

void Stage::render()
{
    arrange();
    whole_->ResetCameraClippingRange();
    draw_whole_overlay();
    draw_spot_overlay(radius_mm_, length(touch_.proxy_mm - touch_.tip_mm) > 1e-6);
    window_->Render();
}

Status Stage::save_png(const std::filesystem::path& file)
{
    // Twice: the first frame settles text sizes and the window's real size.
    render();
    render();
    return save_window(window_, file);
}

} // namespace phantom::view
