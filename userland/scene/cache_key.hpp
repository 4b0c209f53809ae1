// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace phantom::scene {

/// What the content was made from: two that differ have different keys.
struct CacheKey {
    std::array<std::uint64_t, 2> words{};
    bool operator==(const CacheKey&) const = default;
    /// 32 hexadecimal digits.
    [[nodiscard]] std::string text() const;
};

} // namespace phantom::scene
