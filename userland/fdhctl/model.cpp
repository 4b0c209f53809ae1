// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl model: the running servo's contact model; what is not named stays as it is.
#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "fdhctl/command_line.hpp"

namespace phantom::fdhctl {

namespace {

nlohmann::json request_of(const scene::ServoSettings& words)
{
    nlohmann::json request = {{"command", "model"}};
    const auto add = [&request](const char* key, const auto& value) {
        if (value)
            request[key] = *value;
    };
    add("model", words.model);
    add("combine", words.combine);
    add("proxy", words.proxy);
    add("arith", words.arith);
    add("steps", words.steps);
    return request;
}

} // namespace

Run add_model(CLI::App& app)
{
    struct Options {
        ServoOptions servo;
        bool json = false;
    };
    auto options = std::make_shared<Options>();
    options->servo.add(app, true);
    app.add_flag("--json", options->json, "the answer as one line of JSON");
    // At least one word, or there is nothing to change.
    app.callback([options] {
        if (request_of(options->servo.words).size() == 1)
            throw CLI::RequiredError("a model, or one of --steps, --combine, --proxy, --arith");
    });
    return [options] {
        const Result<std::string> answer = ask_session(request_of(options->servo.words).dump());
        if (!answer)
            return fail(answer.error());
        if (options->json)
            std::printf("%s\n", answer->c_str());
        else
            std::printf("model %s\n", nlohmann::json::parse(*answer)["model"].get<std::string>().c_str());
        return exit_success;
    };
}

} // namespace phantom::fdhctl
