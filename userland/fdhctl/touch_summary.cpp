// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdhctl/touch_summary.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "feeder/status_report.hpp"

namespace phantom::fdhctl {

namespace {

using nlohmann::json;

json percentiles(std::vector<float> values)
{
    if (values.empty())
        return {{"median", 0.0}, {"p99", 0.0}, {"max", 0.0}};
    std::sort(values.begin(), values.end());
    const auto at = [&values](double part) {
        return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
    };
    return {{"median", at(0.5)}, {"p99", at(0.99)}, {"max", values.back()}};
}

std::string three(const json& times, const char* unit)
{
    return fmt::format("{:.2f} / {:.2f} / {:.2f} {}", times["median"].get<double>(),
                       times["p99"].get<double>(), times["max"].get<double>(), unit);
}

} // namespace

void TouchSummary::take(feeder::Session& session, double seconds)
{
    const feeder::Feeder::Totals fed = session.feeder().totals();
    const feeder::Session::Timings timings = session.timings();
    facts_ = {{"scene", session.scene().file.string()},
              {"triangles", session.scene().triangles()},
              {"device", session.device().name()},
              {"thread", session.device().thread_text()},
              {"seconds", seconds},
              {"load_ms",
               {{"read_and_prepare", timings.read_prepare_ms},
                {"build", timings.build_ms},
                {"first_force", timings.first_force_ms}}},
              {"feeder",
               {{"sets", fed.sets},
                {"sets_per_s", seconds > 0 ? static_cast<double>(fed.sets) / seconds : 0.0},
                {"query_us", percentiles(fed.query_us)},
                {"interval_ms", percentiles(fed.interval_ms)},
                {"level_sets", fed.level_sets},
                {"level_changes", fed.level_changes}}},
              {"servo", feeder::status_json(session.device().status())}};
}

json TouchSummary::json() const
{
    nlohmann::json all = facts_;
    all["touch"] = {{"ticks", touched.ticks},
                    {"contact_ticks", touched.contact_ticks},
                    {"inside_ticks", touched.inside_ticks},
                    {"uncovered_ticks", touched.uncovered_ticks},
                    {"records_lost", touched.lost},
                    {"force_max_n", touched.force_max_n},
                    {"path_late_s", path_late_s}};
    return all;
}

std::string TouchSummary::text() const
{
    const nlohmann::json& servo = facts_["servo"];
    const nlohmann::json& tick = servo["tick"];
    const nlohmann::json& wake = servo["wake"];
    std::string text;
    const auto add = [&text](const char* name, const std::string& value) {
        text += fmt::format("{:<10} {}\n", name, value);
    };
    const auto number = [](const nlohmann::json& value) { return value.get<double>(); };
    add("touched", fmt::format("{:.1f} s, {} ticks at {} Hz, {} missed, idle {:.1f} %",
                               number(facts_["seconds"]), touched.ticks, servo["rate_hz"].get<unsigned>(),
                               servo["missed"].get<std::uint64_t>(), number(servo["idle_percent"])));
    add("contact", fmt::format("{} ticks, {} of them inside, {} not covered, |F| at most {:.3f} N",
                               touched.contact_ticks, touched.inside_ticks, touched.uncovered_ticks,
                               touched.force_max_n));
    add("tick", fmt::format("{:.2f} / {:.2f} / {:.2f} us (median, p99, max)", number(tick["p50_us"]),
                            number(tick["p99_us"]), number(tick["max_us"])));
    add("wake-up", fmt::format("{:.2f} / {:.2f} / {:.2f} us late", number(wake["p50_us"]),
                               number(wake["p99_us"]), number(wake["max_us"])));
    const nlohmann::json& feeder = facts_["feeder"];
    add("feeder", fmt::format("{} sets, {:.0f} per s, {} apart, query {}",
                              feeder["sets"].get<std::uint64_t>(), number(feeder["sets_per_s"]),
                              three(feeder["interval_ms"], "ms"), three(feeder["query_us"], "us")));
    if (feeder["level_sets"].size() > 1) {
        std::string sets;
        for (const nlohmann::json& count : feeder["level_sets"])
            sets += fmt::format("{}{}", sets.empty() ? "" : " / ", count.get<std::uint64_t>());
        add("levels",
            fmt::format("{} sets of level 0 ... {}, {} changes", sets, feeder["level_sets"].size() - 1,
                        feeder["level_changes"].get<std::uint64_t>()));
    }
    const nlohmann::json& load = facts_["load_ms"];
    add("load",
        fmt::format("first force after {:.0f} ms: read and prepared {:.0f}, hierarchy {:.0f}",
                    number(load["first_force"]), number(load["read_and_prepare"]), number(load["build"])));
    if (!recorded.empty())
        add("recorded", recorded);
    if (path_late_s > 0.001)
        add("path", fmt::format("{:.3f} s late: the computer was busy elsewhere", path_late_s));
    if (touched.lost)
        add("records", fmt::format("{} ticks without a record", touched.lost));
    if (servo["faults"] != "none")
        add("fault", servo["faults"].get<std::string>());
    return text;
}

} // namespace phantom::fdhctl
