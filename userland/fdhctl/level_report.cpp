// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdhctl/level_report.hpp"

#include <fmt/format.h>

namespace phantom::fdhctl {

namespace {

using nlohmann::json;

std::uint64_t triangles(const scene::Scene& scene, const scene::Levels& levels, std::size_t level)
{
    return level == 0 ? scene.triangles() : levels.coarser[level - 1].scene.triangles();
}

/// A coverage, or that it has no end.
std::string shown_mm(double mm)
{
    return mm < scene::coverage_max_mm ? fmt::format("{:.3g}", mm) : "all";
}

/// Hands do not come near it: what is faster needs no figure.
constexpr double any_speed_mm_s = 1e4;

std::string speed_words(double speed_mm_s)
{
    if (speed_mm_s <= 0)
        return "less than a tip at rest needs (larger sets are sent)";
    return speed_mm_s < any_speed_mm_s ? fmt::format("enough for a tip at {:.0f} mm/s", speed_mm_s)
                                       : "enough for a tip at any speed";
}

} // namespace

double FeedPace::speed_mm_s(const scene::Coverage& coverage) const
{
    return scene::speed_allowed_mm_s(coverage.p1_mm, contact_radius_mm, 1.0 / feed_rate_hz);
}

CLI::Option* add_feed_rate(CLI::App& app, double& feed_rate_hz, const char* description)
{
    return app.add_option("--feed-rate,--feed-hz", feed_rate_hz, description)
        ->check(CLI::Range(20.0, 2000.0))
        ->type_name("HZ")
        ->capture_default_str();
}

json coverage_json(const scene::Coverage& coverage, const FeedPace& pace)
{
    return {{"budget", coverage.budget},
            {"samples", coverage.samples},
            {"min_mm", coverage.min_mm},
            {"p1_mm", coverage.p1_mm},
            {"median_mm", coverage.median_mm},
            {"feed_rate_hz", pace.feed_rate_hz},
            {"speed_mm_s", pace.speed_mm_s(coverage)}};
}

std::string coverage_text(const scene::Coverage& coverage, const FeedPace& pace)
{
    return fmt::format("{} triangles hold all within {} / {} / {} mm (least, 1 %, median): {}, with {:g} "
                       "sets a second",
                       coverage.budget, shown_mm(coverage.min_mm), shown_mm(coverage.p1_mm),
                       shown_mm(coverage.median_mm), speed_words(pace.speed_mm_s(coverage)),
                       pace.feed_rate_hz);
}

std::optional<std::string> coverage_warning(const scene::Coverage& coverage, const FeedPace& pace)
{
    const double speed_mm_s = pace.speed_mm_s(coverage);
    if (speed_mm_s >= scene::fastest_hand_mm_s)
        return std::nullopt;
    return fmt::format(
        "fine triangles: {} of them are {}, with {:g} sets a second; a hand in a hurry does "
        "{:.0f} mm/s (levels of detail, --levels auto, are for that; or prepare --simplify, or a "
        "higher --feed-rate)",
        coverage.budget, speed_words(speed_mm_s), pace.feed_rate_hz, scene::fastest_hand_mm_s);
}

json levels_json(const scene::Scene& scene, const scene::Levels& levels, const FeedPace& pace)
{
    json out = json::array();
    for (std::size_t level = 0; level < levels.size(); ++level)
        out.push_back({{"level", level},
                       {"triangles", triangles(scene, levels, level)},
                       {"error_mm", levels.error_mm(level)},
                       {"coverage", coverage_json(levels.coverage(level), pace)}});
    return out;
}

std::string levels_text(const scene::Scene& scene, const scene::Levels& levels, const FeedPace& pace)
{
    if (levels.size() == 1)
        return fmt::format("{:<11} none: the mesh does not need them\n", "levels");
    std::string text = fmt::format("{:<11} {:>5} {:>10} {:>10}  {:<26} {:>9}\n", "levels", "level",
                                   "triangles", "error mm", "cover mm (least, 1 %, med)", "to mm/s");
    for (std::size_t level = 0; level < levels.size(); ++level) {
        const scene::Coverage& coverage = levels.coverage(level);
        text += fmt::format("{:<11} {:>5} {:>10} {:>10.4g}  {:<26} {:>9.0f}\n", "", level,
                            triangles(scene, levels, level), levels.error_mm(level),
                            fmt::format("{} / {} / {}", shown_mm(coverage.min_mm), shown_mm(coverage.p1_mm),
                                        shown_mm(coverage.median_mm)),
                            pace.speed_mm_s(coverage));
    }
    return text + fmt::format("{:<11} built in {:.0f} ms\n", "", levels.build_ms);
}

} // namespace phantom::fdhctl
