// SPDX-License-Identifier: GPL-2.0-or-later
// Vertex normals weighted by the faces' angles at the vertex (Thuermer and Wuethrich 1998, "Computing
// Vertex Normals from Polygonal Facets"): independent of how a flat part is cut into triangles.
#include <cmath>
#include <numbers>
#include <optional>

#include "mesh/groups.hpp"
#include "mesh/steps.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

/// A sum of unit normals shorter than this part of their summed weights has cancelled: what is left is
/// rounding, and the corner takes its face's own normal.
constexpr double cancelled = 1e-6;

/// A normal of the file on the inner side of its face is taken the other way round when that is nearer to the
/// computed one than this (cosine of 60 degrees): the file's faces or its normals were inside out.
constexpr double turned_cosine = 0.5;

std::vector<Vec3> face_normals_of(const Soup& soup)
{
    std::vector<Vec3> normals(soup.faces.size());
    for (std::size_t f = 0; f < normals.size(); ++f)
        normals[f] = face_normal(soup, soup.faces[f]);
    return normals;
}

/// Inner angle at a corner, radians.
double corner_angle(const Soup& soup, const Triple& face, std::size_t corner)
{
    const Vec3& at = soup.vertices[face[corner]];
    return angle_between(subtract(soup.vertices[face[(corner + 1) % 3]], at),
                         subtract(soup.vertices[face[(corner + 2) % 3]], at));
}

std::uint32_t corner_of(const Triple& face, std::uint32_t vertex)
{
    return face[0] == vertex ? 0 : face[1] == vertex ? 1 : 2;
}

/// Whether the smoothing groups of two neighbours make their edge a crease; nothing where one has none.
std::optional<bool> parted_by_groups(const Soup& soup, std::uint32_t face, std::uint32_t other)
{
    if (soup.smoothing.empty() || soup.smoothing[face] == 0 || soup.smoothing[other] == 0)
        return std::nullopt;
    return soup.smoothing[face] != soup.smoothing[other];
}

/// Corners are numbered 3 f + i. Joins those on either end of every edge that is no crease.
Groups group_corners(const Soup& soup, const std::vector<Triple>& neighbours,
                     const std::vector<Vec3>& face_normals, double crease_deg, Report& report)
{
    Groups groups(3 * soup.faces.size());
    // At 180 degrees nothing is a crease, whatever rounding makes of two opposite normals.
    const double crease_cosine = crease_deg < 180.0 ? std::cos(crease_deg * std::numbers::pi / 180.0) : -2.0;
    for (std::uint32_t f = 0; f < soup.faces.size(); ++f) {
        for (std::uint32_t i = 0; i < 3; ++i) {
            const std::uint32_t other = neighbours[f][i];
            if (other == no_neighbour || other < f)
                continue; // each edge once, from its lower face
            const bool sharp = dot(face_normals[f], face_normals[other]) < crease_cosine;
            if (parted_by_groups(soup, f, other).value_or(sharp)) {
                ++report.crease_edges;
                continue;
            }
            for (const std::uint32_t corner : {i, (i + 1) % 3}) {
                const std::uint32_t vertex = soup.faces[f][corner];
                groups.join(3 * f + corner, 3 * other + corner_of(soup.faces[other], vertex));
            }
        }
    }
    return groups;
}

/// Normals of one group of corners, weighted by angle.
struct Sum {
    Vec3 normal{0, 0, 0};
    double weight = 0;
};

} // namespace

void corner_normals(Soup& soup, const std::vector<Triple>& neighbours, double crease_deg, Report& report)
{
    const std::vector<Vec3> faces = face_normals_of(soup);
    Groups groups = group_corners(soup, neighbours, faces, crease_deg, report);
    std::vector<Sum> sums(3 * soup.faces.size());
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
        for (std::uint32_t i = 0; i < 3; ++i) {
            Sum& sum = sums[groups.first(3 * f + i)];
            const double angle = corner_angle(soup, soup.faces[f], i);
            sum.normal = add(sum.normal, scaled(faces[f], angle));
            sum.weight += angle;
        }
    }

    const bool from_file = !soup.face_normals.empty();
    std::vector<Vec3> normals;
    std::vector<Triple> face_normals(faces.size());
    // of the file's normals, as they are and turned over
    std::vector<std::uint32_t> file_number(soup.normals.size(), no_neighbour), turned_number;
    std::vector<std::uint32_t> group_number(sums.size(), no_neighbour);
    const auto numbered = [&normals](std::uint32_t& number, const Vec3& normal) {
        if (number == no_neighbour) {
            number = static_cast<std::uint32_t>(normals.size());
            normals.push_back(normal);
        }
        return number;
    };
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
        std::uint32_t own_number = no_neighbour;
        for (std::uint32_t i = 0; i < 3; ++i) {
            if (from_file) {
                const std::uint32_t given = soup.face_normals[f][i];
                // True only for a direction on the outer side: zero and NaN fail as well.
                if (dot(soup.normals[given], faces[f]) > 0) {
                    face_normals[f][i] = numbered(file_number[given], soup.normals[given]);
                    continue;
                }
                ++report.normals_repaired;
            }
            const std::uint32_t group = groups.first(3 * f + i);
            const Sum& sum = sums[group];
            const Vec3 normal =
                length(sum.normal) > cancelled * sum.weight ? normalized(sum.normal) : Vec3{0, 0, 0};
            if (from_file) {
                const std::uint32_t given = soup.face_normals[f][i];
                const Vec3 turned = scaled(soup.normals[given], -1);
                if (dot(turned, faces[f]) > 0 && dot(turned, normal) > turned_cosine) {
                    turned_number.resize(soup.normals.size(), no_neighbour);
                    face_normals[f][i] = numbered(turned_number[given], turned);
                    continue;
                }
            }
            if (dot(normal, faces[f]) > 0) {
                face_normals[f][i] = numbered(group_number[group], normal);
                continue;
            }
            report.normals_repaired += !from_file;
            face_normals[f][i] = numbered(own_number, faces[f]);
        }
    }
    soup.normals = std::move(normals);
    soup.face_normals = std::move(face_normals);
}

void vertex_normals(Soup& soup)
{
    soup.normals.assign(soup.vertices.size(), Vec3{0, 0, 0});
    for (const Triple& face : soup.faces) {
        const Vec3 normal = face_normal(soup, face);
        for (std::size_t i = 0; i < 3; ++i)
            soup.normals[face[i]] = add(soup.normals[face[i]], scaled(normal, corner_angle(soup, face, i)));
    }
    for (Vec3& normal : soup.normals)
        normal = normalized(normal);
    soup.face_normals = soup.faces;
}

} // namespace phantom::mesh
