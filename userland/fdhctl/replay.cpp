// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl replay: a recording computed again by the user-mode build, and compared.
#include "study/replay.hpp"

#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/output_file.hpp"
#include "base/progress_bar.hpp"
#include "fdhctl/command_line.hpp"

namespace phantom::fdhctl {

namespace {

using nlohmann::json;
using study::ReplayReport;

struct Options {
    std::string file, output, isa = "best";
    bool json = false;
};

std::uint32_t isa_number(const std::string& word)
{
    return word == "sse2"     ? PHANTOM_ISA_SSE2
           : word == "avx2"   ? PHANTOM_ISA_AVX2
           : word == "avx512" ? PHANTOM_ISA_AVX512
           : word == "double" ? PHANTOM_ISA_DOUBLE
                              : PHANTOM_ISA_NONE;
}

template <typename T>
json vector_json(const T (&v)[3])
{
    return {v[0], v[1], v[2]};
}

json tick_json(const phantom_tick& tick)
{
    return {{"force_un", vector_json(tick.force_un)},
            {"proxy_nm", vector_json(tick.proxy_nm)},
            {"contacts", tick.contacts},
            {"set_id", tick.set_id},
            {"flags", tick.flags},
            {"faults", device::fault_names(tick.faults)}};
}

std::string tick_text(const phantom_tick& tick)
{
    return fmt::format("force {} {} {} uN, proxy {} {} {} nm, {} contacts, set {}, flags {:#x}, faults: {}",
                       tick.force_un[0], tick.force_un[1], tick.force_un[2], tick.proxy_nm[0],
                       tick.proxy_nm[1], tick.proxy_nm[2], tick.contacts, tick.set_id, tick.flags,
                       device::fault_names(tick.faults));
}

json report_json(const device::Recording& recording, const ReplayReport& report)
{
    json fields;
    for (int field = 0; field < study::replay_fields; ++field)
        fields[study::field_name(field)] = report.field_differs[static_cast<std::size_t>(field)];
    json answer = {{"device", recording.origin.device},
                   {"recorded_isa", device::isa_name(recording.origin.isa)},
                   {"scene", recording.origin.scene},
                   {"complete", recording.cut.empty()},
                   {"isa", report.isa},
                   {"runs", report.runs},
                   {"ticks", report.ticks},
                   {"sets", report.sets},
                   {"contact_ticks", report.contact_ticks},
                   {"inside_ticks", report.inside_ticks},
                   {"fading_ticks", report.fading_ticks},
                   {"ramping_ticks", report.ramping_ticks},
                   {"fault_ticks", report.fault_ticks},
                   {"missed", report.missed},
                   {"records_lost", report.lost},
                   {"not_compared", report.uncompared},
                   {"differ", report.differ},
                   {"differ_in", fields},
                   {"worst_force_n", report.worst_force_n},
                   {"worst_proxy_mm", report.worst_proxy_mm},
                   {"notes", report.notes},
                   {"same", report.same()}};
    if (report.first)
        answer["first"] = {{"run", report.first->run + 1},
                           {"tick", report.first->recorded.tick},
                           {"fields", report.first->fields},
                           {"recorded", tick_json(report.first->recorded)},
                           {"here", tick_json(report.first->here)}};
    return answer;
}

std::string report_text(const device::Recording& recording, const ReplayReport& report)
{
    const device::Recording& r = recording;
    std::string text =
        fmt::format("recorded   {}, {}{}{}: {} ticks in {} run{}, {} sets\n", r.origin.device,
                    device::isa_name(r.origin.isa), r.origin.scene[0] ? ", " : "", r.origin.scene, r.ticks(),
                    r.runs.size(), r.runs.size() == 1 ? "" : "s", r.sets.size());
    text += fmt::format(
        "computed   user mode, {}: {} ticks, {} in contact, {} inside, {} fading, {} ramping, {} with "
        "a fault, {} periods missed, {} sets taken\n",
        report.isa, report.ticks, report.contact_ticks, report.inside_ticks, report.fading_ticks,
        report.ramping_ticks, report.fault_ticks, report.missed, report.sets);
    for (const std::string& note : report.notes)
        text += fmt::format("note       {}\n", note);
    if (report.same())
        return text + "compared   force, proxy, contacts, set, flags, faults: the same, bit for bit\n";
    text += fmt::format("compared   {} of {} ticks differ:", report.differ, report.ticks);
    for (int field = 0; field < study::replay_fields; ++field)
        if (const auto count = report.field_differs[static_cast<std::size_t>(field)])
            text += fmt::format(" {} in {};", count, study::field_name(field));
    text.back() = '\n';
    text += fmt::format("worst      force by {:.3g} N, proxy by {:.3g} mm\n", report.worst_force_n,
                        report.worst_proxy_mm);
    return text + fmt::format("first      run {}, tick {}, in {}\n  recorded {}\n  here     {}\n",
                              report.first->run + 1, report.first->recorded.tick, report.first->fields,
                              tick_text(report.first->recorded), tick_text(report.first->here));
}

int run(const Options& options)
{
    const Result<std::vector<device::Recording>> recordings = device::read_recordings(options.file);
    if (!recordings)
        return fail(recordings.error());
    study::ReplayOptions replay;
    replay.isa = isa_number(options.isa);
    replay.csv = !options.output.empty();
    std::string csv;
    bool same = true;
    for (const device::Recording& recording : *recordings) {
        Result<ReplayReport> report = [&] {
            ProgressBar bar("replaying");
            replay.progress = bar.callback();
            return study::replay(recording, replay);
        }();
        if (!report)
            return fail({options.file, report.error().text()});
        // Of several recordings the trace is one: rows of the next behind those of the one before.
        csv += csv.empty() ? report->csv : report->csv.substr(report->csv.find('\n') + 1);
        same = same && report->same();
        const std::string text =
            options.json ? report_json(recording, *report).dump() + "\n" : report_text(recording, *report);
        std::fputs(text.c_str(), stdout);
    }
    if (!options.output.empty())
        if (Status status = write_file(options.output, csv); !status)
            return fail(status.error());
    return same || replay.isa == PHANTOM_ISA_DOUBLE ? exit_success : exit_failed;
}

} // namespace

Run add_replay(CLI::App& app)
{
    auto options = std::make_shared<Options>();
    app.add_option("recording", options->file, "what fdhctl load --record FILE.rec wrote")
        ->required()
        ->type_name("FILE.rec");
    app.add_option("-o,--output", options->output, "a trace of the ticks as they come out here")
        ->type_name("T.csv");
    app.add_option("--isa", options->isa,
                   "instruction set of the tick; double: the same inputs in double, differences are told and "
                   "no failure")
        ->check(CLI::IsMember({"best", "sse2", "avx2", "avx512", "double"}))
        ->type_name("best|sse2|avx2|double")
        ->capture_default_str();
    app.add_flag("--json", options->json, "one line of JSON a recording");
    return [options] { return run(*options); };
}

} // namespace phantom::fdhctl
