// SPDX-License-Identifier: GPL-2.0-or-later
// Files seen as memory, without a copy.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "base/result.hpp"

namespace phantom {

/// A whole file, read-only, as long as the object lives. Who cuts the file short meanwhile ends the process
/// by SIGBUS, as with every mapping: a file that is replaced by renaming stays as it was.
class MappedFile {
  public:
    static Result<std::shared_ptr<const MappedFile>> open(const std::filesystem::path& file)
    {
        const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
        if (descriptor < 0)
            return failed(file, errno);
        struct stat status {};
        if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
            ::close(descriptor);
            return Error{file.string(), "is no regular file"};
        }
        std::span<const std::byte> bytes;
        if (const auto size = static_cast<std::size_t>(status.st_size); size > 0) {
            void* at = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
            if (at == MAP_FAILED) {
                const int error = errno;
                ::close(descriptor);
                return failed(file, error);
            }
            bytes = {static_cast<const std::byte*>(at), size};
        }
        ::close(descriptor);
        return std::shared_ptr<const MappedFile>(new MappedFile(bytes));
    }

    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;
    ~MappedFile()
    {
        if (!bytes_.empty())
            ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
    }

    [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

  private:
    explicit MappedFile(std::span<const std::byte> bytes) : bytes_(bytes) {}
    static Error failed(const std::filesystem::path& file, int error)
    {
        return {file.string(), "cannot be opened: " + std::string(std::strerror(error))};
    }
    std::span<const std::byte> bytes_;
};

} // namespace phantom
