// SPDX-License-Identifier: GPL-2.0-or-later
// Device: the one class that talks to phantom_rt, be it the kernel's or the user-mode build of the
// same module. Calls are those of phantom_abi.h; errors are sentences.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "phantom_abi.h"

namespace phantom::device {

/// A set of patches ready to be submitted: owns what phantom_set points to.
struct PatchSet {
    /// Counts and pointers are filled in by Device::submit(), and of `effects` what materials name: effects
    /// of space and TIP stand there.
    phantom_set header{};
    std::vector<phantom_patch> patches;
    std::vector<phantom_material> materials;
    std::vector<phantom_object> objects;
    std::vector<std::uint64_t> effect_tables; ///< as they lie behind the materials: phantom_abi.h, EFFECTS
};

struct UsermodeOptions {
    bool virtual_clock = false;
    std::uint32_t rate_hz = 1000;
    int cpu = -1;
    std::uint32_t max_force_un = 0;       ///< 0: the module's default
    std::uint32_t isa = PHANTOM_ISA_NONE; ///< NONE: best the CPU has
    std::uint32_t patches_max = 0;        ///< 0: PHANTOM_PATCHES_MAX
};

enum class Access { feeder, observer };

class Device {
  public:
    /// Hears what the feeder asks of the device. Calls come from the thread that asks.
    class Listener {
      public:
        virtual ~Listener() = default;
        /// START succeeded; start_ns: of the status page.
        virtual void started(const phantom_start& start, std::uint64_t start_ns) = 0;
        /// SUBMIT_SET is about to be made; when it is refused, another may come with the same id.
        virtual void submitting(const PatchSet& set) = 0;
    };

    /// The kernel's device; without a node the first of kernel_nodes(). Fails with a sentence (not loaded, no
    /// permission, busy feeder).
    static Result<Device> open_kernel(Access access, std::string node = {});
    /// A machine of our own.
    static Result<Device> open_usermode(const UsermodeOptions& options);

    Device(Device&&) noexcept;
    Device& operator=(Device&&) noexcept;
    ~Device(); ///< closes; the module ramps the force down

    [[nodiscard]] bool is_kernel() const;
    /// True for a user-mode machine whose time passes only in step().
    [[nodiscard]] bool has_virtual_clock() const;
    /// "/dev/phantom_rt0" or "user mode".
    [[nodiscard]] const std::string& name() const;
    [[nodiscard]] const phantom_info& info() const;

    Status set_rate(std::uint32_t hz);
    Status set_model(const phantom_model& model);
    Status start(const phantom_start& start);
    Status stop();
    /// Fills header.id (last + 1), counts, effects and pointers; EAGAIN is retried for up to 50 ms.
    Status submit(PatchSet& set);
    /// As submit(), but false at once when every slot is in use (a fade holds one): the set before it
    /// stays. For a virtual clock, where waiting frees nothing.
    Result<bool> try_submit(PatchSet& set);
    Status move_simulated_tip(const std::array<std::int64_t, 3>& tip_nm);
    Status clear_fault();

    /// A consistent copy of the status page.
    [[nodiscard]] phantom_status status() const;
    /// Waits until a new set is needed or a fault came (true), or the time is over (false).
    Result<bool> wait_event(std::chrono::milliseconds timeout);
    /// Records since the last call, at most 4096; empty when there are none.
    Result<std::vector<phantom_tick>> read_ticks();

    /// From now on; must outlive the device or be taken away with nullptr. Not while another thread uses the
    /// device.
    void listen(Listener* listener) { listener_ = listener; }

    /// Virtual clock only.
    Status step(std::uint32_t ticks);
    /// Virtual clock only: runs another machine's tick again, as phantom_um_replay() says. False: the run is
    /// over here. Its set is submitted before with submit_as(), which keeps header.id.
    Result<bool> replay(const phantom_tick& record, std::uint64_t due_ns);
    /// That machine slept before its tick of the period that began at due_ns.
    Status replay_sleep(const phantom_tick& record, std::uint64_t due_ns);
    Status set_time(std::uint64_t now_ns);
    Status submit_as(PatchSet& set);
    /// "SCHED_FIFO, CPU 1", or why not; for reports. Empty for the kernel.
    [[nodiscard]] std::string thread_text() const;

  private:
    struct Transport;
    struct KernelTransport;
    struct UsermodeTransport;
    explicit Device(std::unique_ptr<Transport> transport);
    static Result<Device> greet(std::unique_ptr<Transport> transport);
    std::unique_ptr<Transport> transport_;
    /// SUBMIT_SET with header.id as it is: 0 or -errno.
    int call_submit(PatchSet& set);
    phantom_info info_{};
    std::uint64_t last_set_id_ = 0;
    Listener* listener_ = nullptr;
};

/// The nodes that the module has, by number: /dev/phantom_rt0, ... At least PHANTOM_DEVICE_NODE, there or
/// not.
std::vector<std::string> kernel_nodes(const std::filesystem::path& devices = "/sys/class/phantom_rt");

/// Durations behind a histogram: value below which `fraction` of the counts lie, in ns (upper end of the
/// bucket).
double percentile_ns(const phantom_histogram& histogram, double fraction);
std::uint64_t total_count(const phantom_histogram& histogram);

/// The upper end of a bucket of phantom_histogram, in ns.
double bucket_end_ns(std::uint32_t bucket);

const char* state_name(std::uint32_t state);
const char* isa_name(std::uint32_t isa);
const char* device_name(std::uint32_t device);
/// "projected, 2 Newton steps, combine bounded, proxy paper, arith float"
std::string model_text(const phantom_model& model);
std::string fault_names(std::uint32_t faults);

/// Words of the command line ("paper", "projected", "bounded", ...) to numbers; the error lists the words.
Result<phantom_model> model_from_words(const std::string& model, const std::string& combine,
                                       const std::string& proxy, const std::string& arith, int steps);

} // namespace phantom::device
