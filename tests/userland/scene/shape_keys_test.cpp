// SPDX-License-Identifier: GPL-2.0-or-later
// The keys of shapes in scene files: sound ones load, every bad value is one line with its place and what was
// expected.
#include <gtest/gtest.h>

#include "folder.hpp"
#include "scene/scene.hpp"

namespace phantom::scene::test {
namespace {

const Folder& folder()
{
    static const Folder made;
    return made;
}

/// The error of loading an object of these lines (from line 2 on), without the folder's name.
std::string error_of(const std::string& lines)
{
    const auto scene = load(folder().write("a.toml", "[[object]]\n" + lines), {});
    if (scene.ok())
        return "";
    std::string error = scene.error().text();
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    const std::string prefix = folder().path().string() + "/";
    for (std::size_t at = error.find(prefix); at != std::string::npos; at = error.find(prefix))
        error.erase(at, prefix.size());
    return error;
}

const char* const net = "points_mm = [[[0,0,0],[0,9,1]],[[9,0,1],[9,9,0]]]\n";

std::string shape(const std::string& word, const std::string& lines)
{
    folder().write("hills.pgm", "P2 3 3 9\n0 1 2 3 9 5 6 7 8\n");
    folder().write("patch.toml", std::string("degree = [1, 1]\n") + net);
    return error_of("shape = \"" + word + "\"\n" + lines);
}

TEST(SceneShapeKeys, EveryShapeLoads)
{
    EXPECT_EQ(shape("sphere", "radius_mm = 20\nchord_mm = 0.1\n"), "");
    EXPECT_EQ(shape("ellipsoid", "size_mm = [20, 30, 40]\n"), "");
    EXPECT_EQ(shape("torus", "radius_mm = 20\ntube_radius_mm = 5\n"), "");
    EXPECT_EQ(shape("box", "size_mm = [20, 30, 40]\n"), "");
    EXPECT_EQ(shape("cylinder", "radius_mm = 20\nheight_mm = 5\n"), "");
    EXPECT_EQ(shape("cone", "radius_mm = 20\nheight_mm = 5\n"), "");
    EXPECT_EQ(shape("cone", "radius_mm = 20\ntop_radius_mm = 4\nheight_mm = 5\n"), "");
    EXPECT_EQ(shape("superquadric", "size_mm = [20, 30, 40]\nexponents = [0.5, 1.5]\n"), "");
    EXPECT_EQ(shape("height_field", "image = \"hills.pgm\"\nsize_mm = [20, 30]\nheight_mm = 4\n"), "");
    EXPECT_EQ(shape("height_field",
                    "image = \"hills.pgm\"\nsize_mm = [20, 30]\nheight_mm = 4\nclosed = false\n"
                    "two_sided = true\n"),
              "");
    EXPECT_EQ(shape("nurbs", std::string("degree = [1, 1]\n") + net), "");
    EXPECT_EQ(shape("nurbs", std::string("degree = [1, 1]\nweights = [[1, 2], [1, 1]]\n"
                                         "knots_u = [0, 0, 1, 1]\nknots_v = [0, 0, 2, 2]\n") +
                                 net),
              "");
    EXPECT_EQ(shape("nurbs", "file = \"patch.toml\"\nchord_mm = 0.1\ntwo_sided = true\n"), "");
}

TEST(SceneShapeKeys, WhatAShapeNeeds)
{
    EXPECT_EQ(shape("sphere", ""), "a.toml:2: object 1: shape: a sphere needs radius_mm");
    EXPECT_EQ(shape("ellipsoid", ""), "a.toml:2: object 1: shape: an ellipsoid needs size_mm = [x, y, z]");
    EXPECT_EQ(shape("torus", "radius_mm = 3\n"), "a.toml:2: object 1: shape: a torus needs tube_radius_mm");
    EXPECT_EQ(shape("cylinder", "radius_mm = 3\n"), "a.toml:2: object 1: shape: a cylinder needs height_mm");
    EXPECT_EQ(shape("superquadric", "size_mm = [1, 2, 3]\n"),
              "a.toml:2: object 1: shape: a superquadric needs exponents = [north_south, east_west]");
    EXPECT_EQ(shape("height_field", "size_mm = [1, 2]\nheight_mm = 3\n"),
              "a.toml:2: object 1: shape: a height_field needs image = \"FILE\"");
    EXPECT_EQ(shape("nurbs", "degree = [1, 1]\n"), "a.toml:1: object 1: points_mm: is missing");
}

TEST(SceneShapeKeys, ValuesOutOfRange)
{
    constexpr const char* length = ", expected 0.000001 ... 1000000 mm";
    EXPECT_EQ(shape("sphere", "radius_mm = -1\n"),
              std::string("a.toml:3: object 1: radius_mm: is -1") + length);
    EXPECT_EQ(shape("sphere", "radius_mm = nan\n"),
              std::string("a.toml:3: object 1: radius_mm: is nan") + length);
    EXPECT_EQ(shape("sphere", "radius_mm = 1\nchord_mm = 0\n"),
              "a.toml:4: object 1: chord_mm: is 0, expected 0.000001 ... 10000 mm");
    EXPECT_EQ(shape("ellipsoid", "size_mm = [1, 0, 1]\n"),
              std::string("a.toml:3: object 1: size_mm: number 2 is 0") + length);
    EXPECT_EQ(shape("torus", "radius_mm = 3\ntube_radius_mm = 3\n"),
              "a.toml:4: object 1: tube_radius_mm: is 3, expected less than radius_mm = 3");
    EXPECT_EQ(shape("cone", "radius_mm = 3\nheight_mm = inf\n"),
              std::string("a.toml:4: object 1: height_mm: is inf") + length);
    EXPECT_EQ(shape("cone", "radius_mm = 3\nheight_mm = 1\ntop_radius_mm = -2\n"),
              "a.toml:5: object 1: top_radius_mm: is -2, expected 0 ... 1000000 mm");
    EXPECT_EQ(shape("superquadric", "size_mm = [1, 1, 1]\nexponents = [1, 2.5]\n"),
              "a.toml:4: object 1: exponents: number 2 is 2.5, expected 0.1 ... 1.9");
    EXPECT_EQ(shape("superquadric", "size_mm = [1, 1, 1]\nexponents = [1]\n"),
              "a.toml:4: object 1: exponents: is an array of 1, expected [2 numbers]");
    EXPECT_EQ(shape("sphere", "radius_mm = 1000\nchord_mm = 0.000001\n"),
              "a.toml:4: sphere: chord_mm: of 1e-06 mm takes 5.8e+09 triangles, expected at most 10000000: a "
              "larger one");
}

TEST(SceneShapeKeys, KeysOfAnotherShape)
{
    EXPECT_EQ(shape("box", "size_mm = [1, 2, 3]\nchord_mm = 3\n"),
              "a.toml:4: object 1: chord_mm: has no meaning with shape = \"box\"");
    EXPECT_EQ(shape("torus", "radius_mm = 4\ntube_radius_mm = 1\nheight_mm = 3\n"),
              "a.toml:5: object 1: height_mm: has no meaning with shape = \"torus\"");
    EXPECT_EQ(shape("cylinder", "radius_mm = 4\nheight_mm = 3\ntop_radius_mm = 1\n"),
              "a.toml:5: object 1: top_radius_mm: has no meaning with shape = \"cylinder\"");
    EXPECT_EQ(shape("cone", "radius_mm = 4\nheight_mm = 3\ntwo_sided = true\n"),
              "a.toml:5: object 1: two_sided: has no meaning with shape: it is closed");
    EXPECT_EQ(shape("height_field",
                    "image = \"hills.pgm\"\nsize_mm = [1, 2]\nheight_mm = 3\nclosed = false\nbase_mm = 2\n"),
              "a.toml:7: object 1: base_mm: has no meaning with closed = false");
}

TEST(SceneShapeKeys, Images)
{
    folder().write("bad.png", "not at all");
    const std::string sizes = "size_mm = [1, 2]\nheight_mm = 3\n";
    EXPECT_EQ(shape("height_field", "image = \"gone.png\"\n" + sizes),
              "a.toml:3: object 1: image: no such file: gone.png");
    EXPECT_EQ(shape("height_field", "image = \"bad.png\"\n" + sizes),
              "a.toml:3: height_field: image: bad.png: is neither a PNG nor a PGM file (P2, P5)");
    EXPECT_EQ(shape("height_field", "image = 3\n" + sizes),
              "a.toml:3: object 1: image: is 3, expected a text in quotes");
}

TEST(SceneShapeKeys, Patches)
{
    const auto patch = [](const std::string& lines) { return shape("nurbs", lines); };
    const std::string points = net, degree = "degree = [1, 1]\n";
    EXPECT_EQ(patch(points + "degree = [1, 10]\n"),
              "a.toml:4: object 1: degree: number 2 is 10, expected a whole number, 1 ... 9");
    EXPECT_EQ(patch(points + "degree = [1.5, 1]\n"),
              "a.toml:4: object 1: degree: is [1.5, 1], expected whole numbers, 1 ... 9");
    EXPECT_EQ(patch(points + "degree = [1, 2]\n"),
              "a.toml:3: object 1: points_mm: has 2 rows of 2, expected at least 2 of 3: the degree + 1");
    EXPECT_EQ(patch(degree + "points_mm = [[[0,0,0],[0,9,1]],[[9,0,1]]]\n"),
              "a.toml:4: object 1: points_mm: row 2 is an array of 1, expected 2 points like row 1");
    EXPECT_EQ(patch(degree + "points_mm = [[[0,0,0],[0,9]],[[9,0,1],[1,1,1]]]\n"),
              "a.toml:4: object 1: points_mm: row 1, point 2 is an array of 2, expected [3 numbers]");
    EXPECT_EQ(patch(degree + "points_mm = [[[0,0,0],[0,9,nan]],[[9,0,1],[1,1,1]]]\n"),
              "a.toml:4: object 1: points_mm: row 1, point 2 has nan, expected -1000000 ... 1000000 mm");
    EXPECT_EQ(patch(degree + points + "weights = [[1, 1], [1, 0]]\n"),
              "a.toml:5: object 1: weights: row 2 has 0, expected 0.000001 ... 1000000");
    EXPECT_EQ(patch(degree + points + "weights = [[1, 1]]\n"),
              "a.toml:5: object 1: weights: has 1 rows of 2, expected 2 of 2 as points_mm");
    EXPECT_EQ(patch(degree + points + "knots_u = [0, 0, 1]\n"),
              "a.toml:5: object 1: knots_u: has 3 numbers, expected 4: 2 control points and degree 1 + 1");
    EXPECT_EQ(patch(degree + points + "knots_v = [0, 0, 1, 0.5]\n"),
              "a.toml:5: object 1: knots_v: number 4 is 0.5 after 1, expected ascending numbers");
    EXPECT_EQ(patch(degree + points + "knots_v = [0, 1, 1, 2]\n"),
              "a.toml:5: object 1: knots_v: numbers 2 and 3 are equal, expected a range between them");
    EXPECT_EQ(
        patch("degree = [1, 1]\npoints_mm = [[[0,0,0],[0,1,0],[0,2,0],[0,3,0]],[[9,0,1],[9,1,0],[9,2,0],"
              "[9,3,0]]]\nknots_v = [0, 0, 1, 1, 2, 2]\n"),
        "a.toml:5: object 1: knots_v: has 1 more than 1 times, expected at most the degree between the ends");
    EXPECT_EQ(patch("degree = [1, 1]\npoints_mm = [[[1,1,1],[1,1,1]],[[1,1,1],[1,1,1]]]\n"),
              "a.toml:4: nurbs: points_mm: lie all in one place: the patch has no area");
    folder().write("bad.toml", std::string("degree = [1, 1]\npoints = 3\n") + net);
    EXPECT_EQ(
        patch("file = \"bad.toml\"\n"),
        "a.toml:3: object 1: file: bad.toml:2: points: unknown key, expected degree, points_mm, weights, "
        "knots_u, knots_v");
    EXPECT_EQ(patch("file = \"gone.toml\"\n"), "a.toml:3: object 1: file: no such file: gone.toml");
    EXPECT_EQ(patch("file = \"patch.toml\"\n" + degree),
              "a.toml:4: object 1: degree: stands beside file, expected one of the two");
}

} // namespace
} // namespace phantom::scene::test
