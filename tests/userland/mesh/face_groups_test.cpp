// SPDX-License-Identifier: GPL-2.0-or-later
// Groups of faces, from the file through every step of preparing: a face stays where its group was.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "mesh/face_groups.hpp"
#include "mesh/read.hpp"
#include "mesh/simplify_chain.hpp"
#include "meshes.hpp"

namespace phantom::mesh::test {
namespace {

/// A globe whose faces beyond x = 0 are "right"; meridians run along x = 0.
Soup two_halves()
{
    Soup soup = globe(50, 32, 24);
    soup.group_names = {"left", "right"};
    for (const Triple& face : soup.faces) {
        const double x = soup.vertices[face[0]][0] + soup.vertices[face[1]][0] + soup.vertices[face[2]][0];
        soup.face_groups.push_back(x > 0);
    }
    return soup;
}

/// Faces that reach over to the other half, by more than rounding.
std::size_t strays(const Mesh& mesh)
{
    std::size_t count = 0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (const std::uint32_t v : mesh.faces[f])
            if ((mesh.face_groups[f] ? -1.0 : 1.0) * mesh.vertices[v][0] > 1e-9) {
                ++count;
                break;
            }
    return count;
}

Mesh prepared(Soup soup, const PrepareOptions& options)
{
    auto result = prepare(std::move(soup), options, "test");
    EXPECT_TRUE(result.ok()) << result.error().text();
    return result.ok() ? std::move(result->mesh) : Mesh{};
}

void expect_halves(const Mesh& mesh)
{
    ASSERT_EQ(mesh.face_groups.size(), mesh.faces.size());
    EXPECT_EQ(mesh.group_names, (std::vector<std::string>{"left", "right"}));
    const auto right =
        static_cast<std::size_t>(std::count(mesh.face_groups.begin(), mesh.face_groups.end(), 1));
    EXPECT_NEAR(static_cast<double>(right), 0.5 * static_cast<double>(mesh.faces.size()),
                0.1 * static_cast<double>(mesh.faces.size()));
    EXPECT_EQ(strays(mesh), 0U);
}

TEST(FaceGroups, StayWithTheirFacesThroughEveryStep)
{
    Soup damaged = two_halves();
    // Without area, twice, and no number: dropped, and what follows moves up.
    damaged.faces.insert(damaged.faces.begin() + 7, {3, 3, 4});
    damaged.face_groups.insert(damaged.face_groups.begin() + 7, 0);
    damaged.faces.insert(damaged.faces.begin() + 90, damaged.faces[50]);
    damaged.face_groups.insert(damaged.face_groups.begin() + 90, damaged.face_groups[50]);
    expect_halves(prepared(damaged, {}));
    PrepareOptions split;
    split.split_mm = 5;
    const Mesh fine = prepared(damaged, split);
    EXPECT_GT(fine.faces.size(), 2 * damaged.faces.size());
    expect_halves(fine);
    PrepareOptions backs;
    backs.two_sided = true;
    expect_halves(prepared(damaged, backs));
}

TEST(FaceGroups, OfAFaceThatIsCutAtATJunctionAreItsPieces)
{
    // One large triangle beside two small ones that meet in the middle of its edge.
    Soup soup;
    soup.vertices = {{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {10, 0, 0}, {0, -20, 0}, {20, -20, 0}};
    soup.faces = {{0, 4, 3}, {0, 1, 2}, {3, 5, 1}, {3, 4, 5}};
    soup.group_names = {"below", "above"};
    soup.face_groups = {0, 1, 0, 0};
    const Mesh mesh = prepared(soup, {});
    ASSERT_EQ(mesh.faces.size(), 5U);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        double y = 0;
        for (const std::uint32_t v : mesh.faces[f])
            y += mesh.vertices[v][1];
        EXPECT_EQ(mesh.face_groups[f], y > 0) << f;
    }
}

TEST(FaceGroups, SimplificationKeepsTheLineBetweenThem)
{
    PrepareOptions options;
    options.simplify.emplace();
    options.simplify->faces = 500;
    options.simplify->error_mm = 2;
    const Mesh mesh = prepared(two_halves(), options);
    EXPECT_LT(mesh.faces.size(), 1000U);
    expect_halves(mesh);
}

TEST(FaceGroups, LevelsKeepTheLineBetweenThemWithoutACreaseThere)
{
    const Mesh mesh = prepared(two_halves(), {});
    const auto tree = fdh::TriangleTree<14>::build({mesh.vertices, mesh.faces});
    ChainOptions options;
    options.enough = [](const ChainLevel& level) { return level.mesh.faces.size() < 200; };
    const auto chain = simplify_chain(mesh, tree, options);
    ASSERT_GE(chain.size(), 2U);
    for (const ChainLevel& level : chain) {
        expect_halves(level.mesh);
        EXPECT_EQ(level.mesh.normals.size(), level.mesh.vertices.size());
    }
}

constexpr const char* faces_of_a_tetrahedron = "v 0 0 0\nv 40 0 0\nv 0 20 0\nv 0 0 20\n";

Soup read_text(const std::string& name, const std::string& text)
{
    const Folder folder;
    auto soup = read(folder.write(name, text));
    EXPECT_TRUE(soup.ok()) << soup.error().text();
    return soup.ok() ? *std::move(soup) : Soup{};
}

using Names = std::vector<std::string>;
using Numbers = std::vector<std::uint8_t>;

TEST(FaceGroups, OfAnObjFileAreItsMaterialsElseItsGroups)
{
    const std::string v = faces_of_a_tetrahedron;
    const Soup groups =
        read_text("a.obj", v + "g base\nf 1 3 2\ng side wall\nf 1 2 4\nf 1 4 3\ng\nf 2 3 4\n");
    EXPECT_EQ(groups.group_names, (Names{"base", "side wall", ""}));
    EXPECT_EQ(groups.face_groups, (Numbers{0, 1, 1, 2}));
    const Soup materials =
        read_text("a.obj", v + "g a\nf 1 3 2\nusemtl red\nf 1 2 4\ng b\nf 1 4 3\nusemtl blue\nf 2 3 4\n");
    EXPECT_EQ(materials.group_names, (Names{"", "red", "blue"}));
    EXPECT_EQ(materials.face_groups, (Numbers{0, 1, 1, 2}));
    const Soup none = read_text("a.obj", v + "f 1 3 2\ng\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    EXPECT_TRUE(none.face_groups.empty() && none.group_names.empty());
    // A polygon's triangles are all of its group.
    const Soup quad = read_text("a.obj", "v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nv 5 5 9\n"
                                         "g floor\nf 1 4 3 2\ng roof\nf 1 2 5\n");
    EXPECT_EQ(quad.face_groups, (Numbers{0, 0, 1}));
}

std::string ply(const char* format, const std::string& properties, const std::string& faces)
{
    return fmt::format("ply\nformat {} 1.0\nelement flag 1\nproperty list uchar short numbers\n"
                       "element vertex 4\nproperty float x\nproperty float y\n"
                       "property float z\nelement face 4\n{}end_header\n",
                       format, properties) +
           faces;
}

TEST(FaceGroups, OfAPlyFileAreItsMaterialIndicesElseItsColours)
{
    const std::string body = "2 7 -7\n0 0 0\n40 0 0\n0 20 0\n0 0 20\n";
    const std::string list = "property list uchar int vertex_indices\n";
    const std::string colours = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    const Soup painted = read_text(
        "a.ply", ply("ascii", colours + list,
                     body + "255 0 16 3 0 2 1\n255 0 16 3 0 1 3\n0 0 0 3 0 3 2\n255 0 16 3 1 2 3\n"));
    EXPECT_EQ(painted.group_names, (Names{"#ff0010", "#000000"}));
    EXPECT_EQ(painted.face_groups, (Numbers{0, 0, 1, 0}));
    const Soup indexed = read_text(
        "a.ply", ply("ascii", colours + list + "property int material_index\n",
                     body + "1 0 0 3 0 2 1 4\n2 0 0 3 0 1 3 -1\n3 0 0 3 0 3 2 4\n4 0 0 3 1 2 3 4\n"));
    EXPECT_EQ(indexed.group_names, (Names{"4", "-1"}));
    EXPECT_EQ(indexed.face_groups, (Numbers{0, 1, 0, 0}));
    const Soup plain = read_text("a.ply", ply("ascii", list, body + "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"));
    EXPECT_TRUE(plain.face_groups.empty());
}

template <typename T>
void append(std::string& bytes, T value, bool big)
{
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    if (big)
        std::reverse(raw, raw + sizeof value);
    bytes.append(raw, sizeof value);
}

TEST(FaceGroups, OfABinaryPlyFileAreTheSameInEitherOrderOfBytes)
{
    for (const bool big : {false, true}) {
        std::string body;
        append(body, std::uint8_t{2}, big);
        for (const std::int16_t value : {7, -7})
            append(body, value, big);
        for (const float value : {0, 0, 0, 40, 0, 0, 0, 20, 0, 0, 0, 20})
            append(body, value, big);
        const Triple faces[] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
        for (std::int16_t f = 0; f < 4; ++f) {
            append(body, static_cast<std::int16_t>(f == 2 ? -300 : 300), big);
            append(body, std::uint8_t{3}, big);
            for (const std::uint32_t v : faces[f])
                append(body, v, big);
        }
        const Soup soup = read_text(
            "a.ply", ply(big ? "binary_big_endian" : "binary_little_endian",
                         "property short material_indices\nproperty list uchar int vertex_indices\n", body));
        EXPECT_EQ(soup.group_names, (Names{"300", "-300"}));
        EXPECT_EQ(soup.face_groups, (Numbers{0, 0, 1, 0}));
    }
}

TEST(FaceGroups, MoreThanAMeshCanHaveAreNone)
{
    for (const std::size_t count : {face_groups_max, face_groups_max + 1}) {
        FaceGroups groups;
        for (std::size_t i = 0; i < count; ++i)
            groups.add(fmt::format("{}", i));
        Numbers numbers;
        Names names;
        groups.give(numbers, names);
        EXPECT_EQ(groups.too_many(), count > face_groups_max);
        EXPECT_EQ(numbers.size(), count > face_groups_max ? 0 : count);
    }
    Soup soup = globe(50, 8, 6);
    soup.too_many_groups = true;
    auto result = prepare(std::move(soup), {}, "test");
    ASSERT_TRUE(result.ok());
    EXPECT_EQ(result->report.warnings,
              (Names{"more than 256 groups of faces (materials or colours): they are not told apart"}));
}

} // namespace
} // namespace phantom::mesh::test
