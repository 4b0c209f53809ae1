// SPDX-License-Identifier: GPL-2.0-or-later
#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sys/stat.h>
#include <unistd.h>
#include <unordered_map>

#include <fmt/format.h>

#include "mesh/prepare.hpp"

namespace phantom::mesh {

namespace {

static_assert(std::endian::native == std::endian::little, "write_ply() copies values as they lie in memory");

/// Vertices of the file: one for each pair of vertex and normal in use.
struct Split {
    std::vector<std::array<double, 6>> vertices;
    std::vector<Triple> faces;
};

Split split_by_normal(const Mesh& mesh)
{
    Split split;
    split.faces.resize(mesh.faces.size());
    std::unordered_map<std::uint64_t, std::uint32_t> numbers;
    numbers.reserve(mesh.vertices.size());
    // Vertices keep their order by first use, so that a mesh with one normal per vertex keeps its numbers.
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t vertex = mesh.faces[f][i], normal = mesh.face_normals[f][i];
            const auto [found, fresh] =
                numbers.try_emplace(static_cast<std::uint64_t>(vertex) << 32 | normal,
                                    static_cast<std::uint32_t>(split.vertices.size()));
            if (fresh) {
                const Vec3 &p = mesh.vertices[vertex], &n = mesh.normals[normal];
                split.vertices.push_back({p[0], p[1], p[2], n[0], n[1], n[2]});
            }
            split.faces[f][i] = found->second;
        }
    }
    return split;
}

std::string bytes_of(const Mesh& mesh)
{
    const Split split = split_by_normal(mesh);
    std::string bytes = fmt::format("ply\n"
                                    "format binary_little_endian 1.0\n"
                                    "comment phantom_rt, millimetres\n"
                                    "element vertex {}\n"
                                    "property double x\nproperty double y\nproperty double z\n"
                                    "property double nx\nproperty double ny\nproperty double nz\n"
                                    "element face {}\n"
                                    "property list uchar int vertex_indices\n"
                                    "end_header\n",
                                    split.vertices.size(), split.faces.size());
    const std::size_t header = bytes.size(), points = split.vertices.size() * 6 * sizeof(double);
    constexpr std::size_t face_bytes = 1 + sizeof(Triple);
    bytes.resize(header + points + split.faces.size() * face_bytes);
    std::memcpy(bytes.data() + header, split.vertices.data(), points);
    char* at = bytes.data() + header + points;
    for (const Triple& face : split.faces) {
        *at = 3;
        std::memcpy(at + 1, face.data(), sizeof(Triple));
        at += face_bytes;
    }
    return bytes;
}

bool write_all(int descriptor, const std::string& bytes)
{
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t wrote = ::write(descriptor, bytes.data() + done, bytes.size() - done);
        if (wrote < 0 && errno == EINTR)
            continue;
        if (wrote <= 0)
            return false;
        done += static_cast<std::size_t>(wrote);
    }
    return ::fsync(descriptor) == 0;
}

/// What a new file of this process may be: mkstemp() gives 0600.
mode_t default_mode()
{
    const mode_t mask = ::umask(0);
    ::umask(mask);
    return 0666 & ~mask;
}

} // namespace

Status write_ply(const Mesh& mesh, const std::string& file)
{
    const std::string bytes = bytes_of(mesh);
    std::string temporary = file + ".XXXXXX";
    const int descriptor = ::mkstemp(temporary.data());
    if (descriptor < 0)
        return Error{file, std::string("cannot be written: ") + std::strerror(errno)};
    bool good = write_all(descriptor, bytes) && ::fchmod(descriptor, default_mode()) == 0;
    int cause = errno;
    if (::close(descriptor) != 0 && good) {
        good = false;
        cause = errno;
    }
    if (good && std::rename(temporary.c_str(), file.c_str()) == 0)
        return success();
    if (good)
        cause = errno;
    ::unlink(temporary.c_str());
    return Error{file, std::string("cannot be written: ") + std::strerror(cause)};
}

} // namespace phantom::mesh
