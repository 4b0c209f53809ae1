// SPDX-License-Identifier: GPL-2.0-or-later
// What an input is played to. Every call checks what comes of it, and throws a Finding.
#pragma once

#include <cstdint>
#include <memory>

#include "phantom_abi.h"
#include "set_builder.hpp"

namespace phantom::fuzz {

class Subject {
  public:
    /// Calls that a device has beside sets, model and position. Each takes a number, as it likes.
    enum class Control : std::uint32_t {
        Start,
        Stop,
        Rate,
        ClearFault,
        Stall,
        DeviceError,
        Sleep,
        Reopen,
        Allocation,
        Call
    };
    static constexpr std::uint32_t controls = 10;

    virtual ~Subject() = default;
    /// True if it was accepted.
    virtual bool submit(const phantom_set& set) = 0;
    virtual void model(const phantom_model& model) = 0;
    /// One tick with the tip there.
    virtual void tick(const Point& tip_nm) = 0;
    virtual void control(Control, std::uint32_t /*value*/) {}
    /// The input is over.
    virtual void finish() {}
};

/// The float sections themselves, each on every tick: SSE2, AVX2 and AVX-512, bit by bit the same, and
/// float64. Sets pass the border's check first, and a tick comes only where the set covers the tip.
std::unique_ptr<Subject> make_direct(std::uint32_t choice);
/// The whole module on a virtual clock. Two machines live the same life, one with SSE2 and one with the best
/// of this CPU, and leave the same records; or one in float64.
std::unique_ptr<Subject> make_life(std::uint32_t choice);

} // namespace phantom::fuzz
