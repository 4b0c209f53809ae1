// SPDX-License-Identifier: GPL-2.0-or-later
// Transport: how a Device reaches the module. Private to this folder. Every call answers what the
// system call would: >= 0, or -errno.
#pragma once

#include <sys/types.h>

#include <string>

#include "device/device.hpp"

namespace phantom::device {

struct Device::Transport {
    virtual ~Transport() = default;

    virtual int ioctl(unsigned long request, void* argument) = 0;
    virtual ssize_t read(void* buffer, std::size_t size) = 0;
    /// revents, 0 after timeout_ms, or -errno.
    virtual int poll(short events, int timeout_ms) = 0;
    /// The mapped status page; valid as long as the transport.
    [[nodiscard]] virtual const phantom_status* page() const = 0;
    virtual int step(std::uint32_t ticks) = 0;
    virtual int replay(const phantom_tick& record, std::uint64_t due_ns) = 0;
    virtual int set_time(std::uint64_t now_ns) = 0;
    /// Suspend, and resume at woken_ns.
    virtual int sleep_until(std::uint64_t woken_ns) = 0;

    [[nodiscard]] virtual bool is_kernel() const = 0;
    [[nodiscard]] virtual bool has_virtual_clock() const = 0;
    [[nodiscard]] virtual const std::string& name() const = 0;
    [[nodiscard]] virtual std::string thread_text() const = 0;
};

} // namespace phantom::device
