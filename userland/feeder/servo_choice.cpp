// SPDX-License-Identifier: GPL-2.0-or-later
#include "feeder/servo_choice.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "device/device.hpp"

namespace phantom::feeder {

Result<phantom_model> choose_model(const scene::ServoSettings& asked, const scene::ServoSettings& scene,
                                   std::uint64_t features)
{
    const char* proxy = features & PHANTOM_FEATURE_PROXY_CONSTRAINED ? "constrained" : "paper";
    const auto word = [](const std::optional<std::string>& first, const std::optional<std::string>& second,
                         const char* otherwise) { return first ? *first : second.value_or(otherwise); };
    return device::model_from_words(
        word(asked.model, scene.model, "projected"), word(asked.combine, scene.combine, "bounded"),
        word(asked.proxy, scene.proxy, proxy), word(asked.arith, scene.arith, "float"),
        asked.steps ? *asked.steps : scene.steps.value_or(default_newton_steps));
}

Result<phantom_model> change_model_words(const phantom_model& now, const scene::ServoSettings& asked)
{
    const auto word = [](const std::optional<std::string>& text, const char* any) {
        return text.value_or(any);
    };
    Result<phantom_model> words = device::model_from_words(
        word(asked.model, "projected"), word(asked.combine, "bounded"), word(asked.proxy, "paper"),
        word(asked.arith, "float"), asked.steps.value_or(default_newton_steps));
    if (!words)
        return words;
    phantom_model model = now;
    if (asked.model)
        model.model = words->model;
    if (asked.combine)
        model.combine = words->combine;
    if (asked.proxy)
        model.proxy = words->proxy;
    if (asked.arith)
        model.arith = words->arith;
    if (asked.steps)
        model.newton_steps = words->newton_steps;
    return model;
}

Result<std::uint32_t> choose_rate(const scene::ServoSettings& asked, const scene::ServoSettings& scene)
{
    const double rate_hz = asked.rate_hz ? *asked.rate_hz : scene.rate_hz.value_or(default_rate_hz);
    if (!(rate_hz >= PHANTOM_RATE_MIN_HZ && rate_hz <= PHANTOM_RATE_MAX_HZ))
        return Error{"", fmt::format("rate {:g} Hz: expected {} to {} Hz", rate_hz, PHANTOM_RATE_MIN_HZ,
                                     PHANTOM_RATE_MAX_HZ)};
    return static_cast<std::uint32_t>(std::lround(rate_hz));
}

phantom_start choose_start(const phantom_start& asked, const scene::DeviceSettings& scene,
                           const scene::ServoSettings& servo)
{
    // A limit that rounds to zero would mean "the default": the smallest is one unit.
    const auto units = [](double value) {
        return static_cast<__u32>(std::clamp(std::round(value), 1.0, 4e9));
    };
    phantom_start start = asked;
    if (start.max_force_un == 0 && scene.max_force_n)
        start.max_force_un = units(*scene.max_force_n * 1e6);
    if (start.slew_un_per_ms == 0 && scene.slew_n_per_ms)
        start.slew_un_per_ms = units(*scene.slew_n_per_ms * 1e6);
    if (start.ramp_ms == 0 && scene.ramp_ms)
        start.ramp_ms = units(*scene.ramp_ms);
    if (start.crossfade_ms == 0 && servo.crossfade_ms)
        start.crossfade_ms = units(*servo.crossfade_ms);
    return start;
}

} // namespace phantom::feeder
