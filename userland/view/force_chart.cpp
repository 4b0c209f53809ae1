// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/force_chart.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <vtkAxis.h>
#include <vtkBrush.h>
#include <vtkChartLegend.h>
#include <vtkContextScene.h>
#include <vtkDoubleArray.h>
#include <vtkPen.h>
#include <vtkPlot.h>
#include <vtkStringArray.h>
#include <vtkTextProperty.h>

#include "view/colour.hpp"

namespace phantom::view {

namespace {

/// Columns of the table: time, |F|, Fx, Fy, Fz.
constexpr std::array<const char*, 5> column_names{"time, s", "|F|", "Fx", "Fy", "Fz"};
/// A chart is a thousand pixels wide or so: per bin the smallest and the largest sample are enough.
constexpr std::size_t bins = 1200;

double column_value(const Touch& touch, std::size_t column)
{
    if (column == 0)
        return touch.time_s;
    return column == 1 ? touch.force_norm_n() : touch.force_n[column - 2];
}

/// Samples to draw: of each bin the weakest and the strongest, in order of time.
std::vector<const Touch*> envelope(const std::deque<Touch>& samples)
{
    std::vector<const Touch*> kept;
    const std::size_t per_bin = samples.size() / bins;
    if (per_bin < 3) {
        for (const Touch& touch : samples)
            kept.push_back(&touch);
        return kept;
    }
    for (std::size_t begin = 0; begin < samples.size(); begin += per_bin) {
        const Touch *weakest = &samples[begin], *strongest = &samples[begin];
        for (std::size_t i = begin; i < std::min(begin + per_bin, samples.size()); ++i) {
            if (samples[i].force_norm_n() < weakest->force_norm_n())
                weakest = &samples[i];
            if (samples[i].force_norm_n() > strongest->force_norm_n())
                strongest = &samples[i];
        }
        kept.push_back(weakest->time_s <= strongest->time_s ? weakest : strongest);
        if (weakest != strongest)
            kept.push_back(weakest->time_s <= strongest->time_s ? strongest : weakest);
    }
    return kept;
}

vtkSmartPointer<vtkDoubleArray> column(const char* name)
{
    auto array = vtkSmartPointer<vtkDoubleArray>::New();
    array->SetName(name);
    return array;
}

/// A round number not below x: the distance between ticks.
double round_up(double x)
{
    const double decade = std::pow(10.0, std::floor(std::log10(x)));
    for (const double step : {1.0, 2.0, 5.0})
        if (step * decade >= x * (1 - 1e-9))
            return step * decade;
    return 10 * decade;
}

/// Ticks at multiples of `step` in the range. VTK's own choice counts on a fixed font size.
void set_ticks(vtkAxis* axis, double low, double high, double step)
{
    vtkNew<vtkDoubleArray> positions;
    vtkNew<vtkStringArray> labels;
    // + 0.0: ceil may give -0.
    for (double i = std::ceil(low / step - 1e-6) + 0.0; i * step <= high + 1e-6 * step; ++i) {
        positions->InsertNextValue(i * step);
        labels->InsertNextValue(fmt::format("{:g}", i * step));
    }
    axis->SetRange(low, high);
    axis->SetCustomTickPositions(positions, labels);
}

void style_axis(vtkAxis* axis)
{
    axis->SetTitle("");
    axis->SetBehavior(vtkAxis::FIXED);
    vtkTextProperty* text = axis->GetLabelProperties();
    text->SetFontFamilyToArial();
    text->BoldOff();
    set_colour(text, palette::ink);
    const auto byte = [](double part) { return static_cast<unsigned char>(std::lround(255 * part)); };
    const auto& rule = palette::rule;
    axis->GetGridPen()->SetColor(byte(0.90), byte(0.91), byte(0.925));
    axis->GetPen()->SetColor(byte(rule[0]), byte(rule[1]), byte(rule[2]));
}

} // namespace

ForceChart::ForceChart(vtkRenderer* renderer, Lines lines) : lines_(lines), words_(renderer)
{
    for (const char* name : column_names)
        table_->AddColumn(column(name));
    marker_->AddColumn(column("time, s"));
    marker_->AddColumn(column("shown"));

    style_axis(chart_->GetAxis(vtkAxis::BOTTOM));
    style_axis(chart_->GetAxis(vtkAxis::LEFT));
    add_line(1, palette::ink, "magnitude");
    if (lines == Lines::norm_and_components) {
        add_line(2, palette::component_x, "x");
        add_line(3, palette::component_y, "y");
        add_line(4, palette::component_z, "z");
        chart_->SetShowLegend(true);
        vtkChartLegend* legend = chart_->GetLegend();
        legend->SetHorizontalAlignment(vtkChartLegend::RIGHT);
        legend->SetVerticalAlignment(vtkChartLegend::TOP);
        legend->GetLabelProperties()->SetFontFamilyToArial();
        legend->GetPen()->SetLineType(vtkPen::NO_PEN);
        legend->GetBrush()->SetColorF(1, 1, 1, 0.85);
    }
    vtkPlot* marker = chart_->AddPlot(vtkChart::LINE);
    marker->SetInputData(marker_, 0, 1);
    set_colour(marker, palette::force);
    marker->GetPen()->SetLineType(vtkPen::DASH_LINE);
    marker->SetLegendVisibility(false);

    chart_->SetAutoSize(false);
    chart_->GetBackgroundBrush()->SetColorF(palette::panel[0], palette::panel[1], palette::panel[2]);
    actor_->GetScene()->AddItem(chart_);
    renderer->AddActor(actor_);
}

void ForceChart::add_line(int column, const Colour& colour, const char* name)
{
    vtkPlot* line = chart_->AddPlot(vtkChart::LINE);
    line->SetInputData(table_, 0, column);
    set_colour(line, colour);
    line->SetLabel(name);
}

void ForceChart::set_scale(int font_px, double line_px)
{
    font_px_ = font_px;
    const auto width = static_cast<float>(line_px);
    for (const int place : {vtkAxis::BOTTOM, vtkAxis::LEFT}) {
        vtkAxis* axis = chart_->GetAxis(place);
        axis->GetLabelProperties()->SetFontSize(font_px);
        axis->GetPen()->SetWidth(width);
        axis->GetGridPen()->SetWidth(width);
        axis->SetTickLength(4 * width);
        axis->SetLabelOffset(7 * width);
    }
    vtkChartLegend* legend = chart_->GetLegend();
    legend->GetLabelProperties()->SetFontSize(font_px);
    legend->SetSymbolWidth(static_cast<int>(2 * font_px));
    legend->SetPadding(font_px / 3);
    for (vtkIdType i = 0; i < chart_->GetNumberOfPlots(); ++i)
        chart_->GetPlot(i)->SetWidth((i == 0 ? 1.8F : 1.5F) * width);
}

void ForceChart::set_size(int width, int height)
{
    // Half a label stands out at the right and at the top; the words go above.
    const auto font = static_cast<float>(font_px_);
    const auto w = static_cast<float>(width), h = static_cast<float>(height);
    chart_->SetSize(vtkRectf(0.5F * font, 0.3F * font, w - 2.0F * font, h - 2.6F * font));
    words_.clear();
    words_.text(0.7 * font, h - 1.0 * font, "force (N) over time (s)", {font_px_, palette::ink});
}

void ForceChart::show(const std::deque<Touch>& samples, double from_s, double to_s, double full_scale_n)
{
    double low = 0, high = full_scale_n;
    const auto kept = envelope(samples);
    table_->SetNumberOfRows(static_cast<vtkIdType>(kept.size()));
    const std::size_t drawn = lines_ == Lines::norm ? 2 : column_names.size();
    for (std::size_t row = 0; row < kept.size(); ++row) {
        for (std::size_t i = 0; i < column_names.size(); ++i) {
            const double value = column_value(*kept[row], i);
            table_->SetValue(static_cast<vtkIdType>(row), static_cast<vtkIdType>(i), value);
            if (i > 0 && i < drawn) {
                low = std::min(low, value);
                high = std::max(high, value);
            }
        }
    }
    table_->Modified();
    constexpr double rows = 5, columns = 8; // about so many ticks
    const double step_n = round_up(1.04 * (high - low) / rows);
    high = step_n * std::ceil(1.04 * high / step_n);
    low = step_n * std::floor(1.04 * low / step_n);
    to_s = std::max(to_s, from_s + 1e-3);
    set_ticks(chart_->GetAxis(vtkAxis::LEFT), low, high, step_n);
    set_ticks(chart_->GetAxis(vtkAxis::BOTTOM), from_s, to_s, round_up((to_s - from_s) / columns));

    marker_->SetNumberOfRows(marked_s_ ? 2 : 0);
    if (marked_s_) {
        for (vtkIdType row = 0; row < 2; ++row) {
            marker_->SetValue(row, 0, *marked_s_);
            marker_->SetValue(row, 1, row == 0 ? low : high);
        }
    }
    marker_->Modified();
    chart_->RecalculateBounds();
}

void ForceChart::mark(std::optional<double> time_s)
{
    marked_s_ = time_s;
}

} // namespace phantom::view
