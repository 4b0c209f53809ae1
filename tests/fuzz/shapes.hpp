// SPDX-License-Identifier: GPL-2.0-or-later
// From bytes to shapes: what meshes are made of, and what breaks contact mathematics.
#pragma once

#include "bytes.hpp"
#include "set_builder.hpp"

namespace phantom::fuzz {

/// The unit of lengths: 1000 steps of two bytes. 1 mm reaches +-32 mm in micrometres.
struct Ruler {
    std::int64_t unit_nm = 1'000'000;

    /// Two bytes. At the end of the range stand the limits of the border instead.
    std::int64_t length(Bytes& in) const;
    Point point(Bytes& in) const;
};

/// One of the shapes, whichever the bytes say. What it added to the faces.
Range add_shape(Bytes& in, const Ruler& ruler, SetBuilder& to);
constexpr std::uint32_t shape_kinds = 7;
/// In place of a kind: the faces so far end at rims.
constexpr std::uint8_t shape_rims = 255;

/// Three bytes: stiffness, radius and damping over their whole range, on a logarithmic scale; without
/// damping a fourth, which says what else it feels like (feel.hpp).
phantom_material read_material(Bytes& in, std::uint8_t& feel);

} // namespace phantom::fuzz
