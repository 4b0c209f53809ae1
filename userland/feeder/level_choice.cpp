// SPDX-License-Identifier: GPL-2.0-or-later
#include "feeder/level_choice.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace phantom::feeder {

std::vector<DetailLevel> details_of(const scene::Levels& levels)
{
    std::vector<DetailLevel> out;
    for (std::size_t level = 0; level < levels.size(); ++level)
        out.push_back({levels.coverage(level).p1_mm, levels.error_mm(level)});
    return out;
}

double reach_needed_mm(const LevelDemand& demand)
{
    if (!(demand.depth_mm > 0))
        return scene::reach_needed_mm(demand.contact_radius_mm, demand.speed_mm_s, demand.delay_s);
    const double way = LevelChoice::way_margin * demand.speed_mm_s * demand.delay_s;
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

} // namespace phantom::feeder
