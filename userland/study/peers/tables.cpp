// SPDX-License-Identifier: GPL-2.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "study/peers/report.hpp"

namespace phantom::peers {

namespace {

std::string number(const std::optional<double>& value)
{
    if (!value)
        return "–";
    return *value < 0.01 ? fmt::format("{:.1g}", *value)
           : *value < 10 ? fmt::format("{:.2f}", *value)
                         : fmt::format("{:.1f}", *value);
}

std::string verdict(const Goal& goal, const std::optional<double>& figure)
{
    if (!figure)
        return "–";
    const char* mark = goal.stretch && goal.meets(*figure, *goal.stretch) ? " ++"
                       : goal.meets(*figure, goal.goal)                   ? " +"
                                                                          : " **no**";
    return number(figure) + mark;
}

std::string goals_table(std::span<const MeshFigures> meshes)
{
    std::string text = "| goal | | stretch |";
    std::string rule = "| --- | --- | --- |";
    for (const MeshFigures& mesh : meshes) {
        text += fmt::format(" {} |", mesh.mesh);
        rule += " --- |";
    }
    text += "\n" + rule + "\n";
    for (const Goal& goal : goals(meshes)) {
        if (std::ranges::none_of(goal.figures, [](const auto& figure) { return figure.has_value(); }))
            continue;
        const char* sign = goal.at_least ? "≥ " : "≤ ";
        text += fmt::format("| {} | {}{:g} | {} |", goal.what, sign, goal.goal,
                            goal.stretch ? fmt::format("{}{:g}", sign, *goal.stretch) : "");
        for (const auto& figure : goal.figures)
            text += fmt::format(" {} |", verdict(goal, figure));
        text += "\n";
    }
    return text + "\n+ met, ++ stretch met, **no** not met, – not measured.\n";
}

std::string times_of(const PathTimes& times, const PathTimes* yard)
{
    const auto us = [](double ns) { return number(1e-3 * ns); };
    return fmt::format(" {} / {} | {} / {} |", us(times.all_ns.median), us(times.all_ns.p99),
                       number(yard ? ratio(yard->median_ns, times.median_ns) : std::nullopt),
                       number(yard ? ratio(yard->p99_ns, times.p99_ns) : std::nullopt));
}

std::string rates_of(const std::vector<double>& one, const std::vector<double>& all)
{
    if (one.empty())
        return " – |";
    return all.empty() ? fmt::format(" {} |", number(median(one)))
                       : fmt::format(" {} / {} |", number(median(one)), number(median(all)));
}

std::string mesh_table(const MeshFigures& mesh)
{
    std::string text =
        fmt::format("\n{}: {} triangles, R = {:.4g} mm\n\n", mesh.mesh, mesh.triangles, mesh.radius_mm);
    text += "| | walk µs | Embree / it | jump µs | Embree / it | leaves | build Mtri/s | refit Mtri/s | "
            "B/tri | how |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    const Figures* yard = mesh.of(yardstick);
    for (const Figures& f : mesh.figures) {
        text += fmt::format("| {} |{}{}", f.name, times_of(f.walk, yard ? &yard->walk : nullptr),
                            times_of(f.jump, yard ? &yard->jump : nullptr));
        text += f.walk.leaves ? fmt::format(" {} / {} |", number(f.walk.leaves), number(f.jump.leaves))
                              : std::string(" – |");
        text += rates_of(f.build_one, f.build_all) + rates_of(f.refit_one, f.refit_all);
        text += fmt::format(" {} | {} |\n", number(f.bytes_per_triangle), f.method);
    }
    for (const Absent& absent : mesh.absent)
        text += fmt::format("\n{}: {}.\n", absent.name, absent.why);
    return text;
}

} // namespace

std::string tables(std::span<const MeshFigures> meshes)
{
    std::string text = fmt::format(
        "The {} nearest triangles within R, the radius of the median sphere that holds {}. Walk: along the "
        "surface in\nsteps of {:g} of the diagonal; jump: points of random triangles. Median / p99 of single "
        "queries; ratios are\nmedians over rounds in which all contenders took turns. Leaves on walk / jump. "
        "Build and refit: per\nsecond of CPU time on one thread / of the clock on all. Answers of every "
        "contender were\ncompared with FDH14's, and those with brute force, before anything was timed and "
        "once in "
        "every block.\n\n",
        wanted, wanted, walk_step_part);
    text += goals_table(meshes);
    for (const MeshFigures& mesh : meshes)
        text += mesh_table(mesh);
    return text;
}

} // namespace phantom::peers
