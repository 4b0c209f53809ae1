// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures without a display: the right size, and in them what they are of.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "picture.hpp"
#include "process.hpp"
#include "scene/motion.hpp"
#include "test_files.hpp"
#include "view/trace.hpp"

namespace phantom::view::test {
namespace {

const std::map<std::string, std::string> no_display{{"DISPLAY", ""}};

class PictureWithoutDisplay : public testing::Test {
  protected:
    void SetUp() override
    {
        if (!installed("Xvfb"))
            GTEST_SKIP() << "Xvfb is not installed (package xvfb)";
        scene_ = folder_.write("sphere.off", sphere_off());
    }
    TemporaryFolder folder_;
    std::filesystem::path scene_;
};

TEST_F(PictureWithoutDisplay, OfATraceShowsPathArrowAndSelectedTriangles)
{
    const auto trace = folder_.write("t.csv", sphere_trace());
    const Ended ended = run(fdhview({scene_, "--trace", trace, "--screenshot", folder_ / "p.png", "--chart",
                                     folder_ / "c.png", "--size", "800x500", "--json"}),
                            no_display);
    ASSERT_EQ(ended.status, 0) << ended.error;
    EXPECT_EQ(ended.error, "");

    const auto summary = nlohmann::json::parse(ended.out);
    EXPECT_EQ(summary["rows"], 400);
    // The lowest pass is in the middle: row 199 or 200, at 0.2 mm, 0.8 N.
    EXPECT_NEAR(summary["row"].get<double>(), 199.5, 0.6);
    EXPECT_NEAR(summary["force_n"].get<double>(), 0.8, 1e-3);
    EXPECT_EQ(summary["selected"], 64);

    const Picture picture = read_picture(folder_ / "p.png");
    EXPECT_EQ(picture.width, 800);
    EXPECT_EQ(picture.height, 500);
    EXPECT_GT(picture.distinct_colours(), 2000U);
    EXPECT_GT(picture.count(is_arrow), 300U);
    EXPECT_GT(picture.count(is_selected), 1000U);
    EXPECT_GT(picture.count(is_strongest), 60U);

    const Picture chart = read_picture(folder_ / "c.png");
    EXPECT_EQ(chart.width, 800);
    EXPECT_EQ(chart.height, 250);
    EXPECT_GT(chart.distinct_colours(), 50U);
}

TEST_F(PictureWithoutDisplay, AtARowWithoutForceHasNoArrow)
{
    const auto trace = folder_.write("t.csv", sphere_trace());
    const auto arrow_pixels = [&](const std::string& row) {
        const Ended ended = run(fdhview({scene_, "--trace", trace, "--at-row", row, "--screenshot",
                                         folder_ / "p.png", "--size", "800x500"}),
                                no_display);
        EXPECT_EQ(ended.status, 0) << ended.error;
        return read_picture(folder_ / "p.png").count(is_arrow);
    };
    // The legend's disc and the mark in the chart stay.
    EXPECT_GT(arrow_pixels("200"), 2 * arrow_pixels("0"));
}

/// Pixels that differ by more than shading does.
std::size_t differences(const Picture& a, const Picture& b)
{
    std::size_t count = a.pixels.size() == b.pixels.size() ? 0 : a.pixels.size();
    for (std::size_t i = 0; i < a.pixels.size() && i < b.pixels.size(); ++i)
        for (std::size_t channel = 0; channel < 3; ++channel)
            if (std::abs(a.pixels[i][channel] - b.pixels[i][channel]) > 12) {
                ++count;
                break;
            }
    return count;
}

TEST_F(PictureWithoutDisplay, OfAMovingSceneIsThatOfTheSceneWhereItHasGone)
{
    constexpr std::size_t row = 200;
    const std::string trace_text = sphere_trace();
    const auto trace_file = folder_.write("t.csv", trace_text);
    const auto trace = read_trace(trace_file);
    ASSERT_TRUE(trace.ok());
    const double t_s = trace->rows[row].time_s - trace->rows.front().time_s;
    const double frequency = 0.2 / t_s;
    const scene::Motion swing{.kind = scene::Motion::Kind::oscillation,
                              .axis = {0.6, 0.8, 0},
                              .frequency = frequency,
                              .amplitude_mm = 20,
                              .ramp_s = 0.05};
    const Vec3 gone = swing.at(t_s).offset_mm;
    ASSERT_GT(length(gone), 5);
    // Of the same name, size and number of triangles; a floor that makes the camera see both alike.
    const auto picture_of = [&](const std::string& name, const std::string& keys) {
        const auto scene = folder_.write(
            "a.toml",
            "[[object]]\nshape = \"box\"\nsize_mm = [160, 160, 2]\npose = { translation_mm = [0, 0, "
            "-40] }\n[[object]]\nmesh = \"sphere.off\"\n" +
                keys + "\n");
        const Ended ended = run(fdhview({scene, "--trace", trace_file, "--at-row", std::to_string(row),
                                         "--screenshot", folder_ / name, "--size", "800x500"}),
                                no_display);
        EXPECT_EQ(ended.status, 0) << ended.error;
        return read_picture(folder_ / name);
    };
    const Picture moved = picture_of(
        "moved.png", fmt::format("motion = {{ kind = \"oscillation\", direction = [3, 4, 0], amplitude_mm = "
                                 "20, frequency_hz = {:.17g}, ramp_s = 0.05 }}",
                                 frequency));
    const Picture there =
        picture_of("there.png", fmt::format("pose = {{ translation_mm = [{:.17g}, {:.17g}, {:.17g}] }}",
                                            gone[0], gone[1], gone[2]));
    EXPECT_LT(differences(moved, there), there.pixels.size() / 500);
    EXPECT_GT(there.pixels.size(), 0U);
}

TEST_F(PictureWithoutDisplay, LiveTheArmPressesOnTheMiddleOfTheView)
{
    const Ended ended = run(fdhview({scene_, "--usermode", "--no-control", "--seconds", "2", "--screenshot",
                                     folder_ / "p.png", "--size", "640x400", "--json"}),
                            no_display);
    ASSERT_EQ(ended.status, 0) << ended.error;
    const auto summary = nlohmann::json::parse(ended.out);
    EXPECT_EQ(summary["state"], "RUNNING") << ended.out;
    EXPECT_GT(summary["force_n"].get<double>(), 0.05) << ended.out;
    const Picture picture = read_picture(folder_ / "p.png");
    EXPECT_EQ(picture.width, 640);
    EXPECT_EQ(picture.height, 400);
    EXPECT_GT(picture.count(is_arrow), 200U);
    EXPECT_GT(picture.count(is_selected), 500U);
}

TEST_F(PictureWithoutDisplay, LiveAScriptBesideTheSceneGivesNoForce)
{
    const auto script = folder_.write("s.csv", "time_s,x,y,press,depth_mm\n0,0.02,0.9,1,0\n1,0.02,0.9,1,0\n");
    const Ended ended = run(fdhview({scene_, "--usermode", "--no-control", "--script", script, "--screenshot",
                                     folder_ / "p.png", "--size", "640x400", "--json"}),
                            no_display);
    ASSERT_EQ(ended.status, 0) << ended.error;
    EXPECT_EQ(nlohmann::json::parse(ended.out)["max_force_n"].get<double>(), 0) << ended.out;
}

/// Process numbers of the children of a process.
std::vector<pid_t> children(pid_t parent)
{
    std::ifstream in("/proc/" + std::to_string(parent) + "/task/" + std::to_string(parent) + "/children");
    return {std::istream_iterator<pid_t>(in), {}};
}

TEST_F(PictureWithoutDisplay, ThePrivateServerEndsWithTheProgramEvenWhenItIsKilled)
{
    Process process(
        fdhview({scene_, "--usermode", "--no-control", "--seconds", "60", "--screenshot", folder_ / "p.png"}),
        no_display);
    std::vector<pid_t> server;
    while (server.empty() && process.running()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        server = children(process.pid());
    }
    ASSERT_EQ(server.size(), 1U);
    kill(process.pid(), SIGKILL);
    (void)process.wait();
    // An orphan of ours is reaped by init, or stays a zombie where nobody is init: either way it does not
    // run.
    const auto runs = [&] {
        std::ifstream stat("/proc/" + std::to_string(server[0]) + "/stat");
        std::string pid, name, state;
        return static_cast<bool>(stat >> pid >> name >> state) && state != "Z";
    };
    for (int i = 0; i < 500 && runs(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_FALSE(runs());
    EXPECT_FALSE(std::filesystem::exists(folder_ / "p.png"));
}

TEST_F(PictureWithoutDisplay, SecondPictureReplacesTheFirstAndLeavesNothingElse)
{
    const auto trace = folder_.write("t.csv", sphere_trace());
    for (int i = 0; i < 2; ++i)
        ASSERT_EQ(run(fdhview({scene_, "--trace", trace, "--chart", folder_ / "c.png", "--size", "400x400"}),
                      no_display)
                      .status,
                  0);
    EXPECT_EQ(folder_.files(), 3U);
}

} // namespace
} // namespace phantom::view::test
