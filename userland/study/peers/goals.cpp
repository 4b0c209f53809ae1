// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <cmath>

#include "fdh/isa.hpp"
#include "study/peers/hulls.hpp"
#include "study/peers/report.hpp"

namespace phantom::peers {

namespace {

using Meshes = std::span<const MeshFigures>;
using Measure = std::function<std::optional<double>(const MeshFigures&)>;

std::vector<std::optional<double>> of_each(Meshes meshes, const Measure& measure)
{
    std::vector<std::optional<double>> figures;
    for (const MeshFigures& mesh : meshes)
        figures.push_back(measure(mesh));
    return figures;
}

/// How many times as long as `name` somebody else takes.
Measure times_of(const std::string& other, const std::string& name, PathTimes Figures::*path,
                 std::vector<double> PathTimes::*what)
{
    return [=](const MeshFigures& mesh) -> std::optional<double> {
        const Figures *a = mesh.of(other), *b = mesh.of(name);
        return a && b ? ratio(a->*path.*what, b->*path.*what) : std::nullopt;
    };
}

void add_query_goals(std::vector<Goal>& all, Meshes meshes, const std::string& isa)
{
    const std::string suffix = isa.empty() ? isa : ' ' + isa;
    const std::string label = isa.empty() ? fdh::isa_name(fdh::resolve_isa(fdh::Isa::best)) : isa;
    const std::string own = own_name + suffix, coherent = coherent_name + suffix;
    const auto add = [&](const std::string& what, double goal, std::optional<double> stretch,
                         const Measure& measure) {
        all.push_back({what + ", " + label, goal, stretch, true, of_each(meshes, measure)});
    };
    const auto walk = &Figures::walk, jump = &Figures::jump;
    const auto median_ns = &PathTimes::median_ns, p99_ns = &PathTimes::p99_ns;
    add("walk, median, times Embree", 6, 8, times_of(yardstick, own, walk, median_ns));
    add("walk, coherent, median, times Embree", 8, 15, times_of(yardstick, coherent, walk, median_ns));
    add("jump, median, times Embree", 4.5, 7, times_of(yardstick, own, jump, median_ns));
    add("walk, p99, times Embree", 2.5, {}, times_of(yardstick, own, walk, p99_ns));
    add("walk, coherent, p99, times Embree", 2.5, {}, times_of(yardstick, coherent, walk, p99_ns));
    add("jump, p99, times Embree", 2.5, {}, times_of(yardstick, own, jump, p99_ns));
}

std::optional<double> leaves_ratio(const MeshFigures& mesh, PathTimes Figures::*path)
{
    const Figures *wide = mesh.of(own_name), *boxes = mesh.of(boxes_name);
    if (!wide || !boxes || !(wide->*path).leaves || !(boxes->*path).leaves)
        return std::nullopt;
    return *(wide->*path).leaves / *(boxes->*path).leaves;
}

/// How much longer a query takes than on the smallest of the spheres, in parts of what log n allows.
std::vector<std::optional<double>> growth(Meshes meshes, PathTimes Figures::*path)
{
    const auto is_sphere = [](const MeshFigures& mesh) { return mesh.mesh.starts_with("sphere-"); };
    const MeshFigures* smallest = nullptr;
    for (const MeshFigures& mesh : meshes)
        if (is_sphere(mesh) && (!smallest || mesh.triangles < smallest->triangles))
            smallest = &mesh;
    return of_each(meshes, [&](const MeshFigures& mesh) -> std::optional<double> {
        if (!is_sphere(mesh) || &mesh == smallest)
            return std::nullopt;
        const auto ns = [path](const MeshFigures& m) { return (m.of(own_name)->*path).all_ns.median; };
        const auto log_n = [](const MeshFigures& m) { return std::log(static_cast<double>(m.triangles)); };
        return ns(mesh) / ns(*smallest) / (log_n(mesh) / log_n(*smallest));
    });
}

} // namespace

std::vector<Goal> goals(Meshes meshes)
{
    std::vector<Goal> all;
    const auto walk = &Figures::walk, jump = &Figures::jump;
    const auto median_ns = &PathTimes::median_ns;
    const auto own = [](auto measure) {
        return [measure](const MeshFigures& mesh) { return measure(*mesh.of(own_name), mesh); };
    };
    add_query_goals(all, meshes, "");
    add_query_goals(all, meshes, "avx2");
    all.push_back({"walk, times FDH6",
                   1.1,
                   {},
                   false,
                   of_each(meshes, times_of(own_name, boxes_name, walk, median_ns))});
    all.push_back({"jump, times FDH6",
                   1.1,
                   {},
                   false,
                   of_each(meshes, times_of(own_name, boxes_name, jump, median_ns))});
    all.push_back({"walk, leaves, times FDH6", 1, {}, false, of_each(meshes, [=](const MeshFigures& m) {
                       return leaves_ratio(m, walk);
                   })});
    all.push_back({"jump, leaves, times FDH6", 1, {}, false, of_each(meshes, [=](const MeshFigures& m) {
                       return leaves_ratio(m, jump);
                   })});
    all.push_back({"build on one thread, times Embree",
                   2.5,
                   {},
                   true,
                   of_each(meshes, own([](const Figures& f, const MeshFigures& mesh) {
                               const Figures* yard = mesh.of(yardstick);
                               return yard ? ratio(f.build_one, yard->build_one) : std::nullopt;
                           }))});
    all.push_back({"build on all threads, times one",
                   1.8,
                   {},
                   true,
                   of_each(meshes, own([](const Figures& f, const MeshFigures& mesh) {
                               return mesh.threads > 1 ? ratio(f.build_all, f.build_one) : std::nullopt;
                           }))});
    all.push_back(
        {"memory, B/triangle", 48, 30, false, of_each(meshes, own([](const Figures& f, const MeshFigures&) {
                                                          return std::optional(f.bytes_per_triangle);
                                                      }))});
    all.push_back(
        {"refit on one thread, Mtri/s",
         35,
         {},
         true,
         of_each(meshes, own([](const Figures& f, const MeshFigures&) { return median(f.refit_one); }))});
    all.push_back({"walk, growth, times log n", 1, {}, false, growth(meshes, walk)});
    all.push_back({"jump, growth, times log n", 1, {}, false, growth(meshes, jump)});
    return all;
}

} // namespace phantom::peers
