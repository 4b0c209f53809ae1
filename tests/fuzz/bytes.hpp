// SPDX-License-Identifier: GPL-2.0-or-later
// An input as a stream of small choices. Its end reads as zeros, so that every string is an input and a
// byte that is removed or added moves what follows but spoils nothing.
#pragma once

#include <cstddef>
#include <cstdint>

namespace phantom::fuzz {

class Bytes {
  public:
    Bytes(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}

    [[nodiscard]] bool empty() const { return at_ == end_; }
    std::uint8_t byte() { return at_ == end_ ? std::uint8_t(0) : *at_++; }
    /// 0 ... count - 1
    std::uint32_t choose(std::uint32_t count) { return byte() % count; }
    /// Little-endian, as many bytes as the type has.
    template <class T>
    T raw()
    {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < sizeof(T); ++i)
            value |= std::uint64_t(byte()) << (8 * i);
        return static_cast<T>(value);
    }

  private:
    const std::uint8_t* at_;
    const std::uint8_t* end_;
};

} // namespace phantom::fuzz
