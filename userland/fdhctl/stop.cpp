// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl stop: ramps down and waits until the session has ended.
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "fdhctl/command_line.hpp"
#include "feeder/control_socket.hpp"

namespace phantom::fdhctl {

namespace {

/// The ramp takes a quarter of a second unless the scene asks for more.
constexpr std::chrono::seconds patience{10};

int run(bool as_json)
{
    const Result<std::string> answer = ask_session(R"({"command":"stop"})");
    if (!answer)
        return fail(answer.error());
    const int pid = nlohmann::json::parse(*answer)["pid"].get<int>();
    const auto end = std::chrono::steady_clock::now() + patience;
    while (feeder::control::running_pid() == pid) {
        if (std::chrono::steady_clock::now() > end)
            return fail({"", fmt::format("process {} was asked to stop and has not ended yet", pid)});
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    if (as_json)
        std::printf("%s\n", answer->c_str());
    else
        std::printf("stopped (process %d)\n", pid);
    return exit_success;
}

} // namespace

Run add_stop(CLI::App& app)
{
    auto as_json = std::make_shared<bool>(false);
    app.add_flag("--json", *as_json, "the answer as one line of JSON");
    return [as_json] { return run(*as_json); };
}

} // namespace phantom::fdhctl
