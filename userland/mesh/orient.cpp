// SPDX-License-Identifier: GPL-2.0-or-later
// Orientation by component. A component is what can be reached over edges of exactly two faces. It is
// closed when its boundary vanishes: on every edge its faces run as often one way as the other. That
// holds for each of two cubes that share an edge, where no face has a unique neighbour.
#include <algorithm>
#include <cmath>
#include <compare>
#include <memory>

#include "mesh/edge_index.hpp"
#include "mesh/steps.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

struct Components {
    std::vector<std::uint32_t> of_face;
    std::vector<std::uint64_t> size,
        turned;             ///< faces; of them those to turn so that all agree with the first
    std::vector<bool> turn; ///< per face: against the first face of its component
};

/// Face over each half-edge where exactly two meet, whatever their sense, with "same sense" in the low bit;
/// all ones otherwise.
std::vector<std::uint64_t> links_of(const Soup& soup, const EdgeIndex& edges)
{
    std::vector<std::uint64_t> links(3 * soup.faces.size(), ~0ULL);
    edges.for_each([&](std::uint32_t, std::uint32_t, std::span<const HalfEdge> halves) {
        if (halves.size() != 2)
            return;
        const std::uint64_t same = from_vertex(soup.faces, halves[0]) == from_vertex(soup.faces, halves[1]);
        links[halves[0]] = 2ULL * (halves[1] / 3) + same;
        links[halves[1]] = 2ULL * (halves[0] / 3) + same;
    });
    return links;
}

/// Faces that agree already are reached before any is turned, so a second run finds nothing to turn. Each
/// face is reached once, so a Moebius strip ends like any other; where it closes on itself two faces go on
/// disagreeing.
Components components_of(const Soup& soup, const EdgeIndex& edges)
{
    struct Step {
        std::uint32_t face;
        bool turn;
    };
    const std::vector<std::uint64_t> links = links_of(soup, edges);
    const std::size_t faces = soup.faces.size();
    Components found;
    found.of_face.assign(faces, no_neighbour);
    found.turn.assign(faces, false);
    std::vector<Step> agreeing, disagreeing; // stacks
    for (std::uint32_t seed = 0; seed < faces; ++seed) {
        if (found.of_face[seed] != no_neighbour)
            continue;
        const auto component = static_cast<std::uint32_t>(found.size.size());
        found.size.push_back(0);
        found.turned.push_back(0);
        agreeing.push_back({seed, false});
        while (!agreeing.empty() || !disagreeing.empty()) {
            std::vector<Step>& next = agreeing.empty() ? disagreeing : agreeing;
            const Step step = next.back();
            next.pop_back();
            if (found.of_face[step.face] != no_neighbour)
                continue;
            found.of_face[step.face] = component;
            found.turn[step.face] = step.turn;
            ++found.size[component];
            found.turned[component] += step.turn;
            for (std::uint32_t i = 0; i < 3; ++i) {
                const std::uint64_t link = links[3ULL * step.face + i];
                const auto other = static_cast<std::uint32_t>(link / 2);
                if (link == ~0ULL || found.of_face[other] != no_neighbour)
                    continue;
                const bool same_sense = link & 1;
                (same_sense ? disagreeing : agreeing).push_back({other, step.turn != same_sense});
            }
        }
    }
    return found;
}

void turn(Soup& soup, std::size_t face)
{
    std::swap(soup.faces[face][1], soup.faces[face][2]);
    if (!soup.face_normals.empty())
        std::swap(soup.face_normals[face][1], soup.face_normals[face][2]);
}

std::vector<bool> closed_components(const Soup& soup, const EdgeIndex& edges, const Components& components)
{
    std::vector<bool> closed(components.size.size(), true);
    std::vector<std::pair<std::uint32_t, int>> sums; // per component on one edge
    edges.for_each([&](std::uint32_t low, std::uint32_t, std::span<const HalfEdge> halves) {
        sums.clear();
        for (const HalfEdge half : halves) {
            const std::uint32_t component = components.of_face[half / 3];
            const int sense = from_vertex(soup.faces, half) == low ? 1 : -1;
            auto sum =
                std::find_if(sums.begin(), sums.end(), [&](const auto& s) { return s.first == component; });
            if (sum == sums.end())
                sums.emplace_back(component, sense);
            else
                sum->second += sense;
        }
        for (const auto& [component, sum] : sums) {
            if (sum != 0)
                closed[component] = false;
        }
    });
    return closed;
}

/// Signed volume of each component (positive: normals outward), and a bound of its rounding error.
struct Volume {
    double value = 0, magnitude = 0;
};

std::vector<Volume> volumes_of(const Soup& soup, const Components& components)
{
    // Relative to one of its own vertices, so that a small part far from the origin keeps its sign.
    std::vector<std::uint32_t> anchor(components.size.size(), no_neighbour);
    std::vector<Volume> volumes(components.size.size());
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
        if (halves.size() < 2)
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

/// Turns closed components that are inside out; returns how many components.
std::uint64_t turn_outward(Soup& soup, const EdgeIndex& edges, const Components& components)
{
    const std::vector<bool> closed = closed_components(soup, edges, components);
    const std::vector<Volume> volumes = volumes_of(soup, components);
    std::vector<bool> inside_out(closed.size());
    std::uint64_t count = 0;
    for (std::size_t c = 0; c < closed.size(); ++c) {
        // A doubled sheet has no volume but rounding's: it has no outside either.
        inside_out[c] = closed[c] && volumes[c].value < -1e-9 * volumes[c].magnitude;
        count += inside_out[c];
    }
    for (std::size_t f = 0; count > 0 && f < soup.faces.size(); ++f) {
        if (inside_out[components.of_face[f]])
            turn(soup, f);
    }
    return count;
}

} // namespace

std::uint64_t count_components(const Soup& soup, const EdgeIndex& edges)
{
    return components_of(soup, edges).size.size();
}

void orient(Soup& soup, Report& report)
{
    // Turning faces can make two of them equal, and dropping one can give an edge its two faces: until
    // nothing changes. Each further round has fewer faces, so it ends.
    for (bool first = true;; first = false) {
        auto edges = std::make_unique<EdgeIndex>(soup.faces, soup.vertices.size());
        const std::uint64_t dropped = drop_duplicates(soup, *edges);
        report.faces_duplicate += dropped;
        if (dropped == 0 && !first)
            return;
        if (dropped > 0)
            edges = std::make_unique<EdgeIndex>(soup.faces, soup.vertices.size());
        const Components components = components_of(soup, *edges);
        const std::uint64_t flipped = turn_to_agree(soup, components);
        if (flipped > 0)
            edges = std::make_unique<EdgeIndex>(soup.faces, soup.vertices.size());
        const std::uint64_t turned = turn_outward(soup, *edges, components);
        report.faces_flipped += flipped;
        report.components_turned += turned;
        if (flipped == 0 && turned == 0)
            return;
    }
}

} // namespace phantom::mesh
