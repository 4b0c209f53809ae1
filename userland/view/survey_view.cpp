// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/survey_view.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkUnsignedCharArray.h>

#include "view/camera.hpp"
#include "view/flat_shapes.hpp"
#include "view/picture_file.hpp"
#include "view/renderer_look.hpp"
#include "view/scene_actors.hpp"
#include "view/scene_words.hpp"
#include "view/survey.hpp"

namespace phantom::view {

namespace {

constexpr std::uint32_t budget = 64; ///< triangles of a set, as the feeder's
constexpr double crease_px = 1.6, rim_px = 4, fault_px = 5;
constexpr double legend_part = 0.24; ///< of the height, at the lower edge
constexpr double title_px = 54;      ///< at a height of 800

/// A colour for every face.
vtkSmartPointer<vtkActor> surface_actor(vtkPolyData* surface, const std::vector<unsigned char>& bands,
                                        const std::array<SpeedBand, 4>& speeds, const fdh::Pose& pose)
{
    vtkNew<vtkUnsignedCharArray> colours;
    colours->SetNumberOfComponents(3);
    for (const unsigned char band : bands)
        for (const double part : speeds[band].colour)
            colours->InsertNextValue(static_cast<unsigned char>(std::lround(255 * part)));
    surface->GetCellData()->SetScalars(colours);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(surface);
    mapper->SetScalarModeToUseCellData();
    // Behind the lines that lie in it.
    mapper->SetResolveCoincidentTopologyToPolygonOffset();
    mapper->SetRelativeCoincidentTopologyPolygonOffsetParameters(1, 1);
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    actor->SetUserMatrix(matrix_of(pose));
    vtkProperty* look = actor->GetProperty();
    look->SetInterpolationToPhong();
    look->SetAmbient(0.25);
    look->SetDiffuse(0.75);
    return actor;
}

vtkSmartPointer<vtkActor> line_actor(const std::vector<SurveyLine>& lines, const Colour& colour, double width)
{
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> cells;
    for (const SurveyLine& line : lines) {
        cells->InsertNextCell(2);
        cells->InsertCellPoint(points->InsertNextPoint(line.from.data()));
        cells->InsertCellPoint(points->InsertNextPoint(line.to.data()));
    }
    vtkNew<vtkPolyData> data;
    data->SetPoints(points);
    data->SetLines(cells);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(data);
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    vtkProperty* look = actor->GetProperty();
    set_colour(look, colour);
    look->LightingOff();
    look->SetLineWidth(static_cast<float>(width));
    return actor;
}

class SurveyPicture {
  public:
    SurveyPicture(const scene::Scene& scene, const Options& options, Survey survey)
        : scene_(scene), options_(options), survey_(std::move(survey)), surfaces_(scene), shapes_(legend_)
    {
        window_->SetOffScreenRendering(true);
        window_->SetSize(picture_oversampling * options.width, picture_oversampling * options.height);
        window_->SetMultiSamples(0);
        set_background(legend_, palette::panel, palette::panel);
        window_->AddRenderer(legend_);
        const CameraAngles front = options.camera.value_or(CameraAngles{});
        CameraAngles back = front;
        back.azimuth_deg += 180;
        back.elevation_deg = -back.elevation_deg;
        add_side(left_, 0, front);
        add_side(right_, 0.5, back);
        // Pixels are those of the window.
        legend_->SetViewport(0, 0, 1, 1);
        draw_titles();
        draw_legend();
    }

    Status save(const std::filesystem::path& file)
    {
        window_->Render();
        return save_window(window_, file, picture_oversampling);
    }

  private:
    [[nodiscard]] double px(double at_800) const
    {
        return at_800 * std::min<double>(options_.height, 0.625 * options_.width) / 800 *
               picture_oversampling;
    }
    [[nodiscard]] double width() const { return picture_oversampling * options_.width; }
    [[nodiscard]] double height() const { return picture_oversampling * options_.height; }
    [[nodiscard]] int font(double factor = 1) const { return static_cast<int>(std::lround(factor * px(15))); }

    void add_side(vtkRenderer* renderer, double x, const CameraAngles& angles)
    {
        set_background(renderer, palette::background_bottom, palette::background_top);
        const double top = 1 - px(title_px) / height();
        renderer->SetViewport(x + (x > 0 ? 1 / width() : 0), legend_part, x + 0.5, top);
        window_->AddRenderer(renderer);
        light(renderer);
        for (std::size_t i = 0; i < surfaces_.surfaces().size(); ++i)
            renderer->AddActor(surface_actor(surfaces_.surfaces()[i], survey_.bands[i], survey_.speeds,
                                             scene_.objects[i].pose));
        const double scale = picture_oversampling;
        renderer->AddActor(line_actor(survey_.creases, palette::crease, crease_px * scale));
        renderer->AddActor(line_actor(survey_.rims, palette::tip, rim_px * scale));
        renderer->AddActor(line_actor(survey_.faults, palette::fault, fault_px * scale));
        frame_all(renderer, surfaces_.outline(), angles,
                  {0.5 * width(), (top - legend_part) * height(), px(10), px(10)});
        renderer->ResetCameraClippingRange();
    }

    void draw_titles()
    {
        const double y = height() - 0.5 * px(title_px);
        shapes_.text(px(20), y, scene_.file.filename().string(), {font(1.25), palette::ink, true});
        shapes_.text(0.5 * width() - px(20), y, "from the front",
                     {font(), palette::faint_ink, false, Align::right});
        shapes_.text(0.5 * width() + px(20), y, scene_size_text(scene_), {font(), palette::ink});
        shapes_.text(width() - px(20), y, "from behind and below",
                     {font(), palette::faint_ink, false, Align::right});
    }

    void line_row(double x, double y, double thickness, const Colour& colour, const std::string& words)
    {
        shapes_.rectangle(x, y - 0.5 * px(thickness), px(40), px(thickness), colour);
        shapes_.text(x + px(54), y, words, {font(), palette::ink});
    }

    /// At most two lines that fit into half of the width.
    [[nodiscard]] std::vector<std::string> repair_lines() const
    {
        constexpr std::size_t letters = 74;
        if (survey_.repairs.empty())
            return {options_.load.prepare.full ? "Preparation had nothing to repair."
                                               : "Nothing was looked for: --prepare none."};
        std::vector<std::string> lines{"Preparation:"};
        for (const std::string& repair : survey_.repairs) {
            const std::string more = (lines.back().ends_with(':') ? " " : ", ") + repair;
            if (lines.back().size() + more.size() <= letters) {
                lines.back() += more;
            } else if (lines.size() < 2) {
                lines.back() += ",";
                lines.push_back(repair);
            } else {
                lines.back() += ", ...";
                break;
            }
        }
        return lines;
    }

    void draw_legend()
    {
        const double line = 1.7 * font(), top = legend_part * height() - 1.3 * font();
        const double left = px(20), middle = 0.5 * width() + px(20);
        double y = top;
        shapes_.text(left, y, "Edges", {font(1.05), palette::ink, true});
        line_row(left, y -= line, crease_px + 0.8, palette::crease,
                 fmt::format("{} crease edge{}: either face keeps its own normals, it feels sharp",
                             grouped(survey_.creases.size()), survey_.creases.size() == 1 ? "" : "s"));
        line_row(left, y -= line, rim_px, palette::tip,
                 survey_.rims.empty()
                     ? "no rims: the surface is closed"
                     : fmt::format("{} edges in {} rim{}: the surface ends, the force fades before it",
                                   grouped(survey_.rims.size()), survey_.loops,
                                   survey_.loops == 1 ? "" : "s"));
        line_row(
            left, y -= line, fault_px, palette::fault,
            survey_.faults.empty()
                ? "no faulty edges"
                : fmt::format("{} faulty edges, of more than two faces or not welded: no proxy slides across",
                              grouped(survey_.faults.size())));
        y -= 0.4 * line;
        for (const std::string& words : repair_lines())
            shapes_.text(left, y -= line, words, {font(), palette::faint_ink});

        y = top;
        shapes_.text(middle, y,
                     fmt::format("How fast a tip may go: what {} triangles last for at {:g} sets a second",
                                 budget, options_.feed_hz),
                     {font(1.05), palette::ink, true});
        for (std::size_t band = survey_.speeds.size(); band-- > 0;) {
            const SpeedBand& speed = survey_.speeds[band];
            y -= line;
            shapes_.rectangle(middle, y - 0.32 * line, px(40), 0.64 * line, speed.colour);
            shapes_.frame(middle, y - 0.32 * line, px(40), 0.64 * line, px(1), palette::rule);
            const std::string range =
                band + 1 == survey_.speeds.size()
                    ? fmt::format("{:g} mm/s and more: enough for a hand in a hurry", speed.from_mm_s)
                    : fmt::format("{:g} to {:g} mm/s{}", speed.from_mm_s, survey_.speeds[band + 1].from_mm_s,
                                  band == 0 ? ": too fine (levels, --simplify)" : "");
            shapes_.text(middle + px(54), y, range, {font(), palette::ink});
            shapes_.text(width() - px(20), y, fmt::format("{:.1f} % of the surface", 100 * speed.area_part),
                         {font(), palette::ink, false, Align::right});
        }
    }

    const scene::Scene& scene_;
    const Options& options_;
    Survey survey_;
    SceneActors surfaces_;
    vtkNew<vtkRenderWindow> window_;
    vtkNew<vtkRenderer> legend_, left_, right_;
    FlatShapes shapes_;
};

} // namespace

Status run_survey_view(const Options& options)
{
    const auto scene = scene::load(options.scene, options.load);
    if (!scene)
        return scene.error();
    return SurveyPicture(*scene, options, survey_of(*scene, budget, options.feed_hz)).save(*options.survey);
}

} // namespace phantom::view
