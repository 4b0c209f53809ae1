// SPDX-License-Identifier: GPL-2.0-or-later
// What values a scene may hold, in one place: the scene file, the options and scenes/README.md agree.
#pragma once

namespace phantom::scene {

struct Range {
    double low, high;
    const char* text; ///< for messages, after "expected "
    [[nodiscard]] constexpr bool contains(double value) const { return value >= low && value <= high; }
};

namespace range {

// The kernel border carries mN/mm in 32 bits; no device renders beyond some N/mm.
inline constexpr Range stiffness_n_mm{0.001, 1000.0, "0.001 ... 1000 N/mm"};
// Patches of a set are in nm in 32 bits round its origin: 100 mm leaves room for the faces themselves.
inline constexpr Range radius_mm{0.001, 100.0, "0.001 ... 100 mm"};
inline constexpr Range damping_ns_m{0.0, 1000.0, "0 ... 1000 N*s/m"};
// What the module takes: phantom_abi.h.
inline constexpr Range effect_force_n{0.0, 100.0, "0 ... 100 N"};
inline constexpr Range constant_force_n{-100.0, 100.0, "-100 ... 100 N"};
inline constexpr Range guide_force_n{1e-6, 100.0, "0.000001 ... 100 N"};
inline constexpr Range viscosity_ns_m{0.0, 20.0, "0 ... 20 N*s/m"};
inline constexpr Range drag_ns2_m2{0.0, 1000.0, "0 ... 1000 N*s^2/m^2"};
// Where a medium or a guide ends. No farther, so that one which a set cannot name is out of the tip's reach.
inline constexpr Range region_mm{0.1, 1000.0, "0.1 ... 1000 mm"};
inline constexpr Range map_spacing_mm{0.01, 100.0, "0.01 ... 100 mm"};
inline constexpr Range impact_gain_ns_m{0.0, 125.0, "0 ... 125 N*s/m"};
inline constexpr Range impact_frequency_hz{10.0, 1000.0, "10 ... 1000 Hz"};
inline constexpr Range impact_decay_ms{1.0, 500.0, "1 ... 500 ms"};
inline constexpr Range field_scale{-1000.0, 1000.0, "-1000 ... 1000"};
inline constexpr Range tip_radius_mm{1e-6, 50.0, "0.000001 ... 50 mm"};
inline constexpr Range effect_stiffness_n_mm{0.001, 100.0, "0.001 ... 100 N/mm"};
inline constexpr Range friction{0.0, 4.0, "0 ... 4"};
inline constexpr Range stribeck_mm_s{0.0, 1000.0, "0 ... 1000 mm/s"};
inline constexpr Range amplitude_mm{1e-6, 100.0, "0.000001 ... 100 mm"};
inline constexpr Range wavelength_mm{0.02, 1000.0, "0.02 ... 1000 mm"};
inline constexpr Range length_mm{1e-6, 1e6, "0.000001 ... 1000000 mm"};
inline constexpr Range chord_mm{1e-6, 1e4, "0.000001 ... 10000 mm"};
inline constexpr Range position_mm{-1e6, 1e6, "-1000000 ... 1000000 mm"};
inline constexpr Range max_force_n{0.001, 1000.0, "0.001 ... 1000 N"};
inline constexpr Range encoder_mm{1e-6, 10.0, "0.000001 ... 10 mm"};
inline constexpr Range arm_mass_kg{0.001, 10.0, "0.001 ... 10 kg"};
inline constexpr Range hand_mass_kg{0.0, 10.0, "0 ... 10 kg"};
inline constexpr Range delay_ms{0.0, 100.0, "0 ... 100 ms"};
inline constexpr Range bandwidth_hz{1.0, 10000.0, "1 ... 10000 Hz"};
inline constexpr Range slew_n_per_ms{0.001, 1000.0, "0.001 ... 1000 N/ms"};
inline constexpr Range ramp_ms{0.0, 10000.0, "0 ... 10000 ms"};
inline constexpr Range crossfade_ms{1.0, 10000.0, "1 ... 10000 ms"};
inline constexpr Range rate_hz{1000.0, 10000.0, "1000 ... 10000 Hz"};
inline constexpr Range motion_mm{0.0, 1000.0, "0 ... 1000 mm"};
inline constexpr Range motion_hz{0.0, 100.0, "0 ... 100 Hz"};
inline constexpr Range motion_mm_s{0.0, 2000.0, "no more than 2000 mm/s"};
inline constexpr Range motion_ramp_s{0.05, 60.0, "0.05 ... 60 s"};
inline constexpr Range rev_per_s{-10.0, 10.0, "-10 ... 10 revolutions per second"};
inline constexpr Range angle_deg{-36000.0, 36000.0, "-36000 ... 36000 degrees"};

} // namespace range

} // namespace phantom::scene
