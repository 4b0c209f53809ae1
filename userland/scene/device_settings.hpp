// SPDX-License-Identifier: GPL-2.0-or-later
// [device] of a scene: limits of the force, and what a simulated device and the hand that holds it are like.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace phantom::scene {

/// A hand's impedance at the tip: a mass that moves along, a spring and a damper to where it wants to be.
struct HandSettings {
    double stiffness_n_mm = 0;
    double damping_ns_m = 0;
    double mass_kg = 0;
};

struct AmplifierSettings {
    std::optional<double> max_force_n;  ///< saturation, direction kept
    std::optional<double> bandwidth_hz; ///< first order
};

struct DeviceSettings {
    std::optional<double> max_force_n;
    std::optional<double> slew_n_per_ms;
    std::optional<double> ramp_ms;

    // What follows is simulated only if it is named (study/device_simulation.hpp).
    std::optional<double> encoder_mm; ///< steps of the position
    std::optional<HandSettings> hand; ///< the arm answers; it has then a mass, and may have the rest
    std::optional<double> mass_kg;    ///< of the arm at its tip
    std::optional<double> damping_ns_m, friction_n; ///< of the arm itself
    std::optional<double> delay_ms;                 ///< from a tick's position to its force
    std::optional<AmplifierSettings> amplifier;

    /// Names of what is simulated: "encoder", "hand", ...; and of what is not.
    [[nodiscard]] std::vector<std::string> simulated() const;
    [[nodiscard]] std::vector<std::string> not_simulated() const;
};

} // namespace phantom::scene
