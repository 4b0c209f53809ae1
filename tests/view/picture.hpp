// SPDX-License-Identifier: GPL-2.0-or-later
// A PNG file as pixels, and what can be counted in it.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <vector>

#include "view/colour.hpp"

namespace phantom::view::test {

struct Picture {
    int width = 0, height = 0; ///< 0: not readable
    std::vector<std::array<unsigned char, 3>> pixels;

    [[nodiscard]] std::size_t distinct_colours() const;
    [[nodiscard]] std::size_t count(const std::function<bool(const Colour&)>& is) const;
};

Picture read_picture(const std::filesystem::path& file);

/// Colours by hue and saturation (HSV), so that shading does not matter. Hue in degrees.
bool has_hue(const Colour& colour, double low_deg, double high_deg, double least_saturation);
/// Vermilion of the force arrow in light or shadow.
bool is_arrow(const Colour& colour);
/// The sky blue of selected triangles, filled or over the surface.
bool is_selected(const Colour& colour);
/// The yellow end of the colour map, where the force is largest.
bool is_strongest(const Colour& colour);

} // namespace phantom::view::test
