// SPDX-License-Identifier: GPL-2.0-or-later
#include "device/device.hpp"

#include <poll.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <thread>

#include <fmt/format.h>

#include "device/transport.hpp"

namespace phantom::device {

namespace {

using std::chrono::milliseconds;

/// How long submit() waits for a slot: longer than the fade that holds one.
constexpr milliseconds submit_patience{50};

/// Most records that one read_ticks() hands out.
constexpr std::size_t records_max = 4096;

std::string reason(int negative_errno)
{
    return std::strerror(-negative_errno);
}

/// An Error for a failed call, unless the caller knows more.
Error call_failed(const std::string& where, const std::string& what, int negative_errno)
{
    return {where, fmt::format("{} failed: {}", what, reason(negative_errno))};
}

/// What model needs that `features` lacks; empty when all of it is offered.
std::string missing_feature(const phantom_model& model, std::uint64_t features)
{
    struct Need {
        bool wanted;
        std::uint64_t feature;
        const char* words;
    };
    const Need needs[] = {
        {model.model == PHANTOM_MODEL_PAPER, PHANTOM_FEATURE_MODEL_PAPER, "model paper"},
        {model.model == PHANTOM_MODEL_PROJECTED, PHANTOM_FEATURE_MODEL_PROJECTED, "model projected"},
        {model.proxy == PHANTOM_PROXY_PAPER, PHANTOM_FEATURE_PROXY_PAPER, "proxy paper"},
        {model.proxy == PHANTOM_PROXY_CONSTRAINED, PHANTOM_FEATURE_PROXY_CONSTRAINED, "proxy constrained"},
        {model.arith == PHANTOM_ARITH_FLOAT, PHANTOM_FEATURE_ARITH_FLOAT, "arith float"},
        {model.arith == PHANTOM_ARITH_FIXED, PHANTOM_FEATURE_ARITH_FIXED, "arith fixed"},
        {model.arith == PHANTOM_ARITH_DOUBLE, PHANTOM_FEATURE_ARITH_DOUBLE, "arith double"},
    };
    std::string lacking, offered;
    for (const Need& need : needs) {
        if (features & need.feature)
            offered += (offered.empty() ? "" : ", ") + std::string(need.words);
        else if (need.wanted)
            lacking += (lacking.empty() ? "" : ", ") + std::string(need.words);
    }
    return lacking.empty() ? ""
                           : fmt::format("{} is not offered by this module; it offers {}", lacking, offered);
}

} // namespace

Device::Device(std::unique_ptr<Transport> transport) : transport_(std::move(transport)) {}
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;
Device::~Device() = default;

Result<Device> Device::greet(std::unique_ptr<Transport> transport)
{
    Device device(std::move(transport));
    if (const int rc = device.transport_->ioctl(PHANTOM_GET_INFO, &device.info_); rc < 0)
        return call_failed(device.name(), "GET_INFO", rc);
    if (device.info_.abi_version != PHANTOM_ABI_VERSION || device.info_.tick_size != sizeof(phantom_tick))
        return Error{device.name(),
                     fmt::format("the module speaks version {} of the interface with ticks of {} bytes, this "
                                 "program version {} with {}",
                                 device.info_.abi_version, device.info_.tick_size, PHANTOM_ABI_VERSION,
                                 sizeof(phantom_tick)),
                     "build and load the module that belongs to this program: make modules"};
    return device;
}

bool Device::is_kernel() const
{
    return transport_->is_kernel();
}

bool Device::has_virtual_clock() const
{
    return transport_->has_virtual_clock();
}

const std::string& Device::name() const
{
    return transport_->name();
}

const phantom_info& Device::info() const
{
    return info_;
}

std::string Device::thread_text() const
{
    return transport_->thread_text();
}

Status Device::set_rate(std::uint32_t hz)
{
    phantom_rate rate{};
    rate.rate_hz = hz;
    const int rc = transport_->ioctl(PHANTOM_SET_RATE, &rate);
    if (rc == -EINVAL)
        return Error{name(), fmt::format("rate {} Hz: expected {} to {} Hz", hz, info_.rate_min_hz,
                                         info_.rate_max_hz)};
    if (rc < 0)
        return call_failed(name(), fmt::format("setting the rate to {} Hz", hz), rc);
    return success();
}

Status Device::set_model(const phantom_model& model)
{
    if (std::string lacking = missing_feature(model, info_.features); !lacking.empty())
        return Error{name(), lacking};
    phantom_model copy = model;
    const int rc = transport_->ioctl(PHANTOM_SET_MODEL, &copy);
    if (rc < 0)
        return call_failed(name(), fmt::format("setting the model ({})", model_text(model)), rc);
    return success();
}

Status Device::start(const phantom_start& start)
{
    phantom_start copy = start;
    if (start.crossfade_ms != 0 && (info_.features & PHANTOM_FEATURE_CROSSFADE) == 0)
        return Error{name(), "cannot start: this module knows no crossfade but its own of 20 ms"};
    switch (const int rc = transport_->ioctl(PHANTOM_START, &copy); rc) {
    case -EBUSY:
        return Error{name(), "cannot start: the servo is running already"};
    case -EIO:
        return Error{name(),
                     fmt::format("cannot start: a fault is latched ({})", fault_names(status().faults))};
    case -EINVAL:
        return Error{name(),
                     fmt::format("cannot start: a limit is above the device's own (force at most {:.3g} N)",
                                 info_.max_force_un * 1e-6)};
    case -EPERM:
        return Error{name(), "limits can be switched off on a simulated device only"};
    default:
        if (rc < 0)
            return call_failed(name(), "START", rc);
    }
    if (listener_)
        listener_->started(start, status().start_ns);
    return success();
}

Status Device::stop()
{
    const int rc = transport_->ioctl(PHANTOM_STOP, nullptr);
    return rc < 0 ? Status(call_failed(name(), "STOP", rc)) : success();
}

int Device::call_submit(PatchSet& set)
{
    set.header.patch_count = static_cast<__u32>(set.patches.size());
    set.header.material_count = static_cast<__u32>(set.materials.size());
    set.header.object_count = static_cast<__u32>(set.objects.size());
    set.header.patches = reinterpret_cast<std::uintptr_t>(set.patches.data());
    set.header.materials = reinterpret_cast<std::uintptr_t>(set.materials.data());
    set.header.objects = reinterpret_cast<std::uintptr_t>(set.objects.data());
    set.header.effects &= ~PHANTOM_EFFECTS_SURFACE;
    for (const phantom_material& material : set.materials)
        set.header.effects |= material.effects;
    set.header.effect_bytes = static_cast<__u32>(set.effect_tables.size() * sizeof(std::uint64_t));
    if (listener_)
        listener_->submitting(set);
    if (set.effect_tables.empty())
        return transport_->ioctl(PHANTOM_SUBMIT_SET, &set.header);
    // The module takes the tables from behind the materials.
    const auto materials = std::as_bytes(std::span(set.materials));
    const auto tables = std::as_bytes(std::span(set.effect_tables));
    std::vector<std::byte> both(materials.begin(), materials.end());
    both.insert(both.end(), tables.begin(), tables.end());
    phantom_set header = set.header;
    header.materials = reinterpret_cast<std::uintptr_t>(both.data());
    return transport_->ioctl(PHANTOM_SUBMIT_SET, &header);
}

Result<bool> Device::try_submit(PatchSet& set)
{
    set.header.id = last_set_id_ + 1;
    const int rc = call_submit(set);
    if (rc == -EAGAIN)
        return false;
    if (rc == -EINVAL)
        return Error{name(), fmt::format("the module refused a set of {} triangles, {} materials, {} objects",
                                         set.patches.size(), set.materials.size(), set.objects.size())};
    if (rc < 0)
        return call_failed(name(), "SUBMIT_SET", rc);
    last_set_id_ = set.header.id;
    return true;
}

Status Device::submit(PatchSet& set)
{
    const auto end = std::chrono::steady_clock::now() + submit_patience;
    for (;;) {
        Result<bool> taken = try_submit(set);
        if (!taken)
            return taken.error();
        if (*taken)
            return success();
        if (has_virtual_clock() || std::chrono::steady_clock::now() >= end)
            return Error{name(), "no slot for a new set: the servo does not take the ones it has"};
        std::this_thread::sleep_for(milliseconds(1));
    }
}

Status Device::move_simulated_tip(const std::array<std::int64_t, 3>& tip_nm)
{
    phantom_sim_move move{};
    for (int axis = 0; axis < 3; ++axis)
        move.tip_nm[axis] = tip_nm[axis];
    const int rc = transport_->ioctl(PHANTOM_SIM_MOVE, &move);
    if (rc == -EOPNOTSUPP)
        return Error{name(), "only a simulated device can be moved by a program; this one is " +
                                 std::string(device_name(info_.device))};
    return rc < 0 ? Status(call_failed(name(), "SIM_MOVE", rc)) : success();
}

Status Device::clear_fault()
{
    const int rc = transport_->ioctl(PHANTOM_CLEAR_FAULT, nullptr);
    if (rc == -EAGAIN)
        return Error{name(),
                     fmt::format("the cause of the fault is still there ({})", fault_names(status().faults))};
    return rc < 0 ? Status(call_failed(name(), "CLEAR_FAULT", rc)) : success();
}

phantom_status Device::status() const
{
    const phantom_status* page = transport_->page();
    phantom_status copy;
    for (unsigned attempt = 0;; ++attempt) {
        const std::uint32_t before = __atomic_load_n(&page->sequence, __ATOMIC_ACQUIRE);
        if ((before & 1U) == 0) {
            std::memcpy(&copy, page, sizeof copy);
            std::atomic_thread_fence(std::memory_order_acquire);
            if (__atomic_load_n(&page->sequence, __ATOMIC_RELAXED) == before)
                return copy;
        }
        // The writer may have been preempted in the middle: let it run.
        if (attempt % 64 == 63)
            std::this_thread::yield();
    }
}

Result<bool> Device::wait_event(std::chrono::milliseconds timeout)
{
    const int rc = transport_->poll(POLLPRI, static_cast<int>(timeout.count()));
    if (rc == -EINTR)
        return false;
    if (rc < 0)
        return call_failed(name(), "poll", rc);
    return (rc & (POLLPRI | POLLERR | POLLHUP)) != 0;
}

Result<std::vector<phantom_tick>> Device::read_ticks()
{
    std::vector<phantom_tick> records(records_max);
    const ssize_t rc = transport_->read(records.data(), records.size() * sizeof(phantom_tick));
    if (rc == -EAGAIN || rc == -EINTR)
        return std::vector<phantom_tick>{};
    if (rc < 0)
        return call_failed(name(), "read", static_cast<int>(rc));
    records.resize(static_cast<std::size_t>(rc) / sizeof(phantom_tick));
    return records;
}

Status Device::submit_as(PatchSet& set)
{
    if (const int rc = call_submit(set); rc < 0)
        return call_failed(name(), fmt::format("SUBMIT_SET of set {}", set.header.id), rc);
    last_set_id_ = set.header.id;
    return success();
}

Result<bool> Device::replay(const phantom_tick& record, std::uint64_t due_ns)
{
    const int rc = transport_->replay(record, due_ns);
    if (rc == -EAGAIN)
        return false;
    if (rc < 0)
        return Error{name(), "only a machine with a virtual clock can replay"};
    return true;
}

Status Device::replay_sleep(const phantom_tick& record, std::uint64_t due_ns)
{
    const std::uint64_t woken_ns = due_ns - 1000000000ULL / record.rate_hz;
    if (const int rc = transport_->sleep_until(woken_ns); rc < 0)
        return call_failed(name(), "waking up", rc);
    return success();
}

Status Device::set_time(std::uint64_t now_ns)
{
    if (transport_->set_time(now_ns) < 0)
        return Error{name(), "only a virtual clock can be set"};
    return success();
}

Status Device::step(std::uint32_t ticks)
{
    const int rc = transport_->step(ticks);
    if (rc == -EAGAIN)
        return Error{name(), "the servo is not started"};
    if (rc < 0)
        return Error{name(), "only a machine with a virtual clock can be stepped"};
    return success();
}

} // namespace phantom::device
