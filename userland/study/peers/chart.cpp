// SPDX-License-Identifier: GPL-2.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "study/peers/hulls.hpp"
#include "study/peers/report.hpp"

namespace phantom::peers {

namespace {

// Pixels.
constexpr double panel_width = 430, panel_height = 400, left = 60, top = 40, gap = 150, bottom = 50;
constexpr double label_height = 14;

struct Sample {
    double triangles, ns;
};
struct Curve {
    std::string name;
    std::vector<Sample> samples;
};

/// Everyone's medians on the spheres, by size.
std::vector<Curve> curves(std::span<const MeshFigures> meshes, PathTimes Figures::*path)
{
    std::map<std::string, std::vector<Sample>> by_name;
    for (const MeshFigures& mesh : meshes)
        if (mesh.mesh.starts_with("sphere-"))
            for (const Figures& figures : mesh.figures)
                by_name[figures.name].push_back(
                    {static_cast<double>(mesh.triangles), (figures.*path).all_ns.median});
    std::vector<Curve> all;
    for (auto& [name, samples] : by_name) {
        std::ranges::sort(samples, {}, &Sample::triangles);
        all.push_back({name, std::move(samples)});
    }
    return all;
}

/// What holds all values, on a logarithmic scale with some room.
class Axis {
  public:
    void take(double value)
    {
        if (!(value > 0))
            return;
        low_ = std::min(low_, value);
        high_ = std::max(high_, value);
    }
    /// 0 at the lower end, 1 at the upper.
    [[nodiscard]] double part(double value) const
    {
        return std::log(value / (low_ / room)) / std::log(high_ / low_ * room * room);
    }
    /// 1, 2 and 5 of every decade in it.
    [[nodiscard]] std::vector<double> ticks() const
    {
        std::vector<double> all;
        if (high_ < low_)
            return all;
        for (double decade = std::pow(10, std::floor(std::log10(low_ / room))); decade < high_ * room;
             decade *= 10)
            for (const double digit : {1, 2, 5})
                if (const double part_of = part(digit * decade); part_of >= 0 && part_of <= 1)
                    all.push_back(digit * decade);
        return all;
    }

  private:
    static constexpr double room = 1.2;
    double low_ = std::numeric_limits<double>::max(), high_ = 0;
};

std::string colour(const std::string& name)
{
    if (name.starts_with(own_name))
        return name == own_name ? "#c0392b" : name == coherent_name ? "#7b1f15" : "#e08a80";
    constexpr std::pair<const char*, const char*> colours[] = {{"Embree", "#1f4e8c"},
                                                               {"Bullet", "#2a8c4a"},
                                                               {"CGAL", "#8c6d1f"},
                                                               {"FCL", "#6b3fa0"},
                                                               {"VTK", "#555555"}};
    for (const auto& [library, its] : colours)
        if (name == library)
            return its;
    return "#e0b080";
}

class Panel {
  public:
    Panel(std::string title, std::vector<Curve> curves, double x)
        : title_(std::move(title)), curves_(std::move(curves)), x_(x)
    {
        for (const Curve& curve : curves_) {
            for (const Sample& sample : curve.samples) {
                across_.take(sample.triangles);
                up_.take(sample.ns);
            }
        }
    }

    [[nodiscard]] std::string svg() const { return frame() + lines() + labels(); }

  private:
    [[nodiscard]] double x_of(double triangles) const { return x_ + panel_width * across_.part(triangles); }
    [[nodiscard]] double y_of(double ns) const { return top + panel_height * (1 - up_.part(ns)); }

    [[nodiscard]] std::string frame() const
    {
        std::string text =
            fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" class=\"title\">{}</text>\n", x_, top - 14, title_);
        const auto line = [&text](double x1, double y1, double x2, double y2) {
            text += fmt::format(
                "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" class=\"grid\"/>\n", x1, y1,
                x2, y2);
        };
        for (const double triangles : across_.ticks()) {
            const double x = x_of(triangles);
            line(x, top, x, top + panel_height);
            text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"middle\">{}</text>\n", x,
                                top + panel_height + 18, words(triangles, {"", "k", "M", "G"}));
        }
        for (const double ns : up_.ticks()) {
            const double y = y_of(ns);
            line(x_, y, x_ + panel_width, y);
            text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"end\">{}</text>\n", x_ - 6, y + 4,
                                words(ns, {" ns", " µs", " ms", " s"}));
        }
        return text + fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"middle\">triangles</text>\n",
                                  x_ + panel_width / 2, top + panel_height + 38);
    }

    static std::string words(double value, const std::array<const char*, 4>& units)
    {
        std::size_t unit = 0;
        for (; value >= 999.5 && unit + 1 < units.size(); ++unit)
            value /= 1000;
        return fmt::format("{:g}{}", value, units[unit]);
    }

    [[nodiscard]] std::string lines() const
    {
        std::string text;
        for (const Curve& curve : curves_) {
            std::string points;
            for (const Sample& sample : curve.samples) {
                points += fmt::format("{:.1f},{:.1f} ", x_of(sample.triangles), y_of(sample.ns));
                text += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n",
                                    x_of(sample.triangles), y_of(sample.ns), colour(curve.name));
            }
            text += fmt::format("<polyline points=\"{}\" stroke=\"{}\"/>\n", points, colour(curve.name));
        }
        return text;
    }

    /// Beside each curve's end, pushed apart where they would overlap.
    [[nodiscard]] std::string labels() const
    {
        std::vector<std::pair<double, const Curve*>> places;
        for (const Curve& curve : curves_)
            places.emplace_back(y_of(curve.samples.back().ns), &curve);
        std::ranges::sort(places, {}, [](const auto& place) { return place.first; });
        for (std::size_t i = 1; i < places.size(); ++i)
            places[i].first = std::max(places[i].first, places[i - 1].first + label_height);
        std::string text;
        for (const auto& [y, curve] : places)
            text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"{}\">{}</text>\n",
                                x_ + panel_width + 8, y + 4, colour(curve->name), curve->name);
        return text;
    }

    std::string title_;
    std::vector<Curve> curves_;
    double x_;
    Axis across_, up_;
};

} // namespace

std::string chart(std::span<const MeshFigures> meshes)
{
    const double width = left + 2 * (panel_width + gap), height = top + panel_height + bottom;
    std::string text = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 "
        "{0:.0f} "
        "{1:.0f}\">\n<style>text {{ font: 12px sans-serif; }} .title {{ font-weight: bold; }} .middle {{ "
        "text-anchor: middle; }} .end {{ text-anchor: end; }} .grid {{ stroke: #ddd; }} polyline {{ fill: "
        "none; "
        "stroke-width: 1.8; }}</style>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
        width, height);
    text += Panel("Walk: median of one query for the 64 nearest", curves(meshes, &Figures::walk), left).svg();
    text += Panel("Jump", curves(meshes, &Figures::jump), left + panel_width + gap).svg();
    return text + "</svg>\n";
}

} // namespace phantom::peers
