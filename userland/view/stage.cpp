// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/stage.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <vtkCamera.h>
#include <vtkProperty.h>

#include "view/colour.hpp"
#include "view/picture_file.hpp"
#include "view/renderer_look.hpp"

namespace phantom::view {

namespace {

constexpr double right_part = 0.37;   ///< of the width: close-up, figures and chart
constexpr double chart_part = 0.32;   ///< of the height
constexpr double spot_opacity = 0.62; ///< of the surface in the close-up: a tip inside is seen
constexpr double row_lines = 1.42;    ///< height of a line of figures, in font sizes
constexpr double legend_lines = 3.9;  ///< height of the legend, in font sizes

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
      oversampling_(offscreen ? picture_oversampling : 1),
      surfaces_(scene),
      whole_probe_(whole_, 1),
      spot_probe_(spot_, 0.28),
      chart_(graph_, ForceChart::Lines::norm),
      base_shapes_(base_),
      whole_shapes_(whole_),
      spot_shapes_(spot_)
{
    extent_mm_ = std::max(scene_.bounds().diagonal(), 1e-3);
    window_->SetWindowName("fdhview");
    window_->SetOffScreenRendering(offscreen);
    window_->SetSize(oversampling_ * width, oversampling_ * height);
    window_->SetMultiSamples(0);

    for (vtkRenderer* renderer : {base_.Get(), whole_.Get(), spot_.Get(), graph_.Get()}) {
        set_background(renderer, palette::panel, palette::panel);
        window_->AddRenderer(renderer);
    }
    set_background(whole_, palette::background_bottom, palette::background_top);
    set_background(spot_, palette::background_bottom, palette::background_top);
    base_->InteractiveOff();
    spot_->InteractiveOff();
    graph_->InteractiveOff();

    light(whole_);
    light(spot_);

    surfaces_.add_to(whole_, 1);
    surfaces_.add_to(spot_, spot_opacity);
    selected_in_whole_ = selected_.add_to(whole_, 1, 1.0 * oversampling_);
    selected_.add_to(spot_, 0.55, 1.3 * oversampling_);
    whole_probe_.set_label_visible(true);
    arrange();
}

int Stage::font(double factor) const
{
    return static_cast<int>(std::lround(factor * px(15)));
}

double Stage::px(double at_800) const
{
    // Words stay readable in a small window, and do not fill a narrow one.
    const double size = std::min<double>(arranged_[1], 0.625 * arranged_[0]);
    return at_800 * std::max(size / 800, oversampling_ * 0.65);
}

double Stage::header_px() const
{
    return 4.4 * font();
}

double Stage::footer_px() const
{
    return (colour_bar_n_ ? 2.9 : 1.2) * font() + 1.35 * font() * static_cast<double>(panel_.hints.size());
}

void Stage::arrange()
{
    const int* size = window_->GetSize();
    if (size[0] == arranged_[0] && size[1] == arranged_[1] && arranged_rows_ == panel_.rows.size())
        return;
    arranged_ = {size[0], size[1]};
    arranged_rows_ = panel_.rows.size();
    const double width = size[0], height = size[1];
    const auto place = [&](vtkRenderer* renderer, const Box& box) {
        renderer->SetViewport(box.x / width, box.y / height, (box.x + box.width) / width,
                              (box.y + box.height) / height);
    };
    const double left = std::round(width * (1 - right_part)), right = width - left;
    const double chart_top = std::round(height * chart_part);
    const double rows = std::round((row_lines * static_cast<double>(arranged_rows_) + 1.2) * font());
    const double spot_bottom = chart_top + rows + std::round(legend_lines * font());
    whole_box_ = {0, 0, left, height};
    spot_box_ = {left + px(1), spot_bottom, right - px(1), std::max(height - spot_bottom, 40.0)};
    column_box_ = {left, chart_top, right, spot_bottom - chart_top};
    const Box graph{left + px(6), px(4), right - px(14), chart_top - px(8)};
    place(base_, {0, 0, width, height});
    place(whole_, whole_box_);
    place(spot_, spot_box_);
    place(graph_, graph);
    chart_.set_scale(font(0.87), px(1));
    chart_.set_size(static_cast<int>(graph.width), static_cast<int>(graph.height));
    whole_probe_.set_scale(font(1.05), px(2));
    spot_probe_.set_scale(font(1.2), px(2));
}

void Stage::set_camera(const CameraAngles& angles)
{
    arrange();
    const Room room{whole_box_.width, whole_box_.height, header_px(), footer_px()};
    frame_all(whole_, surfaces_.outline(), angles, room);
    whole_->ResetCameraClippingRange();
}

void Stage::aim_spot(const Touch& touch, const Vec3& normal, double radius_mm, double blend)
{
    // Half of the selection's corners lie within `reach`. On coarse meshes that is most of the
    // scene, on fine ones less than the tip's ball: keep the ball between a third and a tenth.
    const double reach = selected_.reach_mm(touch.proxy_mm);
    const double wanted = std::clamp(1.6 * reach, 2.6 * radius_mm, 10 * radius_mm);
    if (looked_.half_height_mm <= 0)
        blend = 1;
    looked_.half_height_mm += blend * (wanted - looked_.half_height_mm);
    looked_.normal = unit_or((1 - blend) * looked_.normal + blend * normal, normal);
    // The arrow needs the room above.
    const Vec3 centre = touch.proxy_mm + 0.36 * looked_.half_height_mm * looked_.normal;
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

void Stage::show(const Touch& touch, std::span<const fdh::Hit> selected, const scene::Scene& of,
                 const scene::Moment* moment, const Vec3& normal, double radius_mm, double blend)
{
    touch_ = touch;
    radius_mm_ = radius_mm;
    if (moment)
        surfaces_.show(*moment);
    selected_.show(selected, of, moment);
    // Of a patch that is small in the whole picture the edges would leave nothing to see.
    constexpr double large_patch = 0.06;
    selected_in_whole_->GetProperty()->SetEdgeVisibility(selected_.reach_mm(touch.proxy_mm) >
                                                         large_patch * extent_mm_);
    aim_spot(touch, normal, radius_mm, blend);
    size_probes(touch, radius_mm);
}

void Stage::draw_whole_overlay()
{
    whole_shapes_.clear();
    const double x = 1.3 * font(), line = 1.35 * font();
    const double top = whole_box_.height;
    whole_shapes_.text(x, top - 1.7 * font(), panel_.title, {font(1.35), palette::ink, true});
    whole_shapes_.text(x, top - 3.3 * font(), panel_.subtitle, {font(0.93), palette::faint_ink});
    double y = 1.1 * font() + line * (static_cast<double>(panel_.hints.size()) - 1);
    for (const std::string& hint : panel_.hints) {
        whole_shapes_.text(x, y, hint, {font(0.87), palette::faint_ink});
        y -= line;
    }
    draw_region_marker();
    if (colour_bar_n_)
        draw_colour_bar();
}

void Stage::draw_colour_bar()
{
    constexpr int steps = 128;
    const double x = 12.6 * font(), width = 14.0 * font(), height = 0.7 * font();
    const double y = footer_px() - 1.0 * font();
    whole_shapes_.text(1.3 * font(), y + 0.5 * height, "force along the path, N", {font(0.93), palette::ink});
    for (int i = 0; i < steps; ++i)
        whole_shapes_.rectangle(x + width * i / steps, y, width / steps, height, viridis((i + 0.5) / steps));
    for (const double part : {0.0, 0.5, 1.0})
        whole_shapes_.text(x + part * width, y - 0.85 * font(), fmt::format("{:.2g}", part * *colour_bar_n_),
                           {font(0.87), palette::ink, false, Align::centre});
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
    if (half > 0.3 * whole_box_.height)
        return;
    whole_shapes_.frame(middle[0] - half, middle[1] - half, 2 * half, 2 * half, px(1.5), palette::ink);
}

void Stage::draw_spot_overlay()
{
    spot_shapes_.clear();
    const double x = 1.0 * font(), width = spot_box_.width, height = spot_box_.height;
    spot_shapes_.text(x, height - 1.7 * font(), "Contact", {font(1.1), palette::ink, true});

    const double px_per_mm = height / (2 * looked_.half_height_mm);
    const double bar_mm = round_down(0.28 * width / px_per_mm);
    const double bar_x = width - 1.3 * font() - bar_mm * px_per_mm, bar_y = height - 2.3 * font();
    spot_shapes_.rectangle(bar_x, bar_y, bar_mm * px_per_mm, px(2), palette::ink);
    for (const double end : {bar_x, bar_x + bar_mm * px_per_mm - px(2)})
        spot_shapes_.rectangle(end, bar_y - px(4), px(2), px(10), palette::ink);
    spot_shapes_.text(bar_x + 0.5 * bar_mm * px_per_mm, bar_y + 1.1 * font(), fmt::format("{:g} mm", bar_mm),
                      {font(0.87), palette::ink, false, Align::centre});
}

void Stage::draw_column()
{
    base_shapes_.clear();
    const Box& box = column_box_;
    const double x = box.x + 1.0 * font();
    base_shapes_.rectangle(box.x, 0, px(1), arranged_[1], palette::rule);
    base_shapes_.rectangle(box.x, box.y + box.height - px(1), box.width, px(1), palette::rule);
    draw_legend(x, box.y + box.height, box.width);
    double y = box.y + box.height - legend_lines * font();
    base_shapes_.rectangle(x, y, box.width - 2.0 * font(), px(1), palette::rule);
    y += (0.5 * row_lines - 0.5) * font();
    for (const PanelRow& row : panel_.rows) {
        y -= row_lines * font();
        base_shapes_.text(x, y, row.name, {font(0.93), palette::faint_ink});
        base_shapes_.text(x + 6.2 * font(), y, row.value,
                          {font(0.93), row.warning ? palette::warning : palette::ink, row.warning});
    }
}

void Stage::draw_legend(double x, double y, double width)
{
    const bool apart = length(touch_.proxy_mm - touch_.tip_mm) > 1e-6;
    struct Entry {
        Colour colour;
        std::string words;
    };
    const std::array<Entry, 4> entries{
        Entry{palette::tip, fmt::format("tip, R = {:g} mm", radius_mm_)},
        Entry{palette::proxy, apart ? "proxy" : "proxy (= tip)"},
        Entry{palette::selected, fmt::format("{} selected triangles", selected_.count())},
        Entry{palette::force, "force on the hand"}};
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const double left = x + (i < 2 ? 0.0 : 0.46 * width);
        const double middle = y - (i % 2 == 0 ? 1.25 : 2.7) * font();
        base_shapes_.disc(left + 0.4 * font(), middle, 0.42 * font(), entries[i].colour);
        base_shapes_.text(left + 1.4 * font(), middle, entries[i].words, {font(0.93), palette::ink});
    }
}

void Stage::render()
{
    arrange();
    whole_->ResetCameraClippingRange();
    draw_whole_overlay();
    draw_spot_overlay();
    draw_column();
    window_->Render();
    if (oversampling_ == 1 && !driver_known_) {
        driver_known_ = true;
        // Drawn in software, eight samples make a frame take six times as long.
        const std::string driver = window_->ReportCapabilities();
        if (driver.find("llvmpipe") == std::string::npos && driver.find("softpipe") == std::string::npos)
            window_->SetMultiSamples(8);
    }
}

Status Stage::save_png(const std::filesystem::path& file)
{
    // Twice: the first frame settles text sizes and the window's real size.
    render();
    render();
    return save_window(window_, file, oversampling_);
}

} // namespace phantom::view
