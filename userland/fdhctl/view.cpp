// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl view: becomes fdhview, which lies beside fdhctl.
#include "fdhctl/view.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "fdhctl/command_line.hpp"

namespace phantom::fdhctl {

int exec_view(const std::vector<std::string>& arguments)
{
    std::error_code code;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", code);
    if (code)
        return fail({"/proc/self/exe", code.message()});
    const std::string program = (self.parent_path() / "fdhview").string();
    std::vector<std::string> words{program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (std::string& word : words)
        argv.push_back(word.data());
    argv.push_back(nullptr);
    ::execv(program.c_str(), argv.data());
    if (errno == ENOENT)
        return fail({program, "is not there: the viewer was not built", "make all builds it"});
    return fail({program, fmt::format("cannot be started: {}", std::strerror(errno))});
}

CLI::Option* add_picture(CLI::App& app, std::optional<std::string>& picture)
{
    return app
        .add_option(
            "--picture", picture,
            "draw creases, rims, faults and where triangles are too fine, in colour; needs no display")
        ->type_name("FILE.png");
}

int draw_picture(const std::optional<std::string>& picture, std::vector<std::string> scene_words,
                 double feed_rate_hz)
{
    if (!picture)
        return exit_success;
    // Nothing of what was printed may be lost with this program.
    std::fflush(stdout);
    scene_words.insert(scene_words.end(),
                       {"--survey", *picture, "--feed-rate", fmt::format("{}", feed_rate_hz)});
    return exec_view(scene_words);
}

Run add_view(CLI::App& app)
{
    // All words but --help go on as they are: fdhview checks them.
    app.prefix_command();
    app.footer("Usage: fdhctl view SCENE [OPTIONS]\nSCENE and every option go to fdhview, which lies beside "
               "fdhctl: fdhview --help lists them.");
    return [&app] {
        const std::vector<std::string> words = app.remaining();
        if (words.empty()) {
            fail({"", "view: SCENE is required", "see fdhctl view --help"});
            return exit_usage;
        }
        return exec_view(words);
    };
}

} // namespace phantom::fdhctl
