// SPDX-License-Identifier: GPL-2.0-or-later
// Where `load` and `record` put a device's ticks: a trace (CSV) or a recording (.rec), by the file's name.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "base/output_file.hpp"
#include "device/recorder.hpp"
#include "feeder/trace_file.hpp"

namespace phantom::fdhctl {

class TickFile {
  public:
    /// Makes sure that it can be written. A trace appears at commit(), whole or not at all; a recording from
    /// begin() on, and what is in it is good whatever becomes of us.
    static Result<TickFile> open(const std::string& file);

    /// fed: every set and START will be made through `device`, from now on. Both must outlive this, or
    /// end_listening().
    Status begin(device::Device& device, bool fed, const std::string& scene);
    /// query_us: what a set's query took, when known, by its id.
    using QueryTime = std::function<double(std::uint64_t set_id)>;
    Status append(std::span<const phantom_tick> ticks, const phantom_status& before,
                  const QueryTime& query_us);
    Status commit();

    [[nodiscard]] bool is_recording() const { return is_recording_; }
    /// "1234 ticks, 100 sets, 1.2 MB", of a recording; else empty.
    [[nodiscard]] std::string text() const;

  private:
    TickFile(OutputFile file, bool is_recording) : file_(std::move(file)), is_recording_(is_recording) {}

    OutputFile file_;
    bool is_recording_;
    std::unique_ptr<device::Recorder> recorder_; ///< of a recording, from begin() on
    std::optional<std::uint64_t> first_ns_;
    std::uint64_t last_set_ = 0;
};

} // namespace phantom::fdhctl
