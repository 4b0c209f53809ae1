// SPDX-License-Identifier: GPL-2.0-or-later
// VTP, legacy VTK, 3DS and glTF: positions, normals, transforms and units; damaged files are told in one line
// and never end the program.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include <gtest/gtest.h>

#include "folder.hpp"
#include "mesh/prepare.hpp"
#include "mesh/read.hpp"
#include "mesh/vector.hpp"
#include "scene/scene.hpp"
#include "vtk_files.hpp"

namespace phantom::mesh::test {
namespace {

using scene::test::Folder;

/// What a command prints, both streams.
std::string output_of(const std::string& command)
{
    std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
    std::string text;
    std::array<char, 4096> part{};
    for (std::size_t got = 0; (got = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
        text.append(part.data(), got);
    ::pclose(pipe);
    return text;
}

TEST(VtkFormats, FdhctlDoesNotLoadVtk)
{
    const std::string libraries = output_of("ldd '" FDHCTL "'");
    EXPECT_NE(libraries.find("libc.so"), std::string::npos) << libraries;
    EXPECT_EQ(libraries.find("libvtk"), std::string::npos) << "every start would be slower";
}

TEST(VtkFormats, WithoutTheReaderOneSentenceSaysSo)
{
    const Folder folder;
    const std::string copy = (folder.path() / "fdhctl").string(), file = folder.write("a.vtp", "<").string();
    std::filesystem::copy_file(FDHCTL, copy);
    EXPECT_EQ(
        output_of("unset PHANTOM_FDHREAD; '" + copy + "' info '" + file + "'"),
        "fdhctl: " + file + ": needs " + (folder.path() / "fdhread").string() +
            ", which reads this format and is not there: it was built without VTK (make all builds it)\n");
}

#if PHANTOM_VIEW

/// The tests do not lie beside the programs.
const bool reader_is_known = ::setenv("PHANTOM_FDHREAD", FDHREAD, 1) == 0;

Soup read_soup(const std::filesystem::path& file)
{
    EXPECT_TRUE(reader_is_known);
    auto soup = read(file);
    EXPECT_TRUE(soup.ok()) << soup.error().text();
    return soup.ok() ? *std::move(soup) : Soup{};
}

void expect_tetrahedron(const Soup& soup, bool with_normals)
{
    ASSERT_EQ(soup.vertices.size(), 4U);
    EXPECT_TRUE(std::equal(soup.vertices.begin(), soup.vertices.end(), tetrahedron_points.begin()))
        << "coordinates lost bits";
    ASSERT_EQ(soup.faces.size(), 4U);
    EXPECT_TRUE(std::equal(soup.faces.begin(), soup.faces.end(), tetrahedron_faces.begin()));
    ASSERT_EQ(soup.normals.size(), with_normals ? 4U : 0U);
    for (std::size_t i = 0; i < soup.normals.size(); ++i)
        EXPECT_LT(distance(soup.normals[i], tetrahedron_normals[i]), 1e-15);
}

TEST(VtkFormats, VtpAndLegacyKeepDoublesAndNormals)
{
    const Folder folder;
    expect_tetrahedron(read_soup(folder.write("a.vtp", vtp_text(false))), false);
    expect_tetrahedron(read_soup(folder.write("b.VTP", vtp_text(true))), true);
    expect_tetrahedron(read_soup(folder.write("c.vtk", vtk_text(false))), false);
    expect_tetrahedron(read_soup(folder.write("d.vtk", vtk_text(true))), true);
    expect_tetrahedron(read_soup(folder.write("e.vtk", vtk_binary())), false);
}

TEST(VtkFormats, StripsAndGridsBecomeTheirSurface)
{
    const Folder folder;
    const auto strip = prepare(read_soup(folder.write("a.vtk", vtk_strip())), {}, "strip");
    ASSERT_TRUE(strip.ok());
    EXPECT_EQ(strip->mesh.faces.size(), 4U);
    EXPECT_TRUE(strip->report.watertight);
    EXPECT_EQ(strip->report.faces_flipped, 0U);
    const auto grid = prepare(read_soup(folder.write("b.vtk", vtk_grid())), {}, "grid");
    ASSERT_TRUE(grid.ok());
    EXPECT_EQ(grid->mesh.faces.size(), 12U);
    EXPECT_TRUE(grid->report.watertight);
}

TEST(VtkFormats, GltfHasItsTransformsApplied)
{
    const Folder folder;
    folder.write("part.bin", gltf_bytes());
    for (const auto& file : {folder.write("a.gltf", gltf_text("part.bin")), folder.write("b.glb", glb())}) {
        const Soup soup = read_soup(file);
        ASSERT_EQ(soup.vertices.size(), 4U);
        ASSERT_EQ(soup.normals.size(), 4U);
        EXPECT_EQ(soup.faces.size(), 4U);
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_LT(distance(soup.vertices[i], in_gltf_scene(tetrahedron_points[i])), 1e-6);
            EXPECT_LT(distance(soup.normals[i], direction_in_gltf_scene(tetrahedron_normals[i])), 1e-6);
        }
    }
}

TEST(VtkFormats, GltfIsInMetresUnlessToldOtherwise)
{
    const Folder folder;
    const auto file = folder.write("a.glb", glb());
    const auto size_of = [](const std::filesystem::path& path, const scene::LoadOptions& options) {
        const auto loaded = scene::load(path, options);
        EXPECT_TRUE(loaded.ok()) << loaded.error().text();
        return loaded.ok() ? loaded->bounds().extent() : 0.0;
    };
    EXPECT_NEAR(size_of(file, {}), 2000 * third, 0.01);
    scene::LoadOptions inches;
    inches.unit = "in";
    EXPECT_NEAR(size_of(file, inches), 2 * 25.4 * third, 0.001);
    const auto scene_of = [&](const std::string& top, const std::string& object) {
        return folder.write("a.toml", top + "[[object]]\nmesh = \"a.glb\"\n" + object);
    };
    EXPECT_NEAR(size_of(scene_of("", ""), {}), 2000 * third, 0.01);
    EXPECT_NEAR(size_of(scene_of("unit = \"cm\"\n", ""), {}), 20 * third, 0.001);
    EXPECT_NEAR(size_of(scene_of("unit = \"cm\"\n", "unit = \"mm\"\n"), {}), 2 * third, 0.001);
}

TEST(VtkFormats, ThreeDs)
{
    const Folder folder;
    const Soup soup = read_soup(folder.write("a.3ds", max_3ds()));
    ASSERT_EQ(soup.vertices.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_LT(distance(soup.vertices[i], tetrahedron_points[i]), 1e-7);
    const auto prepared = prepare(soup, {}, "3ds");
    ASSERT_TRUE(prepared.ok());
    EXPECT_EQ(prepared->mesh.faces.size(), 4U);
    EXPECT_TRUE(prepared->report.watertight);
    EXPECT_EQ(prepared->report.components_turned, 0U);
}

/// The error of a file with these bytes, without the folder; empty when it was read.
std::string error_of(const std::string& name, const std::string& bytes)
{
    static const Folder folder;
    const auto soup = read(folder.write(name, bytes));
    if (soup.ok())
        return "";
    std::string text = soup.error().text();
    EXPECT_EQ(text.find(folder.path().string()), 0U) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    return text.substr(std::min(text.size(), folder.path().string().size() + 1));
}

TEST(VtkFormats, WhatIsNoSuchFileIsTold)
{
    EXPECT_EQ(error_of("a.vtp", ""), "a.vtp: is empty");
    EXPECT_EQ(read("/nonexistent/a.glb").error().text(), "/nonexistent/a.glb: no such file");
    for (const char* name : {"a.vtp", "a.vtk", "a.3ds", "a.gltf", "a.glb"})
        EXPECT_NE(error_of(name, "what is this, then?\n"), "") << name;
    EXPECT_EQ(error_of("a.vtk", "# vtk DataFile Version 3.0\nno mesh\nASCII\nDATASET STRUCTURED_POINTS\n"
                                "DIMENSIONS 2 2 2\nORIGIN 0 0 0\nSPACING 1 1 1\n"),
              "a.vtk: holds no mesh, expected a legacy VTK file with DATASET POLYDATA or UNSTRUCTURED_GRID");
    std::string outside = vtk_text(false);
    outside.replace(outside.find("3 1 2 3"), 7, "3 1 2 9");
    EXPECT_EQ(error_of("a.vtk", outside),
              "a.vtk: is damaged: its polygons name points that it does not have");
    std::string not_finite = vtk_text(false);
    not_finite.replace(not_finite.find("0 0 0"), 5, "0 nan 0");
    EXPECT_NE(error_of("a.vtk", not_finite), "");
}

TEST(VtkFormats, TruncatedAndDamagedFilesNeverEndTheProgram)
{
    const std::array<std::pair<const char*, std::string>, 5> files{{{"a.vtp", vtp_text(true)},
                                                                    {"a.vtk", vtk_binary()},
                                                                    {"a.glb", glb()},
                                                                    {"a.gltf", gltf_text("none.bin")},
                                                                    {"a.3ds", max_3ds()}}};
    std::mt19937 random(5);
    for (const auto& [name, whole] : files) {
        for (int i = 1; i < 8; ++i)
            EXPECT_NE(error_of(name, whole.substr(0, whole.size() * static_cast<std::size_t>(i) / 8)), "")
                << name << " cut to " << i << "/8";
        for (int i = 0; i < 8; ++i) {
            std::string bad = whole;
            for (int changes = 0; changes <= i % 4; ++changes)
                bad[random() % bad.size()] = static_cast<char>(random());
            (void)error_of(name, bad); // read or told
        }
    }
}

#endif

} // namespace
} // namespace phantom::mesh::test
