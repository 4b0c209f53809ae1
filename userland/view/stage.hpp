// SPDX-License-Identifier: GPL-2.0-or-later
// The window and its parts: the whole scene on the left; on the right a close-up of the contact, figures,
// and force over time.
#pragma once

#include <deque>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include "base/result.hpp"
#include "scene/scene.hpp"
#include "view/camera.hpp"
#include "view/flat_shapes.hpp"
#include "view/force_chart.hpp"
#include "view/probe_actors.hpp"
#include "view/scene_actors.hpp"
#include "view/selected_triangles.hpp"
#include "view/touch.hpp"

namespace phantom::view {

/// A line of the figures.
struct PanelRow {
    std::string name, value;
    bool warning = false;
};
struct Panel {
    std::string title, subtitle;
    std::vector<PanelRow> rows;     ///< between close-up and chart
    std::vector<std::string> hints; ///< lines at the lower edge, at most three
};

class Stage {
  public:
    /// The scene must outlive the stage. Offscreen it draws at twice the size: save_png() then gives every
    /// edge, letter and line four samples, whatever the OpenGL driver offers.
    Stage(const scene::Scene& scene, int width, int height, bool offscreen);

    [[nodiscard]] vtkRenderWindow* window() { return window_; }
    [[nodiscard]] vtkRenderer* whole() { return whole_; }
    /// The close-up, for what shall be seen there too.
    [[nodiscard]] vtkRenderer* spot() { return spot_; }
    [[nodiscard]] const SceneActors& surfaces() const { return surfaces_; }
    [[nodiscard]] ForceChart& chart() { return chart_; }
    [[nodiscard]] double extent_mm() const { return extent_mm_; }

    void set_camera(const CameraAngles& angles);
    /// The force whose arrow is as long as arrows get. Larger ones raise it.
    void set_full_scale(double force_n) { full_scale_n_ = force_n; }
    /// The scalar bar of path colours, up to that force.
    void set_colour_bar(double max_force_n) { colour_bar_n_ = max_force_n; }

    /// Shows one moment. normal: outward, at the contact. blend: how far the close-up moves from where
    /// it looks to where it should, 0 ... 1 (1: at once). `of` is what the selected triangles are of.
    /// moment: where everything is; nullptr: where nothing moves.
    void show(const Touch& touch, std::span<const fdh::Hit> selected, const scene::Scene& of,
              const scene::Moment* moment, const Vec3& normal, double radius_mm, double blend);
    void set_panel(Panel panel) { panel_ = std::move(panel); }
    void render();
    /// Renders and writes a PNG: whole or not at all.
    Status save_png(const std::filesystem::path& file);

  private:
    struct Spot {
        Vec3 centre{}, normal{0, 1, 0};
        double half_height_mm = 0; ///< 0: not looked yet
    };
    void arrange();
    void aim_spot(const Touch& touch, const Vec3& normal, double radius_mm, double blend);
    void size_probes(const Touch& touch, double radius_mm);
    [[nodiscard]] double header_px() const;
    [[nodiscard]] double footer_px() const;
    void draw_whole_overlay();
    void draw_column();
    void draw_colour_bar();
    void draw_region_marker();
    void draw_legend(double x, double y, double width);
    void draw_spot_overlay();
    /// A font size in pixels of this window, and a length given for a window 800 pixels high.
    [[nodiscard]] int font(double factor = 1) const;
    [[nodiscard]] double px(double at_800) const;

    const scene::Scene& scene_;
    int oversampling_;
    SceneActors surfaces_;
    vtkNew<vtkRenderWindow> window_;
    vtkNew<vtkRenderer> base_, whole_, spot_, graph_;
    SelectedTriangles selected_;
    vtkActor* selected_in_whole_ = nullptr; ///< owned by whole_
    ProbeActors whole_probe_, spot_probe_;
    ForceChart chart_;
    FlatShapes base_shapes_, whole_shapes_, spot_shapes_;

    /// A rectangle of the window in pixels, from its lower left.
    struct Box {
        double x = 0, y = 0, width = 0, height = 0;
    };
    std::array<int, 2> arranged_{0, 0}; ///< window size that the layout was made for
    std::size_t arranged_rows_ = 0;     ///< and the number of figures
    Box whole_box_, spot_box_, column_box_;
    Spot looked_;
    Panel panel_;
    Touch touch_;
    double extent_mm_ = 1, full_scale_n_ = 1, radius_mm_ = 1;
    std::optional<double> colour_bar_n_;
    bool driver_known_ = false; ///< whether it was looked at for multisampling
};

} // namespace phantom::view
