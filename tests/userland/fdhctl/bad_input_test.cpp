// SPDX-License-Identifier: GPL-2.0-or-later
// Every kind of bad input: one line with the place, status 1, nothing left behind.
#include <algorithm>
#include <sstream>

#include "program.hpp"

namespace phantom::test {
namespace {

class BadInput : public Program {
  protected:
    /// The command fails with one line that has all the words, and t.csv is not there.
    void expect_failure(const std::vector<std::string>& arguments, const std::vector<std::string>& words)
    {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.status, 1) << outcome.err;
        // Before the error there may be warnings of the preparation, and nothing else.
        std::istringstream lines(outcome.err);
        std::string line;
        int errors = 0;
        while (std::getline(lines, line)) {
            EXPECT_TRUE(line.starts_with("fdhctl: ")) << outcome.err;
            errors += !line.starts_with("fdhctl: warning: ");
        }
        EXPECT_EQ(errors, 1) << outcome.err;
        for (const std::string& word : words)
            EXPECT_NE(outcome.err.find(word), std::string::npos) << "'" << word << "' in " << outcome.err;
        EXPECT_TRUE(outcome.out.empty()) << outcome.out;
        EXPECT_TRUE(files_beginning("t.csv").empty());
    }
    void expect_bad_mesh(const std::string& mesh, const std::vector<std::string>& words)
    {
        const std::string way = write("p.csv", "time_s,x_mm,y_mm,z_mm\n0,0,0,5\n");
        expect_failure({"trace", mesh, "--path", way, "-o", path("t.csv")}, words);
    }
    std::string ply(const std::string& name, const std::string& body, int faces = 1) const
    {
        return write(name, "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                           "property float z\nelement face " +
                               std::to_string(faces) +
                               "\nproperty list uchar int vertex_indices\nend_header\n" + body);
    }
};

TEST_F(BadInput, Meshes)
{
    expect_bad_mesh(path("missing.ply"), {"missing.ply"});
    expect_bad_mesh(folder_.string(), {folder_.string(), "directory"});
    expect_bad_mesh(write("empty.ply", ""), {"empty.ply", "empty"});
    expect_bad_mesh(write("mesh.xyz", "0 0 0\n"), {"mesh.xyz"});
    expect_bad_mesh(ply("short.ply", "0 0 0\n1 0 0\n"), {"short.ply"});
    expect_bad_mesh(ply("nan.ply", "0 0 0\n1 0 0\nnan 1 0\n3 0 1 2\n"), {"nan.ply"});
    expect_bad_mesh(ply("huge.ply", "0 0 0\n1 0 0\n0 1e30 0\n3 0 1 2\n"), {"huge.ply"});
    expect_bad_mesh(ply("index.ply", "0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"), {"index.ply", "7"});
    expect_bad_mesh(ply("none.ply", "0 0 0\n1 0 0\n0 1 0\n", 0), {"none.ply", "face"});
}

TEST_F(BadInput, PathRows)
{
    const std::string mesh = plate();
    const auto expect = [&](const std::string& text, const std::vector<std::string>& words) {
        const std::string way = write("p.csv", text);
        expect_failure({"trace", mesh, "--path", way, "-o", path("t.csv")}, words);
        expect_failure({"load", mesh, "--usermode", "--path", way, "--record", path("t.csv")}, words);
    };
    const std::string header = "time_s,x_mm,y_mm,z_mm\n";
    expect("0,0,0,5\n", {"p.csv:1", "time_s,x_mm,y_mm,z_mm"});
    expect(header + "0,0,0,5\n0.001,0,0\n", {"p.csv:3", "4 columns", "found 3"});
    expect(header + "0,0,up,5\n", {"p.csv:2", "y_mm", "number"});
    expect(header + "0,0,0,inf\n", {"p.csv:2", "z_mm", "finite"});
    expect(header + "0,0,0,5\n0,0,0,5\n", {"p.csv:3", "increase"});
    expect(header, {"p.csv", "no row"});
    expect_failure({"trace", mesh, "--path", path("none.csv"), "-o", path("t.csv")}, {"none.csv"});
}

TEST_F(BadInput, OutputsThatCannotBeWritten)
{
    const std::string mesh = plate(), way = write("p.csv", "time_s,x_mm,y_mm,z_mm\n0,0,0,5\n");
    expect_failure({"trace", mesh, "--path", way, "-o", path("no/folder/t.csv")}, {"no/folder/t.csv"});
    expect_failure({"trace", mesh, "--path", way, "-o", "/dev/full"}, {"/dev/full"});
    expect_failure({"trace", mesh, "--path", way, "-o", folder_.string()}, {folder_.string()});
    expect_failure({"load", mesh, "--usermode", "--record", path("no/folder/t.csv")}, {"no/folder/t.csv"});
    expect_failure({"stroke", sphere(), "-o", path("no/folder/s.csv")}, {"no/folder/s.csv"});
}

TEST_F(BadInput, WhatTheModuleDoesNotOfferIsNamed)
{
    const Outcome outcome = run({"load", plate(), "--usermode", "--arith", "double", "--seconds", "0.1"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("arith double is not offered"), std::string::npos) << outcome.err;
}

TEST_F(BadInput, ATriangleThatNoSetCanCarryNamesTheRemedy)
{
    const std::string mesh = write("wide.off", "OFF\n3 1 0\n0 0 0\n5000 0 0\n0 5000 0\n3 0 1 2\n");
    const std::string way = write("p.csv", "time_s,x_mm,y_mm,z_mm\n0,0,0,5\n");
    const Outcome outcome = run({"trace", mesh, "--path", way, "-o", path("t.csv")});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("--split"), std::string::npos) << outcome.err;
    EXPECT_TRUE(files_beginning("t.csv").empty());
    EXPECT_EQ(run({"trace", mesh, "--path", way, "--split", "500", "-o", path("t.csv")}).status, 0);
}

} // namespace
} // namespace phantom::test
