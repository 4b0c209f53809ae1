// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/bytes.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace phantom::mesh {

namespace {

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

} // namespace

Result<std::uintmax_t> size_of(const std::filesystem::path& file)
{
    const std::string name = file.string();
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found)
        return Error{name, "no such file"};
    if (status.type() == std::filesystem::file_type::directory)
        return Error{name, "is a directory, expected a file"};
    if (error)
        return Error{name, "cannot be opened: " + error.message()};
    if (status.type() != std::filesystem::file_type::regular)
        return Error{name, "is not a regular file"};
    const auto size = std::filesystem::file_size(file, error);
    if (error)
        return Error{name, "size unknown: " + error.message()};
    if (size == 0)
        return Error{name, "is empty"};
    return size;
}

Result<std::string> load_bytes(const std::filesystem::path& file)
{
    const auto size = size_of(file);
    if (!size)
        return size.error();
    const std::string name = file.string();
    const std::unique_ptr<std::FILE, CloseFile> stream(std::fopen(name.c_str(), "rb"));
    if (!stream)
        return Error{name, std::string("cannot be opened: ") + std::strerror(errno)};
    std::string bytes(*size, '\0');
    const std::size_t got = std::fread(bytes.data(), 1, bytes.size(), stream.get());
    if (got != bytes.size())
        return Error{name, "could be read only up to byte " + std::to_string(got) + " of " +
                               std::to_string(bytes.size())};
    return bytes;
}

std::size_t line_of(const std::string& bytes, std::size_t offset)
{
    const auto end = bytes.begin() + static_cast<std::ptrdiff_t>(std::min(offset, bytes.size()));
    return 1 + static_cast<std::size_t>(std::count(bytes.begin(), end, '\n'));
}

ByteBuffer::ByteBuffer(std::string& bytes)
{
    setg(bytes.data(), bytes.data(), bytes.data() + bytes.size());
}

ByteBuffer::pos_type ByteBuffer::seekoff(off_type offset, std::ios_base::seekdir from,
                                         std::ios_base::openmode which)
{
    off_type base = 0;
    if (from == std::ios_base::cur)
        base = gptr() - eback();
    else if (from == std::ios_base::end)
        base = egptr() - eback();
    return seekpos(base + offset, which);
}

ByteBuffer::pos_type ByteBuffer::seekpos(pos_type position, std::ios_base::openmode which)
{
    const off_type to = position;
    if (!(which & std::ios_base::in) || to < 0 || to > egptr() - eback())
        return pos_type(off_type(-1));
    setg(eback(), eback() + to, egptr());
    return position;
}

} // namespace phantom::mesh
