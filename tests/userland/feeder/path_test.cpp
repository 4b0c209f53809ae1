// SPDX-License-Identifier: GPL-2.0-or-later
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include <gtest/gtest.h>

#include "feeder/path.hpp"

namespace phantom::test {
namespace {

class PathFile : public ::testing::Test {
  protected:
    PathFile()
        : file_(std::filesystem::temp_directory_path() /
                ("phantom_path_" + std::to_string(::getpid()) + ".csv"))
    {
    }
    ~PathFile() override { std::filesystem::remove(file_); }
    Result<feeder::Path> read(const std::string& text)
    {
        std::ofstream(file_, std::ios::binary) << text;
        return feeder::read_path(file_);
    }
    /// The error of a file whose trouble is in that line.
    void expect_error(const std::string& text, const std::string& line, const std::string& words)
    {
        const Result<feeder::Path> path = read(text);
        ASSERT_FALSE(path.ok()) << text;
        EXPECT_EQ(path.error().where, line.empty() ? file_.string() : file_.string() + ":" + line) << text;
        EXPECT_NE(path.error().what.find(words), std::string::npos) << path.error().what;
    }
    std::filesystem::path file_;
};

const std::string header = "time_s,x_mm,y_mm,z_mm\n";

TEST_F(PathFile, ReadsRowsWithAnyLineEnd)
{
    for (const char* end : {"\n", "\r\n"}) {
        const std::string e = end;
        const auto path = read("time_s,x_mm,y_mm,z_mm" + e + "0,1,-2.5,3e1" + e + "0.5, 4 ,5,+6" + e);
        ASSERT_TRUE(path.ok()) << path.error().text();
        ASSERT_EQ(path->size(), 2U);
        EXPECT_EQ((*path)[0].tip_mm, (std::array<double, 3>{1, -2.5, 30}));
        EXPECT_EQ((*path)[1].time_s, 0.5);
        EXPECT_EQ((*path)[1].tip_mm, (std::array<double, 3>{4, 5, 6}));
    }
}

TEST_F(PathFile, BadRowsNameTheirLine)
{
    expect_error("", "", "empty");
    expect_error(header, "", "no row");
    expect_error("t,x,y,z\n0,0,0,0\n", "1", "header");
    expect_error("0,0,0,0\n1,0,0,0\n", "1", "header");
    expect_error(header + "0,0,0\n", "2", "4 columns");
    expect_error(header + "0,0,0,0\n1,0,0,0,0\n", "3", "4 columns");
    expect_error(header + "0,0,0,0\n\n1,0,0,0\n", "3", "empty line");
    expect_error(header + "0,0,zero,0\n", "2", "y_mm");
    expect_error(header + "0,0,1.5mm,0\n", "2", "number");
    expect_error(header + "0,,0,0\n", "2", "x_mm");
    expect_error(header + "0,0,0,nan\n", "2", "finite");
    expect_error(header + "0,0,0,inf\n", "2", "finite");
    expect_error(header + "0,0,0,1e300\n", "2", "at most");
    expect_error(header + "0,0,0,0\n1,0,0,0\n1,0,0,0\n", "4", "increase");
    expect_error(header + "1,0,0,0\n0.5,0,0,0\n", "3", "increase");
}

TEST_F(PathFile, MissingFileAndFolderAreTold)
{
    EXPECT_FALSE(feeder::read_path("/nonexistent/p.csv").ok());
    const auto folder = feeder::read_path(std::filesystem::temp_directory_path());
    ASSERT_FALSE(folder.ok());
    EXPECT_NE(folder.error().what.find("directory"), std::string::npos);
}

TEST_F(PathFile, WhatIsWrittenIsReadBack)
{
    const feeder::Path path{{0, {0.123456789, -1e-6, 120}}, {0.001, {1.5, 2.25, -3.125}}};
    const auto back = read(feeder::path_text(path));
    ASSERT_TRUE(back.ok());
    for (std::size_t i = 0; i < path.size(); ++i)
        EXPECT_EQ((*back)[i].tip_mm, path[i].tip_mm);
}

TEST(Path, PositionIsLinearBetweenRowsAndHeldOutside)
{
    const feeder::Path path{{1, {0, 0, 0}}, {2, {10, -10, 0}}, {4, {10, 10, 0}}};
    EXPECT_EQ(feeder::position_at(path, 0), path[0].tip_mm);
    EXPECT_EQ(feeder::position_at(path, 1.25), (std::array<double, 3>{2.5, -2.5, 0}));
    EXPECT_EQ(feeder::position_at(path, 3), (std::array<double, 3>{10, 0, 0}));
    EXPECT_EQ(feeder::position_at(path, 9), path[2].tip_mm);
}

} // namespace
} // namespace phantom::test
