// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl status: what the running servo does, through the session that feeds it, else as an observer of the
// kernel's device.
#include "feeder/status_report.hpp"

#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "device/device.hpp"
#include "fdhctl/command_line.hpp"

namespace phantom::fdhctl {

namespace {

using nlohmann::json;

/// Of a session, or of the kernel's device without one (somebody else's program feeds it). With a node: of
/// that.
Result<json> status_of_whatever_runs(const std::string& node)
{
    const Result<std::string> answer = ask_session(R"({"command":"status"})");
    if (answer) {
        json status = json::parse(*answer);
        if (node.empty() || status["device"] == node)
            return status;
    }
    const Result<device::Device> kernel = device::Device::open_kernel(device::Access::observer, node);
    if (!kernel)
        return node.empty() ? answer.error() : kernel.error();
    json status = feeder::status_json(kernel->status());
    status["device"] = kernel->name();
    return status;
}

int run(bool as_json, const std::string& node)
{
    const Result<json> status = status_of_whatever_runs(node);
    if (!status)
        return fail(status.error());
    if (as_json) {
        std::printf("%s\n", status->dump().c_str());
        return exit_success;
    }
    if (status->contains("pid"))
        std::printf("%-10s process %d, %s, %s\n%-10s %s, %llu triangles\n", "session",
                    (*status)["pid"].get<int>(), (*status)["device"].get<std::string>().c_str(),
                    (*status)["thread"].get<std::string>().c_str(), "scene",
                    (*status)["scene"].get<std::string>().c_str(),
                    static_cast<unsigned long long>((*status)["triangles"].get<std::uint64_t>()));
    else
        std::printf("%-10s %s, fed by another program\n", "device",
                    (*status)["device"].get<std::string>().c_str());
    std::printf("%s", feeder::status_text(*status).c_str());
    return exit_success;
}

} // namespace

Run add_status(CLI::App& app)
{
    auto as_json = std::make_shared<bool>(false);
    auto node = std::make_shared<std::string>();
    add_device_option(app, *node);
    app.add_flag("--json", *as_json, "as one line of JSON");
    return [as_json, node] { return run(*as_json, *node); };
}

} // namespace phantom::fdhctl
