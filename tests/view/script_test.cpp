// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/script.hpp"

#include <gtest/gtest.h>

#include "temporary_folder.hpp"

namespace phantom::view {
namespace {

using test::TemporaryFolder;

TEST(Script, MovesLinearlyBetweenRowsAndHoldsAtBothEnds)
{
    const TemporaryFolder folder;
    const auto script = read_script(
        folder.write("s.csv", std::string(script_header) + "\n1,0,0,0,0\n2,1,0.5,1,4\n3,1,1,0,0\n"));
    ASSERT_TRUE(script.ok()) << script.error().text();
    EXPECT_DOUBLE_EQ(script->at(0).x, 0);
    EXPECT_FALSE(script->at(1.5).press);
    EXPECT_DOUBLE_EQ(script->at(1.5).x, 0.5);
    EXPECT_DOUBLE_EQ(script->at(1.5).y, 0.25);
    EXPECT_DOUBLE_EQ(script->at(1.5).depth_mm, 2);
    EXPECT_TRUE(script->at(2.5).press);
    EXPECT_DOUBLE_EQ(script->at(9).y, 1);
    EXPECT_FALSE(script->at(9).press);
}

TEST(Script, RefusesTimeThatStandsStillAndAPressThatIsNeither)
{
    const TemporaryFolder folder;
    const std::string header = std::string(script_header) + "\n";
    const auto still = read_script(folder.write("a.csv", header + "1,0,0,0,0\n1,0,0,0,0\n"));
    ASSERT_FALSE(still.ok());
    EXPECT_NE(still.error().text().find("a.csv:3: column time_s"), std::string::npos);
    const auto press = read_script(folder.write("b.csv", header + "1,0,0,0.5,0\n"));
    ASSERT_FALSE(press.ok());
    EXPECT_NE(press.error().text().find("b.csv:2: column press"), std::string::npos);
}

} // namespace
} // namespace phantom::view
