// SPDX-License-Identifier: GPL-2.0-or-later
// Writing a recording while a device runs. The format is told in recording_format.h.
#pragma once

#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/device.hpp"
#include "device/recording_format.h"

namespace phantom::device {

/// Listens to a Device (Device::listen) and turns what it hears, and the records that its owner reads, into
/// the bytes of one recording. Any thread.
class Recorder final : public Device::Listener {
  public:
    /// fed: every START and SUBMIT_SET of the device will be heard, from the first on. scene: for people.
    Recorder(const Device& device, bool fed, std::string_view scene);

    void started(const phantom_start& start, std::uint64_t start_ns) override;
    void submitting(const PatchSet& set) override;

    /// Records in the order of read(), and the status page as it was before they were read.
    void add(std::span<const phantom_tick> ticks, const phantom_status& before);
    /// Nothing comes after it.
    void end();

    /// The bytes since the last call, to be appended to the file.
    std::string take();

    struct Counts {
        std::uint64_t ticks = 0, sets = 0, bytes = 0;
    };
    [[nodiscard]] Counts counts() const;

  private:
    /// Appends a chunk; its payload in parts.
    void chunk(std::uint32_t kind, std::initializer_list<std::string_view> parts);

    mutable std::mutex mutex_; ///< protects what follows
    std::string bytes_;
    Counts counts_;
    recording_mark mark_{};
};

} // namespace phantom::device
