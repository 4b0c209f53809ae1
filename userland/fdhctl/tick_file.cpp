// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdhctl/tick_file.hpp"

#include <fmt/format.h>

#include "device/recording.hpp"

namespace phantom::fdhctl {

Result<TickFile> TickFile::open(const std::string& file)
{
    Result<OutputFile> out = OutputFile::open(file);
    if (!out)
        return out.error();
    return TickFile(std::move(*out), device::is_recording_name(file));
}

Status TickFile::begin(device::Device& device, bool fed, const std::string& scene)
{
    if (!is_recording_)
        return file_.append(std::string(feeder::trace_header) + "\n");
    recorder_ = std::make_unique<device::Recorder>(device, fed, scene);
    if (fed)
        device.listen(recorder_.get());
    return success();
}

Status TickFile::append(std::span<const phantom_tick> ticks, const phantom_status& before,
                        const QueryTime& query_us)
{
    if (recorder_) {
        recorder_->add(ticks, before);
        if (Status status = file_.append(recorder_->take()); !status)
            return status;
        return file_.publish();
    }
    std::string text;
    for (const phantom_tick& tick : ticks) {
        if (!first_ns_)
            first_ns_ = tick.time_ns;
        feeder::TraceRow row = feeder::trace_row(tick, static_cast<double>(tick.time_ns - *first_ns_) * 1e-9);
        // A query's time stands once, where its set is used first.
        if (row.set_id != last_set_ && row.set_id != 0)
            row.query_us = query_us(row.set_id);
        last_set_ = row.set_id ? row.set_id : last_set_;
        feeder::append_trace_row(text, row);
    }
    return text.empty() ? success() : file_.append(text);
}

Status TickFile::commit()
{
    if (recorder_) {
        recorder_->end();
        if (Status status = file_.append(recorder_->take()); !status)
            return status;
    }
    return file_.commit();
}

std::string TickFile::text() const
{
    if (!recorder_)
        return {};
    const device::Recorder::Counts counts = recorder_->counts();
    return fmt::format("{} ticks, {} sets, {:.1f} MB", counts.ticks, counts.sets,
                       1e-6 * static_cast<double>(counts.bytes));
}

} // namespace phantom::fdhctl
