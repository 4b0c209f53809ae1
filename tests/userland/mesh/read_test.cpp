// SPDX-License-Identifier: GPL-2.0-or-later
// Reading: the same cube and sphere through every format, exact to the last bit.
#include <limits>

#include <gtest/gtest.h>

#include "mesh/read.hpp"
#include "meshes.hpp"

namespace phantom::mesh::test {
namespace {

/// Corner positions face by face: the same whatever the numbering of vertices.
std::vector<Vec3> corners(const Soup& soup)
{
    std::vector<Vec3> out;
    for (const Triple& face : soup.faces) {
        for (const std::uint32_t v : face)
            out.push_back(soup.vertices[v]);
    }
    return out;
}

/// Coordinates that float cannot hold, so that a detour through float would show.
Soup fine_globe()
{
    Soup soup = globe(50, 12, 8);
    for (Vec3& v : soup.vertices)
        v = add(v, {5000000.0001, 0.1, -1.0 / 3});
    return soup;
}

Soup read_back(const std::string& name, const std::string& bytes)
{
    const Folder folder;
    auto soup = read(folder.write(name, bytes));
    EXPECT_TRUE(soup.ok()) << soup.error().text();
    return soup.ok() ? *std::move(soup) : Soup{};
}

TEST(MeshRead, KnowsExtensionsInAnyCase)
{
    EXPECT_TRUE(is_mesh_file("a.ply"));
    EXPECT_TRUE(is_mesh_file("a.PLY"));
    EXPECT_TRUE(is_mesh_file("dir/a.Obj"));
    EXPECT_TRUE(is_mesh_file("a.stl"));
    EXPECT_TRUE(is_mesh_file("a.off"));
    EXPECT_FALSE(is_mesh_file("a.toml"));
    EXPECT_FALSE(is_mesh_file("ply"));
}

TEST(MeshRead, PlyInEveryEncodingKeepsEveryBit)
{
    const Soup given = fine_globe();
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
        const Soup got = read_back("a.ply", ply_of(given, format));
        EXPECT_EQ(got.vertices, given.vertices) << format;
        EXPECT_EQ(got.faces, given.faces) << format;
        EXPECT_TRUE(got.normals.empty()) << format;
    }
}

TEST(MeshRead, ObjOffAndStlTextKeepEveryBit)
{
    const Soup given = fine_globe();
    EXPECT_EQ(corners(read_back("a.obj", obj_of(given))), corners(given));
    EXPECT_EQ(corners(read_back("a.off", off_of(given))), corners(given));
    EXPECT_EQ(corners(read_back("a.stl", stl_text_of(given))), corners(given));
}

TEST(MeshRead, BinaryStlIsFoundOutDespiteAHeaderThatSaysSolid)
{
    const Soup given = cube();
    EXPECT_EQ(corners(read_back("a.stl", stl_binary_of(given))), corners(given));
}

TEST(MeshRead, PlyNormalsAreKeptAtUnitLength)
{
    Soup given = globe(50, 12, 8);
    given.normals = given.vertices; // 50 long in the file
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
        const Soup got = read_back("a.ply", ply_of(given, format, true));
        ASSERT_EQ(got.normals.size(), given.vertices.size()) << format;
        EXPECT_EQ(got.face_normals, got.faces) << format;
        for (std::size_t v = 0; v < got.normals.size(); ++v)
            EXPECT_LT(distance(got.normals[v], normalized(given.vertices[v])), 1e-7) << format;
    }
}

TEST(MeshRead, PlyOtherPropertiesAndElementsAreStepppedOver)
{
    const std::string bytes =
        "ply\r\nformat ascii 1.0\r\nobj_info none\r\nelement material 1\r\n"
        "property list uchar float shine\r\nelement vertex 3\r\nproperty float x\r\n"
        "property uchar red\r\nproperty float y\r\nproperty float z\r\nelement face 1\r\n"
        "property int flags\r\nproperty list uint uint vertex_index\r\nend_header\r\n"
        "2 0.5 0.25\r\n0 255 0 0\r\n1 255 0 0\r\n0 255 1 0\r\n7 3 0 1 2\r\n";
    const Soup got = read_back("a.ply", bytes);
    ASSERT_EQ(got.faces.size(), 1U);
    EXPECT_EQ(got.faces[0], (Triple{0, 1, 2}));
    EXPECT_EQ(got.vertices[1], (Vec3{1, 0, 0}));
}

TEST(MeshRead, ObjNormalsByCorner)
{
    const Soup got = read_back("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvn 0 0 2\nvn 0 1 1\n"
                                        "f 1//1 2//1 3//2\nf 2/1/1 4/1/2 3/1/-1\n");
    ASSERT_EQ(got.face_normals.size(), 2U);
    EXPECT_EQ(got.face_normals[0], (Triple{0, 0, 1}));
    EXPECT_EQ(got.face_normals[1], (Triple{0, 1, 1}));
    EXPECT_EQ(got.normals[0], (Vec3{0, 0, 1}));
    EXPECT_NEAR(got.normals[1][1], std::sqrt(0.5), 1e-15);
}

TEST(MeshRead, ObjCornersWithoutNormalGetOneWithoutDirection)
{
    const Soup got =
        read_back("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\nf 2 4 3\n");
    ASSERT_EQ(got.face_normals.size(), 2U);
    EXPECT_EQ(got.normals[got.face_normals[0][0]], (Vec3{0, 0, 1}));
    EXPECT_EQ(got.normals[got.face_normals[1][0]], (Vec3{0, 0, 0}));
}

TEST(MeshRead, ObjNegativeIndicesCommentsGroupsLinesAndContinuations)
{
    const Soup got = read_back("a.obj", "mtllib a.mtl\no thing\nv 0 0 0\nv 1 0 0\nv 0 1 0 # corner\n"
                                        "g part\nusemtl red\ns off\nl 1 2 3\nf -3 -2 \\\n -1\n\n   \n"
                                        "v 1 1 0\nf -3 -1 -2\n");
    ASSERT_EQ(got.faces.size(), 2U);
    EXPECT_EQ(got.faces[0], (Triple{0, 1, 2}));
    EXPECT_EQ(got.faces[1], (Triple{1, 3, 2}));
}

TEST(MeshRead, ObjSmoothingGroups)
{
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 2 0 0\nv 2 1 0\n";
    const Soup got = read_back("a.obj", vertices + "f 1 2 3\ns 4\nf 2 4 3\nf 2 5 6 4\ns off\nf 1 3 2\n");
    EXPECT_EQ(got.smoothing, (std::vector<std::uint32_t>{0, 4, 4, 4, 0}));
    EXPECT_TRUE(read_back("a.obj", vertices + "s off\nf 1 2 3\ns 0\nf 2 4 3\n").smoothing.empty());
}

TEST(MeshRead, PlyVerticesThatAreNoNumberAreDroppedWithTheirFaces)
{
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
        Soup soup = cube();
        soup.vertices[5][1] = bad;
        for (const char* format : {"binary_little_endian", "binary_big_endian"}) {
            const Soup got = read_back("a.ply", ply_of(soup, format));
            ASSERT_EQ(got.faces.size(), 12U);
            for (const bool full : {true, false}) {
                const auto out = prepare(got, {.full = full}, "a.ply");
                ASSERT_TRUE(out.ok());
                EXPECT_EQ(out->report.faces_nonfinite, 4U);
                EXPECT_EQ(out->report.faces, 8U);
                EXPECT_EQ(out->report.vertices, 7U);
            }
        }
    }
}

TEST(MeshRead, PolygonsAreFannedRoundTheirFirstCorner)
{
    const Soup got = read_back("a.off", "OFF # comment\n# another\n5 1 0\n0 0 0\n2 0 0\n3 1 0\n1 2 0\n0 1 0\n"
                                        "5 0 1 2 3 4\n");
    EXPECT_EQ(got.faces, (std::vector<Triple>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(MeshRead, OffWithNormalsAndOffWithColours)
{
    const Soup normals = read_back("a.off", "NOFF\n3 1 0\n0 0 0 0 0 3\n1 0 0 0 0 1\n0 1 0 0 1 0\n3 0 1 2\n");
    ASSERT_EQ(normals.normals.size(), 3U);
    EXPECT_EQ(normals.normals[0], (Vec3{0, 0, 1}));
    EXPECT_EQ(normals.normals[2], (Vec3{0, 1, 0}));
    const Soup colours = read_back(
        "a.off", "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 0 0 1 255\n0 1 0 0 1 0 255\n3 0 1 2 255 0 0\n");
    EXPECT_EQ(colours.vertices[1], (Vec3{1, 0, 0}));
    EXPECT_TRUE(colours.normals.empty());
}

TEST(MeshRead, StlFacetNormalsAreIgnored)
{
    EXPECT_TRUE(read_back("a.stl", stl_text_of(cube())).normals.empty());
}

TEST(MeshRead, StanfordBunny)
{
    const std::filesystem::path bunny = "/usr/share/glmark2/models/bunny.obj";
    if (!std::filesystem::exists(bunny))
        GTEST_SKIP() << "package glmark2-data is not installed";
    const auto soup = read(bunny);
    ASSERT_TRUE(soup.ok()) << soup.error().text();
    EXPECT_EQ(soup->faces.size(), 69666U);
    const auto prepared = prepare(*soup, {.fit_mm = 120}, "bunny");
    ASSERT_TRUE(prepared.ok());
    EXPECT_EQ(prepared->mesh.faces.size(), 69666U);
    EXPECT_NEAR(bounds_of(prepared->mesh.vertices).extent(), 120, 1e-9);
    EXPECT_TRUE(prepared->report.warnings.empty());
}

} // namespace
} // namespace phantom::mesh::test
