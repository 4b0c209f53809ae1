// SPDX-License-Identifier: GPL-2.0-or-later
// Bad files: one error each, with the file, the place and what was expected; never a crash.
#include <limits>

#include <gtest/gtest.h>

#include "mesh/read.hpp"
#include "meshes.hpp"

namespace phantom::mesh::test {
namespace {

/// The error of reading these bytes, without the folder's name; empty when they were read.
std::string error_of(const std::string& name, const std::string& bytes)
{
    static const Folder folder;
    const auto soup = read(folder.write(name, bytes));
    if (soup.ok())
        return "";
    std::string text = soup.error().text();
    const std::string prefix = folder.path().string() + "/";
    EXPECT_EQ(text.find(prefix), 0U) << "the error does not begin with the file: " << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << "more than one line: " << text;
    return text.substr(std::min(prefix.size(), text.size()));
}

void expect_error(const std::string& name, const std::string& bytes, const std::string& place,
                  const std::string& what)
{
    const std::string text = error_of(name, bytes);
    EXPECT_EQ(text.find(name + place), 0U) << "expected the place \"" << place << "\" in: " << text;
    EXPECT_NE(text.find(what), std::string::npos) << "expected \"" << what << "\" in: " << text;
}

TEST(MeshReadBad, MissingFile)
{
    const auto soup = read("/nonexistent/bunny.ply");
    ASSERT_FALSE(soup.ok());
    EXPECT_EQ(soup.error().text(), "/nonexistent/bunny.ply: no such file");
}

TEST(MeshReadBad, Directory)
{
    const Folder folder;
    std::filesystem::create_directory(folder / "a.ply");
    const auto soup = read(folder / "a.ply");
    ASSERT_FALSE(soup.ok());
    EXPECT_NE(soup.error().text().find("is a directory"), std::string::npos);
}

TEST(MeshReadBad, NotARegularFile)
{
    const Folder folder;
    std::filesystem::create_symlink("/dev/zero", folder / "a.ply");
    const auto soup = read(folder / "a.ply");
    ASSERT_FALSE(soup.ok());
    EXPECT_NE(soup.error().text().find("not a regular file"), std::string::npos);
}

TEST(MeshReadBad, EmptyFile)
{
    for (const char* name : {"a.ply", "a.obj", "a.stl", "a.off"})
        expect_error(name, "", ": ", "is empty");
}

TEST(MeshReadBad, UnknownExtension)
{
    expect_error("a.step", "anything", ": ",
                 "expected .ply, .obj, .stl, .off, .vtp, .vtk, .3ds, .gltf or .glb");
    expect_error("mesh", "anything", ": ", "unknown extension");
}

TEST(MeshReadBad, TruncatedBinaryPlyAtEveryLength)
{
    for (const char* format : {"binary_little_endian", "binary_big_endian"}) {
        const std::string whole = ply_of(cube(), format);
        for (std::size_t size = 1; size < whole.size(); ++size)
            ASSERT_NE(error_of("a.ply", whole.substr(0, size)), "") << format << " cut to " << size;
        ASSERT_EQ(error_of("a.ply", whole), "");
        expect_error("a.ply", whole.substr(0, whole.size() - 1), ": ", "in face 11 of 12, at byte");
        expect_error("a.ply", whole.substr(0, whole.find("end_header") + 50), ": ", "8 of element vertex");
    }
}

TEST(MeshReadBad, TruncatedAsciiPlyAtEveryLength)
{
    const std::string whole = ply_of(cube(), "ascii");
    // Without its last digit the file is still whole: nothing can tell.
    for (std::size_t size = 1; size + 3 < whole.size(); ++size)
        ASSERT_NE(error_of("a.ply", whole.substr(0, size)), "") << "cut to " << size;
    expect_error("a.ply", whole.substr(0, whole.size() - 4), ": ", "in face 11 of 12");
}

TEST(MeshReadBad, TruncatedStl)
{
    const std::string binary = stl_binary_of(cube());
    expect_error("a.stl", binary.substr(0, binary.size() - 1), ": ",
                 "promises 12 facets, 684 bytes; it ends at byte 683");
    const std::string text = stl_text_of(cube());
    expect_error("a.stl", text.substr(0, text.size() / 2), ":", "ends early (truncated)");
}

TEST(MeshReadBad, TruncatedOff)
{
    const std::string whole = off_of(cube());
    for (std::size_t size = 1; size + 3 < whole.size(); ++size)
        ASSERT_NE(error_of("a.off", whole.substr(0, size)), "") << "cut to " << size;
}

TEST(MeshReadBad, PlyHugeOrNotANumberInText)
{
    struct Case {
        double value;
        const char* what;
    };
    for (const Case& bad : {Case{1.1e9, "1100000000"}, Case{-1e300, "-1e+300"}}) {
        Soup soup = cube();
        soup.vertices[5][1] = bad.value;
        for (const char* format : {"binary_little_endian", "binary_big_endian"})
            expect_error("a.ply", ply_of(soup, format), ": vertex 5: y is ", bad.what);
    }
    Soup soup = cube();
    soup.vertices[5][1] = std::numeric_limits<double>::quiet_NaN();
    expect_error("a.ply", ply_of(soup, "ascii"), ":16: ", "cannot be read as a number");
    soup.vertices[5][1] = 2e9;
    expect_error("a.ply", ply_of(soup, "ascii"), ": vertex 5: ", "expected a finite number within +-1e+09");
}

TEST(MeshReadBad, NotANumberOrHugeInTheOtherFormats)
{
    Soup soup = cube();
    soup.vertices[5][2] = 2e9;
    expect_error("a.obj", obj_of(soup), ": vertex 5: z is ", "expected a finite number");
    expect_error("a.off", off_of(soup), ": vertex 5: z is ", "expected a finite number");
    expect_error("a.stl", stl_text_of(soup), ": vertex ", "expected a finite number");
    soup.vertices[5][2] = std::numeric_limits<double>::quiet_NaN();
    expect_error("a.obj", obj_of(soup), ":7: ", "expected \"v X Y Z\"");
    expect_error("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\ns two\nf 1 2 3\n", ":4: ", "expected \"s off\"");
    expect_error("a.off", off_of(soup), ":8: ", "expected a vertex");
    expect_error("a.stl", stl_text_of(soup), ":", "in numbers");
    expect_error("a.stl", stl_binary_of(soup), ": face ", "z of corner 1 is nan");
}

TEST(MeshReadBad, FaceIndexOutOfRange)
{
    Soup soup = cube();
    soup.faces[7][2] = 8;
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"})
        expect_error("a.ply", ply_of(soup, format), ": face 7: ", "names vertex 8, expected 0 ... 7");
    expect_error("a.off", off_of(soup), ":18: ", "0 <= I < 8");
    expect_error("a.obj", obj_of(soup), ":17: ", "names vertex 9, but there are 8");
    expect_error("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n", ":4: ", "expected 1 ... 3");
    expect_error("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999\n", ":4: ", "expected V");
}

TEST(MeshReadBad, FaceIndexNegative)
{
    Soup soup = cube();
    soup.faces[7][2] = static_cast<std::uint32_t>(-1);
    for (const char* format : {"binary_little_endian", "binary_big_endian"})
        expect_error("a.ply", ply_of(soup, format), ": face 7: ", "names vertex -1, expected 0 ... 7");
    expect_error("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -2\n", ":6: ", "0 <= I < 3");
    expect_error("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n", ":4: ", "-3 ... -1");
}

TEST(MeshReadBad, NoFaces)
{
    Soup soup = cube();
    soup.faces.clear();
    for (const char* format : {"ascii", "binary_little_endian"})
        expect_error("a.ply", ply_of(soup, format), ": ", "has no faces");
    expect_error("a.ply",
                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                 "property float z\nend_header\n0 0 0\n",
                 ": ", "has no faces");
    expect_error("a.obj", obj_of(soup), ": ", "has no faces");
    expect_error("a.off", off_of(soup), ": ", "has no faces");
    expect_error("a.stl", stl_binary_of(soup), ": ", "has no faces");
    expect_error("a.stl", stl_text_of(soup), ": ", "has no");
}

TEST(MeshReadBad, PolygonWithTwoCorners)
{
    expect_error("a.ply",
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                 "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
                 "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n2 0 1\n",
                 ": face 1: ", "has 2 corners, expected 3 or more");
    expect_error("a.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n2 0 1\n", ": face 1: ", "has 2 corners");
    expect_error("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n", ":4: ", "2 corners, expected 3 or more");
}

TEST(MeshReadBad, HeadersThatPromiseBillionsAreRefusedBeforeMemoryIsTaken)
{
    const std::string vertex = "\nproperty float x\nproperty float y\nproperty float z\nelement face ";
    const std::string list = "\nproperty list uchar int vertex_indices\n";
    const std::pair<const char*, std::string> formats[] = {
        {"ascii", "0 0 0 3 0 0 0\n"},
        {"binary_little_endian", std::string(12, '\0') + '\3' + std::string(12, '\0')}};
    for (const auto& [format, data] : formats) {
        const std::string start = std::string("ply\nformat ") + format + " 1.0\nelement vertex ";
        ASSERT_EQ(error_of("a.ply", start + "1" + vertex + "1" + list + "end_header\n" + data), "");
        expect_error("a.ply", start + "4000000000" + vertex + "1" + list + "end_header\n" + data, ": ",
                     "promises 4000000000 of element vertex");
        expect_error("a.ply", start + "1" + vertex + "4000000000" + list + "end_header\n" + data, ": ",
                     "promises 4000000000 of element face");
        expect_error("a.ply",
                     start + "1" + vertex + "1" + list + "element nothing 4000000000\nend_header\n" + data,
                     ": ", "promises 4000000000 of element nothing");
    }
    // One list whose length alone would be gigabytes.
    const std::string wide = "\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                             "element face 1\nproperty list uint int vertex_indices\nend_header\n";
    expect_error("a.ply", "ply\nformat ascii 1.0" + wide + "0 0 0\n2000000000 0 0 0\n", ": ",
                 "in face 0 of 1");
    expect_error("a.ply",
                 "ply\nformat binary_little_endian 1.0" + wide + std::string(12, '\0') + raw(0x7fffffffU) +
                     std::string(12, '\0'),
                 ": ", "in face 0 of 1");
    expect_error("a.off", "OFF\n4000000000 1 0\n0 0 0\n", ":2: ", "more than 25 bytes can hold");
    expect_error("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n", ":6: ", "or a face");
    std::string stl = stl_binary_of(cube());
    stl.replace(80, 4, raw(4000000000U));
    expect_error("a.stl", stl, ": ", "promises 4000000000 facets");
}

TEST(MeshReadBad, PlyHeaders)
{
    expect_error("a.ply", "plx\nformat ascii 1.0\n", ":1: ", "expected \"ply\"");
    expect_error("a.ply", "ply\nformat ebcdic 1.0\nend_header\n", ":2: ", "expected ascii");
    expect_error("a.ply", "ply\nelement vertex 3\n", ":2: ", "expected \"format\"");
    expect_error("a.ply", "ply\nformat ascii 1.0\nelement vertex many\n", ":3: ", "whole number");
    expect_error("a.ply", "ply\nformat ascii 1.0\nelement vertex -3\n", ":3: ", "whole number");
    expect_error("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty quad x\n",
                 ":4: ", "unknown type quad");
    expect_error("a.ply", "ply\nformat ascii 1.0\nwhatever\n", ":3: ", "unknown word \"whatever\"");
    expect_error("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\n", ":4: ", "without \"end_header\"");
    expect_error("a.ply",
                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty float y\n"
                 "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                 "0 0 0\n3 0 0 0\n",
                 ": ", "no property x of type float or double");
    expect_error("a.ply",
                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                 "property float z\nelement face 1\nproperty int vertex_indices\nend_header\n0 0 0\n0\n",
                 ": ", "vertex_indices");
}

TEST(MeshReadBad, ObjLinesAreNamed)
{
    expect_error("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1\nf 1 2 3\n", ":3: ", "expected \"v X Y Z\"");
    expect_error("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 x\n", ":4: ", "a corner \"x\"");
    expect_error("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//7\n",
                 ":5: ", "names normal 7");
    expect_error("a.obj", "v 0 0 0\nbogus 1 2 3\n", ":2: ", "unknown word \"bogus\"");
    expect_error("a.obj", "v 0 0 0\nv 1 0 0\nv 0 \\\n1 0\nf 1 2 x\n", ":5: ", "a corner");
}

TEST(MeshReadBad, RandomBytes)
{
    std::mt19937 random(1);
    for (int round = 0; round < 60; ++round) {
        std::string bytes(1 + random() % 3000, '\0');
        for (char& byte : bytes)
            byte = static_cast<char>(random());
        // Past the first check of the format, too.
        const std::string starts[] = {"ply\nformat binary_little_endian 1.0\n", "v 0 0 0\n", "solid\n",
                                      "OFF\n"};
        const char* names[] = {"a.ply", "a.obj", "a.stl", "a.off"};
        for (int i = 0; i < 4; ++i) {
            EXPECT_NE(error_of(names[i], bytes), "");
            EXPECT_NE(error_of(names[i], starts[i] + bytes), "");
        }
    }
}

/// A damaged file is refused, or what comes out of it is whole.
TEST(MeshReadBad, DamagedFilesNeverCrash)
{
    const Soup given = globe(50, 6, 4);
    const std::pair<const char*, std::string> files[] = {{"a.ply", ply_of(given, "ascii")},
                                                         {"a.ply", ply_of(given, "binary_little_endian")},
                                                         {"a.ply", ply_of(given, "binary_big_endian")},
                                                         {"a.obj", obj_of(given)},
                                                         {"a.stl", stl_text_of(given)},
                                                         {"a.stl", stl_binary_of(given)},
                                                         {"a.off", off_of(given)}};
    std::mt19937 random(2);
    const Folder folder;
    for (const auto& [name, whole] : files) {
        for (int round = 0; round < 150; ++round) {
            std::string bytes = whole;
            for (std::uint32_t i = 0; i < 1 + random() % 4; ++i) {
                // Half of the damage goes to the header, where it hurts most.
                const std::size_t at =
                    random() % (random() % 2 ? bytes.size() : std::min<std::size_t>(200, bytes.size()));
                bytes[at] = random() % 2 ? static_cast<char>(random()) : "0123456789-. \n"[random() % 14];
            }
            if (random() % 8 == 0)
                bytes.resize(random() % bytes.size() + 1);
            auto soup = read(folder.write(name, bytes));
            if (!soup.ok()) {
                EXPECT_EQ(soup.error().text().find('\n'), std::string::npos);
                continue;
            }
            for (const Triple& face : soup->faces)
                ASSERT_LT(*std::max_element(face.begin(), face.end()), soup->vertices.size());
            const auto prepared = prepare(*std::move(soup), {}, name);
            if (prepared.ok()) {
                for (const Vec3& normal : prepared->mesh.normals)
                    ASSERT_NEAR(length(normal), 1, 1e-9);
            }
        }
    }
}

TEST(MeshReadBad, LibraryIsSilent)
{
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    for (const char* name : {"a.ply", "a.obj", "a.stl", "a.off"})
        EXPECT_NE(error_of(name, "solid\nfacet vertex 1 nonsense"), "");
    EXPECT_NE(error_of("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n"), "");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

} // namespace
} // namespace phantom::mesh::test
