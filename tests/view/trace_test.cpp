// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/trace.hpp"

#include <gtest/gtest.h>

#include "temporary_folder.hpp"

namespace phantom::view {
namespace {

using test::TemporaryFolder;

const std::string header = std::string(trace_header) + "\n";
const std::string row_at_0 = "0,1,2,3,0,0,0,0,0,1,2,3,1,12.5,900\n";
const std::string row_at_1 = "0.001,1,2,2.5,0.3,0,0.4,2,1,1,2,3,7,12.5,900\n";

/// The error text of a trace with that content; empty when it was read.
std::string refusal(const std::string& text)
{
    const TemporaryFolder folder;
    const auto read = read_trace(folder.write("t.csv", text));
    if (read)
        return {};
    const std::string prefix = (folder / "t.csv").string();
    EXPECT_EQ(read.error().text().rfind(prefix, 0), 0U) << read.error().text();
    return read.error().text().substr(prefix.size());
}

TEST(Trace, EveryColumnArrivesWhereItBelongs)
{
    const TemporaryFolder folder;
    const auto trace = read_trace(folder.write("t.csv", header + row_at_0 + row_at_1));
    ASSERT_TRUE(trace.ok()) << trace.error().text();
    ASSERT_EQ(trace->rows.size(), 2U);
    const Touch& touch = trace->rows[1];
    EXPECT_DOUBLE_EQ(touch.time_s, 0.001);
    EXPECT_EQ(touch.tip_mm, (Vec3{1, 2, 2.5}));
    EXPECT_EQ(touch.force_n, (Vec3{0.3, 0, 0.4}));
    EXPECT_EQ(touch.contacts, 2U);
    EXPECT_TRUE(touch.inside);
    EXPECT_EQ(touch.proxy_mm, (Vec3{1, 2, 3}));
    EXPECT_NEAR(touch.force_norm_n(), 0.5, 1e-15);
    EXPECT_EQ(trace->strongest(), 1U);
    EXPECT_NEAR(trace->max_force_n(), 0.5, 1e-15);
}

TEST(Trace, InsideTheQueryIsRoundTheMiddleOfTipAndProxy)
{
    Touch touch;
    touch.tip_mm = {0, 0, -1};
    touch.proxy_mm = {0, 0, 1};
    touch.inside = true;
    EXPECT_EQ(touch.query_centre_mm(), (Vec3{0, 0, 0}));
    touch.inside = false;
    EXPECT_EQ(touch.query_centre_mm(), touch.tip_mm);
}

TEST(Trace, LinesMayEndAsOnWindowsAndTheLastWithoutAnEnd)
{
    std::string text = header + row_at_0 + row_at_1;
    for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2)
        text.replace(at, 1, "\r\n");
    EXPECT_EQ(refusal(text), "");
    EXPECT_EQ(refusal(header + "0,1,2,3,0,0,0,0,0,1,2,3,1,12.5,900"), "");
}

TEST(Trace, WhatIsWrongIsToldWithItsLineAndColumn)
{
    EXPECT_EQ(refusal(""), ": is empty, expected a trace CSV file");
    EXPECT_EQ(refusal("time_s,x_mm,y_mm,z_mm\n0,0,0,0\n").rfind(":1: not a trace, expected the columns ", 0),
              0U);
    EXPECT_EQ(refusal(header), ": has no rows");
    EXPECT_EQ(refusal(header + row_at_0 + "0.001,1,2\n"), ":3: 3 columns, expected 15");
    EXPECT_EQ(refusal(header + "0,1,2,3,0,0,0,0,0,1,2,3,1,12.5,900,5\n"), ":2: 16 columns, expected 15");
    EXPECT_EQ(refusal(header + "0,1,two,3,0,0,0,0,0,1,2,3,1,12.5,900\n"),
              ":2: column y_mm: 'two' is not a finite number");
    EXPECT_EQ(refusal(header + "0,1,2,nan,0,0,0,0,0,1,2,3,1,12.5,900\n"),
              ":2: column z_mm: 'nan' is not a finite number");
    EXPECT_EQ(refusal(header + "0,1,2,3,1e999,0,0,0,0,1,2,3,1,12.5,900\n"),
              ":2: column fx_N: '1e999' is not a finite number");
    EXPECT_EQ(refusal(header + "0,1,2,3,0,0,0,1.5,0,1,2,3,1,12.5,900\n"),
              ":2: column contacts: 1.5 is not a count");
    EXPECT_EQ(refusal(header + "0,1,2,3,0,0,0,-1,0,1,2,3,1,12.5,900\n"),
              ":2: column contacts: -1 is not a count");
    EXPECT_EQ(refusal(header + "0,1,2,3,0,0,0,1,2,1,2,3,1,12.5,900\n"),
              ":2: column inside: 2 is neither 0 nor 1");
    EXPECT_EQ(refusal(header + row_at_1 + row_at_0), ":3: column time_s: time runs backward");
}

TEST(Trace, MissingFileAndDirectoryAreToldApart)
{
    const TemporaryFolder folder;
    EXPECT_NE(read_trace(folder / "none.csv").error().text().find("no such trace file"), std::string::npos);
    EXPECT_NE(read_trace(folder.path()).error().text().find("is a directory"), std::string::npos);
}

} // namespace
} // namespace phantom::view
