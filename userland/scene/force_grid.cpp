// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/force_grid.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include <fmt/format.h>

#include "base/csv_line.hpp"
#include "scene/ranges.hpp"

namespace phantom::scene {

namespace {

constexpr std::string_view header = "x_mm,y_mm,z_mm,fx_N,fy_N,fz_N";

/// Coordinates as far apart as this, or this part of the spacing, are the same or evenly spaced.
constexpr double same_mm = 1e-6, even = 1e-3;

struct Row {
    std::array<double, 3> place_mm, force_n;
};

Result<Row> row_of(std::string_view line, const std::string& where)
{
    const auto cells = csv::cells_of(line);
    if (cells.size() != 6)
        return Error{where, fmt::format("expected 6 columns ({}), found {}", header, cells.size())};
    Row row{};
    for (std::size_t i = 0; i < 6; ++i) {
        const auto value = csv::number_of(cells[i]);
        const Range& range = i < 3 ? range::position_mm : range::constant_force_n;
        if (!value || !range.contains(*value))
            return Error{where, fmt::format("expected {}, found '{}'", range.text, cells[i])};
        (i < 3 ? row.place_mm : row.force_n)[i % 3] = *value;
    }
    return row;
}

Result<std::vector<Row>> read_rows(const std::filesystem::path& file)
{
    std::ifstream stream(file);
    if (!stream || std::filesystem::is_directory(file))
        return Error{file.string(), "no such file, or it cannot be read"};
    std::vector<Row> rows;
    std::string line;
    for (std::size_t number = 1; std::getline(stream, line); ++number) {
        const std::string where = fmt::format("{}:{}", file.string(), number);
        const std::string_view text = csv::trimmed(line);
        if (number == 1) {
            if (text != header)
                return Error{where, fmt::format("expected the header {}", header)};
            continue;
        }
        if (text.empty() && stream.peek() == std::ifstream::traits_type::eof())
            break;
        Result<Row> row = row_of(text, where);
        if (!row)
            return row.error();
        rows.push_back(*row);
        if (rows.size() > force_grid_nodes_max)
            return Error{where, fmt::format("expected at most {} nodes", force_grid_nodes_max)};
    }
    return rows;
}

/// Where the nodes stand along an axis, or what is wrong with it.
Status lay_out_axis(const std::vector<Row>& rows, std::size_t axis, const std::string& file, ForceGrid& out)
{
    const char name = "xyz"[axis];
    std::vector<double> places;
    places.reserve(rows.size());
    for (const Row& row : rows)
        places.push_back(row.place_mm[axis]);
    std::sort(places.begin(), places.end());
    places.erase(
        std::unique(places.begin(), places.end(), [](double a, double b) { return b - a < same_mm; }),
        places.end());
    if (places.size() < 2)
        return Error{file, fmt::format("has {} place along {}, expected at least 2", places.size(), name)};
    const double side = places.back() - places.front();
    const double spacing = side / static_cast<double>(places.size() - 1);
    for (std::size_t i = 0; i < places.size(); ++i)
        if (std::abs(places[i] - places.front() - static_cast<double>(i) * spacing) > even * spacing)
            return Error{file, fmt::format("{}_mm = {:g} is not evenly spaced, expected steps of {:g} mm",
                                           name, places[i], spacing)};
    if (spacing < force_grid_spacing_min_mm || side > force_grid_side_max_mm)
        return Error{file,
                     fmt::format("is {:g} mm long along {} in steps of {:g} mm, expected at most {:g} in "
                                 "steps of at least {:g}",
                                 side, name, spacing, force_grid_side_max_mm, force_grid_spacing_min_mm)};
    out.corner_mm[axis] = places.front();
    out.spacing_mm[axis] = spacing;
    out.nodes[axis] = static_cast<std::uint32_t>(places.size());
    return success();
}

} // namespace

double ForceGrid::shortest_side_mm() const
{
    double side = force_grid_side_max_mm;
    for (std::size_t axis = 0; axis < 3; ++axis)
        side = std::min(side, (nodes[axis] - 1) * spacing_mm[axis]);
    return side;
}

double ForceGrid::force_max_n() const
{
    double most = 0;
    for (const auto& force : force_n)
        for (const double part : force)
            most = std::max(most, std::abs(part));
    return most;
}

double ForceGrid::slope_max_n_mm() const
{
    const std::array<std::size_t, 3> stride = {1, nodes[0], std::size_t{nodes[0]} * nodes[1]};
    double most = 0;
    for (std::size_t i = 0; i < force_n.size(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (i / stride[axis] % nodes[axis] + 1 == nodes[axis])
                continue;
            for (std::size_t part = 0; part < 3; ++part)
                most = std::max(most, std::abs(force_n[i + stride[axis]][part] - force_n[i][part]) /
                                          spacing_mm[axis]);
        }
    return most;
}

Result<ForceGrid> read_force_grid(const std::filesystem::path& file)
{
    const Result<std::vector<Row>> rows = read_rows(file);
    if (!rows)
        return rows.error();
    ForceGrid out;
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (Status status = lay_out_axis(*rows, axis, file.string(), out); !status)
            return status.error();
    const std::size_t count = std::size_t{out.nodes[0]} * out.nodes[1] * out.nodes[2];
    if (count != rows->size())
        return Error{file.string(),
                     fmt::format("has {} nodes, expected {} x {} x {}: every node of the grid once",
                                 rows->size(), out.nodes[0], out.nodes[1], out.nodes[2])};
    out.force_n.resize(count);
    std::vector<bool> there(count);
    for (const Row& row : *rows) {
        std::array<std::size_t, 3> node;
        for (std::size_t axis = 0; axis < 3; ++axis)
            node[axis] = static_cast<std::size_t>(
                std::llround((row.place_mm[axis] - out.corner_mm[axis]) / out.spacing_mm[axis]));
        const std::size_t index = node[0] + out.nodes[0] * (node[1] + out.nodes[1] * node[2]);
        if (there[index])
            return Error{file.string(), fmt::format("names the node at {:g}, {:g}, {:g} twice",
                                                    row.place_mm[0], row.place_mm[1], row.place_mm[2])};
        there[index] = true;
        out.force_n[index] = row.force_n;
    }
    return out;
}

} // namespace phantom::scene
