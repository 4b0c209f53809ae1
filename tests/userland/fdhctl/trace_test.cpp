// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl trace against forces known on paper.
#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace phantom::test {
namespace {

/// Columns of a trace.
enum Column { time_s, x, y, z, fx, fy, fz, contacts, inside, vx, vy, vz, set_id, query_us, tick_ns, columns };

const std::string path_header = "time_s,x_mm,y_mm,z_mm\n";

/// The trace without its two columns of measured times.
std::string without_times(const std::string& csv)
{
    std::istringstream lines(csv);
    std::string line, out;
    while (std::getline(lines, line))
        out += line.substr(0, line.rfind(',', line.rfind(',') - 1)) + "\n";
    return out;
}

class Trace : public Program {
  protected:
    std::vector<std::vector<double>> trace(const std::string& mesh, const std::string& rows,
                                           std::vector<std::string> more = {})
    {
        const std::string way = write("p.csv", path_header + rows);
        std::vector<std::string> words{"trace", mesh, "--path", way};
        words.insert(words.end(), more.begin(), more.end());
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        text = outcome.out;
        return csv_rows(outcome.out);
    }
    std::string text;
};

/// Down on a plate from 3 mm above it to 1 mm below it and up again, sideways a little.
std::string dip()
{
    std::string rows;
    for (int i = 0; i <= 400; ++i)
        rows += fmt::format("{:.6f},{:.9f},1.3,{:.9f}\n", 0.001 * i, 2.1 + 0.0001 * i,
                            1.0 + 2.0 * std::cos(0.0157 * i));
    return rows;
}

TEST_F(Trace, APlateGivesStiffnessTimesNearness)
{
    for (const char* model : {"paper", "projected"}) {
        const auto rows = trace(plate(), dip(), {"--model", model, "--radius", "1.5", "--stiffness", "0.8"});
        ASSERT_EQ(rows.size(), 401U);
        int outside = 0, below = 0;
        for (const auto& row : rows) {
            ASSERT_EQ(row.size(), std::size_t{columns});
            // Outside k (R - h), below k (R + depth): one line without a step.
            const double expected = 0.8 * std::max(0.0, 1.5 - row[z]);
            EXPECT_NEAR(row[fz], expected, 2e-5) << model << " z " << row[z];
            // The proxy stays where the tip came in while it goes down, so sideways there is the lag's pull.
            EXPECT_NEAR(row[fx], row[inside] != 0 ? 0.8 * (row[vx] - row[x]) : 0.0, 2e-5);
            EXPECT_NEAR(row[fy], 0, 2e-5);
            EXPECT_EQ(row[inside], row[z] < 0 ? 1 : 0) << "z " << row[z];
            EXPECT_EQ(row[contacts] > 0, expected > 0) << "z " << row[z];
            if (row[inside] != 0) {
                EXPECT_NEAR(row[vz], 0, 2e-6);
                ++below;
            } else {
                EXPECT_EQ(row[vz], row[z]);
                outside += expected > 0;
            }
        }
        EXPECT_GT(outside, 60);
        EXPECT_GT(below, 50);
    }
}

/// At 1 um a tick out over the rim of the open plate, touching it and pressed in, and back.
TEST_F(Trace, TheForceOfAPlateFadesBeforeItsRim)
{
    for (const char* model : {"paper", "projected"}) {
        for (const double height : {0.4, -0.2}) {
            std::string rows;
            for (int i = 0; i <= 3200; ++i)
                rows += fmt::format("{:.6f},{:.9f},1.3,{:.9f}\n", 0.001 * i, 8.0 + 0.0007 * std::min(i, 3000),
                                    std::max(height, 2.0 - 0.01 * i));
            const auto out =
                trace(plate(), rows, {"--model", model, "--radius", "1.5", "--stiffness", "0.8"});
            ASSERT_EQ(out.size(), 3201U);
            int faded = 0;
            for (std::size_t i = 1; i < out.size(); ++i) {
                const auto& row = out[i];
                const double away = 10.0 - row[row[inside] != 0 ? vx : x];
                const double part = std::clamp(away / 1.5, 0.0, 1.0);
                EXPECT_NEAR(row[fz], 0.8 * std::max(0.0, 1.5 - row[z]) * part, 2e-5)
                    << model << " x " << row[x];
                EXPECT_LE(std::abs(row[fz] - out[i - 1][fz]), 0.8 * (0.01 + 0.001)) << "x " << row[x];
                faded += part < 1 && part > 0;
            }
            EXPECT_GT(faded, 1000);
            EXPECT_LE(std::abs(out.back()[fz]), 2e-3) << "beyond the rim";
        }
    }
}

TEST_F(Trace, ASphereWithRadialNormalsPushesRadially)
{
    std::string rows;
    for (int i = 0; i < 500; ++i) {
        const double turn = 0.01 * i, distance = 31.0 + 0.9 * std::sin(0.05 * i);
        rows += fmt::format("{},{:.9f},{:.9f},{:.9f}\n", 0.001 * i, distance * std::cos(turn) * std::sin(1.1),
                            distance * std::sin(turn) * std::sin(1.1), distance * std::cos(1.1));
    }
    const auto out = trace(sphere(), rows, {"--radius", "2", "--prepare", "none", "--model", "projected"});
    ASSERT_EQ(out.size(), 500U);
    for (const auto& row : out) {
        const double distance = std::hypot(row[x], row[y], row[z]),
                     size = std::hypot(row[fx], row[fy], row[fz]);
        // The facets lie up to 30 mm (1 - cos(pi/24)) + ... = 0.26 + 0.07 mm below the sphere.
        const double expected = 2.0 - (distance - 30.0);
        EXPECT_LE(size, expected + 1e-4);
        EXPECT_GE(size, expected - 0.34);
        for (int axis = 0; axis < 3 && size > 0.1; ++axis)
            EXPECT_NEAR(row[fx + axis] / size, row[x + axis] / distance, 2e-5);
    }
}

TEST_F(Trace, SetsGiveTheForceOfTheWholeMesh)
{
    const std::string mesh = sphere();
    std::string rows;
    for (int i = 0; i < 600; ++i) {
        const double turn = 0.004 * i, distance = 30.5 + 1.2 * std::cos(0.03 * i);
        rows += fmt::format("{},{:.9f},{:.9f},{:.9f}\n", 0.001 * i, distance * std::sin(turn), 3.0,
                            distance * std::cos(turn));
    }
    const auto few = trace(mesh, rows, {"--radius", "1.5"});
    const auto all = trace(mesh, rows, {"--radius", "1.5", "--budget", "all"});
    ASSERT_EQ(few.size(), all.size());
    double largest = 0;
    for (std::size_t i = 0; i < few.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(few[i][fx + axis], all[i][fx + axis], 1e-4) << "row " << i;
        EXPECT_EQ(few[i][inside], all[i][inside]) << "row " << i;
        largest = std::max(largest, few[i][fx]);
    }
    EXPECT_GT(largest, 0.5);
    EXPECT_EQ(all.back()[set_id], 1);
    EXPECT_EQ(few.back()[set_id], 600);
}

TEST_F(Trace, RepeatsByteForByteButForMeasuredTimes)
{
    const std::string mesh = sphere();
    const std::string rows =
        "0,0,0,33\n0.001,0,0,31\n0.002,0.2,0,30.4\n0.003,0.4,0,29.5\n0.004,0.6,0,29\n0.005,1,0,31\n";
    (void)trace(mesh, rows);
    const std::string first = without_times(text);
    (void)trace(mesh, rows);
    EXPECT_EQ(without_times(text), first);
    (void)trace(mesh, rows, {"--isa", "sse2"});
    EXPECT_EQ(without_times(text), first);
}

TEST_F(Trace, ColumnsAreTheContract)
{
    (void)trace(plate(), "0.25,1,2,0.5\n");
    EXPECT_TRUE(
        text.starts_with("time_s,x_mm,y_mm,z_mm,fx_N,fy_N,fz_N,contacts,inside,vx_mm,vy_mm,vz_mm,set_id,"
                         "query_us,tick_ns\n0.25,1,2,0.5,0,0,0.5,"))
        << text;
}

TEST_F(Trace, FeedEveryQueriesOnlyThen)
{
    const auto rows = trace(plate(), dip(), {"--feed-every", "50"});
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(rows[i][query_us] > 0, i % 50 == 0) << i;
        EXPECT_EQ(rows[i][set_id], static_cast<double>(1 + i / 50)) << i;
    }
}

TEST_F(Trace, ModelOffIsWithoutForce)
{
    for (const auto& row : trace(plate(), dip(), {"--model", "off"}))
        EXPECT_EQ(row[fz], 0);
}

TEST_F(Trace, EveryArithmeticAgreesWithFloat)
{
    const auto single = trace(plate(), dip());
    for (const char* arith : {"double", "fixed"}) {
        const auto other = trace(plate(), dip(), {"--arith", arith});
        for (std::size_t i = 0; i < single.size(); ++i)
            EXPECT_NEAR(single[i][fz], other[i][fz], 2e-5) << arith;
    }
}

TEST_F(Trace, WithLimitsTheForceRampsUp)
{
    std::string rows;
    for (int i = 0; i < 400; ++i)
        rows += fmt::format("{},1,2,0.5\n", 0.001 * i);
    const auto free = trace(plate(), rows);
    EXPECT_NEAR(free.front()[fz], 0.5, 1e-5);
    const auto limited = trace(plate(), rows, {"--limits", "on"});
    EXPECT_LT(limited.front()[fz], 0.05);
    EXPECT_NEAR(limited.back()[fz], 0.5, 1e-5);
    for (std::size_t i = 1; i < limited.size(); ++i)
        EXPECT_GE(limited[i][fz], limited[i - 1][fz] - 1e-6);
}

TEST_F(Trace, OutputFileIsWrittenWholeAndTheSummaryGoesElsewhere)
{
    const std::string way = write("p.csv", path_header + "0,1,2,0.5\n");
    const Outcome outcome = run({"trace", plate(), "--path", way, "-o", path("t.csv"), "--json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(csv_rows(read(path("t.csv"))).size(), 1U);
    EXPECT_EQ(files_beginning("t.csv").size(), 1U);
    const auto summary = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(summary["ticks"], 1);
    EXPECT_NEAR(summary["force_max_n"].get<double>(), 0.5, 1e-5);
}

TEST_F(Trace, AStrokeTouchesAndStaysBelowItsSpeedLimit)
{
    const std::string mesh = sphere();
    const Outcome made = run({"stroke", mesh, "-o", path("s.csv"), "--seconds", "4", "--speed-limit", "50"});
    ASSERT_EQ(made.status, 0) << made.err;
    const auto way = csv_rows(read(path("s.csv")));
    ASSERT_EQ(way.size(), 4001U);
    for (std::size_t i = 1; i < way.size(); ++i) {
        const double step =
            std::hypot(way[i][1] - way[i - 1][1], way[i][2] - way[i - 1][2], way[i][3] - way[i - 1][3]);
        EXPECT_LE(step, 50 * 0.001 * (1 + 1e-5)) << "row " << i;
    }
    const Outcome traced = run({"trace", mesh, "--path", path("s.csv"), "-o", path("t.csv")});
    ASSERT_EQ(traced.status, 0) << traced.err;
    const auto rows = csv_rows(read(path("t.csv")));
    const auto in_contact =
        std::count_if(rows.begin(), rows.end(), [](const auto& row) { return row[contacts] > 0; });
    const auto below =
        std::count_if(rows.begin(), rows.end(), [](const auto& row) { return row[inside] > 0; });
    EXPECT_GT(in_contact, 2000);
    EXPECT_GT(below, 100);
    EXPECT_EQ(rows.front()[contacts], 0);
    EXPECT_EQ(rows.back()[contacts], 0);
}

} // namespace
} // namespace phantom::test
