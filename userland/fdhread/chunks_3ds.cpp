// SPDX-License-Identifier: GPL-2.0-or-later
// A chunk is an id of 16 bits, its own size in bytes of 32 bits, and its content; of some ids the content is
// chunks again.
#include "fdhread/chunks_3ds.hpp"

#include <cstdint>
#include <fstream>
#include <iterator>

namespace phantom::fdhread {

namespace {

constexpr std::size_t head = 6;
enum Id : std::uint16_t { file_id = 0x4D4D, scene_id = 0x3D3D, object_id = 0x4000, triangles_id = 0x4100 };

std::uint32_t number(const std::string& bytes, std::size_t at, std::size_t size)
{
    std::uint32_t value = 0;
    for (std::size_t i = size; i-- > 0;)
        value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

/// Chunks from `at` to `end`; the offset of a bad one, or npos.
std::size_t check(const std::string& bytes, std::size_t at, std::size_t end)
{
    while (at < end) {
        const std::uint32_t id = end - at < head ? 0 : number(bytes, at, 2);
        const std::size_t size = end - at < head ? 0 : number(bytes, at + 2, 4);
        if (size < head || size > end - at)
            return at;
        std::size_t content = at + head;
        if (id == object_id)
            content = bytes.find('\0', content); // its name
        if (id == object_id && content++ >= at + size)
            return at;
        if (id == file_id || id == scene_id || id == object_id || id == triangles_id) {
            const std::size_t bad = check(bytes, content, at + size);
            if (bad != std::string::npos)
                return bad;
        }
        at += size;
    }
    return std::string::npos;
}

} // namespace

std::string bad_chunk(const std::string& file)
{
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
    if (bytes.size() < head || number(bytes, 0, 2) != file_id)
        return "is no 3DS file: its first two bytes are not 4D 4D";
    const std::size_t bad = check(bytes, 0, bytes.size());
    return bad == std::string::npos
               ? ""
               : "is damaged: the chunk at byte " + std::to_string(bad) + " does not end within its parent";
}

} // namespace phantom::fdhread
