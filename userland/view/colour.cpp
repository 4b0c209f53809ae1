// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/colour.hpp"

#include <algorithm>
#include <cstddef>

namespace phantom::view {

namespace {

// viridis at 0, 1/16 ... 16/16; between them it is linear to 1/255.
constexpr std::array<std::array<unsigned char, 3>, 17> anchors{{
    {68, 1, 84},
    {72, 24, 106},
    {71, 45, 123},
    {66, 64, 134},
    {59, 82, 139},
    {51, 99, 141},
    {44, 114, 142},
    {38, 130, 142},
    {33, 145, 140},
    {31, 160, 136},
    {40, 174, 128},
    {63, 188, 115},
    {94, 201, 98},
    {132, 212, 75},
    {173, 220, 48},
    {216, 226, 25},
    {253, 231, 37},
}};

} // namespace

Colour viridis(double fraction)
{
    // The comparison is false for NaN too.
    const double at = fraction > 0 ? std::min(fraction, 1.0) * (anchors.size() - 1) : 0.0;
    const auto low = std::min(static_cast<std::size_t>(at), anchors.size() - 2);
    const double part = at - static_cast<double>(low);
    Colour colour{};
    for (std::size_t i = 0; i < 3; ++i)
        colour[i] = ((1 - part) * anchors[low][i] + part * anchors[low + 1][i]) / 255.0;
    return colour;
}

} // namespace phantom::view
