// SPDX-License-Identifier: GPL-2.0-or-later
// Orientation by component: neighbours agree, a closed one points out of the solid that it bounds.
#include <algorithm>
#include <cmath>
#include <compare>
#include <memory>

#include "mesh/components.hpp"
#include "mesh/edge_index.hpp"
#include "mesh/steps.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

void turn(Soup& soup, std::size_t face)
{
    std::swap(soup.faces[face][1], soup.faces[face][2]);
    if (!soup.face_normals.empty())
        std::swap(soup.face_normals[face][1], soup.face_normals[face][2]);
}

/// Signed volume of each component (positive: normals outward), and a bound of its rounding error.
struct Volume {
    double value = 0, magnitude = 0;
};

std::vector<Volume> volumes_of(const Soup& soup, const Components& components)
{
    // Relative to one of its own vertices, so that a small part far from the origin keeps its sign.
    std::vector<std::uint32_t> anchor(components.count(), no_neighbour);
    std::vector<Volume> volumes(components.count());
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        const std::uint32_t component = components.of_face[f];
        const Triple& face = soup.faces[f];
        if (anchor[component] == no_neighbour)
            anchor[component] = face[0];
        const Vec3& origin = soup.vertices[anchor[component]];
        const Vec3 a = subtract(soup.vertices[face[0]], origin);
        const Vec3 b = subtract(soup.vertices[face[1]], origin);
        const Vec3 c = subtract(soup.vertices[face[2]], origin);
        const double six_volumes = dot(a, cross(b, c));
        volumes[component].value += six_volumes;
        volumes[component].magnitude += std::abs(six_volumes);
    }
    return volumes;
}

/// A duplicate lies on the same edges as its original, in the same sense, with the same third corner.
std::uint64_t drop_duplicates(Soup& soup, const EdgeIndex& edges)
{
    struct Side {
        std::uint32_t from, third, face;
        auto operator<=>(const Side&) const = default; // NOLINT(modernize-use-nullptr): its 0
    };
    std::vector<bool> duplicate(soup.faces.size(), false);
    std::vector<Side> sides;
    edges.for_each([&](std::uint32_t, std::uint32_t, std::span<const HalfEdge> halves) {
        // two that run opposite ways are the usual case
        if (halves.size() < 2 ||
            (halves.size() == 2 && from_vertex(soup.faces, halves[0]) != from_vertex(soup.faces, halves[1])))
            return;
        sides.clear();
        for (const HalfEdge half : halves)
            sides.push_back({from_vertex(soup.faces, half), soup.faces[half / 3][(half + 2) % 3], half / 3});
        std::sort(sides.begin(), sides.end());
        for (std::size_t i = 1; i < sides.size(); ++i) {
            if (sides[i].from == sides[i - 1].from && sides[i].third == sides[i - 1].third)
                duplicate[sides[i].face] = true;
        }
    });
    return remove_faces(soup, [&](std::size_t f) { return duplicate[f]; });
}

/// Turns faces so that all of a component agree; returns how many.
std::uint64_t turn_to_agree(Soup& soup, const Components& components)
{
    std::uint64_t flipped = 0;
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        const std::uint32_t component = components.of_face[f];
        // The fewer are turned; with as many on either side, the first face decides.
        const bool others = 2 * components.turned[component] > components.size[component];
        if (components.turn[f] != others) {
            turn(soup, f);
            ++flipped;
        }
    }
    return flipped;
}

/// Turns closed components that do not point out of their solid; returns how many components.
std::uint64_t turn_outward(Soup& soup, const EdgeIndex& edges, const Components& components, Report& report)
{
    const std::vector<bool> closed = closed_components(soup.faces, edges, components);
    const std::vector<bool> cavity = cavities_of(soup, components, closed);
    const std::vector<Volume> volumes = volumes_of(soup, components);
    std::vector<bool> inside_out(closed.size());
    std::uint64_t count = 0;
    report.cavities = 0;
    for (std::size_t c = 0; c < closed.size(); ++c) {
        // A doubled sheet has no volume but rounding's: it has no outside either.
        const double outward = cavity[c] ? -volumes[c].value : volumes[c].value;
        inside_out[c] = closed[c] && outward < -1e-9 * volumes[c].magnitude;
        count += inside_out[c];
        report.cavities += cavity[c];
    }
    for (std::size_t f = 0; count > 0 && f < soup.faces.size(); ++f) {
        if (inside_out[components.of_face[f]])
            turn(soup, f);
    }
    return count;
}

} // namespace

void orient(Soup& soup, std::unique_ptr<EdgeIndex>& edges, Report& report)
{
    const auto index_again = [&] {
        edges.reset(); // before the next: each is as large as the soup
        edges = std::make_unique<EdgeIndex>(soup.faces, soup.vertices.size());
    };
    // Turning faces can make two of them equal, and dropping one can give an edge its two faces: until
    // nothing changes. Each further round has fewer faces, so it ends.
    for (bool first = true;; first = false) {
        const std::uint64_t dropped = drop_duplicates(soup, *edges);
        report.faces_duplicate += dropped;
        if (dropped == 0 && !first)
            return;
        if (dropped > 0)
            index_again();
        const Components components = components_of(soup.faces, *edges);
        const std::uint64_t flipped = turn_to_agree(soup, components);
        if (flipped > 0)
            index_again();
        const std::uint64_t turned = turn_outward(soup, *edges, components, report);
        if (turned > 0)
            index_again();
        report.faces_flipped += flipped;
        report.components_turned += turned;
        if (flipped == 0 && turned == 0)
            return;
    }
}

} // namespace phantom::mesh
