// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "corpus.hpp"

namespace phantom::mesh::test {

namespace {

Soup moved(Soup soup, const Vec3& by)
{
    for (Vec3& v : soup.vertices)
        v = add(v, by);
    return soup;
}

Soup sized(Soup soup, double factor)
{
    for (Vec3& v : soup.vertices)
        v = scaled(v, factor);
    return soup;
}

Soup inside_out(Soup soup)
{
    for (std::size_t f = 0; f < soup.faces.size(); ++f)
        turn(soup, f);
    return soup;
}

Soup together(std::initializer_list<Soup> parts)
{
    Soup all;
    for (const Soup& part : parts)
        append(all, part);
    return all;
}

/// A tube bent round, closed.
Soup ring(double radius, double thickness, std::uint32_t sides, std::uint32_t round)
{
    Soup soup;
    for (std::uint32_t i = 0; i < sides; ++i) {
        const double t = 2 * std::numbers::pi * i / sides;
        for (std::uint32_t j = 0; j < round; ++j) {
            const double s = 2 * std::numbers::pi * j / round, r = radius + thickness * std::cos(s);
            soup.vertices.push_back({r * std::cos(t), r * std::sin(t), thickness * std::sin(s)});
        }
    }
    const auto number = [=](std::uint32_t i, std::uint32_t j) { return i % sides * round + j % round; };
    for (std::uint32_t i = 0; i < sides; ++i) {
        for (std::uint32_t j = 0; j < round; ++j) {
            soup.faces.push_back({number(i, j), number(i + 1, j), number(i + 1, j + 1)});
            soup.faces.push_back({number(i, j), number(i + 1, j + 1), number(i, j + 1)});
        }
    }
    return soup;
}

void expect_closed(const Report& report, std::uint64_t components)
{
    EXPECT_TRUE(report.watertight);
    EXPECT_EQ(report.components, components);
    EXPECT_EQ(report.rims, 0U);
}

} // namespace

std::vector<Sample> solid_samples()
{
    const auto closed = [](std::uint64_t components) {
        return [components](const Report& report) { expect_closed(report, components); };
    };
    const auto turned = [](std::uint64_t components, std::uint64_t count, std::uint64_t cavities) {
        return [=](const Report& report) {
            expect_closed(report, components);
            EXPECT_EQ(report.components_turned, count);
            EXPECT_EQ(report.cavities, cavities);
        };
    };
    return {
        {"Globe", [] { return globe(50, 24, 16); }, {}, closed(1)},
        {"Ring", [] { return ring(40, 12, 30, 14); }, {}, closed(1)},
        {"SolidInsideOut", [] { return inside_out(globe(50, 16, 9)); }, {}, turned(1, 1, 0)},
        {"OneOfTwoInsideOut",
         [] {
             return together({cube(10), inside_out(cube(10, {50, 0, 0}))});
         },
         {},
         turned(2, 1, 0)},
        {"Cavity",
         [] {
             return together({globe(50, 20, 12), globe(30, 14, 9)});
         },
         {},
         turned(2, 1, 1)},
        {"CavityThatPointsRight",
         [] {
             return together({globe(50, 20, 12), inside_out(globe(30, 14, 9))});
         },
         {},
         turned(2, 0, 1)},
        {"NestedCavities",
         [] {
             return together({cube(10), cube(50), cube(30), cube(20), cube(40)});
         },
         {},
         turned(5, 2, 2)},
        {"SolidInTheHoleOfARing",
         [] {
             return together({ring(40, 12, 24, 10), cube(10)});
         },
         {},
         turned(2, 0, 0)},
        {"CubesThatShareAnEdge",
         [] {
             return together({cube(10), inside_out(cube(10, {20, 20, 0}))});
         },
         {},
         turned(2, 1, 0)},
        {"CubesThatShareASide",
         [] {
             return together({cube(10), cube(10, {20, 0, 0})});
         },
         {},
         closed(2)},
        {"CubesThatShareAVertex",
         [] {
             return together({cube(10), cube(10, {20, 20, 20})});
         },
         {},
         closed(2)},
        {"BowTie",
         [] {
             return together({globe(20, 8, 2), moved(globe(20, 8, 2), {0, 0, 40})});
         },
         {},
         [](const Report& report) {
             expect_closed(report, 2);
             EXPECT_EQ(report.nonmanifold_vertices, 1U);
         }},
        {"SelfIntersection",
         [] {
             return together({globe(30, 16, 9), moved(globe(30, 16, 9), {25, 7, 3})});
         },
         {},
         turned(2, 0, 0)},
        {"FiveMillionMetresAway",
         [] {
             return moved(ring(40, 12, 24, 10), {5e9, -5e9, 5e9});
         },
         {},
         closed(1)},
        {"FiveMillionMillimetresAway",
         [] {
             return moved(globe(50, 24, 16), {5e6, 5e6, 5e6});
         },
         {},
         closed(1)},
        {"TenMicrometres", [] { return sized(globe(50, 24, 16), 1e-4); }, {}, closed(1)},
        {"SplitToSmallEdges", [] { return cube(50); }, {.split_mm = 9}, closed(1)},
        {"SplitOfTouchingSolids",
         [] {
             return together({cube(10), cube(10, {20, 20, 0})});
         },
         {.split_mm = 3},
         closed(2)},
        {"FittedToASize",
         [] {
             return moved(globe(3, 12, 8), {70, 0, 0});
         },
         {.fit_mm = 120},
         closed(1)},
    };
}

} // namespace phantom::mesh::test
