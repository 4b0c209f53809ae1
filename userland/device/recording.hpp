// SPDX-License-Identifier: GPL-2.0-or-later
// Recordings in memory: read from a file, whole or as far as it is good. The format is told in
// recording_format.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "device/device.hpp"
#include "device/recording_format.h"

namespace phantom::device {

/// From a START to the next.
struct RecordedRun {
    bool started = false; ///< false: the recorder did not see its START
    phantom_start start{};
    std::uint64_t start_ns = 0; ///< when the run began, as well as it is known
    std::vector<phantom_tick> ticks;
    std::vector<recording_mark> marks;

    /// How many of `ticks` come before the first lost record, and how many records are lost, as far as the
    /// marks tell.
    struct Losses {
        std::size_t before = 0;
        std::uint64_t lost = 0;
    };
    [[nodiscard]] Losses losses() const;
};

struct Recording {
    recording_origin origin{};
    std::vector<RecordedRun> runs;
    std::map<std::uint64_t, PatchSet> sets; ///< by id
    /// Why it ends before its end; empty for one that its recorder ended.
    std::string cut;

    [[nodiscard]] bool fed() const { return (origin.flags & RECORDING_FED) != 0; }
    [[nodiscard]] std::size_t ticks() const;
};

/// True for a file name that stands for a recording (".rec"); others are traces (CSV).
bool is_recording_name(const std::filesystem::path& file);

/// Every recording in `bytes`. `where` names them in errors. Fails when there is none, of this version.
Result<std::vector<Recording>> parse_recordings(std::span<const std::byte> bytes, const std::string& where);
Result<std::vector<Recording>> read_recordings(const std::filesystem::path& file);

/// The model of a record, and the other way round.
phantom_model model_of(const phantom_tick& tick);
/// When the record's period began. U32_MAX in latency_ns means later than that by an unknown time.
std::uint64_t due_ns(const phantom_tick& tick);

} // namespace phantom::device
