// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl record: the ticks of a device that somebody else feeds.
#include <chrono>
#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "device/recording.hpp"
#include "fdhctl/command_line.hpp"
#include "fdhctl/end_signals.hpp"
#include "fdhctl/touch_record.hpp"

namespace phantom::fdhctl {

namespace {

using Clock = std::chrono::steady_clock;

struct Options {
    std::string output, node;
    double seconds = 0; ///< 0: until a signal
    bool json = false;
};

/// Records are read this often; the module's ring holds far more.
constexpr std::chrono::milliseconds collect_period{20};

/// A session in user mode has no device that others could open.
Error no_device(Error error)
{
    const Result<std::string> answer = ask_session(R"({"command":"status"})");
    if (answer && nlohmann::json::parse(*answer).value("device", "") == "user mode")
        return {"", "what runs is in user mode, where nobody else can read its ticks",
                "fdhctl load SCENE --usermode --record FILE"};
    return error;
}

Status collect(const Options& options, const EndSignals& signals, device::Device& device, TouchRecord& record)
{
    const auto nothing_known = [](std::uint64_t) { return 0.0; };
    const auto begin = Clock::now();
    bool more = true;
    while (more) {
        more = !signals.wait(collect_period);
        if (options.seconds > 0 &&
            std::chrono::duration<double>(Clock::now() - begin).count() >= options.seconds)
            more = false;
        if (Status status = record.collect(device, nothing_known); !status)
            return status;
    }
    return record.commit();
}

int run(const Options& options)
{
    const EndSignals signals;
    Result<device::Device> device = device::Device::open_kernel(device::Access::observer, options.node);
    if (!device)
        return fail(no_device(device.error()));
    Result<TickFile> file = TickFile::open(options.output);
    if (!file)
        return fail(file.error());
    const bool recording = file->is_recording();
    TouchRecord record(std::move(*file));
    if (Status status = record.begin(*device, false, ""); !status)
        return fail(status.error());
    if (Status status = collect(options, signals, *device, record); !status)
        return fail(status.error());
    const TouchRecord::Totals& totals = record.totals();
    if (options.json) {
        const nlohmann::json answer = {{"device", device->name()},
                                       {"file", options.output},
                                       {"ticks", totals.ticks},
                                       {"contact_ticks", totals.contact_ticks},
                                       {"inside_ticks", totals.inside_ticks},
                                       {"records_lost", totals.lost},
                                       {"force_max_n", totals.force_max_n},
                                       {"sets", false}};
        std::printf("%s\n", answer.dump().c_str());
        return exit_success;
    }
    std::printf("%s: %llu ticks of %s, %llu in contact, |F| at most %.3f N\n", options.output.c_str(),
                static_cast<unsigned long long>(totals.ticks), device->name().c_str(),
                static_cast<unsigned long long>(totals.contact_ticks), totals.force_max_n);
    if (totals.ticks == 0)
        std::printf("no tick came: nobody had started the servo\n");
    if (recording)
        std::printf(
            "without sets, which only the feeder knows: it cannot be computed again (fdhctl load --record "
            "FILE.rec can)\n");
    return exit_success;
}

} // namespace

Run add_record(CLI::App& app)
{
    auto options = std::make_shared<Options>();
    app.add_option("-o,--output", options->output, "a trace (CSV), or the records themselves as FILE.rec")
        ->required()
        ->type_name("T.csv|FILE.rec");
    app.add_option("--seconds", options->seconds, "end after this time [Ctrl-C]")
        ->check(positive())
        ->type_name("S");
    add_device_option(app, options->node);
    app.add_flag("--json", options->json, "what was recorded as one line of JSON");
    return [options] { return run(*options); };
}

} // namespace phantom::fdhctl
