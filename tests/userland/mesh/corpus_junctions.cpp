// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "corpus.hpp"

namespace phantom::mesh::test {

namespace {

/// A side of a box as its own grid of cells, facing away from the middle.
Soup side_of_box(std::uint32_t side, std::uint32_t cells, double half)
{
    const std::uint32_t axis = side / 2;
    Soup part;
    for (std::uint32_t j = 0; j <= cells; ++j) {
        for (std::uint32_t i = 0; i <= cells; ++i) {
            Vec3 v{};
            v[axis] = side % 2 ? half : -half;
            v[(axis + 1) % 3] = -half + 2 * half * i / cells;
            v[(axis + 2) % 3] = -half + 2 * half * j / cells;
            part.vertices.push_back(v);
        }
    }
    for (std::uint32_t j = 0; j < cells; ++j) {
        for (std::uint32_t i = 0; i < cells; ++i) {
            const std::uint32_t a = j * (cells + 1) + i, c = a + cells + 1;
            part.faces.push_back({a, a + 1, c + 1});
            part.faces.push_back({a, c + 1, c});
        }
    }
    for (std::size_t f = 0; side % 2 == 0 && f < part.faces.size(); ++f)
        turn(part, f);
    return part;
}

/// Sides of uneven cells: T-junctions along all twelve edges; vertices off by up to that much.
Soup uneven_box(double off)
{
    Soup soup;
    for (std::uint32_t side = 0; side < 6; ++side)
        append(soup, side_of_box(side, 2 + side, 50));
    Noise noise(5);
    for (Vec3& v : soup.vertices)
        v = add(v, noise.vector(off));
    return soup;
}

/// A Klein bottle as the figure eight turned round: one side, no rim, and it meets itself in a circle.
Soup klein(std::uint32_t sides, std::uint32_t round)
{
    Soup soup;
    for (std::uint32_t i = 0; i < sides; ++i) {
        const double t = 2 * std::numbers::pi * i / sides;
        for (std::uint32_t j = 0; j < round; ++j) {
            const double s = 2 * std::numbers::pi * (j + 0.25) / round;
            const double r = 40 + 12 * (std::cos(t / 2) * std::sin(s) - std::sin(t / 2) * std::sin(2 * s));
            soup.vertices.push_back(
                {r * std::cos(t), r * std::sin(t),
                 12 * (std::sin(t / 2) * std::sin(s) + std::cos(t / 2) * std::sin(2 * s))});
        }
    }
    const auto number = [=](std::uint32_t i, std::uint32_t j) {
        // round once t/2 has grown by pi: the section comes back turned by half
        const std::uint32_t at = i == sides ? (round + round / 2 - j % round) % round : j % round;
        return i % sides * round + at;
    };
    // sin s and sin 2 s change sign together where s becomes -s; with the quarter step -(j + 1/4) is no
    // sample of its own, so the last cell reaches over half a step
    for (std::uint32_t i = 0; i < sides; ++i) {
        for (std::uint32_t j = 0; j < round; ++j) {
            soup.faces.push_back({number(i, j), number(i + 1, j), number(i + 1, j + 1)});
            soup.faces.push_back({number(i, j), number(i + 1, j + 1), number(i, j + 1)});
        }
    }
    return soup;
}

/// Fins on a ball: each an edge of three faces.
Soup fins()
{
    Soup soup = globe(40, 12, 8);
    const std::size_t faces = soup.faces.size();
    for (std::size_t f = 3; f < faces; f += 17) {
        const Triple face = soup.faces[f];
        const auto tip = static_cast<std::uint32_t>(soup.vertices.size());
        soup.vertices.push_back(scaled(soup.vertices[face[0]], 1.3));
        soup.faces.push_back({face[0], face[1], tip});
    }
    return soup;
}

/// A box of two rooms: one wall that both need.
Soup two_rooms()
{
    Soup soup;
    for (std::uint32_t side = 0; side < 6; ++side)
        append(soup, side_of_box(side, 4, 50));
    Soup wall = side_of_box(1, 4, 50);
    for (Vec3& v : wall.vertices)
        v[0] = 0;
    append(soup, wall);
    return soup;
}

/// Two sheets through one another, welded where they meet.
Soup crossing()
{
    Soup soup;
    for (std::uint32_t axis : {1U, 2U}) {
        Soup part = sheet(4, 4);
        for (Vec3& v : part.vertices) {
            const Vec3 flat = {v[0] - 20, v[1] - 20, 0};
            v = flat;
            if (axis == 2)
                v = {flat[0], 0, flat[1]};
        }
        append(soup, part);
    }
    return soup;
}

/// Twenty half-planes round one line.
Soup book()
{
    Soup soup;
    soup.vertices = {{0, 0, 0}, {0, 50, 0}};
    for (std::uint32_t i = 0; i < 20; ++i) {
        const double t = 2 * std::numbers::pi * i / 20;
        soup.vertices.push_back({40 * std::cos(t), 25, 40 * std::sin(t)});
        soup.faces.push_back(i % 3 ? Triple{0, 1, i + 2} : Triple{1, 0, i + 2});
    }
    return soup;
}

/// Two half sheets with a crack of that width between them.
Soup cracked(double gap)
{
    Soup left = sheet(4, 8), right = sheet(4, 8);
    for (Vec3& v : right.vertices)
        v = add(v, {40 + gap, 0, gap});
    append(left, right);
    return left;
}

} // namespace

std::vector<Sample> junction_samples()
{
    const auto watertight = [](const Report& report) {
        EXPECT_TRUE(report.watertight);
        EXPECT_GT(report.t_junctions, 0U);
    };
    return {
        {"TJunctions", [] { return uneven_box(0); }, {}, watertight},
        {"TJunctionsThatAreOff", [] { return uneven_box(2e-5); }, {}, watertight},
        {"TJunctionsWelded", [] { return uneven_box(0.05); }, {.weld_mm = 0.3}, watertight},
        {"TJunctionsAndSplit", [] { return uneven_box(0); }, {.split_mm = 20}, watertight},
        {"Crack",
         [] { return cracked(4e-5); },
         {},
         [](const Report& report) {
             EXPECT_EQ(report.vertices_sewn, 9U);
             EXPECT_EQ(report.rims, 1U);
         }},
        {"CrackTooWide",
         [] { return cracked(1e-3); },
         {},
         [](const Report& report) {
             EXPECT_EQ(report.vertices_sewn, 0U);
             EXPECT_EQ(report.rims, 2U);
         }},
        {"MoebiusStrip",
         [] { return moebius(40); },
         {},
         [](const Report& report) { EXPECT_GT(report.unorientable_edges, 0U); }},
        {"KleinBottle",
         [] { return klein(32, 16); },
         {},
         [](const Report& report) {
             EXPECT_GT(report.unorientable_edges, 0U);
             EXPECT_EQ(report.boundary_edges, 0U);
         }},
        {"Fins", fins, {}, [](const Report& report) { EXPECT_GT(report.nonmanifold_edges, 5U); }},
        {"WallBetweenTwoRooms",
         two_rooms,
         {},
         [](const Report& report) {
             EXPECT_EQ(report.nonmanifold_edges, 16U);
             EXPECT_EQ(report.components, 2U);
             EXPECT_EQ(report.boundary_edges, 16U);
         }},
        {"SheetsThatCross",
         crossing,
         {},
         [](const Report& report) {
             EXPECT_EQ(report.nonmanifold_edges, 4U);
             EXPECT_EQ(report.components, 2U);
         }},
        {"Book", book},
        {"OpenSheet", [] { return sheet(8, 6); }},
        {"OpenSheetSplit", [] { return sheet(8, 6); }, {.split_mm = 6}},
    };
}

} // namespace phantom::mesh::test
