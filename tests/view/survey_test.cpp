// SPDX-License-Identifier: GPL-2.0-or-later
// fdhview --survey, by colours in its two views: creases dark, rims blue, faults magenta, fine triangles
// orange.
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "picture.hpp"
#include "process.hpp"
#include "view/colour.hpp"

namespace phantom::view::test {
namespace {

struct Counts {
    std::size_t crease = 0, rim = 0, fault = 0, thin = 0;
};

/// Pixels of the middle, clear of title and legend.
Counts counts_in_views(const Picture& picture)
{
    const auto is = [](const std::array<unsigned char, 3>& pixel, const Colour& colour) {
        double off = 0;
        for (std::size_t i = 0; i < 3; ++i)
            off = std::max(off, std::abs(pixel[i] / 255.0 - colour[i]));
        return off < 0.02;
    };
    Counts counts;
    for (int row = picture.height * 3 / 10; row < picture.height * 7 / 10; ++row) {
        for (int column = 0; column < picture.width; ++column) {
            const auto& pixel = picture.pixels[static_cast<std::size_t>(row * picture.width + column)];
            counts.crease += is(pixel, palette::crease);
            counts.rim += is(pixel, palette::tip);
            counts.fault += is(pixel, palette::fault);
            // Lit by lamps: vermilion's hue.
            counts.thin += has_hue({pixel[0] / 255.0, pixel[1] / 255.0, pixel[2] / 255.0}, 15, 32, 0.8);
        }
    }
    return counts;
}

class Survey : public testing::Test {
  protected:
    void SetUp() override
    {
        if (!installed("Xvfb"))
            GTEST_SKIP() << "Xvfb is not installed (package xvfb)";
    }
    Counts of(const std::string& name, const std::string& text, std::vector<std::string> more = {})
    {
        std::vector<std::string> words{folder_.write(name, text), "--no-cache", "--survey",
                                       folder_ / "p.png",         "--size",     "800x500"};
        words.insert(words.end(), more.begin(), more.end());
        const Ended ended = run(fdhview(words), {{"DISPLAY", ""}});
        EXPECT_EQ(ended.status, 0) << ended.error;
        EXPECT_EQ(ended.error, "");
        const Picture picture = read_picture(folder_ / "p.png");
        EXPECT_EQ(picture.width, 800);
        EXPECT_EQ(picture.height, 500);
        return counts_in_views(picture);
    }
    TemporaryFolder folder_;
};

TEST_F(Survey, BoxHasCreasesAndNothingElse)
{
    const Counts counts = of("box.toml", "[[object]]\nshape = \"box\"\nsize_mm = [80, 60, 40]\n");
    EXPECT_GT(counts.crease, 300U);
    EXPECT_EQ(counts.rim, 0U);
    EXPECT_EQ(counts.fault, 0U);
    EXPECT_EQ(counts.thin, 0U);
}

TEST_F(Survey, SheetHasARim)
{
    const Counts counts = of("sheet.obj", "v 0 0 0\nv 80 0 0\nv 80 60 0\nv 0 60 0\nf 1 2 3 4\n");
    EXPECT_GT(counts.rim, 500U);
    EXPECT_EQ(counts.crease, 0U);
    EXPECT_EQ(counts.fault, 0U);
}

TEST_F(Survey, EdgeOfThreeFacesIsAFaultUnlessPrepared)
{
    const std::string fin =
        "v 0 0 0\nv 0 60 0\nv 50 30 0\nv -50 30 0\nv 0 30 50\nf 1 3 2\nf 1 2 4\nf 1 2 5\n";
    EXPECT_GT(of("fin.obj", fin, {"--prepare", "none"}).fault, 60U);
    EXPECT_EQ(of("fin.obj", fin).fault, 0U);
}

TEST_F(Survey, FineTrianglesAreOrange)
{
    const auto sphere = [this](const std::string& chord_mm) {
        return of("sphere.toml",
                  "[[object]]\nshape = \"sphere\"\nradius_mm = 40\nchord_mm = " + chord_mm + "\n");
    };
    EXPECT_EQ(sphere("0.5").thin, 0U);
    EXPECT_GT(sphere("0.002").thin, 1000U);
}

TEST_F(Survey, FdhctlDrawsItAfterItsReport)
{
    const std::string fdhctl = std::filesystem::path(PHANTOM_FDHVIEW).replace_filename("fdhctl");
    const auto sheet = folder_.write("sheet.obj", "v 0 0 0\nv 80 0 0\nv 80 60 0\nv 0 60 0\nf 1 2 3 4\n");
    const std::vector<std::vector<std::string>> commands{
        {fdhctl, "info", sheet, "--no-cache"}, {fdhctl, "prepare", sheet, "-o", folder_ / "out.ply"}};
    for (std::vector<std::string> command : commands) {
        const auto picture = folder_ / (command[1] + ".png");
        command.insert(command.end(), {"--split", "30", "--picture", picture});
        const Ended ended = run(command, {{"DISPLAY", ""}});
        EXPECT_EQ(ended.status, 0) << ended.error;
        EXPECT_NE(ended.out.find("1 rim,"), std::string::npos) << "the report was lost: " << ended.out;
        EXPECT_GT(counts_in_views(read_picture(picture)).rim, 500U);
    }
}

TEST_F(Survey, WhatCannotBeIsTold)
{
    const auto scene = folder_.write("box.toml", "[[object]]\nshape = \"box\"\nsize_mm = [8, 6, 4]\n");
    const Ended nowhere = run(fdhview({scene, "--survey", "/nonexistent/p.png"}), {{"DISPLAY", ""}});
    EXPECT_EQ(nowhere.status, 1);
    EXPECT_EQ(nowhere.error,
              "fdhview: /nonexistent/p.png: the folder /nonexistent does not exist (create it first)\n");
    EXPECT_EQ(run(fdhview({scene, "--survey", folder_ / "p.png", "--feed-rate", "0"})).status, 2);
}

} // namespace
} // namespace phantom::view::test
