// SPDX-License-Identifier: GPL-2.0-or-later
// The module's own sources as a library: a machine of our own with a simulated device.
#include <fcntl.h>

#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "device/transport.hpp"
#include "phantom_usermode.h"

namespace phantom::device {

struct Device::UsermodeTransport final : Device::Transport {
    UsermodeTransport(phantom_um* machine, bool virtual_clock)
        : machine_(machine), virtual_clock_(virtual_clock)
    {
    }
    UsermodeTransport(const UsermodeTransport&) = delete;
    UsermodeTransport& operator=(const UsermodeTransport&) = delete;
    ~UsermodeTransport() override
    {
        if (file_)
            phantom_um_close(file_);
        phantom_um_destroy(machine_);
    }

    /// 0 or -errno.
    int open()
    {
        int error = 0;
        file_ = phantom_um_open(machine_, O_RDWR | O_NONBLOCK, &error);
        if (!file_)
            return error;
        page_ = phantom_um_mmap(file_, &error);
        return page_ ? 0 : error;
    }

    int ioctl(unsigned long request, void* argument) override
    {
        return phantom_um_ioctl(file_, request, argument);
    }
    ssize_t read(void* buffer, std::size_t size) override { return phantom_um_read(file_, buffer, size); }
    int poll(short events, int timeout_ms) override { return phantom_um_poll(file_, events, timeout_ms); }
    const phantom_status* page() const override { return page_; }
    int step(std::uint32_t ticks) override { return phantom_um_step(machine_, ticks); }
    int replay(const phantom_tick& record, std::uint64_t due_ns) override
    {
        return phantom_um_replay(machine_, &record, due_ns);
    }
    int set_time(std::uint64_t now_ns) override { return phantom_um_set_time(machine_, now_ns); }
    int sleep_until(std::uint64_t woken_ns) override
    {
        phantom_um_suspend(machine_);
        const int rc = phantom_um_set_time(machine_, woken_ns);
        return rc < 0 ? rc : phantom_um_resume(machine_);
    }
    bool is_kernel() const override { return false; }
    bool has_virtual_clock() const override { return virtual_clock_; }
    const std::string& name() const override { return name_; }
    std::string thread_text() const override
    {
        if (virtual_clock_)
            return "virtual clock";
        phantom_um_thread_info thread{};
        phantom_um_thread(machine_, &thread);
        if (thread.fifo < 0)
            return "not started";
        const std::string policy =
            thread.fifo == 1 ? "SCHED_FIFO" : "SCHED_OTHER (SCHED_FIFO is not allowed here)";
        return thread.cpu >= 0 ? fmt::format("{}, CPU {}", policy, thread.cpu) : policy;
    }

  private:
    phantom_um* machine_;
    phantom_um_file* file_ = nullptr;
    const phantom_status* page_ = nullptr;
    bool virtual_clock_;
    std::string name_ = "user mode";
};

Result<Device> Device::open_usermode(const UsermodeOptions& options)
{
    phantom_um_config config{};
    config.clock = options.virtual_clock ? PHANTOM_UM_CLOCK_VIRTUAL : PHANTOM_UM_CLOCK_REAL;
    config.rate_hz = options.rate_hz;
    config.cpu = options.cpu;
    config.max_force_un = options.max_force_un;
    config.isa = options.isa;
    config.patches_max = options.patches_max;
    if (options.rate_hz != 0 &&
        (options.rate_hz < PHANTOM_RATE_MIN_HZ || options.rate_hz > PHANTOM_RATE_MAX_HZ))
        return Error{"user mode", fmt::format("rate {} Hz: expected {} to {} Hz", options.rate_hz,
                                              PHANTOM_RATE_MIN_HZ, PHANTOM_RATE_MAX_HZ)};
    int error = 0;
    phantom_um* machine = phantom_um_create(&config, &error);
    if (!machine)
        return Error{"user mode", error == -EINVAL
                                      ? fmt::format("this processor has no {}", isa_name(options.isa))
                                      : fmt::format("no machine could be made: {}", std::strerror(-error))};
    auto transport = std::make_unique<UsermodeTransport>(machine, options.virtual_clock);
    if (const int rc = transport->open(); rc < 0)
        return Error{"user mode", fmt::format("the machine cannot be opened: {}", std::strerror(-rc))};
    return greet(std::move(transport));
}

} // namespace phantom::device
