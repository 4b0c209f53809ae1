// SPDX-License-Identifier: GPL-2.0-or-later
#include <fmt/format.h>

#include "study/peers/report.hpp"

namespace phantom::peers {

namespace {

class Rows {
  public:
    Rows(std::string& text, const MeshFigures& mesh, const Figures& figures)
        : text_(text), mesh_(mesh), figures_(figures)
    {
    }
    void add(const char* measure, const char* unit, std::optional<double> value)
    {
        if (value)
            text_ += fmt::format("{},{},{},{},{},{:.6g}\n", mesh_.mesh, mesh_.triangles, figures_.name,
                                 measure, unit, *value);
    }

  private:
    std::string& text_;
    const MeshFigures& mesh_;
    const Figures& figures_;
};

void add_path(Rows& rows, const std::string& path, const PathTimes& times, const PathTimes* yard)
{
    const auto named = [&path](const char* what) { return path + "_" + what; };
    rows.add(named("queries").c_str(), "1", static_cast<double>(times.all_ns.count));
    rows.add(named("median").c_str(), "ns", times.all_ns.median);
    rows.add(named("p99").c_str(), "ns", times.all_ns.p99);
    rows.add(named("max").c_str(), "ns", times.all_ns.max);
    rows.add(named("leaves").c_str(), "1", times.leaves);
    if (yard) {
        rows.add(named("median_ratio").c_str(), "1", ratio(yard->median_ns, times.median_ns));
        rows.add(named("p99_ratio").c_str(), "1", ratio(yard->p99_ns, times.p99_ns));
    }
}

} // namespace

std::string csv(std::span<const MeshFigures> meshes)
{
    std::string text = "mesh,triangles,contender,measure,unit,value\n";
    for (const MeshFigures& mesh : meshes) {
        const Figures* yard = mesh.of(yardstick);
        for (const Figures& figures : mesh.figures) {
            Rows rows(text, mesh, figures);
            rows.add("radius", "mm", mesh.radius_mm);
            rows.add("build_one_thread", "Mtri/s", median(figures.build_one));
            rows.add("build_all_threads", "Mtri/s", median(figures.build_all));
            rows.add("refit_one_thread", "Mtri/s", median(figures.refit_one));
            rows.add("refit_all_threads", "Mtri/s", median(figures.refit_all));
            rows.add("memory", "B/triangle", figures.bytes_per_triangle);
            if (yard)
                rows.add("build_ratio", "1", ratio(figures.build_one, yard->build_one));
            add_path(rows, "walk", figures.walk, yard ? &yard->walk : nullptr);
            add_path(rows, "jump", figures.jump, yard ? &yard->jump : nullptr);
        }
    }
    return text;
}

} // namespace phantom::peers
