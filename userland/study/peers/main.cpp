// SPDX-License-Identifier: GPL-2.0-or-later
// peers_bench: the 64 nearest triangles, by this project's hulls and by other libraries.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "study/peers/measure.hpp"

namespace {

using namespace phantom;
using namespace phantom::peers;

std::string number(const std::optional<double>& value, const char* format)
{
    return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

void print(const MeshFigures& mesh)
{
    std::printf("%s: %zu triangles, radius %.4g mm\n", mesh.mesh.c_str(), mesh.triangles, mesh.radius_mm);
    std::printf("%-14s %7s %7s %6s %6s | %8s %8s %6s %6s %6s | %8s %8s %6s %6s %6s\n", "", "b/1", "b/all",
                "B/tri", "refit", "walk ns", "p99", "ratio", "r p99", "leaves", "jump ns", "p99", "ratio",
                "r p99", "leaves");
    const Figures* base = mesh.of(yardstick);
    for (const Figures& f : mesh.figures) {
        const auto against = [&](auto of) { return base ? ratio(of(*base), of(f)) : std::nullopt; };
        std::printf("%-14s %7s %7s %6.1f %6s | %8.0f %8.0f %6s %6s %6s | %8.0f %8.0f %6s %6s %6s\n",
                    f.name.c_str(), number(median(f.build_one_mtri_s), "{:.2f}").c_str(),
                    number(median(f.build_all_mtri_s), "{:.2f}").c_str(), f.bytes_per_triangle,
                    number(median(f.refit_mtri_s), "{:.1f}").c_str(), f.walk.all_ns.median, f.walk.all_ns.p99,
                    number(against([](const Figures& x) { return x.walk.median_ns; }), "{:.2f}").c_str(),
                    number(against([](const Figures& x) { return x.walk.p99_ns; }), "{:.2f}").c_str(),
                    number(f.walk.leaves, "{:.1f}").c_str(), f.jump.all_ns.median, f.jump.all_ns.p99,
                    number(against([](const Figures& x) { return x.jump.median_ns; }), "{:.2f}").c_str(),
                    number(against([](const Figures& x) { return x.jump.p99_ns; }), "{:.2f}").c_str(),
                    number(f.jump.leaves, "{:.1f}").c_str());
    }
    for (const Absent& absent : mesh.absent)
        std::printf("%s: %s\n", absent.name.c_str(), absent.why.c_str());
    std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App app("peers_bench: the 64 nearest triangles, by this project's hulls and by other libraries");
    std::vector<std::string> meshes{"sphere-20k", "sphere-200k", "sphere-2M",
                                    "sphere-20M", "spot-200k",   "bunny"};
    app.add_option("--meshes", meshes, "sphere-20k, spot-200k, bunny, FILE, ...")->delimiter(',');
    CLI11_PARSE(app, argc, argv);
    MeasureOptions options;
    options.progress = [](const std::string& what) { std::fprintf(stderr, "%s\n", what.c_str()); };
    for (const std::string& name : meshes) {
        const Result<Mesh> mesh = make_mesh(name);
        if (!mesh) {
            std::fprintf(stderr, "peers_bench: %s\n", mesh.error().text().c_str());
            return 1;
        }
        const Result<MeshFigures> figures = measure(*mesh, options);
        if (!figures) {
            std::fprintf(stderr, "peers_bench: %s\n", figures.error().text().c_str());
            return 1;
        }
        print(*figures);
    }
    return 0;
}
