// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <unordered_set>

#include "mesh/steps.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

/// Height over the longest side, as a part of it, below which three corners count as collinear: about
/// what rounding leaves of corners that are collinear in exact arithmetic. Such a face has no direction to
/// push.
constexpr double collinear = 1e-12;

bool has_no_area(const Soup& soup, const Triple& face)
{
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0])
        return true;
    const Vec3 a = subtract(soup.vertices[face[1]], soup.vertices[face[0]]);
    const Vec3 b = subtract(soup.vertices[face[2]], soup.vertices[face[0]]);
    const Vec3 c = subtract(b, a);
    const double longest = std::max({dot(a, a), dot(b, b), dot(c, c)});
    return !(length(cross(a, b)) > collinear * longest);
}

/// Removes the faces for which drop(face) holds; the rest stays in order.
template <typename Drop>
std::uint64_t remove_faces(Soup& soup, Drop&& drop)
{
    const bool with_normals = !soup.face_normals.empty();
    std::size_t kept = 0;
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        if (drop(soup.faces[f]))
            continue;
        soup.faces[kept] = soup.faces[f];
        if (with_normals)
            soup.face_normals[kept] = soup.face_normals[f];
        ++kept;
    }
    const std::uint64_t dropped = soup.faces.size() - kept;
    soup.faces.resize(kept);
    if (with_normals)
        soup.face_normals.resize(kept);
    return dropped;
}

struct TripleHash {
    std::size_t operator()(const Triple& t) const
    {
        std::uint64_t hash = t[0];
        for (const std::uint32_t v : {t[1], t[2]})
            hash = (hash ^ v ^ hash >> 32) * 0x9e3779b97f4a7c15ULL;
        return hash ^ hash >> 29;
    }
};

/// The same for a face and its two rotations, another for its reverse.
Triple smallest_first(const Triple& face)
{
    const auto first = static_cast<std::size_t>(std::min_element(face.begin(), face.end()) - face.begin());
    return {face[first], face[(first + 1) % 3], face[(first + 2) % 3]};
}

} // namespace

Vec3 face_normal(const Soup& soup, const Triple& face)
{
    const Vec3 a = subtract(soup.vertices[face[1]], soup.vertices[face[0]]);
    const Vec3 b = subtract(soup.vertices[face[2]], soup.vertices[face[0]]);
    return normalized(cross(a, b));
}

void drop_degenerate(Soup& soup, Report& report)
{
    report.faces_nonfinite += remove_faces(soup, [&](const Triple& face) {
        return !is_finite(soup.vertices[face[0]]) || !is_finite(soup.vertices[face[1]]) ||
               !is_finite(soup.vertices[face[2]]);
    });
    report.faces_zero_area += remove_faces(soup, [&](const Triple& face) { return has_no_area(soup, face); });
}

std::uint64_t drop_duplicates(Soup& soup, Report& report)
{
    std::unordered_set<Triple, TripleHash> seen;
    seen.reserve(soup.faces.size());
    const std::uint64_t dropped =
        remove_faces(soup, [&](const Triple& face) { return !seen.insert(smallest_first(face)).second; });
    report.faces_duplicate += dropped;
    return dropped;
}

} // namespace phantom::mesh
