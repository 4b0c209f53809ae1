// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl devices: what can be driven here, how, and what to do when it cannot.
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <unistd.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "device/device.hpp"
#include "fdhctl/command_line.hpp"
#include "feeder/control_socket.hpp"

namespace phantom::fdhctl {

namespace {

struct Entry {
    std::string name, kind, state, remedy;
    bool usable = false;
};

Entry kernel_entry(const std::string& node)
{
    Entry entry{node, "kernel", "", "", false};
    Result<device::Device> device = device::Device::open_kernel(device::Access::observer, node);
    if (!device) {
        entry.state = device.error().what;
        entry.remedy = device.error().remedy;
        return entry;
    }
    entry.usable = ::access(node.c_str(), R_OK | W_OK) == 0;
    entry.kind = fmt::format("kernel, {} device", device::device_name(device->info().device));
    const phantom_status status = device->status();
    entry.state = fmt::format("{}, {} to {} Hz, at most {:.3g} N", device::state_name(status.state),
                              device->info().rate_min_hz, device->info().rate_max_hz,
                              device->info().max_force_un * 1e-6);
    if (status.faults)
        entry.state += ", fault: " + device::fault_names(status.faults);
    if (device->info().device == PHANTOM_DEVICE_NONE) {
        entry.usable = false;
        entry.remedy = "the module was loaded without a device: device=sim or device=hid";
        return entry;
    }
    if (!entry.usable)
        entry.remedy = "may be read, not fed: a udev rule or membership of its group gives write access";
    return entry;
}

Entry simulated_entry()
{
    Entry entry{"simulated", "user mode", "", "", true};
    const pid_t pid = feeder::control::running_pid();
    entry.state = pid ? fmt::format("in use by process {}", pid) : "ready";
    return entry;
}

int run(bool as_json)
{
    std::vector<Entry> entries;
    for (const std::string& node : device::kernel_nodes())
        entries.push_back(kernel_entry(node));
    entries.push_back(simulated_entry());
    constexpr const char* hardware = "arms: WoodenHaptics/Polhem over USB HID, by the module loaded with "
                                     "device=hid; no back end yet for the Novint "
                                     "Falcon and PCI PHANToMs";
    if (as_json) {
        nlohmann::json list = nlohmann::json::array();
        for (const Entry& entry : entries)
            list.push_back({{"name", entry.name},
                            {"kind", entry.kind},
                            {"state", entry.state},
                            {"usable", entry.usable},
                            {"remedy", entry.remedy}});
        const nlohmann::json answer = {{"devices", list}, {"hardware_back_ends", {"hid"}}};
        std::printf("%s\n", answer.dump().c_str());
        return exit_success;
    }
    for (const Entry& entry : entries) {
        std::printf("%-18s %-10s %-11s %s\n", entry.name.c_str(), entry.kind.c_str(),
                    entry.usable ? "usable" : "not usable", entry.state.c_str());
        if (!entry.remedy.empty())
            std::printf("%-18s %s\n", "", entry.remedy.c_str());
    }
    std::printf("%s\n", hardware);
    return exit_success;
}

} // namespace

Run add_devices(CLI::App& app)
{
    auto as_json = std::make_shared<bool>(false);
    app.add_flag("--json", *as_json, "as one line of JSON");
    return [as_json] { return run(*as_json); };
}

} // namespace phantom::fdhctl
