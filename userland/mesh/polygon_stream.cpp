// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/polygon_stream.hpp"

#include <array>
#include <cstring>
#include <string_view>

namespace phantom::mesh {

namespace {

constexpr std::string_view soup_mark = "PHSOUP1\n", error_mark = "PHERROR\n";
using Counts = std::array<std::uint64_t, 4>; ///< vertices, normals, corners, polygons

template <typename T>
bool send(const T* values, std::size_t count, std::FILE* to)
{
    return std::fwrite(values, sizeof(T), count, to) == count;
}

template <typename T>
void take(std::string_view& bytes, T* values, std::size_t count)
{
    if (count > 0)
        std::memcpy(values, bytes.data(), count * sizeof(T));
    bytes.remove_prefix(count * sizeof(T));
}

} // namespace

bool send_polygons(const PolygonSoup& polygons, std::FILE* to)
{
    const Counts counts{polygons.vertices.size(), polygons.normals.size(), polygons.corners.size(),
                        polygons.polygons()};
    std::array<std::uint64_t, 1> end{};
    bool good = send(soup_mark.data(), soup_mark.size(), to) && send(counts.data(), counts.size(), to) &&
                send(polygons.vertices.data(), polygons.vertices.size(), to) &&
                send(polygons.normals.data(), polygons.normals.size(), to) &&
                send(polygons.corners.data(), polygons.corners.size(), to);
    for (std::size_t p = 1; p < polygons.first.size() && good; ++p) {
        end[0] = polygons.first[p];
        good = send(end.data(), 1, to);
    }
    return good && std::fflush(to) == 0;
}

bool send_error(const std::string& what, std::FILE* to)
{
    return send(error_mark.data(), error_mark.size(), to) && send(what.data(), what.size(), to) &&
           std::fflush(to) == 0;
}

Result<PolygonSoup> received_polygons(const std::string& bytes)
{
    std::string_view left = bytes;
    if (left.starts_with(error_mark))
        return Error{"", bytes.substr(error_mark.size())};
    Counts counts{};
    const bool marked = left.starts_with(soup_mark);
    left.remove_prefix(marked ? soup_mark.size() : left.size());
    if (left.size() < sizeof(counts))
        return Error{"", "nothing was read"};
    take(left, counts.data(), counts.size());
    const auto [vertices, normals, corners, polygons] = counts;
    // Each count alone is bounded first, so that the sum cannot wrap.
    for (const std::uint64_t count : counts) {
        if (count > left.size())
            return Error{"", "only a part was read"};
    }
    if (left.size() != sizeof(Vec3) * (vertices + normals) + sizeof(std::uint32_t) * corners +
                           sizeof(std::uint64_t) * polygons)
        return Error{"", "only a part was read"};
    PolygonSoup soup;
    soup.vertices.resize(vertices);
    soup.normals.resize(normals);
    soup.corners.resize(corners);
    soup.first.resize(polygons + 1);
    take(left, soup.vertices.data(), vertices);
    take(left, soup.normals.data(), normals);
    take(left, soup.corners.data(), corners);
    for (std::size_t p = 1; p <= polygons; ++p) {
        std::uint64_t end = 0;
        take(left, &end, 1);
        soup.first[p] = end;
        if (end < soup.first[p - 1] || end > corners)
            return Error{"", "only a part was read"};
    }
    return soup;
}

} // namespace phantom::mesh
