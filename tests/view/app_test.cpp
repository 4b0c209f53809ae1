// SPDX-License-Identifier: GPL-2.0-or-later
// What a user gets who asks for something that cannot be: one line, exit status 1, nothing written.
#include <algorithm>

#include <gtest/gtest.h>

#include "process.hpp"
#include "test_files.hpp"
#include "view/trace.hpp"

namespace phantom::view::test {
namespace {

const std::map<std::string, std::string> no_display{{"DISPLAY", ""}};

/// Expects status 1 and one line that contains `words`; also that nothing new lies in the folder.
void expect_refusal(const TemporaryFolder& folder, const std::vector<std::string>& arguments,
                    const std::string& words, std::map<std::string, std::string> environment = no_display)
{
    const std::size_t files = folder.files();
    const Ended ended = run(fdhview(arguments), environment);
    EXPECT_EQ(ended.status, 1) << ended.error;
    EXPECT_NE(ended.error.find(words), std::string::npos) << ended.error;
    EXPECT_EQ(std::count(ended.error.begin(), ended.error.end(), '\n'), 1) << ended.error;
    EXPECT_EQ(ended.error.rfind("fdhview: ", 0), 0U) << ended.error;
    EXPECT_EQ(folder.files(), files);
}

TEST(Refusal, SceneThatIsMissing)
{
    const TemporaryFolder folder;
    const auto scene = folder / "none.ply";
    expect_refusal(folder, {scene, "--screenshot", folder / "p.png"}, scene.string() + ": no such file");
}

TEST(Refusal, NoDisplayAndNoPictureAskedFor)
{
    const TemporaryFolder folder;
    const auto scene = folder.write("sphere.off", sphere_off());
    expect_refusal(folder, {scene, "--usermode"}, "--screenshot FILE.png");
    expect_refusal(folder, {scene, "--usermode"}, "the X display :4242 cannot be opened",
                   {{"DISPLAY", ":4242"}});
}

TEST(Refusal, NeitherDisplayNorXvfbNamesThePackage)
{
    const TemporaryFolder folder;
    const auto scene = folder.write("sphere.off", sphere_off());
    expect_refusal(folder, {scene, "--screenshot", folder / "p.png"}, "sudo apt install xvfb",
                   {{"DISPLAY", ""}, {"PATH", folder.path()}});
}

TEST(Refusal, PictureIntoAFolderThatIsNotThere)
{
    const TemporaryFolder folder;
    const auto scene = folder.write("sphere.off", sphere_off());
    expect_refusal(folder, {scene, "--screenshot", folder / "none" / "p.png"}, "does not exist");
    expect_refusal(folder, {scene, "--screenshot", folder.path()}, "is a directory");
}

class RefusalOffscreen : public testing::Test {
  protected:
    void SetUp() override
    {
        if (!installed("Xvfb"))
            GTEST_SKIP() << "Xvfb is not installed (package xvfb)";
    }
    TemporaryFolder folder_;
};

TEST_F(RefusalOffscreen, TraceWithABadRowNamesItsLine)
{
    const auto scene = folder_.write("sphere.off", sphere_off());
    const auto trace = folder_.write("t.csv", std::string(trace_header) + "\n1,2,3\n");
    expect_refusal(folder_, {scene, "--trace", trace, "--screenshot", folder_ / "p.png"},
                   trace.string() + ":2: 3 columns, expected 15");
}

TEST_F(RefusalOffscreen, RowBeyondTheTrace)
{
    const auto scene = folder_.write("sphere.off", sphere_off());
    const auto trace = folder_.write("t.csv", sphere_trace());
    expect_refusal(folder_, {scene, "--trace", trace, "--at-row", "400", "--screenshot", folder_ / "p.png"},
                   "--at-row 400: the trace has 400 rows");
}

TEST_F(RefusalOffscreen, SceneThatIsNoMesh)
{
    const auto scene = folder_.write("broken.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n");
    expect_refusal(folder_, {scene, "--usermode", "--no-control", "--screenshot", folder_ / "p.png"},
                   "broken.off");
}

} // namespace
} // namespace phantom::view::test
