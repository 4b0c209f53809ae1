// SPDX-License-Identifier: GPL-2.0-or-later
#include "feeder/level_choice.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace phantom::feeder {

namespace {

/// Points that a reach is measured at.
constexpr std::size_t points_max = 2000;

/// No reach is looked for beyond this, mm: every budget that ends there lasts long enough.
constexpr double reach_max_mm = 1000.0;

} // namespace

double reach_needed_mm(const LevelDemand& demand)
{
    const double way = LevelChoice::way_margin * demand.speed_mm_s * demand.delay_s;
    if (!(demand.depth_mm > 0))
        return demand.contact_radius_mm + way;
    const double dive = LevelChoice::way_margin * std::max(demand.dive_mm_s, 0.0) * demand.delay_s;
    return std::sqrt(way * way + demand.depth_mm * dive);
}

LevelChoice::LevelChoice(std::vector<DetailLevel> levels) : levels_(std::move(levels)) {}

std::size_t LevelChoice::choose(const LevelDemand& demand)
{
    const double needed = reach_needed_mm(demand);
    const auto first = [this](double reach) {
        std::size_t number = 0;
        while (number + 1 < levels_.size() && levels_[number].reach_mm < reach)
            ++number;
        return number;
    };
    const std::size_t enough = first(needed), ample = first(finer_margin * needed);
    if (enough > current_) {
        current_ = enough;
        finer_for_ = 0;
    } else if (ample >= current_) {
        finer_for_ = 0;
    } else {
        finer_ = finer_for_++ ? std::max(finer_, ample) : ample;
        if (finer_for_ == finer_sets) {
            current_ = finer_;
            finer_for_ = 0;
        }
    }
    return current_;
}

double measure_reach_mm(const mesh::Mesh& mesh, const fdh::TriangleTree<14>& tree, std::uint32_t budget)
{
    const std::size_t every = std::max<std::size_t>(1, mesh.vertices.size() / points_max);
    std::vector<double> reaches;
    fdh::Nearest nearest;
    for (std::size_t vertex = 0; vertex < mesh.vertices.size(); vertex += every) {
        nearest.clear();
        tree.nearest(mesh.vertices[vertex], budget, reach_max_mm, nearest);
        reaches.push_back(nearest.coverage);
    }
    if (reaches.empty())
        return reach_max_mm;
    const auto low = reaches.begin() + static_cast<std::ptrdiff_t>(reaches.size() / 100);
    std::nth_element(reaches.begin(), low, reaches.end());
    return *low;
}

} // namespace phantom::feeder
