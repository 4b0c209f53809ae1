// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl rate: the running servo's rate, without a missed tick.
#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "fdhctl/command_line.hpp"

namespace phantom::fdhctl {

Run add_rate(CLI::App& app)
{
    struct Options {
        double rate_hz = 0;
        bool json = false;
    };
    auto options = std::make_shared<Options>();
    app.add_option("rate", options->rate_hz, "servo rate, 1000 to 10000")
        ->required()
        ->check(CLI::Range(double{PHANTOM_RATE_MIN_HZ}, double{PHANTOM_RATE_MAX_HZ}))
        ->type_name("HZ");
    app.add_flag("--json", options->json, "the answer as one line of JSON");
    return [options] {
        const nlohmann::json request = {{"command", "rate"}, {"rate_hz", options->rate_hz}};
        const Result<std::string> answer = ask_session(request.dump());
        if (!answer)
            return fail(answer.error());
        if (options->json)
            std::printf("%s\n", answer->c_str());
        else
            std::printf("rate %u Hz\n", nlohmann::json::parse(*answer)["rate_hz"].get<unsigned>());
        return exit_success;
    };
}

} // namespace phantom::fdhctl
