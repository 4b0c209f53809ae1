// SPDX-License-Identifier: GPL-2.0-or-later
// Help, exit status and usage errors of every command.
#include <algorithm>

#include "program.hpp"

namespace phantom::test {
namespace {

class Usage : public Program {
  protected:
    void expect_usage_error(const std::vector<std::string>& arguments, const std::string& words)
    {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.status, 2) << outcome.err;
        EXPECT_TRUE(outcome.err.starts_with("fdhctl: ")) << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
        EXPECT_TRUE(outcome.out.empty()) << outcome.out;
    }
};

TEST_F(Usage, EveryCommandHasHelp)
{
    const Outcome all = run({"--help"});
    EXPECT_EQ(all.status, 0);
    for (const char* command : {"load", "status", "rate", "model", "effect", "stop", "info", "prepare",
                                "stroke", "trace", "record", "replay", "bench", "devices", "view"}) {
        EXPECT_NE(all.out.find(std::string("\n  ") + command), std::string::npos) << command;
        const Outcome outcome = run({command, "--help"});
        EXPECT_EQ(outcome.status, 0) << command;
        EXPECT_NE(outcome.out.find("Usage: "), std::string::npos) << command;
        EXPECT_TRUE(outcome.err.empty()) << outcome.err;
    }
}

TEST_F(Usage, VersionIsPrinted)
{
    const Outcome outcome = run({"--version"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(outcome.out.starts_with("fdhctl ")) << outcome.out;
}

TEST_F(Usage, WrongUseIsStatusTwoAndOneLine)
{
    const std::string mesh = plate();
    expect_usage_error({}, "subcommand");
    expect_usage_error({"fly"}, "fly");
    expect_usage_error({"load"}, "scene");
    expect_usage_error({"load", mesh, "--frobnicate"}, "--frobnicate");
    expect_usage_error({"load", mesh, "--rate", "500"}, "500");
    expect_usage_error({"load", mesh, "--radius", "0"}, "above 0");
    expect_usage_error({"load", mesh, "--radius", "nan"}, "above 0");
    expect_usage_error({"load", mesh, "--view", "--detach"}, "--view");
    expect_usage_error({"trace", mesh}, "--path");
    expect_usage_error({"trace", mesh, "--path", "p.csv", "--model", "magic"}, "magic");
    expect_usage_error({"trace", mesh, "--path", "p.csv", "--steps", "4"}, "4");
    expect_usage_error({"trace", mesh, "--path", "p.csv", "--budget", "some"}, "some");
    expect_usage_error({"trace", mesh, "--path", "p.csv", "--budget", "0"}, "0");
    expect_usage_error({"trace", mesh, "--path", "p.csv", "--budget", "513"}, "513");
    expect_usage_error({"trace", mesh, "--path", "p.csv", "--feed-every", "0"}, "0");
    expect_usage_error({"load", mesh, "--budget", "all"}, "all");
    expect_usage_error({"rate"}, "rate");
    expect_usage_error({"rate", "12"}, "12");
    expect_usage_error({"model"}, "model");
    expect_usage_error({"prepare", mesh}, "--output");
    expect_usage_error({"stroke", mesh}, "--output");
    expect_usage_error({"view"}, "SCENE");
}

TEST_F(Usage, WithoutASessionStatusRateModelAndStopSaySo)
{
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"status"}, {"rate", "2000"}, {"model", "paper"}, {"effect"}, {"stop"}}) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.status, 1) << arguments[0];
        EXPECT_EQ(outcome.err, "fdhctl: nothing is running (fdhctl load SCENE starts it)\n");
        EXPECT_TRUE(outcome.out.empty());
    }
}

TEST_F(Usage, DevicesIsHonestAboutHardware)
{
    const Outcome outcome = run({"devices"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_NE(outcome.out.find("/dev/phantom_rt0"), std::string::npos);
    EXPECT_NE(outcome.out.find("simulated"), std::string::npos);
    EXPECT_NE(outcome.out.find("no back end yet for the Novint Falcon"), std::string::npos);
}

} // namespace
} // namespace phantom::test
