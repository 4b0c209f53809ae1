// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl cache, and what the other commands do with what it shows.
#include <cstdlib>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace phantom::test {
namespace {

class CacheCommand : public Program {
  protected:
    nlohmann::json cache(std::vector<std::string> words = {}) const
    {
        words.insert(words.begin(), "cache");
        words.emplace_back("--json");
        const Outcome outcome = run(words);
        return nlohmann::json::parse(outcome.out, nullptr, false);
    }
};

TEST_F(CacheCommand, ListsWhatWasPreparedAndPrunesIt)
{
    const std::string mesh = sphere();
    EXPECT_EQ(cache()["entries"].size(), 0U);
    ASSERT_EQ(run({"info", mesh, "--levels", "off"}).status, 0);
    ASSERT_EQ(run({"info", mesh, "--levels", "off"}).status, 0);
    const nlohmann::json list = cache();
    ASSERT_EQ(list["entries"].size(), 1U);
    EXPECT_EQ(list["entries"][0]["source"], mesh);
    EXPECT_EQ(list["entries"][0]["triangles"], 2 * 48 * 23);
    EXPECT_EQ(list["directory"], path("phantom_rt"));
    EXPECT_EQ(cache({"prune"})["entries"].size(), 0U);
    EXPECT_EQ(cache({"prune", "--all"})["entries"].size(), 1U);
    EXPECT_EQ(cache()["entries"].size(), 0U);
}

TEST_F(CacheCommand, NoCacheLeavesNothing)
{
    ASSERT_EQ(run({"info", sphere(), "--no-cache"}).status, 0);
    EXPECT_FALSE(exists("phantom_rt"));
}

TEST_F(CacheCommand, TheReportIsTheSameFromTheCache)
{
    const std::string mesh = plate();
    const auto report = [&] { return nlohmann::json::parse(run({"info", mesh, "--json"}).out)["objects"]; };
    const nlohmann::json first = report();
    EXPECT_EQ(cache()["entries"].size(), 1U);
    EXPECT_EQ(report(), first);
}

TEST_F(CacheCommand, ChangedFilesAreFoundSaidAndReplaced)
{
    const std::string mesh = sphere();
    ASSERT_EQ(run({"info", mesh, "--levels", "off"}).status, 0);
    const std::string file = cache()["entries"][0]["file"];
    std::string bytes = read(file);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    std::filesystem::remove(file);
    write(std::filesystem::relative(file, folder_), bytes);
    EXPECT_EQ(run({"cache"}).status, 0);
    const Outcome check = run({"cache", "check"});
    EXPECT_EQ(check.status, 1);
    EXPECT_NE(check.out.find("has changed since it was written"), std::string::npos) << check.out;
    const Outcome again = run({"info", mesh, "--levels", "off"});
    EXPECT_EQ(again.status, 0);
    EXPECT_NE(again.err.find("prepared again"), std::string::npos) << again.err;
    EXPECT_EQ(run({"cache", "check"}).status, 0);
}

TEST_F(CacheCommand, WithoutAHomeItSaysSo)
{
    ::unsetenv("XDG_CACHE_HOME");
    const char* home = std::getenv("HOME");
    const std::string kept = home ? home : "";
    ::unsetenv("HOME");
    const Outcome none = run({"cache"});
    EXPECT_EQ(none.status, 1);
    EXPECT_NE(none.err.find("XDG_CACHE_HOME"), std::string::npos) << none.err;
    EXPECT_EQ(run({"info", sphere()}).status, 0);
    if (home)
        ::setenv("HOME", kept.c_str(), 1);
}

} // namespace
} // namespace phantom::test
