// SPDX-License-Identifier: GPL-2.0-or-later
// Grey images as height fields come: PNG of 8 or 16 bits, PGM as text or binary up to 65535.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/result.hpp"

namespace phantom::scene {

struct GreyImage {
    std::uint32_t width = 0, height = 0;
    std::vector<double> samples; ///< 0 ... 1, row by row from the upper edge

    [[nodiscard]] double at(std::uint32_t column, std::uint32_t row) const
    {
        return samples[static_cast<std::size_t>(row) * width + column];
    }
};

/// More samples than this on a side are taken for damage.
inline constexpr std::uint32_t image_side_max = 30000;

/// The format is told by the first bytes. Errors name the file and what was expected: missing, truncated,
/// another format, colours, transparency, fewer than 2 samples on a side.
Result<GreyImage> read_grey_image(const std::filesystem::path& file);

} // namespace phantom::scene
