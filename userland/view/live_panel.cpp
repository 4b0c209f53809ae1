// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/live_panel.hpp"

#include <fmt/format.h>

#include "device/device.hpp"
#include "view/history.hpp"
#include "view/scene_words.hpp"

namespace phantom::view {

namespace {

PanelRow state_row(const phantom_status& status, bool switched_off)
{
    if (switched_off)
        return {"state", "stopped, no force (space starts)", true};
    if (status.state == PHANTOM_STATE_FAULT)
        return {"state", fmt::format("FAULT: {} (c clears)", device::fault_names(status.faults)), true};
    std::string text = status.state == PHANTOM_STATE_RUNNING ? "running" : "idle";
    if ((status.flags & PHANTOM_TICK_UNCOVERED) != 0)
        text += ", no set covers the tip";
    else if ((status.flags & PHANTOM_TICK_STALE) != 0)
        text += ", the set is stale";
    else if ((status.flags & PHANTOM_TICK_RAMPING) != 0)
        text += ", ramping";
    else if ((status.flags & PHANTOM_TICK_CLAMPED) != 0)
        text += ", force at its limit";
    return {"state", text, false};
}

} // namespace

Panel live_panel(const scene::Scene& scene, const phantom_status& status, const feeder::FeedReport& fed,
                 bool switched_off, const std::string& message, bool hints)
{
    const auto microseconds = [&](double fraction) {
        return 1e-3 * device::percentile_ns(status.duration, fraction);
    };
    const Touch touch = touch_of(status, 0);
    const double age_ms = status.time_ns > status.set_time_ns
                              ? 1e-6 * static_cast<double>(status.time_ns - status.set_time_ns)
                              : 0;
    Panel panel;
    panel.title = scene.file.filename().string();
    panel.subtitle = scene_size_text(scene);
    panel.rows = {
        state_row(status, switched_off),
        {"rate", fmt::format("{} Hz", status.rate_hz)},
        {"tick", fmt::format("{:.1f} / {:.1f} / {:.1f} µs (p50, p99, max)", microseconds(0.5),
                             microseconds(0.99), 1e-3 * status.duration.max_ns)},
        {"set", fmt::format("{} patches, {:.1f} ms old", status.set_patches, age_ms)},
        {"coverage", fmt::format("{:.2f} mm", fed.coverage_mm)},
        {"contacts", fmt::format("{}{}", touch.contacts, touch.inside ? ", held by the proxy" : "")},
        {"force", fmt::format("{:.2f} N", touch.force_norm_n())},
    };
    if (!message.empty())
        panel.hints.push_back(message);
    if (hints) {
        panel.hints.emplace_back(
            "left: touch, drag    wheel, up, down: press    right: turn    middle: zoom");
        panel.hints.emplace_back(
            "space: force off, on    c: clear fault    r: view    s: picture    q: quit");
    }
    return panel;
}

} // namespace phantom::view
