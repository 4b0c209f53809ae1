// SPDX-License-Identifier: GPL-2.0-or-later
#include "feeder/status_report.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "device/device.hpp"

namespace phantom::feeder {

namespace {

using nlohmann::json;

template <typename Integer>
json scaled(const Integer (&values)[3], double unit)
{
    return {static_cast<double>(values[0]) * unit, static_cast<double>(values[1]) * unit,
            static_cast<double>(values[2]) * unit};
}

json durations(const phantom_histogram& histogram)
{
    return {{"count", device::total_count(histogram)},
            {"p50_us", device::percentile_ns(histogram, 0.50) * 1e-3},
            {"p99_us", device::percentile_ns(histogram, 0.99) * 1e-3},
            {"max_us", histogram.max_ns * 1e-3}};
}

double force_n(const phantom_status& status)
{
    return 1e-6 *
           std::hypot(double(status.force_un[0]), double(status.force_un[1]), double(status.force_un[2]));
}

/// Part of the time in which the servo thread did nothing, in percent.
double idle_percent(const phantom_status& status)
{
    if (status.time_ns <= status.start_ns)
        return 100.0;
    const double whole = static_cast<double>(status.time_ns - status.start_ns);
    return 100.0 * std::max(0.0, 1.0 - static_cast<double>(status.busy_ns) / whole);
}

double set_age_ms(const phantom_status& status)
{
    if (status.set_id == 0 || status.time_ns < status.set_time_ns)
        return 0.0;
    return static_cast<double>(status.time_ns - status.set_time_ns) * 1e-6;
}

} // namespace

json status_json(const phantom_status& status)
{
    return {{"state", device::state_name(status.state)},
            {"faults", device::fault_names(status.faults)},
            {"rate_hz", status.rate_hz},
            {"isa", device::isa_name(status.isa)},
            {"model", device::model_text(status.model)},
            {"ticks", status.tick},
            {"missed", status.missed},
            {"idle_percent", idle_percent(status)},
            {"tip_mm", scaled(status.tip_nm, 1e-6)},
            {"proxy_mm", scaled(status.proxy_nm, 1e-6)},
            {"velocity_mm_s", scaled(status.velocity_nm_s, 1e-6)},
            {"force_n", scaled(status.force_un, 1e-6)},
            {"force_magnitude_n", force_n(status)},
            {"contacts", status.contacts},
            {"inside", (status.flags & PHANTOM_TICK_INSIDE) != 0},
            {"covered", (status.flags & PHANTOM_TICK_UNCOVERED) == 0},
            {"set",
             {{"id", status.set_id},
              {"age_ms", set_age_ms(status)},
              {"patches", status.set_patches},
              {"level", status.set_level},
              {"level_error_mm", status.set_level_error_nm * 1e-6}}},
            {"sets", status.sets},
            {"fades", status.fades},
            {"saturated", status.saturated},
            {"refused", status.refused},
            {"clamped", status.clamped},
            {"tick", durations(status.duration)},
            {"wake", durations(status.latency)},
            {"float_section", durations(status.section)}};
}

std::string status_line(const phantom_status& status)
{
    std::string line = fmt::format(
        "{} {} Hz | tick {:.1f}/{:.1f}/{:.1f} us | idle {:.1f} % | set {:.1f} ms, {} patches | {} contact{} "
        "| |F| {:.3f} N",
        device::state_name(status.state), status.rate_hz, device::percentile_ns(status.duration, 0.50) * 1e-3,
        device::percentile_ns(status.duration, 0.99) * 1e-3, status.duration.max_ns * 1e-3,
        idle_percent(status), set_age_ms(status), status.set_patches, status.contacts,
        status.contacts == 1 ? "" : "s", force_n(status));
    if (status.set_level)
        line += fmt::format(" | level {}, {:.2g} mm off", status.set_level, status.set_level_error_nm * 1e-6);
    if (status.flags & PHANTOM_TICK_INSIDE)
        line += " | inside";
    if (status.flags & PHANTOM_TICK_UNCOVERED)
        line += " | not covered";
    if (status.faults)
        line += " | fault: " + device::fault_names(status.faults);
    return line;
}

std::string status_text(const json& status)
{
    const auto vector = [](const json& v) {
        return fmt::format("{:.3f} {:.3f} {:.3f}", v[0].get<double>(), v[1].get<double>(),
                           v[2].get<double>());
    };
    const auto times = [](const json& d) {
        return fmt::format("{:.2f} / {:.2f} / {:.2f} us (median, p99, max of {})", d["p50_us"].get<double>(),
                           d["p99_us"].get<double>(), d["max_us"].get<double>(),
                           d["count"].get<std::uint64_t>());
    };
    std::string text;
    const auto add = [&text](const char* name, const std::string& value) {
        text += fmt::format("{:<10} {}\n", name, value);
    };
    add("state", status["state"].get<std::string>() +
                     (status["faults"] == "none" ? "" : ", fault: " + status["faults"].get<std::string>()));
    add("rate", fmt::format("{} Hz, {} ticks, {} missed, idle {:.1f} %", status["rate_hz"].get<unsigned>(),
                            status["ticks"].get<std::uint64_t>(), status["missed"].get<std::uint64_t>(),
                            status["idle_percent"].get<double>()));
    add("model", status["model"].get<std::string>() + ", " + status["isa"].get<std::string>());
    add("tick", times(status["tick"]));
    add("wake-up", times(status["wake"]));
    const json& set = status["set"];
    add("set", fmt::format("{} patches, {:.1f} ms old, {} sets taken, {} fades",
                           set["patches"].get<unsigned>(), set["age_ms"].get<double>(),
                           status["sets"].get<std::uint64_t>(), status["fades"].get<std::uint64_t>()));
    if (status.contains("levels") || set["level"].get<unsigned>())
        add("level", fmt::format("{}{}, {:.4g} mm from the mesh", set["level"].get<unsigned>(),
                                 status.contains("levels")
                                     ? fmt::format(" of 0 ... {}", status["levels"].get<unsigned>() - 1)
                                     : "",
                                 set["level_error_mm"].get<double>()));
    add("tip", vector(status["tip_mm"]) + " mm" + (status["inside"].get<bool>() ? ", inside" : "") +
                   (status["covered"].get<bool>() ? "" : ", not covered"));
    add("force", fmt::format("{} N, |F| {:.3f} N, {} contacts", vector(status["force_n"]),
                             status["force_magnitude_n"].get<double>(), status["contacts"].get<unsigned>()));
    return text;
}

} // namespace phantom::feeder
