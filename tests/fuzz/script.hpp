// SPDX-License-Identifier: GPL-2.0-or-later
// An input is a script: one byte says to whom it is played, then come operations, each with its arguments.
#pragma once

#include <cstddef>
#include <cstdint>

namespace phantom::fuzz {

/// Throws a Finding where a result is wrong.
void play(const std::uint8_t* data, std::size_t size);

/// The operations, in the order of their codes. seeds.cpp writes scripts with them.
enum class Operation : std::uint8_t {
    Shape,    ///< adds a shape to the set under construction
    Material, ///< for the faces that follow
    Object,   ///< for the faces that follow; from first_mover on one that moves
    Ruler,    ///< a power of ten as the unit of lengths
    Cover,    ///< the coverage
    Origin,   ///< of the set
    Weld,     ///< whether equal corners are one vertex
    Repeat,   ///< the last shape's faces once more, moved, perhaps flipped
    Clear,    ///< begins another set
    Submit,
    Spoil, ///< submits with words overwritten
    Model,
    Touch, ///< moves the tip to a place over a face, in some ticks
    Move,  ///< moves it by a way, in some ticks
    Jump,  ///< teleports it
    Rest,
    Control,
};
constexpr std::uint32_t operations = 17;

/// Objects with such a number have a pose and velocities behind the revision.
constexpr std::uint8_t first_mover = 240;

} // namespace phantom::fuzz
