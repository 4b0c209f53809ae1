// SPDX-License-Identifier: GPL-2.0-or-later
// Output files that are there whole or not at all.
#pragma once

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "base/result.hpp"

namespace phantom {

/// A file being written: to a temporary one beside it, renamed by commit() or publish(), removed without
/// them. What is there and is no regular file (a pipe, /dev/null) is written to directly.
class OutputFile {
  public:
    static Result<OutputFile> open(const std::filesystem::path& file)
    {
        std::error_code code;
        const auto kind = std::filesystem::status(file, code).type();
        OutputFile out;
        out.file_ = file;
        out.direct_ =
            kind != std::filesystem::file_type::not_found && kind != std::filesystem::file_type::regular;
        out.written_ = file;
        if (!out.direct_)
            out.written_ += ".tmp-" + std::to_string(::getpid());
        out.stream_ = std::fopen(out.written_.c_str(), "wb");
        if (!out.stream_)
            return out.failed(errno);
        return out;
    }

    OutputFile(OutputFile&& other) noexcept
        : file_(std::move(other.file_)),
          written_(std::move(other.written_)),
          direct_(other.direct_),
          stream_(std::exchange(other.stream_, nullptr))
    {
    }
    OutputFile& operator=(OutputFile&& other) noexcept
    {
        std::swap(file_, other.file_);
        std::swap(written_, other.written_);
        std::swap(direct_, other.direct_);
        std::swap(stream_, other.stream_);
        return *this;
    }
    ~OutputFile() { discard(); }

    Status append(std::string_view text)
    {
        // An empty text may have no address, which fwrite does not allow.
        if (text.empty() || std::fwrite(text.data(), 1, text.size(), stream_) == text.size())
            return success();
        const int error = errno;
        discard();
        return failed(error);
    }

    /// For a file that is good at any length: it gets its name, and what was appended so far is in it. More
    /// may come.
    Status publish()
    {
        const bool written = std::fflush(stream_) == 0;
        if (written && (direct_ || std::rename(written_.c_str(), file_.c_str()) == 0)) {
            direct_ = true;
            written_ = file_;
            return success();
        }
        const int error = errno;
        discard();
        return failed(error);
    }

    /// Nothing may be appended after it.
    Status commit()
    {
        std::FILE* stream = std::exchange(stream_, nullptr);
        const bool closed = std::fclose(stream) == 0;
        if (closed && (direct_ || std::rename(written_.c_str(), file_.c_str()) == 0))
            return success();
        const int error = errno;
        if (!direct_)
            ::unlink(written_.c_str());
        return failed(error);
    }

  private:
    OutputFile() = default;
    [[nodiscard]] Error failed(int error) const
    {
        return {file_.string(), "cannot be written: " + std::string(std::strerror(error))};
    }
    void discard()
    {
        if (!stream_)
            return;
        std::fclose(std::exchange(stream_, nullptr));
        if (!direct_)
            ::unlink(written_.c_str());
    }

    std::filesystem::path file_, written_;
    bool direct_ = false;
    std::FILE* stream_ = nullptr;
};

/// All of text at once.
inline Status write_file(const std::filesystem::path& file, std::string_view text)
{
    Result<OutputFile> out = OutputFile::open(file);
    if (!out)
        return out.error();
    if (Status status = out->append(text); !status)
        return status;
    return out->commit();
}

} // namespace phantom
