// SPDX-License-Identifier: GPL-2.0-or-later
// The window, a mouse and a keyboard: dragged with xdotool on a private X server.
#include <chrono>
#include <csignal>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "feeder/control_socket.hpp"
#include "picture.hpp"
#include "process.hpp"
#include "test_files.hpp"
#include "view/display.hpp"

namespace phantom::view::test {
namespace {

using nlohmann::json;

constexpr auto patience = std::chrono::seconds(60);

class Window : public testing::Test {
  protected:
    void SetUp() override
    {
        for (const char* program : {"Xvfb", "xdotool"})
            if (!installed(program))
                GTEST_SKIP() << program << " is not installed";
        unsetenv("DISPLAY");
        auto display = Display::acquire(Display::Need::offscreen, 1280, 1024);
        ASSERT_TRUE(display.ok()) << display.error().text();
        display_.emplace(std::move(*display));
        setenv("XDG_RUNTIME_DIR", folder_.path().c_str(), 1);
        const auto scene = folder_.write("sphere.off", sphere_off());
        process_.emplace(fdhview({scene, "--usermode", "--window", "--size", "800x500", "--json",
                                  "--screenshot", folder_ / "p.png"}),
                         std::map<std::string, std::string>{});
        const Ended found =
            run({"timeout", "60", "xdotool", "search", "--sync", "--onlyvisible", "--name", "fdhview"});
        ASSERT_EQ(found.status, 0) << found.error;
        window_ = found.out.substr(0, found.out.find('\n'));
        ASSERT_TRUE(until([](const json& s) { return s["state"] == "RUNNING"; }));
    }
    void TearDown() override
    {
        process_.reset(); // before its display
        display_.reset();
    }

    static void xdotool(std::vector<std::string> words)
    {
        words.insert(words.begin(), "xdotool");
        const Ended ended = run(words);
        EXPECT_EQ(ended.status, 0) << ended.error;
        // As a hand does it: the window sees each event before the next.
        std::this_thread::sleep_for(std::chrono::milliseconds(60));
    }
    void move(int x, int y) const
    {
        xdotool({"mousemove", "--window", window_, std::to_string(x), std::to_string(y)});
    }

    static json status()
    {
        const auto answer = feeder::control::request(R"({"command": "status"})");
        return answer ? json::parse(*answer) : json::object();
    }
    /// Waits for the session to say so.
    static bool until(const std::function<bool(const json&)>& is)
    {
        const auto begin = std::chrono::steady_clock::now();
        while (std::chrono::steady_clock::now() - begin < patience) {
            const json now = status();
            if (now.contains("state") && is(now))
                return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        ADD_FAILURE() << status().dump();
        return false;
    }
    static bool pressed(const json& s) { return s["force_magnitude_n"].get<double>() > 0.1; }
    static bool free(const json& s) { return s["force_magnitude_n"].get<double>() == 0; }

    TemporaryFolder folder_;
    std::optional<Display> display_;
    std::optional<Process> process_;
    std::string window_;
    /// Where the sphere's middle is in a window of 800 x 500: the whole view is the left 63 %.
    static constexpr int middle_x = 252, middle_y = 255;
};

TEST_F(Window, APressOnTheSurfaceGivesForceAndADragMovesTheTip)
{
    EXPECT_TRUE(free(status()));
    move(middle_x, middle_y);
    xdotool({"mousedown", "1"});
    ASSERT_TRUE(until(pressed));
    const auto before = status()["tip_mm"].get<std::vector<double>>();

    // 30 pixels to the left, over a sphere that falls off: the wheel keeps the tip on it.
    for (int x = middle_x; x >= middle_x - 30; x -= 5)
        move(x, middle_y);
    for (int i = 0; i < 8; ++i)
        xdotool({"click", "4"});
    ASSERT_TRUE(until([&](const json& s) {
        const auto tip = s["tip_mm"].get<std::vector<double>>();
        return std::hypot(tip[0] - before[0], tip[1] - before[1], tip[2] - before[2]) > 2;
    }));
    ASSERT_TRUE(until(pressed));
    xdotool({"mouseup", "1"});

    xdotool({"key", "q"});
    const Ended ended = process_->wait();
    EXPECT_EQ(ended.status, 0) << ended.error;
    EXPECT_GT(json::parse(ended.out)["max_force_n"].get<double>(), 0.1) << ended.out;
    EXPECT_GT(json::parse(ended.out)["frames"].get<int>(), 1) << ended.out;
    const Picture picture = read_picture(folder_ / "p.png");
    EXPECT_EQ(picture.width, 800);
    EXPECT_EQ(picture.height, 500);
    EXPECT_GT(picture.distinct_colours(), 1000U);
    EXPECT_GT(picture.count(is_arrow), 200U);
    EXPECT_GT(picture.count(is_selected), 500U);
}

TEST_F(Window, SpaceTakesTheForceAwayAndGivesItBack)
{
    move(middle_x, middle_y);
    xdotool({"mousedown", "1"});
    ASSERT_TRUE(until(pressed));
    xdotool({"mouseup", "1"});
    xdotool({"key", "space"});
    ASSERT_TRUE(until([](const json& s) { return s["state"] == "IDLE" && free(s); }));
    xdotool({"key", "space"});
    ASSERT_TRUE(until([](const json& s) { return s["state"] == "RUNNING"; }));
}

TEST_F(Window, TheWheelPressesHarder)
{
    move(middle_x, middle_y);
    xdotool({"mousedown", "1"});
    ASSERT_TRUE(until(pressed));
    xdotool({"mouseup", "1"});
    for (int i = 0; i < 3; ++i)
        xdotool({"key", "Up"});
    // The hand's spring goes 1.5 mm farther in: more than twice the first touch's force.
    ASSERT_TRUE(until([](const json& s) { return s["force_magnitude_n"].get<double>() > 0.55; }));
    for (int i = 0; i < 8; ++i)
        xdotool({"click", "5"});
    ASSERT_TRUE(until(free));
}

TEST_F(Window, CtrlCEndsItInOrder)
{
    kill(process_->pid(), SIGINT);
    const Ended ended = process_->wait();
    EXPECT_EQ(ended.status, 0) << ended.error;
    EXPECT_EQ(read_picture(folder_ / "p.png").width, 800);
}

TEST_F(Window, StopOverTheControlSocketEndsIt)
{
    const auto answer = feeder::control::request(R"({"command": "stop"})");
    ASSERT_TRUE(answer.ok()) << answer.error().text();
    EXPECT_EQ(process_->wait().status, 0);
}

} // namespace
} // namespace phantom::view::test
