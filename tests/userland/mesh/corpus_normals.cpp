// SPDX-License-Identifier: GPL-2.0-or-later
#include <limits>

#include <gtest/gtest.h>

#include "corpus.hpp"

namespace phantom::mesh::test {

namespace {

/// With the sphere's own normals.
Soup smooth_globe()
{
    Soup soup = globe(50, 24, 16);
    for (const Vec3& v : soup.vertices)
        soup.normals.push_back(normalized(v));
    soup.face_normals = soup.faces;
    return soup;
}

/// Every face of a cube with its side's normal at its corners.
Soup creased_cube()
{
    Soup soup = cube(50);
    for (const Triple& f : soup.faces) {
        const auto number = static_cast<std::uint32_t>(soup.normals.size());
        soup.normals.push_back(normalized(cross(subtract(soup.vertices[f[1]], soup.vertices[f[0]]),
                                                subtract(soup.vertices[f[2]], soup.vertices[f[0]]))));
        soup.face_normals.push_back({number, number, number});
    }
    return soup;
}

Soup with_normals(const std::function<Vec3(std::size_t, const Vec3&)>& change)
{
    Soup soup = smooth_globe();
    for (std::size_t i = 0; i < soup.normals.size(); ++i)
        soup.normals[i] = change(i, soup.normals[i]);
    return soup;
}

} // namespace

std::vector<Sample> normal_samples()
{
    const auto repaired = [](std::uint64_t most) {
        return [most](const Report& report) {
            EXPECT_TRUE(report.watertight);
            EXPECT_LE(report.normals_repaired, most);
            EXPECT_EQ(report.normals_repaired > 0, most > 0);
        };
    };
    const std::uint64_t all = 3 * globe(50, 24, 16).faces.size();
    return {
        {"NormalsOfTheFormula", smooth_globe, {}, repaired(0)},
        {"NormalsSplitAtCreases", creased_cube, {}, repaired(0)},
        {"NormalsSplitWithoutCreaseAngle", creased_cube, {.crease_deg = 180}, repaired(0)},
        {"ZeroNormals",
         [] { return with_normals([](std::size_t, const Vec3&) {
                  return Vec3{0, 0, 0};
              }); },
         {},
         repaired(all)},
        {"SomeNormalsZero",
         [] { return with_normals([](std::size_t i, const Vec3& n) {
                  return i % 5 ? n : Vec3{0, 0, 0};
              }); },
         {},
         repaired(all / 4)},
        {"NormalsNotANumber",
         [] {
             const double nan = std::numeric_limits<double>::quiet_NaN();
             return with_normals([nan](std::size_t i, const Vec3& n) { return i % 7 ? n : Vec3{nan, 0, 1}; });
         },
         {},
         repaired(all / 5)},
        {"InvertedNormals",
         [] { return with_normals([](std::size_t, const Vec3& n) { return scaled(n, -1); }); },
         {},
         repaired(all)},
        {"InvertedSolidWithItsNormals",
         [] {
             Soup soup = with_normals([](std::size_t, const Vec3& n) { return scaled(n, -1); });
             for (std::size_t f = 0; f < soup.faces.size(); ++f) {
                 turn(soup, f);
                 std::swap(soup.face_normals[f][1], soup.face_normals[f][2]);
             }
             return soup;
         },
         {},
         repaired(all)},
        {"NormalsAcrossTheSurface",
         [] {
             return with_normals([](std::size_t, const Vec3& n) { return normalized({-n[1], n[0], 0.1}); });
         }},
        {"NormalsAndSplit", smooth_globe, {.split_mm = 6}, repaired(0)},
        {"NormalsAndNoFaceInPlace",
         [] {
             Soup soup = smooth_globe();
             soup.faces.push_back({3, 3, 4});
             soup.face_normals.push_back({1, 2, 3});
             soup.faces.insert(soup.faces.begin(), soup.faces[9]);
             soup.face_normals.insert(soup.face_normals.begin(), soup.face_normals[9]);
             return soup;
         }},
    };
}

} // namespace phantom::mesh::test
