// SPDX-License-Identifier: GPL-2.0-or-later
// fdhview: the feeder with a face. Shows a scene being touched, live or out of a trace.
#include <cstdio>
#include <exception>

#include <unistd.h>

#include <vtkObject.h>

#include "view/display.hpp"
#include "view/live_view.hpp"
#include "view/options.hpp"
#include "view/survey_view.hpp"
#include "view/trace_view.hpp"

namespace {

using phantom::Error;
using phantom::Status;
using namespace phantom::view;

/// A picture that cannot be written is told before the work, not after it.
Status check_output(const std::optional<std::filesystem::path>& file)
{
    if (!file)
        return phantom::success();
    std::error_code ignored;
    if (std::filesystem::is_directory(*file, ignored))
        return Error{file->string(), "is a directory, expected the name of a PNG file"};
    const auto folder = file->has_parent_path() ? file->parent_path() : std::filesystem::path(".");
    if (!std::filesystem::is_directory(folder, ignored))
        return Error{file->string(), "the folder " + folder.string() + " does not exist", "create it first"};
    if (access(folder.c_str(), W_OK) != 0)
        return Error{file->string(), "the folder " + folder.string() + " cannot be written to"};
    return phantom::success();
}

/// Input that cannot be right is told before a display is asked for.
Status check_input(const Options& options)
{
    std::error_code ignored;
    for (const auto& file : {std::optional(options.scene), options.trace, options.script})
        if (file && !std::filesystem::exists(*file, ignored))
            return Error{file->string(), "no such file"};
    return phantom::success();
}

Status run(const Options& options)
{
    for (const Status& status : {check_input(options), check_output(options.screenshot),
                                 check_output(options.chart), check_output(options.survey)})
        if (!status)
            return status;
    const auto need = options.offscreen() ? Display::Need::offscreen : Display::Need::window;
    // Outlives every window: VTK does not survive the loss of its display.
    auto display = Display::acquire(need, options.width, options.height);
    if (!display)
        return display.error();
    if (options.survey)
        return run_survey_view(options);
    return options.trace ? run_trace_view(options) : run_live_view(options);
}

} // namespace

int main(int argc, char** argv)
{
    const auto parsed = parse_options(argc, argv);
    if (const int* status = std::get_if<int>(&parsed))
        return *status;
    vtkObject::GlobalWarningDisplayOff();
    try {
        const Status status = run(std::get<Options>(parsed));
        if (status)
            return 0;
        std::fprintf(stderr, "fdhview: %s\n", status.error().text().c_str());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "fdhview: %s\n", error.what());
    }
    return 1;
}
