// SPDX-License-Identifier: GPL-2.0-or-later
// The kernel's module: system calls on /dev/phantom_rt0. Nothing else in the project makes them.
#include <fcntl.h>
#include <grp.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
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
    int replay(const phantom_tick&, std::uint64_t) override { return -EINVAL; }
    int set_time(std::uint64_t) override { return -EINVAL; }
    int sleep_until(std::uint64_t) override { return -EINVAL; }
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

constexpr const char* node_prefix = "phantom_rt";

/// What gives this user the right to open the node.
std::string permission_remedy(const std::string& node)
{
    struct stat status {};
    const bool known = ::stat(node.c_str(), &status) == 0;
    const struct group* group = known && status.st_gid != 0 ? ::getgrgid(status.st_gid) : nullptr;
    if (group && (status.st_mode & S_IRGRP) != 0)
        return fmt::format("it belongs to group {}: sudo usermod -aG {} $USER, then log in again",
                           group->gr_name, group->gr_name);
    return R"(a udev rule gives it: KERNEL=="phantom_rt*", GROUP="plugdev", MODE="0660")";
}

Error open_failed(const std::string& node, int error)
{
    switch (error) {
    case ENOENT:
    case ENXIO:
        if (std::filesystem::exists("/sys/module/phantom_rt"))
            return {node,
                    "there is no such device: the module phantom_rt is loaded and has none of that name",
                    "fdhctl devices lists them"};
        return {node, "there is no such device: the module phantom_rt is not loaded",
                "sudo insmod phantom_rt.ko; make modules builds it"};
    case EACCES:
    case EPERM:
        return {node, "no permission to open the device", permission_remedy(node)};
    case EBUSY:
        return {node, "another program feeds the device already", "fdhctl stop ends a session of fdhctl"};
    case ENODEV:
        return {node, "the device is gone (unplugged)"};
    default:
        return {node, fmt::format("cannot be opened: {}", std::strerror(error))};
    }
}

} // namespace

std::vector<std::string> kernel_nodes(const std::filesystem::path& devices)
{
    const std::string prefix = node_prefix;
    std::vector<unsigned long> numbers;
    std::error_code code;
    for (const auto& entry : std::filesystem::directory_iterator(devices, code)) {
        const std::string name = entry.path().filename().string();
        const std::string digits = name.starts_with(prefix) ? name.substr(prefix.size()) : "";
        if (!digits.empty() && digits.size() < 9 &&
            digits.find_first_not_of("0123456789") == std::string::npos)
            numbers.push_back(std::stoul(digits));
    }
    std::sort(numbers.begin(), numbers.end());
    std::vector<std::string> nodes;
    nodes.reserve(numbers.size());
    for (const unsigned long number : numbers)
        nodes.push_back(fmt::format("/dev/{}{}", prefix, number));
    if (nodes.empty())
        nodes.emplace_back(PHANTOM_DEVICE_NODE);
    return nodes;
}

Result<Device> Device::open_kernel(Access access, std::string node)
{
    if (node.empty())
        node = kernel_nodes().front();
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
