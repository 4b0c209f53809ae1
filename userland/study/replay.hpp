// SPDX-License-Identifier: GPL-2.0-or-later
// A recording computed again: every tick of it by the module's own code, at its recorded time and from its
// recorded inputs, and what comes out held against what was recorded.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "device/recording.hpp"

namespace phantom::study {

struct ReplayOptions {
    std::uint32_t isa = PHANTOM_ISA_NONE; ///< DOUBLE: the same inputs in double, to see what float costs
    bool csv = false;                     ///< a trace of the ticks as they come out here
    std::function<void(double)> progress{};
};

/// What is compared of a tick, bit for bit. The rest of a record is what it was computed from, or how long
/// that took.
enum ReplayField : std::uint8_t { force, proxy, contacts, set, flags, faults, replay_fields };
const char* field_name(int field);

struct ReplayDifference {
    std::size_t run = 0; ///< from 0
    phantom_tick recorded{}, here{};
    std::string fields; ///< "force, proxy"
};

struct ReplayReport {
    std::string isa;        ///< that computed it again
    std::uint64_t runs = 0; ///< of which something was computed
    std::uint64_t ticks = 0, differ = 0;
    std::array<std::uint64_t, replay_fields> field_differs{};
    std::optional<ReplayDifference> first;
    double worst_force_n = 0, worst_proxy_mm = 0; ///< lengths of the differences
    /// What the compared ticks were, as recorded: a comparison of nothing but zeros proves nothing.
    std::uint64_t contact_ticks = 0, inside_ticks = 0, fading_ticks = 0, ramping_ticks = 0, fault_ticks = 0;
    std::uint64_t missed = 0;     ///< periods that the servo skipped
    std::uint64_t sets = 0;       ///< taken by the servo
    std::uint64_t lost = 0;       ///< records that the recording lacks
    std::uint64_t uncompared = 0; ///< ticks behind a lost record: what they came from is not known
    std::string csv;
    std::vector<std::string> notes; ///< sentences about what was not compared, and why

    [[nodiscard]] bool same() const { return differ == 0; }
};

/// Fails when there is nothing to compute from: not recorded by the feeder, sets that are missing or refused,
/// an instruction set that this processor lacks.
Result<ReplayReport> replay(const device::Recording& recording, const ReplayOptions& options);

} // namespace phantom::study
