// SPDX-License-Identifier: GPL-2.0-or-later
// The kernel's module: system calls on /dev/phantom_rt0. Nothing else in the project makes them.
#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "device/transport.hpp"

namespace phantom::device {

struct Device::KernelTransport final : Device::Transport {
    KernelTransport(int fd, std::string node) : fd_(fd), node_(std::move(node)) {}
    KernelTransport(const KernelTransport&) = delete;
    KernelTransport& operator=(const KernelTransport&) = delete;
    ~KernelTransport() override
    {
        if (page_ != MAP_FAILED)
            ::munmap(page_, page_size_);
        ::close(fd_);
    }

    /// 0 or -errno.
    int map(std::size_t size)
    {
        page_ = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, fd_, 0);
        page_size_ = size;
        return page_ == MAP_FAILED ? -errno : 0;
    }

    int ioctl(unsigned long request, void* argument) override
    {
        const int rc = ::ioctl(fd_, request, argument);
        return rc < 0 ? -errno : rc;
    }
    ssize_t read(void* buffer, std::size_t size) override
    {
        const ssize_t rc = ::read(fd_, buffer, size);
        return rc < 0 ? -errno : rc;
    }
    int poll(short events, int timeout_ms) override
    {
        pollfd entry{fd_, events, 0};
        const int rc = ::poll(&entry, 1, timeout_ms);
        return rc < 0 ? -errno : rc == 0 ? 0 : entry.revents;
    }
    const phantom_status* page() const override { return static_cast<const phantom_status*>(page_); }
    int step(std::uint32_t) override { return -EINVAL; }
    bool is_kernel() const override { return true; }
    bool has_virtual_clock() const override { return false; }
    const std::string& name() const override { return node_; }
    std::string thread_text() const override { return {}; }

  private:
    int fd_;
    std::string node_;
    void* page_ = MAP_FAILED;
    std::size_t page_size_ = 0;
};

namespace {

Error open_failed(const std::string& node, int error)
{
    switch (error) {
    case ENOENT:
    case ENXIO:
        return {node, "there is no such device: the module phantom_rt is not loaded"};
    case EACCES:
    case EPERM:
        return {node, "no permission to open the device", "a udev rule or membership of its group gives it"};
    case EBUSY:
        return {node, "another program feeds the device already"};
    case ENODEV:
        return {node, "the device is gone (unplugged)"};
    default:
        return {node, fmt::format("cannot be opened: {}", std::strerror(error))};
    }
}

} // namespace

Result<Device> Device::open_kernel(Access access, const std::string& node)
{
    const int flags = (access == Access::feeder ? O_RDWR : O_RDONLY) | O_NONBLOCK | O_CLOEXEC;
    const int fd = ::open(node.c_str(), flags);
    if (fd < 0)
        return open_failed(node, errno);
    auto transport = std::make_unique<KernelTransport>(fd, node);
    KernelTransport& kernel = *transport;
    Result<Device> device = greet(std::move(transport));
    if (!device)
        return device;
    if (device->info_.status_size < sizeof(phantom_status))
        return Error{node, fmt::format("the status page has {} bytes, expected {}", device->info_.status_size,
                                       sizeof(phantom_status))};
    if (const int rc = kernel.map(device->info_.status_size); rc < 0)
        return Error{node, fmt::format("the status page cannot be mapped: {}", std::strerror(-rc))};
    return device;
}

} // namespace phantom::device
