// SPDX-License-Identifier: GPL-2.0-or-later
// Levels of detail and simplification as users of fdhctl meet them.
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "program.hpp"

namespace phantom::test {
namespace {

using nlohmann::json;

class LevelsCommand : public Program {
  protected:
    json json_of(const std::vector<std::string>& words) const
    {
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return json::parse(outcome.out, nullptr, false);
    }
    /// Down onto the sphere of 30 mm from above, and along it.
    std::string stroke() const
    {
        std::string rows = "time_s,x_mm,y_mm,z_mm\n";
        for (int i = 0; i <= 40; ++i)
            rows += std::to_string(i * 0.005) + ",0," + std::to_string(0.1 * i) + "," +
                    std::to_string(31.5 - 0.04 * std::min(i, 20)) + "\n";
        return write("stroke.csv", rows);
    }
};

TEST_F(LevelsCommand, InfoShowsTheChain)
{
    const std::string mesh = sphere();
    const json levels = json_of({"info", mesh, "--json"})["levels"];
    ASSERT_GT(levels.size(), 1U);
    EXPECT_EQ(levels[0]["error_mm"], 0.0);
    for (std::size_t i = 1; i < levels.size(); ++i) {
        EXPECT_LT(levels[i]["triangles"], levels[i - 1]["triangles"]);
        EXPECT_GT(levels[i]["error_mm"], levels[i - 1]["error_mm"]);
    }
    EXPECT_EQ(json_of({"info", mesh, "--json"})["levels"], levels) << "from the cache";
    EXPECT_EQ(json_of({"info", mesh, "--json", "--levels", "off"})["levels"].size(), 1U);
}

TEST_F(LevelsCommand, TraceTouchesTheLevelThatIsAskedFor)
{
    const std::string mesh = sphere(), way = stroke();
    const auto traced = [&](const char* levels) {
        return json_of({"trace", mesh, "--path", way, "-o", path("t.csv"), "--json", "--levels", levels});
    };
    const json off = traced("off"), first = traced("1");
    EXPECT_GT(off["contact_ticks"], 0);
    ASSERT_GE(first["level_sets"].size(), 2U);
    EXPECT_EQ(first["level_sets"][0], 0);
    EXPECT_GT(first["level_sets"][1], 0);
    // 1 N/mm, the sphere's curvature and the level's error
    const double error_mm = first["level_error_mm"][1];
    EXPECT_GT(error_mm, 0.0);
    EXPECT_NEAR(first["force_max_n"].get<double>(), off["force_max_n"].get<double>(), 3 * error_mm);
    EXPECT_NE(first["force_max_n"], off["force_max_n"]);
}

TEST_F(LevelsCommand, LoadBuildsThemWhileItIsTouched)
{
    Running load = start_load({sphere(), "--usermode"});
    json status;
    for (int attempt = 0; attempt < 500; ++attempt) {
        status = json_of({"status", "--json"});
        if (status.value("levels", 1) > 1)
            break;
        ::usleep(20000);
    }
    EXPECT_GT(status.value("levels", 1), 1);
    EXPECT_EQ(status["set"]["level"], 0) << "the tip rests";
    EXPECT_EQ(run({"stop"}).status, 0);
    EXPECT_EQ(load.wait().status, 0);
}

TEST_F(LevelsCommand, PrepareSimplifiesToANumberOrADistance)
{
    const std::string mesh = sphere();
    const json number = json_of({"prepare", mesh, "-o", path("n.ply"), "--simplify", "600", "--json"});
    EXPECT_LE(number["faces"], 600);
    EXPECT_GT(number["faces"], 500);
    EXPECT_TRUE(number["watertight"]);
    const json distance = json_of({"prepare", mesh, "-o", path("d.ply"), "--simplify", "0.3mm", "--json"});
    EXPECT_LT(distance["faces"], 2 * 48 * 23);
    EXPECT_LE(distance["simplify_error_mm"], 0.3);
    EXPECT_EQ(json_of({"info", path("n.ply"), "--json"})["triangles"], number["faces"]);
}

TEST_F(LevelsCommand, BadWordsAreRefused)
{
    const std::string mesh = sphere();
    EXPECT_EQ(run({"info", mesh, "--levels", "many"}).status, 2);
    EXPECT_EQ(run({"prepare", mesh, "-o", path("o.ply"), "--simplify", "-3"}).status, 2);
    EXPECT_EQ(run({"prepare", mesh, "-o", path("o.ply"), "--simplify-error", "1"}).status, 2);
    EXPECT_FALSE(exists("o.ply"));
}

} // namespace
} // namespace phantom::test
