// SPDX-License-Identifier: GPL-2.0-or-later
// A container for arrays: written atomically, checked as a whole, used in place.
//
//   Header        64 bytes: what it is, key, size of the file, checksum of header and table
//   Section[n]    id, where, how many bytes, checksum
//   bytes         of each section, at a multiple of 64, zeros between
//
// In this machine's byte order: the file is a cache and never travels. Checksums are XXH3 (Collet), 64 bits.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "base/mapped_file.hpp"
#include "base/result.hpp"
#include "scene/cache_key.hpp"

namespace phantom::scene {

class SectionWriter {
  public:
    /// The elements must stay where they are until write().
    template <typename T>
    void add(std::uint32_t id, std::span<const T> elements)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        sections_.push_back({id, std::as_bytes(elements)});
    }
    /// The file is there whole or not at all. Error: it cannot be written.
    [[nodiscard]] Status write(const std::filesystem::path& file, const CacheKey& key) const;

  private:
    struct Section {
        std::uint32_t id;
        std::span<const std::byte> bytes;
    };
    std::vector<Section> sections_;
};

/// What is checked on opening: all of it, or no more than header and table.
enum class Check { content, table };

/// An opened file.
class SectionReader {
  public:
    /// Error: not there, cut short, no such file, of another version, or changed since (with the words "has
    /// changed"). With a key: it must be that one's.
    static Result<SectionReader> open(const std::filesystem::path& file, const std::optional<CacheKey>& key,
                                      Check check = Check::content);

    /// The elements of a section, in the mapping; nothing if there is no such section, or it does not hold a
    /// whole number of elements.
    template <typename T>
    [[nodiscard]] std::optional<std::span<const T>> find(std::uint32_t id) const
    {
        static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= alignment);
        const std::optional<std::span<const std::byte>> bytes = find_bytes(id);
        if (!bytes || bytes->size() % sizeof(T) != 0)
            return std::nullopt;
        return std::span(reinterpret_cast<const T*>(bytes->data()), bytes->size() / sizeof(T));
    }
    /// Keeps the mapping alive.
    [[nodiscard]] std::shared_ptr<const void> keeper() const { return file_; }
    [[nodiscard]] const CacheKey& key() const { return key_; }

    static constexpr std::size_t alignment = 64;

  private:
    SectionReader() = default;
    [[nodiscard]] std::optional<std::span<const std::byte>> find_bytes(std::uint32_t id) const;

    std::shared_ptr<const MappedFile> file_;
    CacheKey key_;
};

} // namespace phantom::scene
