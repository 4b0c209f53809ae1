// SPDX-License-Identifier: GPL-2.0-or-later
#include <limits>

#include <gtest/gtest.h>

#include "corpus.hpp"

namespace phantom::mesh::test {

namespace {

Soup with_holes()
{
    Soup soup = globe(50, 24, 16);
    std::size_t number = 0;
    std::erase_if(soup.faces, [&number](const Triple&) { return number++ % 37 == 5; });
    return soup;
}

Soup with_flips()
{
    Soup soup = globe(50, 24, 16);
    Noise noise(1);
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        if (noise.one_in(3))
            turn(soup, f);
    }
    return soup;
}

Soup with_duplicates()
{
    Soup soup = globe(50, 12, 8);
    for (std::size_t f = 0; f < 30; f += 3) {
        const Triple face = soup.faces[f];
        soup.faces.insert(soup.faces.begin() + static_cast<std::ptrdiff_t>(2 * f),
                          {face[1], face[2], face[0]});
    }
    return soup;
}

/// Faces with points of their own, off by up to that much.
Soup shaken(const Soup& soup, double size)
{
    Soup out = unwelded(soup);
    Noise noise(2);
    for (Vec3& v : out.vertices)
        v = add(v, noise.vector(size));
    return out;
}

/// Needles (one short edge) and caps (a height of nearly nothing) in a sheet.
Soup with_slivers(double thin)
{
    Soup soup;
    for (std::uint32_t i = 0; i <= 20; ++i) {
        soup.vertices.push_back({5.0 * (i / 2) + (i % 2 ? thin : 0), 0, 0});
        soup.vertices.push_back({5.0 * (i / 2) + (i % 2 ? thin : 0), 40, 0});
    }
    for (std::uint32_t i = 0; i < 20; ++i) {
        soup.faces.push_back({2 * i, 2 * i + 2, 2 * i + 3});
        soup.faces.push_back({2 * i, 2 * i + 3, 2 * i + 1});
    }
    const auto base = static_cast<std::uint32_t>(soup.vertices.size());
    soup.vertices.push_back({25, -thin, 0});
    soup.faces.push_back({0, base, 40}); // a cap along the lower side
    return soup;
}

Soup with_zero_area()
{
    Soup soup = cube(50);
    soup.faces.push_back({0, 0, 1});
    soup.faces.push_back({2, 2, 2});
    const auto base = static_cast<std::uint32_t>(soup.vertices.size());
    soup.vertices.insert(soup.vertices.end(), {{-20, -20, 50}, {0, 0, 50}, {20, 20, 50}});
    soup.faces.insert(soup.faces.begin() + 4, {base, base + 1, base + 2});
    return soup;
}

Soup with_bad_numbers(double bad)
{
    Soup soup = globe(50, 16, 10);
    soup.vertices[20][1] = bad;
    soup.vertices[77][2] = -bad;
    soup.vertices.push_back({bad, bad, bad}); // no face's
    return soup;
}

Soup one_face()
{
    Soup soup;
    soup.vertices = {{0, 0, 0}, {30, 0, 0}, {0, 30, 0}};
    soup.faces = {{0, 1, 2}};
    return soup;
}

/// Triangles of all kinds and sizes that have nothing to do with each other.
Soup confetti()
{
    Soup soup;
    Noise noise(3);
    for (std::uint32_t i = 0; i < 150; ++i) {
        const Vec3 at = noise.vector(50);
        const double size = i % 3 == 0 ? 1e-3 : i % 3 == 1 ? 1 : 40;
        for (int k = 0; k < 3; ++k)
            soup.vertices.push_back(add(at, noise.vector(size)));
        soup.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return soup;
}

/// Any three of a few points, over and over: every edge has many faces.
Soup tangle()
{
    Soup soup;
    Noise noise(4);
    for (int i = 0; i < 12; ++i)
        soup.vertices.push_back(noise.vector(50));
    for (std::uint32_t i = 0; i < 160; ++i)
        soup.faces.push_back({(i * 7) % 12, (i * 5 + 1) % 12, (i * i + 3) % 12});
    return soup;
}

} // namespace

std::vector<Sample> defect_samples()
{
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 infinite = std::numeric_limits<double>::infinity();
    return {
        {"Holes", with_holes, {}, [](const Report& report) { EXPECT_EQ(report.rims, 20U); }},
        {"Flips",
         with_flips,
         {},
         [](const Report& report) {
             EXPECT_GT(report.faces_flipped, 200U);
             EXPECT_TRUE(report.watertight);
         }},
        {"Duplicates",
         with_duplicates,
         {},
         [](const Report& report) {
             EXPECT_EQ(report.faces_duplicate, 10U);
             EXPECT_TRUE(report.watertight);
         }},
        {"UnweldedSoup",
         [] { return unwelded(globe(50, 24, 16)); },
         {},
         [](const Report& report) { EXPECT_TRUE(report.watertight); }},
        {"UnweldedAndShaken",
         [] { return shaken(globe(50, 16, 10), 1e-5); },
         {},
         [](const Report& report) {
             EXPECT_TRUE(report.watertight);
             EXPECT_GT(report.vertices_sewn, 0U);
         }},
        {"WeldedByDistance",
         [] { return shaken(globe(50, 16, 10), 0.05); },
         {.weld_mm = 0.2},
         [](const Report& report) { EXPECT_TRUE(report.watertight); }},
        {"Slivers", [] { return with_slivers(1e-5); }},
        {"SliversOfRounding",
         [] { return with_slivers(1e-12); },
         {},
         [](const Report& report) { EXPECT_EQ(report.faces_zero_area, 21U); }},
        {"FacesWithoutArea",
         with_zero_area,
         {},
         [](const Report& report) {
             EXPECT_EQ(report.faces_zero_area, 3U);
             EXPECT_TRUE(report.watertight);
         }},
        {"NotANumber",
         [nan] { return with_bad_numbers(nan); },
         {},
         [](const Report& report) { EXPECT_EQ(report.faces_nonfinite, 12U); }},
        {"Infinite", [infinite] { return with_bad_numbers(infinite); }, {.fit_mm = 100}},
        {"OneFace", one_face},
        {"FacesBackToBack",
         [] {
             Soup soup = one_face();
             soup.faces.push_back({0, 2, 1});
             return soup;
         }},
        {"Confetti", confetti},
        {"Tangle", tangle},
        {"TangleWelded", tangle, {.weld_mm = 20, .crease_deg = 180}},
        {"EverythingFlippedAtRandom",
         [] {
             Soup soup = confetti();
             append(soup, with_flips());
             append(soup, with_holes());
             append(soup, tangle());
             return soup;
         }},
    };
}

} // namespace phantom::mesh::test
