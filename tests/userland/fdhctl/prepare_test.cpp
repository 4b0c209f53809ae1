// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl prepare: what it says of a mesh with every fault it can have, to people and to programs.
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace phantom::test {
namespace {

using nlohmann::json;

class Prepare : public Program {
  protected:
    /// A sheet with a T-junction, a fin, a bow-tie, a duplicate, a face without area, one turned over and one
    /// polygon that crosses itself.
    [[nodiscard]] std::string faulty() const
    {
        return write("faulty.obj", "v 0 0 0\nv 20 0 0\nv 20 20 0\nv 0 20 0\nv 10 20 0\nv 0 40 0\nv 20 40 0\n"
                                   "v 10 0 20\nv 40 60 0\nv 20 60 0\nv 100 0 0\nv 110 10 0\nv 110 0 0\n"
                                   "v 100 10 0\n"
                                   "f 1 2 3 4\nf 4 5 6\nf 5 6 7\nf 5 3 7\nf 1 2 8\nf 4 5 6\nf 1 1 2\n"
                                   "f 7 9 10\nf 11 12 13 14\nf 2 1 8\n");
    }
};

TEST_F(Prepare, SaysStepByStepWhatItFound)
{
    const Outcome outcome = run({"prepare", faulty(), "-o", path("out.ply")});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    for (const char* line : {"read        14 vertices, 12 triangles, 1 polygon that crosses itself\n",
                             "dropped     1 face without area, 1 duplicate\n",
                             "closed      1 T-junction, 1 face added\n", "not watertight\n", "written to"})
        EXPECT_NE(outcome.out.find(line), std::string::npos) << line << outcome.out;
    EXPECT_NE(outcome.err.find("--weld MM"), std::string::npos) << outcome.err;
    EXPECT_TRUE(exists("out.ply"));
}

TEST_F(Prepare, TellsProgramsEveryCount)
{
    const Outcome outcome = run({"prepare", faulty(), "-o", path("out.ply"), "--json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const json report = json::parse(outcome.out);
    const auto count = [&report](const char* key) { return report.at(key).get<std::uint64_t>(); };
    EXPECT_EQ(count("faces_read"), 12U);
    EXPECT_EQ(count("polygons_crossed"), 1U);
    EXPECT_EQ(count("faces_zero_area"), 1U);
    EXPECT_EQ(count("faces_duplicate"), 1U);
    EXPECT_EQ(count("faces_nonfinite"), 0U);
    EXPECT_EQ(count("t_junctions"), 1U);
    EXPECT_EQ(count("nonmanifold_edges"), 1U);
    EXPECT_GE(count("nonmanifold_vertices"), 1U);
    EXPECT_EQ(count("unorientable_edges"), 0U);
    EXPECT_EQ(count("cavities"), 0U);
    EXPECT_EQ(count("vertices_sewn"), 0U);
    EXPECT_EQ(count("faults"), 0U);
    EXPECT_EQ(count("faces"), 12U - 2 + count("faces_cut"));
    EXPECT_EQ(report["patches"]["faces"], report["faces"]);
    EXPECT_EQ(report["patches"]["rims"], report["rim_edges"]);
    EXPECT_FALSE(report["watertight"].get<bool>());
}

TEST_F(Prepare, WeldsCracksOfTheWidthThatIsAskedFor)
{
    const std::string mesh = write("crack.obj", "v 0 0 0\nv 50 0 0\nv 0 50 0\nv 0.04 0 0\nv 0 -50 0\n"
                                                "v 50 0.04 0\nf 1 2 3\nf 4 5 6\n");
    for (const auto& [weld, boundary] : {std::pair{"0", 6}, std::pair{"0.01", 6}, std::pair{"0.1", 4}}) {
        const Outcome outcome = run({"prepare", mesh, "-o", path("out.ply"), "--weld", weld, "--json"});
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_EQ(json::parse(outcome.out)["boundary_edges"], boundary) << weld;
    }
    for (const char* bad : {"-1", "nan", "wide"}) {
        const Outcome outcome = run({"prepare", mesh, "-o", path("bad.ply"), "--weld", bad});
        EXPECT_EQ(outcome.status, 2) << bad;
        EXPECT_NE(outcome.err.find("--weld"), std::string::npos) << outcome.err;
        EXPECT_FALSE(exists("bad.ply"));
    }
}

} // namespace
} // namespace phantom::test
