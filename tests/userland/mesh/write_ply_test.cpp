// SPDX-License-Identifier: GPL-2.0-or-later
#include <sys/stat.h>

#include <gtest/gtest.h>

#include "mesh/read.hpp"
#include "meshes.hpp"

namespace phantom::mesh::test {
namespace {

std::size_t files_in(const Folder& folder)
{
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder.path()), {}));
}

/// Positions and normals corner by corner: what the servo will get.
std::vector<std::pair<Vec3, Vec3>> corners(const Mesh& mesh)
{
    std::vector<std::pair<Vec3, Vec3>> out;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i)
            out.emplace_back(mesh.vertices[mesh.faces[f][i]], mesh.normals[mesh.face_normals[f][i]]);
    }
    return out;
}

/// The file's unit normals are normalized once more on reading: an ulp may change.
void expect_same(const Mesh& a, const Mesh& b)
{
    const auto x = corners(a), y = corners(b);
    ASSERT_EQ(x.size(), y.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        EXPECT_EQ(x[i].first, y[i].first);
        EXPECT_LT(distance(x[i].second, y[i].second), 1e-15);
    }
    EXPECT_EQ(a.neighbours, b.neighbours);
}

TEST(MeshWritePly, CreasesAndAllComeBack)
{
    const Folder folder;
    for (const Soup& soup : {cube(50), globe(50, 12, 8), sheet(3, 3)}) {
        const auto given = prepare(soup, {}, "given");
        ASSERT_TRUE(given.ok());
        const std::string file = (folder / "out.ply").string();
        ASSERT_TRUE(write_ply(given->mesh, file).ok());
        auto read_again = read(file);
        ASSERT_TRUE(read_again.ok()) << read_again.error().text();
        const auto again = prepare(*std::move(read_again), {}, "again");
        ASSERT_TRUE(again.ok());
        expect_same(again->mesh, given->mesh);
        EXPECT_EQ(again->report.normals_repaired, 0U);
    }
}

TEST(MeshWritePly, LeavesNothingBesideAndReplacesWhole)
{
    const Folder folder;
    const auto mesh = prepare(cube(), {}, "cube");
    ASSERT_TRUE(mesh.ok());
    const auto file = folder.write("out.ply", "older");
    ASSERT_TRUE(write_ply(mesh->mesh, file.string()).ok());
    EXPECT_EQ(files_in(folder), 1U);
    EXPECT_TRUE(read(file).ok());
    struct stat status {};
    ASSERT_EQ(::stat(file.c_str(), &status), 0);
    const mode_t mask = ::umask(0);
    ::umask(mask);
    EXPECT_EQ(status.st_mode & 0777, 0666 & ~mask);
}

TEST(MeshWritePly, FailureLeavesNoPartialFile)
{
    const Folder folder;
    const auto mesh = prepare(cube(), {}, "cube");
    ASSERT_TRUE(mesh.ok());
    const auto missing = write_ply(mesh->mesh, (folder / "no/such/out.ply").string());
    ASSERT_FALSE(missing.ok());
    EXPECT_NE(missing.error().text().find("out.ply: cannot be written: No such file"), std::string::npos);
    // The target is a folder: written beside it, but the rename fails.
    std::filesystem::create_directory(folder / "out.ply");
    EXPECT_FALSE(write_ply(mesh->mesh, (folder / "out.ply").string()).ok());
    EXPECT_EQ(files_in(folder), 1U);
}

} // namespace
} // namespace phantom::mesh::test
