// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>

#include "mesh/steps.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

/// Height over the longest side, as a part of it, below which three corners count as collinear: about
/// what rounding leaves of corners that are collinear in exact arithmetic. Such a face has no direction to
/// push.
constexpr double collinear = 1e-12;

} // namespace

bool has_no_area(std::span<const Vec3> vertices, const Triple& face)
{
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0])
        return true;
    const Vec3 a = subtract(vertices[face[1]], vertices[face[0]]);
    const Vec3 b = subtract(vertices[face[2]], vertices[face[0]]);
    const Vec3 c = subtract(b, a);
    const double longest = std::max({dot(a, a), dot(b, b), dot(c, c)});
    return !(length(cross(a, b)) > collinear * longest);
}

Vec3 face_normal(std::span<const Vec3> vertices, const Triple& face)
{
    const Vec3 a = subtract(vertices[face[1]], vertices[face[0]]);
    const Vec3 b = subtract(vertices[face[2]], vertices[face[0]]);
    return normalized(cross(a, b));
}

void drop_nonfinite(Soup& soup, Report& report)
{
    report.faces_nonfinite += remove_faces(soup, [&](std::size_t f) {
        const Triple& face = soup.faces[f];
        return !is_finite(soup.vertices[face[0]]) || !is_finite(soup.vertices[face[1]]) ||
               !is_finite(soup.vertices[face[2]]);
    });
}

void drop_degenerate(Soup& soup, Report& report)
{
    drop_nonfinite(soup, report);
    report.faces_zero_area +=
        remove_faces(soup, [&](std::size_t f) { return has_no_area(soup.vertices, soup.faces[f]); });
}

} // namespace phantom::mesh
