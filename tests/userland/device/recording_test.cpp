// SPDX-License-Identifier: GPL-2.0-or-later
// Recordings: written, read back, cut, damaged, foreign.
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "device/recorder.hpp"
#include "device/recording.hpp"

namespace phantom::test {
namespace {

using device::Recording;

template <typename T>
bool same_bytes(const T& a, const T& b)
{
    return std::memcmp(&a, &b, sizeof a) == 0;
}

/// Every byte different, so that nothing can be mixed up.
template <typename T>
T patterned(unsigned seed)
{
    T value;
    unsigned char bytes[sizeof value];
    for (std::size_t i = 0; i < sizeof value; ++i)
        bytes[i] = static_cast<unsigned char>(seed + 31 * i);
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

device::PatchSet patch_set(std::uint64_t id)
{
    device::PatchSet set;
    set.header = patterned<phantom_set>(static_cast<unsigned>(id));
    set.header.id = id;
    set.patches = {patterned<phantom_patch>(1), patterned<phantom_patch>(2)};
    set.materials = {patterned<phantom_material>(3)};
    set.objects = {patterned<phantom_object>(4)};
    set.header.patch_count = 2;
    set.header.material_count = set.header.object_count = 1;
    set.effect_tables = {patterned<std::uint64_t>(5), patterned<std::uint64_t>(6)};
    set.header.effect_bytes = 16;
    return set;
}

phantom_tick tick(std::uint64_t number, std::uint64_t time_ns)
{
    auto tick = patterned<phantom_tick>(static_cast<unsigned>(number));
    tick.tick = number;
    tick.time_ns = time_ns;
    return tick;
}

phantom_status page(std::uint64_t start_ns, std::uint64_t number, std::uint64_t missed)
{
    phantom_status status{};
    status.start_ns = start_ns;
    status.tick = number;
    status.missed = missed;
    return status;
}

class RecordingFile : public ::testing::Test {
  protected:
    RecordingFile()
    {
        device::UsermodeOptions options;
        options.virtual_clock = true;
        auto device = device::Device::open_usermode(options);
        device_.emplace(std::move(*device));
    }

    device::Recorder recorder(bool fed = true) const { return {*device_, fed, "scene.toml"}; }

    /// Two runs of three ticks, two sets.
    std::string example() const
    {
        device::Recorder out = recorder();
        out.submitting(patch_set(1));
        out.started(start_, 1000);
        out.add(std::vector{tick(1, 1100), tick(2, 1200)}, page(1010, 2, 0));
        out.submitting(patch_set(2));
        out.add(std::vector{tick(4, 1400)}, page(1010, 4, 1));
        out.started({}, 5000);
        out.add(std::vector{tick(1, 5100), tick(2, 5200), tick(3, 5300)}, page(5001, 3, 0));
        out.end();
        return out.take();
    }

    static Result<std::vector<Recording>> parse(std::string_view bytes)
    {
        return device::parse_recordings(std::as_bytes(std::span(bytes)), "it");
    }

    std::optional<device::Device> device_;
    phantom_start start_ = patterned<phantom_start>(9);
};

TEST_F(RecordingFile, ComesBackAsItWasWritten)
{
    const auto all = parse(example());
    ASSERT_TRUE(all) << all.error().text();
    ASSERT_EQ(all->size(), 1U);
    const Recording& got = all->front();
    EXPECT_EQ(got.cut, "");
    EXPECT_TRUE(got.fed());
    EXPECT_STREQ(got.origin.scene, "scene.toml");
    EXPECT_STREQ(got.origin.device, "user mode");
    EXPECT_TRUE(same_bytes(got.origin.info, device_->info()));
    ASSERT_EQ(got.runs.size(), 2U);
    EXPECT_TRUE(got.runs[0].started);
    EXPECT_TRUE(same_bytes(got.runs[0].start, start_));
    EXPECT_EQ(got.runs[0].start_ns, 1010U) << "the page knows it better than START";
    ASSERT_EQ(got.runs[0].ticks.size(), 3U);
    EXPECT_TRUE(same_bytes(got.runs[0].ticks[2], tick(4, 1400)));
    EXPECT_EQ(got.runs[0].losses().lost, 0U);
    ASSERT_EQ(got.runs[1].ticks.size(), 3U);
    EXPECT_EQ(got.runs[1].start_ns, 5001U);
    ASSERT_EQ(got.sets.size(), 2U);
    const device::PatchSet& set = got.sets.at(2);
    EXPECT_TRUE(same_bytes(set.patches[1], patch_set(2).patches[1]));
    EXPECT_TRUE(same_bytes(set.materials[0], patch_set(2).materials[0]));
    EXPECT_TRUE(same_bytes(set.objects[0], patch_set(2).objects[0]));
    EXPECT_EQ(set.effect_tables, patch_set(2).effect_tables);
    EXPECT_EQ(set.header.radius_nm, patch_set(2).header.radius_nm);
}

TEST_F(RecordingFile, CutAtAnyByteItIsGoodUpToThere)
{
    const std::string whole = example();
    const auto good = parse(whole);
    ASSERT_TRUE(good);
    std::size_t ticks = 0, readable = 0;
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const auto all = parse(std::string_view(whole).substr(0, size));
        if (!all) {
            EXPECT_EQ(readable, 0U) << "readable at " << size - 1 << " bytes, not at " << size << ": "
                                    << all.error().text();
            continue;
        }
        ++readable;
        const Recording& got = all->front();
        EXPECT_NE(got.cut, "") << size;
        EXPECT_GE(got.ticks(), ticks) << size;
        ticks = got.ticks();
        for (std::size_t run = 0; run < got.runs.size(); ++run)
            for (std::size_t i = 0; i < got.runs[run].ticks.size(); ++i)
                ASSERT_TRUE(same_bytes(got.runs[run].ticks[i], good->front().runs[run].ticks[i])) << size;
    }
    EXPECT_EQ(ticks, 6U);
    EXPECT_GT(readable, whole.size() / 2);
}

TEST_F(RecordingFile, AFlippedBitIsFoundWhereverItIs)
{
    const std::string whole = example();
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string damaged = whole;
        damaged[i] = static_cast<char>(damaged[i] ^ 1 << i % 8);
        const auto all = parse(damaged);
        EXPECT_TRUE(!all || !all->front().cut.empty()) << "bit " << i % 8 << " of byte " << i;
    }
}

TEST_F(RecordingFile, AForeignFileIsRefusedWithWhatMakesOne)
{
    for (const std::string text : {"", "x", "time_s,x_mm,y_mm,z_mm\n0,0,0,0\n"}) {
        const auto all = parse(text);
        ASSERT_FALSE(all);
        EXPECT_NE(all.error().text().find("it: is no recording"), std::string::npos) << all.error().text();
        EXPECT_NE(all.error().remedy.find("--record"), std::string::npos);
    }
}

TEST_F(RecordingFile, AnotherVersionIsRefusedAndNamed)
{
    std::string other = example();
    other[offsetof(recording_header, version)] = 7;
    const auto all = parse(other);
    ASSERT_FALSE(all);
    EXPECT_NE(all.error().text().find("version 7"), std::string::npos) << all.error().text();
}

TEST_F(RecordingFile, TicksOfAnotherSizeAreRefused)
{
    std::string other = example();
    recording_chunk chunk;
    recording_origin origin;
    char* at = other.data() + sizeof(recording_header);
    std::memcpy(&chunk, at, sizeof chunk);
    std::memcpy(&origin, at + sizeof chunk, sizeof origin);
    origin.info.tick_size = 104;
    chunk.checksum = recording_checksum(0, &chunk, offsetof(recording_chunk, checksum));
    chunk.checksum = recording_checksum(chunk.checksum, &origin, sizeof origin);
    std::memcpy(at, &chunk, sizeof chunk);
    std::memcpy(at + sizeof chunk, &origin, sizeof origin);
    const auto all = parse(other);
    ASSERT_FALSE(all);
    EXPECT_NE(all.error().text().find("ticks of 104 bytes"), std::string::npos) << all.error().text();
}

TEST_F(RecordingFile, SeveralStandOneBehindTheOther)
{
    const auto all = parse(example() + example());
    ASSERT_TRUE(all);
    ASSERT_EQ(all->size(), 2U);
    EXPECT_EQ(all->back().ticks(), 6U);
    EXPECT_EQ(all->back().cut, "");
    const auto tail = parse(example() + "rubbish");
    ASSERT_TRUE(tail);
    EXPECT_EQ(tail->front().ticks(), 6U);
    EXPECT_NE(tail->front().cut, "");
}

TEST_F(RecordingFile, LostRecordsAreToldFromMissedPeriods)
{
    // Ticks 1 2 3 . . 6 . 8: the servo missed one period, two records are lost, and the widest gap is where.
    const std::vector ticks{tick(1, 1100), tick(2, 1200), tick(3, 1300), tick(6, 1600), tick(8, 1800)};
    device::Recorder out = recorder();
    out.started({}, 1000);
    out.add(std::span(ticks).first(3), page(1001, 2, 0));
    out.add(std::span(ticks).subspan(3), page(1001, 8, 1));
    out.end();
    const auto all = parse(out.take());
    ASSERT_TRUE(all);
    const auto losses = all->front().runs.front().losses();
    EXPECT_EQ(losses.lost, 2U);
    EXPECT_EQ(losses.before, 3U);
}

TEST_F(RecordingFile, AnObserverThatCameLaterHasLostNothing)
{
    device::Recorder out = recorder(false);
    out.add(std::vector{tick(50, 6000), tick(51, 6100)}, page(1001, 49, 3));
    out.add(std::vector{tick(52, 6200)}, page(1001, 51, 3));
    out.add(std::vector<phantom_tick>{}, page(1001, 52, 3));
    out.add(std::vector{tick(1, 9000)}, page(8000, 1, 0));
    const auto all = parse(out.take());
    ASSERT_TRUE(all);
    const Recording& got = all->front();
    EXPECT_FALSE(got.fed());
    EXPECT_EQ(got.cut, "it was not ended");
    ASSERT_EQ(got.runs.size(), 2U);
    EXPECT_FALSE(got.runs[0].started);
    EXPECT_EQ(got.runs[0].losses().lost, 0U);
    EXPECT_EQ(got.runs[1].ticks.size(), 1U);
}

TEST_F(RecordingFile, ASetThatWasRefusedGivesWayToTheNextWithItsId)
{
    device::Recorder out = recorder();
    device::PatchSet refused = patch_set(1);
    refused.patches.clear();
    refused.header.patch_count = 0;
    out.submitting(refused);
    out.submitting(patch_set(1));
    const auto all = parse(out.take());
    ASSERT_TRUE(all);
    EXPECT_EQ(all->front().sets.at(1).patches.size(), 2U);
}

} // namespace
} // namespace phantom::test
