// SPDX-License-Identifier: GPL-2.0-or-later
// A file in memory, as a stream that always knows where it stands. Readers that only say "failed"
// still leave a place to name in the error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <streambuf>
#include <string>

#include "base/result.hpp"

namespace phantom::mesh {

/// Of a regular file. Errors: missing, a directory, not a regular file, empty.
Result<std::uintmax_t> size_of(const std::filesystem::path& file);

/// Reads a regular file whole. Errors: those of size_of(), no permission.
Result<std::string> load_bytes(const std::filesystem::path& file);

/// Number of the line (from 1) in which byte `offset` lies.
std::size_t line_of(const std::string& bytes, std::size_t offset);

/// Read-only stream buffer over bytes that somebody else owns; seekable.
class ByteBuffer : public std::streambuf {
  public:
    explicit ByteBuffer(std::string& bytes);

    /// Bytes taken so far; also after the stream has failed.
    [[nodiscard]] std::size_t position() const { return static_cast<std::size_t>(gptr() - eback()); }

  protected:
    pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode which) override;
    pos_type seekpos(pos_type position, std::ios_base::openmode which) override;
};

} // namespace phantom::mesh
