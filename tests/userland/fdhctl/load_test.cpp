// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl load in user mode, and the commands that talk to it.
#include <cmath>
#include <csignal>

#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace phantom::test {
namespace {

using nlohmann::json;

class Load : public Program {
  protected:
    json status()
    {
        const Outcome outcome = run({"status", "--json"});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return json::parse(outcome.out, nullptr, false);
    }
};

TEST_F(Load, RunsForItsTimeAndSumsUp)
{
    const Outcome outcome =
        run({"load", sphere(), "--usermode", "--seconds", "0.5", "--summary", path("summary.json")});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("first force after"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("touched"), std::string::npos) << outcome.out;
    const json summary = json::parse(read(path("summary.json")));
    EXPECT_GT(summary["touch"]["ticks"].get<int>(), 100);
    EXPECT_GT(summary["feeder"]["sets"].get<int>(), 10);
    EXPECT_EQ(summary["servo"]["rate_hz"], 1000);
}

TEST_F(Load, FallsBackToUserModeAndSaysWhy)
{
    if (::access("/dev/phantom_rt0", F_OK) == 0)
        GTEST_SKIP() << "the kernel's device is here";
    const Outcome outcome = run({"load", sphere(), "--seconds", "0.1"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("no kernel device at /dev/phantom_rt0 ("), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("): user mode"), std::string::npos) << outcome.out;
}

TEST_F(Load, StatusRateModelAndStopReachItFromElsewhere)
{
    Running load = start_load({sphere(), "--usermode", "--rate", "1000"});
    json now = status();
    EXPECT_EQ(now["state"], "RUNNING");
    EXPECT_EQ(now["rate_hz"], 1000);
    EXPECT_EQ(now["device"], "user mode");
    EXPECT_TRUE(now["model"].get<std::string>().starts_with("projected"));

    EXPECT_EQ(run({"rate", "2000"}).status, 0);
    EXPECT_EQ(run({"model", "paper", "--combine", "paper"}).status, 0);
    for (int attempt = 0; attempt < 200 && status()["rate_hz"] != 2000; ++attempt)
        ::usleep(10000);
    now = status();
    EXPECT_EQ(now["rate_hz"], 2000);
    EXPECT_TRUE(now["model"].get<std::string>().starts_with("paper, combine paper")) << now["model"];

    EXPECT_EQ(run({"model", "--arith", "fixed"}).status, 0);
    const Outcome refused = run({"model", "--arith", "double"});
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.err.find("arith double is not offered"), std::string::npos) << refused.err;

    EXPECT_EQ(run({"stop"}).status, 0);
    const Outcome outcome = load.wait();
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(run({"status"}).status, 1);
    EXPECT_FALSE(exists("phantom_rt0.sock"));
}

TEST_F(Load, EffectsAreListedAndChangedWhileItRuns)
{
    const std::string scene =
        write("a.toml", "[[object]]\nshape = \"box\"\nsize_mm = [20, 20, 20]\nmaterial = \"plate\"\n"
                        "[material.plate.friction]\nstatic = 0.5\ndynamic = 0.4\n"
                        "[effect.wind]\nkind = \"constant\"\nforce_n = [0, 0.25, 0]\n");
    Running load = start_load({scene, "--usermode"});
    Outcome answer = run({"effect"});
    EXPECT_EQ(answer.status, 0) << answer.err;
    EXPECT_NE(answer.out.find("plate.friction  friction"), std::string::npos) << answer.out;
    EXPECT_NE(answer.out.find("force_n=0,0.25,0"), std::string::npos) << answer.out;
    answer = run({"effect", "plate.friction", "static=0.3"});
    EXPECT_EQ(answer.status, 1);
    EXPECT_EQ(answer.err,
              "fdhctl: effect plate.friction: dynamic: is 0.4, expected no more than static, 0.3\n");
    answer = run({"effect", "plate.friction", "static=0.3", "dynamic=0.1", "--json"});
    ASSERT_EQ(answer.status, 0) << answer.err;
    EXPECT_EQ(json::parse(answer.out)["effect"]["values"]["dynamic"], 0.1);
    EXPECT_EQ(run({"effect", "wind", "force_n=0,0,-0.5"}).status, 0);
    double force = 0; // the tip rests above the box: only the wind
    for (int attempt = 0; attempt < 300 && std::abs(force - 0.5) > 1e-3; ++attempt, ::usleep(10000))
        force = status()["force_magnitude_n"].get<double>();
    EXPECT_NEAR(force, 0.5, 1e-3);
    EXPECT_EQ(run({"effect", "wind", "off"}).status, 0);
    for (int attempt = 0; attempt < 300 && force > 1e-6; ++attempt, ::usleep(10000))
        force = status()["force_magnitude_n"].get<double>();
    EXPECT_NEAR(force, 0, 1e-6);
    EXPECT_EQ(run({"effect", "wind", "gust"}).status, 2);
}

TEST_F(Load, ASecondOneIsRefusedAndToldWhoRuns)
{
    const std::string mesh = sphere();
    Running load = start_load({mesh, "--usermode"});
    const int pid = status()["pid"].get<int>();
    const Outcome second = run({"load", mesh, "--usermode", "--seconds", "0.1"});
    EXPECT_EQ(second.status, 1);
    EXPECT_EQ(second.err,
              fmt::format("fdhctl: a session is running already (process {}) (fdhctl stop ends it)\n", pid));
    EXPECT_EQ(status()["pid"].get<int>(), pid);
}

TEST_F(Load, AKilledOneLeavesTheWayFree)
{
    const std::string mesh = sphere();
    {
        Running load = start_load({mesh, "--usermode"});
        load.signal(SIGKILL);
        EXPECT_EQ(load.wait().status, 128 + SIGKILL);
    }
    EXPECT_TRUE(exists("phantom_rt0.sock"));
    EXPECT_EQ(run({"status"}).status, 1);
    EXPECT_EQ(run({"load", mesh, "--usermode", "--seconds", "0.1"}).status, 0);
}

TEST_F(Load, SignalsRampDownAndExitWithZero)
{
    const std::string mesh = sphere();
    for (const int signal : {SIGINT, SIGTERM}) {
        // At rest in the shell: there is a force to ramp down.
        const std::string way = write("p.csv", "time_s,x_mm,y_mm,z_mm\n0,0,0,30.4\n600,0,0,30.4\n");
        Running load = start_load({mesh, "--usermode", "--path", way, "--record", path("r.csv")});
        double force = 0;
        for (int attempt = 0; attempt < 300 && force < 0.5; ++attempt, ::usleep(10000))
            force = status()["force_magnitude_n"].get<double>();
        EXPECT_GT(force, 0.5);
        load.signal(signal);
        const Outcome outcome = load.wait();
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_NE(outcome.out.find("touched"), std::string::npos);
        // No step to zero: the last force is small, and on the way there it came down bit by bit.
        const auto rows = csv_rows(read(path("r.csv")));
        ASSERT_GT(rows.size(), 100U);
        EXPECT_LT(std::abs(rows.back()[6]), 0.1);
        for (std::size_t i = 1; i < rows.size(); ++i)
            EXPECT_LT(rows[i - 1][6] - rows[i][6], 0.2) << "row " << i;
    }
}

TEST_F(Load, APathIsDrivenAndRecorded)
{
    std::string rows;
    for (int i = 0; i <= 100; ++i)
        rows += fmt::format("{},{},0,{}\n", 0.01 * i, 0.05 * i, 30.5 + 2.0 * std::cos(0.0628 * i));
    const std::string way = write("p.csv", "time_s,x_mm,y_mm,z_mm\n" + rows);
    const Outcome outcome = run({"load", sphere(), "--usermode", "--rate", "2000", "--path", way, "--record",
                                 path("r.csv"), "--json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const std::string text = read(path("r.csv"));
    EXPECT_TRUE(text.starts_with(
        "time_s,x_mm,y_mm,z_mm,fx_N,fy_N,fz_N,contacts,inside,vx_mm,vy_mm,vz_mm,set_id,query_us,"
        "tick_ns\n"));
    const auto recorded = csv_rows(text);
    ASSERT_GT(recorded.size(), 500U);
    double largest = 0;
    for (std::size_t i = 1; i < recorded.size(); ++i) {
        EXPECT_GT(recorded[i][0], recorded[i - 1][0]) << "row " << i;
        // 0: the force came from no set.
        if (recorded[i][12] > 0) {
            EXPECT_GE(recorded[i][12], recorded[i - 1][12]) << "row " << i;
        }
        largest = std::max(largest, recorded[i][6]);
    }
    EXPECT_GT(largest, 0.3);
    // The tip went from the first row to the last.
    EXPECT_NEAR(recorded.front()[1], 0.0, 0.05);
    EXPECT_NEAR(recorded.back()[1], 5.0, 1e-3);
    EXPECT_GT(json::parse(outcome.out)["touch"]["contact_ticks"].get<int>(), 50);
}

TEST_F(Load, DetachedItRunsOnAndIsStopped)
{
    const Outcome outcome = run({"load", sphere(), "--usermode", "--detach", "--seconds", "60"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("running in the background: process "), std::string::npos) << outcome.out;
    EXPECT_EQ(status()["state"], "RUNNING");
    EXPECT_EQ(run({"stop"}).status, 0);
    EXPECT_EQ(run({"status"}).status, 1);
}

TEST_F(Load, DetachedWithBadInputItFailsInTheForeground)
{
    const Outcome outcome = run({"load", path("none.ply"), "--usermode", "--detach"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("none.ply"), std::string::npos);
}

TEST_F(Load, ASetOfCommandsAnswersInJson)
{
    const std::string mesh = sphere();
    const Outcome info = run({"info", mesh, "--json"});
    ASSERT_EQ(info.status, 0) << info.err;
    const json facts = json::parse(info.out);
    EXPECT_EQ(facts["triangles"], 2208);
    EXPECT_TRUE(facts["objects"][0]["report"]["watertight"].get<bool>());
    EXPECT_EQ(facts["effects"]["not_called_for"],
              json::array({"damping", "magnet", "friction", "texture", "height_map", "impact", "constant",
                           "viscosity", "guide", "field", "tip"}));
    EXPECT_GT(facts["tick"]["median_ns"].get<double>(), 0);
    ASSERT_EQ(facts["effects"]["costs"].size(), 1U);
    EXPECT_EQ(facts["effects"]["costs"][0]["name"], "contact");
    EXPECT_GT(facts["effects"]["costs"][0]["set_bytes"].get<int>(), 64 * 100);
    EXPECT_EQ(facts["device"]["simulated"], json::array());

    const Outcome prepared = run({"prepare", mesh, "-o", path("out.ply"), "--fit", "50", "--json"});
    ASSERT_EQ(prepared.status, 0) << prepared.err;
    EXPECT_EQ(json::parse(prepared.out)["faces"], 2208);
    const Outcome again = run({"info", path("out.ply"), "--json"});
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_NEAR(json::parse(again.out)["bounds_mm"]["high"][2].get<double>(), 25.0, 1e-6);

    const Outcome bench = run({"bench", mesh, "--queries", "200", "--json"});
    ASSERT_EQ(bench.status, 0) << bench.err;
    const json measured = json::parse(bench.out);
    EXPECT_EQ(measured["triangles"], 2208);
    EXPECT_EQ(measured["query_us"]["walk"]["count"], 200);
    EXPECT_GE(measured["ticks"].size(), 2U);
    EXPECT_EQ(measured["ticks"][0]["patches"], 64);
}

} // namespace
} // namespace phantom::test
