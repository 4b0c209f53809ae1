// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl load --record FILE.rec, fdhctl replay, fdhctl record.
#include <cmath>
#include <csignal>
#include <cstring>

#include <unistd.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "device/recording_format.h"
#include "program.hpp"

namespace phantom::test {
namespace {

using nlohmann::json;

class Record : public Program {
  protected:
    /// Into the sphere of 30 mm and out again, in a second.
    std::string way() const
    {
        std::string rows;
        for (int i = 0; i <= 100; ++i)
            rows += fmt::format("{},{},0,{}\n", 0.01 * i, 0.05 * i, 30.2 + 1.5 * std::cos(0.0628 * i));
        return write("p.csv", "time_s,x_mm,y_mm,z_mm\n" + rows);
    }

    json replayed(const std::string& recording, const std::string& isa, int status = 0) const
    {
        const Outcome outcome = run({"replay", recording, "--isa", isa, "--json"});
        EXPECT_EQ(outcome.status, status) << outcome.err << outcome.out;
        return json::parse(outcome.out, nullptr, false);
    }
};

/// One bit of the first tick is another, and the checksum made good.
std::string with_a_changed_force(std::string bytes)
{
    for (std::size_t at = sizeof(recording_header); at < bytes.size();) {
        recording_chunk chunk;
        std::memcpy(&chunk, bytes.data() + at, sizeof chunk);
        char* payload = bytes.data() + at + sizeof chunk;
        if (chunk.kind == RECORDING_TICKS) {
            payload[offsetof(phantom_tick, force_un)] ^= 4;
            chunk.checksum = recording_checksum(0, &chunk, offsetof(recording_chunk, checksum));
            chunk.checksum = recording_checksum(chunk.checksum, payload, chunk.size);
            std::memcpy(bytes.data() + at, &chunk, sizeof chunk);
            return bytes;
        }
        at += sizeof chunk + chunk.size;
    }
    return {};
}

TEST_F(Record, ATouchIsComputedAgainToTheSameBits)
{
    Running load = start_load({sphere(), "--usermode", "--path", way(), "--record", path("t.rec"), "--json"});
    EXPECT_EQ(run({"rate", "3000"}).status, 0);
    EXPECT_EQ(run({"model", "paper"}).status, 0);
    const Outcome outcome = load.wait();
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    for (const char* isa : {"best", "sse2"}) {
        const json report = replayed(path("t.rec"), isa);
        EXPECT_TRUE(report["same"].get<bool>()) << report;
        EXPECT_TRUE(report["complete"].get<bool>());
        EXPECT_EQ(report["ticks"], json::parse(outcome.out)["touch"]["ticks"]);
        EXPECT_EQ(report["not_compared"], 0);
        EXPECT_GT(report["contact_ticks"].get<int>(), 100);
        EXPECT_GT(report["ramping_ticks"].get<int>(), 200);
    }
    const json in_double = replayed(path("t.rec"), "double");
    EXPECT_LT(in_double["worst_force_n"].get<double>(), 1e-3);

    const Outcome traced = run({"replay", path("t.rec"), "-o", path("t.csv")});
    ASSERT_EQ(traced.status, 0) << traced.err;
    EXPECT_NE(traced.out.find("the same, bit for bit"), std::string::npos) << traced.out;
    EXPECT_EQ(csv_rows(read(path("t.csv"))).size(),
              replayed(path("t.rec"), "best")["ticks"].get<std::size_t>());
}

TEST_F(Record, OneBitOfAForceMakesReplayFailAndIsNamed)
{
    ASSERT_EQ(run({"load", sphere(), "--usermode", "--seconds", "0.1", "--record", path("t.rec")}).status, 0);
    const std::string changed = write("changed.rec", with_a_changed_force(read(path("t.rec"))));
    const json report = replayed(changed, "best", 1);
    EXPECT_FALSE(report["same"].get<bool>());
    EXPECT_EQ(report["differ"], 1);
    EXPECT_EQ(report["first"]["fields"], "force");
    EXPECT_EQ(report["first"]["tick"], 1);
}

TEST_F(Record, AKilledFeederLeavesWhatItRecorded)
{
    {
        Running load = start_load({sphere(), "--usermode", "--path", way(), "--record", path("t.rec")});
        for (int attempt = 0; attempt < 300 && !exists("t.rec"); ++attempt)
            ::usleep(10000);
        ::usleep(200000);
        load.signal(SIGKILL);
        (void)load.wait();
    }
    const json report = replayed(path("t.rec"), "best");
    EXPECT_TRUE(report["same"].get<bool>()) << report;
    EXPECT_FALSE(report["complete"].get<bool>());
    EXPECT_GT(report["ticks"].get<int>(), 10);
    EXPECT_NE(report["notes"].dump().find("ends early"), std::string::npos);
}

TEST_F(Record, AFailedStartLeavesNoFileAndAnOlderOneAlone)
{
    write("old.rec", "precious");
    EXPECT_EQ(run({"load", path("none.ply"), "--usermode", "--record", path("old.rec")}).status, 1);
    EXPECT_EQ(read(path("old.rec")), "precious");
    EXPECT_EQ(run({"load", path("none.ply"), "--usermode", "--record", path("new.rec")}).status, 1);
    EXPECT_TRUE(files_beginning("new.rec").empty());
}

TEST_F(Record, ReplayRefusesWhatIsNoRecordingInOneLine)
{
    for (const std::string& file : {way(), path("none.rec"), write("empty.rec", "")}) {
        const Outcome outcome = run({"replay", file, "-o", path("out.csv")});
        EXPECT_EQ(outcome.status, 1) << file;
        EXPECT_TRUE(outcome.err.starts_with("fdhctl: " + file + ": ")) << outcome.err;
        EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << outcome.err;
        EXPECT_FALSE(exists("out.csv"));
    }
}

TEST_F(Record, RecordWithoutADeviceSaysWhatToDo)
{
    if (::access("/dev/phantom_rt0", F_OK) == 0)
        GTEST_SKIP() << "the kernel's device is here";
    Outcome outcome = run({"record", "-o", path("t.csv"), "--seconds", "0.1"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("/dev/phantom_rt0: there is no such device"), std::string::npos)
        << outcome.err;
    Running load = start_load({sphere(), "--usermode"});
    outcome = run({"record", "-o", path("t.csv"), "--seconds", "0.1"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("fdhctl load SCENE --usermode --record FILE"), std::string::npos)
        << outcome.err;
    EXPECT_FALSE(exists("t.csv"));
    EXPECT_EQ(run({"load", sphere(), "--device", "/dev/phantom_rt9", "--seconds", "0.1"}).status, 1);
}

TEST_F(Record, ATraceHasTheQueryTimeOfEverySetOnce)
{
    ASSERT_EQ(run({"load", sphere(), "--usermode", "--seconds", "0.3", "--record", path("t.csv")}).status, 0);
    const auto rows = csv_rows(read(path("t.csv")));
    ASSERT_GT(rows.size(), 100U);
    double last_set = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double set_id = rows[i][12];
        const bool first = set_id != 0 && set_id != last_set;
        EXPECT_EQ(rows[i][13] > 0, first) << "row " << i << ", set " << set_id;
        last_set = set_id != 0 ? set_id : last_set;
    }
}

} // namespace
} // namespace phantom::test
