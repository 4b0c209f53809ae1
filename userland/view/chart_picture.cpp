// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/chart_picture.hpp"

#include <algorithm>

#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include "view/colour.hpp"
#include "view/force_chart.hpp"
#include "view/picture_file.hpp"

namespace phantom::view {

Status save_chart(const std::deque<Touch>& samples, std::optional<double> marked_s, const Options& options,
                  const std::filesystem::path& file)
{
    const int width = picture_oversampling * options.width;
    const int height = picture_oversampling * std::max(options.height / 2, 240);
    vtkNew<vtkRenderer> renderer;
    renderer->SetBackground(palette::panel[0], palette::panel[1], palette::panel[2]);
    ForceChart chart(renderer, ForceChart::Lines::norm_and_components);
    const int font_px = std::max(width / 85, 10 * picture_oversampling);
    chart.set_scale(font_px, font_px / 15.0);
    chart.set_size(width, height);
    chart.mark(marked_s);
    chart.show(samples, samples.front().time_s, samples.back().time_s, 0.01);

    vtkNew<vtkRenderWindow> window;
    window->SetOffScreenRendering(true);
    window->SetSize(width, height);
    window->AddRenderer(renderer);
    window->Render();
    return save_window(window, file, picture_oversampling);
}

} // namespace phantom::view
