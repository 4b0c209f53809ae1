// SPDX-License-Identifier: GPL-2.0-or-later
// The whole module: what a feeder can do to a device in a life, and what must hold of each record.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <deque>
#include <fcntl.h>
#include <span>

#include "finding.hpp"
#include "phantom_usermode.h"
#include "subject.hpp"

namespace phantom::fuzz {

namespace {

/// A STOP steps the ramp down: longer ones would only take longer to fuzz.
constexpr std::uint32_t ramp_ms_most = 20;

/// Of the clamp and of the slew limit: each component is rounded once.
constexpr double rounding_un = 3;

double norm(const std::int32_t v[3])
{
    return std::hypot(double(v[0]), double(v[1]), double(v[2]));
}

/// One device, its feeder and what the feeder knows.
class Machine {
  public:
    Machine(std::uint32_t isa, std::uint32_t rate_hz)
    {
        const phantom_um_config config{PHANTOM_UM_CLOCK_VIRTUAL, rate_hz, -1, 0, isa, 0};
        int error = 0;
        machine_.reset(phantom_um_create(&config, &error));
        must(machine_ != nullptr, "a machine cannot be made");
        open();
    }
    Machine(const Machine&) = delete;
    Machine& operator=(const Machine&) = delete;
    ~Machine() { close(); }

    void open()
    {
        int error = 0;
        file_ = phantom_um_open(machine_.get(), O_RDWR | O_NONBLOCK, &error);
        must(file_ != nullptr, "the device cannot be opened");
        page_ = phantom_um_mmap(file_, &error);
        must(page_ != nullptr, "the status page cannot be mapped");
    }
    void close()
    {
        if (file_)
            phantom_um_close(file_);
        file_ = nullptr;
    }
    int call(unsigned long request, void* argument = nullptr)
    {
        return phantom_um_ioctl(file_, request, argument);
    }
    [[nodiscard]] phantom_um* raw() const { return machine_.get(); }
    [[nodiscard]] const phantom_status& page() const { return *page_; }
    /// As many records as there are and fit: how many.
    std::size_t read(std::span<phantom_tick> records)
    {
        const ssize_t bytes = phantom_um_read(file_, records.data(), records.size_bytes());
        return bytes > 0 ? std::size_t(bytes) / sizeof(phantom_tick) : 0;
    }

  private:
    struct Destroy {
        void operator()(phantom_um* machine) const { phantom_um_destroy(machine); }
    };
    std::unique_ptr<phantom_um, Destroy> machine_;
    phantom_um_file* file_ = nullptr;
    const phantom_status* page_ = nullptr;
};

class Life final : public Subject {
  public:
    explicit Life(std::uint32_t choice);

    bool submit(const phantom_set& set) override;
    void model(const phantom_model& model) override;
    void tick(const Point& tip_nm) override;
    void control(Control what, std::uint32_t value) override;
    void finish() override;

  private:
    /// The same call on every machine; they must answer the same.
    template <class Call>
    int both(Call call);
    void start(std::uint32_t value);
    void odd_call(std::uint32_t value);
    void read();
    void check(const phantom_tick& record);

    std::deque<Machine> machines_;
    std::array<phantom_tick, 32> records_, others_; ///< of read(); too large to clear each time
    phantom_start start_{};
    std::uint64_t last_id_ = 0, last_time_ns_ = 0;
    std::uint32_t fail_allocation_ = 0;
    bool asleep_ = false, abandoned_ = false;
    std::int32_t force_un_[3] = {0, 0, 0};
};

Life::Life(std::uint32_t choice)
{
    constexpr std::uint32_t rates[] = {1000, 3000, 10000, 1001};
    const std::uint32_t rate_hz = rates[choice / 2 % 4];
    if (choice & 1) {
        machines_.emplace_back(PHANTOM_ISA_DOUBLE, rate_hz);
    } else {
        machines_.emplace_back(PHANTOM_ISA_SSE2, rate_hz);
        // the best that this CPU has
        machines_.emplace_back(PHANTOM_ISA_NONE, rate_hz);
    }
    start(choice / 8);
}

template <class Call>
int Life::both(Call call)
{
    const int first = call(machines_.front());
    for (std::size_t i = 1; i < machines_.size(); ++i)
        must(call(machines_[i]) == first, "two machines answer the same call differently");
    return first;
}

bool Life::submit(const phantom_set& set)
{
    const int error = both([&](Machine& m) {
        phantom_um_inject_allocation_failure(fail_allocation_);
        phantom_set copy = set;
        if (!copy.time_ns)
            copy.time_ns = machines_.front().page().time_ns;
        const int result = m.call(PHANTOM_SUBMIT_SET, &copy);
        phantom_um_inject_allocation_failure(0);
        return result;
    });
    must(error == 0 || error == -EINVAL || error == -EFAULT || (error == -ENOMEM && fail_allocation_) ||
             error == -EAGAIN,
         "SUBMIT_SET answers what it never should");
    fail_allocation_ = 0;
    if (error == 0)
        last_id_ = set.id;
    return error == 0;
}

void Life::model(const phantom_model& model)
{
    const int error = both([&](Machine& m) {
        phantom_model copy = model;
        return m.call(PHANTOM_SET_MODEL, &copy);
    });
    must(error == 0 || error == -EINVAL || error == -EOPNOTSUPP, "SET_MODEL answers what it never should");
}

void Life::tick(const Point& tip_nm)
{
    const int moved = both([&](Machine& m) {
        phantom_sim_move move{{tip_nm[0], tip_nm[1], tip_nm[2]}, 0};
        return m.call(PHANTOM_SIM_MOVE, &move);
    });
    must(moved == 0, "SIM_MOVE refuses a position within its limits");
    if (both([](Machine& m) { return phantom_um_step(m.raw(), 1); }) == 1)
        read();
}

/// Any limits that the module accepts, off as often as on.
void Life::start(std::uint32_t value)
{
    phantom_start wanted{};
    wanted.flags = value & 1 ? PHANTOM_START_LIMITS_OFF : 0;
    wanted.ramp_ms = 1 + (value >> 1) % ramp_ms_most;
    wanted.max_force_un = value >> 6 & 1 ? 1000000U : 0;
    wanted.slew_un_per_ms = value >> 7 & 1 ? 100000U : 0xffffffffU * (value >> 8 & 1);
    wanted.max_speed_um_s = value >> 9 & 1 ? 0 : 0xffffffffU;
    wanted.stall_us = value >> 10 & 1 ? 0 : 0xffffffffU;
    wanted.stale_ms = value >> 11 & 1 ? 5 : 1000000;
    const int error = both([&](Machine& m) {
        phantom_start copy = wanted;
        return m.call(PHANTOM_START, &copy);
    });
    must(error == 0 || error == -EBUSY || error == -EIO, "START answers what it never should");
    if (error)
        return;
    start_ = wanted;
    abandoned_ = false;
    std::fill_n(force_un_, 3, 0);
    last_time_ns_ = 0;
}

/// Calls that must be refused whatever state the machine is in.
void Life::odd_call(std::uint32_t value)
{
    const unsigned long requests[] = {PHANTOM_SET_RATE, PHANTOM_SET_MODEL,  PHANTOM_START,
                                      PHANTOM_SIM_MOVE, PHANTOM_SUBMIT_SET, PHANTOM_GET_INFO};
    const unsigned long request = requests[value % 6];
    if (value >> 8 & 1) { // nobody's memory
        must(both([&](Machine& m) { return m.call(request, reinterpret_cast<void*>(16)); }) == -EFAULT,
             "a pointer into nobody's memory is not refused");
        return;
    }
    std::uint8_t bytes[sizeof(phantom_info) + sizeof(phantom_set)];
    std::memset(bytes, 0xff, sizeof(bytes));
    if (request != PHANTOM_GET_INFO)
        must(both([&](Machine& m) { return m.call(request, bytes); }) == -EINVAL,
             "an argument of nothing but ones is not refused");
    must(both([&](Machine& m) { return m.call(0xE7F0UL + (value >> 16), bytes); }) == -ENOTTY,
         "an unknown call is not refused");
}

void Life::control(Control what, std::uint32_t value)
{
    const auto plain = [&](unsigned long request) {
        return both([request](Machine& m) { return m.call(request); });
    };
    switch (what) {
    case Control::Start:
        start(value);
        break;
    case Control::Stop:
        must(plain(PHANTOM_STOP) == 0, "STOP fails");
        read();
        break;
    case Control::Rate:
        both([&](Machine& m) {
            phantom_rate rate{PHANTOM_RATE_MIN_HZ + value % (PHANTOM_RATE_MAX_HZ - PHANTOM_RATE_MIN_HZ + 2),
                              0};
            return m.call(PHANTOM_SET_RATE, &rate);
        });
        break;
    case Control::ClearFault:
        plain(PHANTOM_CLEAR_FAULT);
        break;
    case Control::Stall:
        both([&](Machine& m) {
            phantom_um_inject_stall(m.raw(), value);
            return 0;
        });
        break;
    case Control::DeviceError:
        both([&](Machine& m) {
            phantom_um_inject_device_error(m.raw(), value % 2 ? 0 : value % 4 ? -EIO : -ENODEV);
            return 0;
        });
        break;
    case Control::Sleep:
        asleep_ = !asleep_;
        abandoned_ = true;
        both([&](Machine& m) {
            if (!asleep_)
                return phantom_um_resume(m.raw());
            phantom_um_suspend(m.raw());
            return 0;
        });
        read();
        std::fill_n(force_un_, 3, 0);
        break;
    case Control::Reopen:
        for (Machine& machine : machines_) {
            machine.close();
            machine.open();
        }
        last_id_ = 0;
        start(value);
        break;
    case Control::Allocation:
        fail_allocation_ = 1 + value % 4;
        break;
    case Control::Call:
        odd_call(value);
        break;
    }
}

void Life::read()
{
    std::size_t count = 0;
    do {
        count = machines_.front().read(records_);
        for (std::size_t i = 1; i < machines_.size(); ++i)
            must(machines_[i].read(others_) == count &&
                     std::memcmp(records_.data(), others_.data(), count * sizeof(phantom_tick)) == 0,
                 "two instruction sets leave different records of the same life");
        for (std::size_t i = 0; i < count; ++i)
            check(records_[i]);
    } while (count == records_.size());
    must((machines_.front().page().sequence & 1) == 0, "the status page is left half written");
}

void Life::check(const phantom_tick& record)
{
    must(!(record.faults & PHANTOM_FAULT_NUMERIC), "the force of an accepted set is no number");
    must(record.set_id == last_id_, "the set in use is not the last one that was accepted");
    must(!record.faults || norm(record.force_un) == 0, "there is a force although a fault is latched");
    const std::uint64_t elapsed = last_time_ns_ ? record.time_ns - last_time_ns_ : 0;
    last_time_ns_ = record.time_ns;
    if (!(start_.flags & PHANTOM_START_LIMITS_OFF)) {
        const double most = start_.max_force_un ? start_.max_force_un : 10e6;
        must(norm(record.force_un) <= most + rounding_un, "the force is larger than START allows");
        // more than two periods count as two
        const double slew = start_.slew_un_per_ms ? start_.slew_un_per_ms : 1e6;
        const double step =
            std::hypot(double(record.force_un[0]) - force_un_[0], double(record.force_un[1]) - force_un_[1],
                       double(record.force_un[2]) - force_un_[2]);
        const double period_ms = 1e3 / record.rate_hz;
        const double time_ms = elapsed ? std::min(1e-6 * double(elapsed), 2 * period_ms) : period_ms;
        must(record.faults || abandoned_ || step <= slew * time_ms + rounding_un,
             "the force steps by more than START allows");
    }
    std::copy_n(record.force_un, 3, force_un_);
}

void Life::finish()
{
    read();
    // far from all sets, so that closing takes no time
    tick({PHANTOM_POSITION_MAX_NM, 0, 0});
    for (Machine& machine : machines_)
        machine.close();
}

} // namespace

std::unique_ptr<Subject> make_life(std::uint32_t choice)
{
    return std::make_unique<Life>(choice);
}

} // namespace phantom::fuzz
