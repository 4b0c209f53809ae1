// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl effect: what the running scene feels like, listed and changed.
#include <algorithm>
#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "fdhctl/command_line.hpp"

namespace phantom::fdhctl {

namespace {

using nlohmann::json;

constexpr const char* footer =
    "Without arguments all are listed. NAME is a material (stiffness_n_mm, damping_ns_m), one of its "
    "effects\n"
    "(plate.friction, plate.magnet, plate.texture, plate.texture.second) or an [effect.NAME] of the scene;\n"
    "keys and ranges are those of scene files (scenes/README.md). Vectors are written 0,0,-1. An effect that "
    "the\n"
    "material has not yet comes on with the keys it needs. Changes fade in: the servo takes 20 ms for "
    "effects,\n"
    "the feeder 0.1 s for stiffness and damping.\n\n"
    "  fdhctl effect plate.friction static=0.3 dynamic=0.2\n"
    "  fdhctl effect gravity force_n=0,0,-0.5\n"
    "  fdhctl effect plate.texture off\n";

struct Options {
    std::string name;
    std::vector<std::string> words;
    bool json = false;
};

bool is_switch(const std::vector<std::string>& words)
{
    return words.size() == 1 && (words[0] == "on" || words[0] == "off");
}

json request_of(const Options& options)
{
    json request = {{"command", "effect"}};
    if (!options.name.empty())
        request["name"] = options.name;
    if (is_switch(options.words)) {
        request["on"] = options.words[0] == "on";
        return request;
    }
    for (const std::string& word : options.words) {
        const std::size_t at = word.find('=');
        request["set"][word.substr(0, at)] = word.substr(at + 1);
    }
    return request;
}

std::string text_of(const json& value)
{
    if (value.is_string())
        return value.get<std::string>();
    if (value.is_number())
        return fmt::format("{:.6g}", value.get<double>());
    std::string text;
    for (const json& part : value)
        text += (text.empty() ? "" : ",") + fmt::format("{:.6g}", part.get<double>());
    return text;
}

void print(const json& effects)
{
    std::size_t width = 0;
    for (const json& effect : effects)
        width = std::max(width, effect["name"].get<std::string>().size());
    for (const json& effect : effects) {
        std::string line = fmt::format("{:<{}}  {:<14}", effect["name"].get<std::string>(), width,
                                       effect["kind"].get<std::string>());
        if (!effect["on"].get<bool>())
            line += "  off";
        for (const auto& [key, value] : effect["values"].items())
            line += "  " + key + "=" + text_of(value);
        std::printf("%s\n", line.c_str());
    }
}

} // namespace

Run add_effect(CLI::App& app)
{
    auto options = std::make_shared<Options>();
    app.add_option("name", options->name, "of a material, one of its effects, or an effect of space")
        ->type_name("NAME");
    app.add_option("words", options->words, "KEY=VALUE ..., or on, or off")->type_name("KEY=VALUE");
    app.add_flag("--json", options->json, "the answer as one line of JSON");
    app.footer(footer);
    app.callback([options] {
        for (const std::string& word : options->words)
            if (!is_switch(options->words) && (word.find('=') == std::string::npos || word[0] == '='))
                throw CLI::ValidationError(word, "expected KEY=VALUE, on or off");
    });
    return [options] {
        const Result<std::string> answer = ask_session(request_of(*options).dump());
        if (!answer)
            return fail(answer.error());
        if (options->json) {
            std::printf("%s\n", answer->c_str());
            return exit_success;
        }
        const json said = json::parse(*answer);
        print(said.contains("effects") ? said["effects"] : json::array({said["effect"]}));
        return exit_success;
    };
}

} // namespace phantom::fdhctl
