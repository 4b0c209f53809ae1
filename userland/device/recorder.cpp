// SPDX-License-Identifier: GPL-2.0-or-later
#include "device/recorder.hpp"

#include <algorithm>
#include <cstring>

namespace phantom::device {

namespace {

template <typename T>
std::string_view bytes_of(const T& value)
{
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

template <typename T>
std::string_view bytes_of(std::span<const T> values)
{
    return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

template <std::size_t size>
void copy_text(char (&to)[size], std::string_view from)
{
    std::memcpy(to, from.data(), std::min(from.size(), size - 1));
}

} // namespace

Recorder::Recorder(const Device& device, bool fed, std::string_view scene)
{
    recording_header header{};
    std::memcpy(header.magic, RECORDING_MAGIC, sizeof header.magic);
    header.version = RECORDING_VERSION;
    bytes_ = bytes_of(header);
    recording_origin origin{};
    origin.info = device.info();
    origin.isa = device.status().isa;
    origin.flags = fed ? RECORDING_FED : 0;
    copy_text(origin.device, device.name());
    copy_text(origin.scene, scene);
    chunk(RECORDING_ORIGIN, {bytes_of(origin)});
    counts_.bytes = bytes_.size();
}

void Recorder::chunk(std::uint32_t kind, std::initializer_list<std::string_view> parts)
{
    recording_chunk head{};
    head.kind = kind;
    for (const std::string_view part : parts)
        head.size += static_cast<__u32>(part.size());
    head.checksum = recording_checksum(0, &head, offsetof(recording_chunk, checksum));
    for (const std::string_view part : parts)
        head.checksum = recording_checksum(head.checksum, part.data(), part.size());
    const std::size_t before = bytes_.size();
    bytes_ += bytes_of(head);
    for (const std::string_view part : parts)
        bytes_ += part;
    counts_.bytes += bytes_.size() - before;
}

void Recorder::started(const phantom_start& start, std::uint64_t start_ns)
{
    const std::lock_guard guard(mutex_);
    recording_start out{};
    out.start_ns = start_ns;
    out.start = start;
    chunk(RECORDING_START, {bytes_of(out)});
}

void Recorder::submitting(const PatchSet& set)
{
    const std::lock_guard guard(mutex_);
    phantom_set header = set.header;
    header.patches = header.materials = header.objects = 0;
    chunk(RECORDING_SET,
          {bytes_of(header), bytes_of(std::span(set.patches)), bytes_of(std::span(set.materials)),
           bytes_of(std::span(set.effect_tables)), bytes_of(std::span(set.objects))});
    ++counts_.sets;
}

void Recorder::add(std::span<const phantom_tick> ticks, const phantom_status& before)
{
    const std::lock_guard guard(mutex_);
    if (!ticks.empty())
        chunk(RECORDING_TICKS, {bytes_of(ticks)});
    counts_.ticks += ticks.size();
    if (before.tick == 0 || (before.tick == mark_.tick && before.start_ns == mark_.start_ns))
        return;
    mark_ = {before.start_ns, before.tick, before.missed};
    chunk(RECORDING_MARK, {bytes_of(mark_)});
}

void Recorder::end()
{
    const std::lock_guard guard(mutex_);
    recording_end out{};
    out.ticks = counts_.ticks;
    out.sets = counts_.sets;
    chunk(RECORDING_END, {bytes_of(out)});
}

std::string Recorder::take()
{
    const std::lock_guard guard(mutex_);
    return std::exchange(bytes_, {});
}

Recorder::Counts Recorder::counts() const
{
    const std::lock_guard guard(mutex_);
    return counts_;
}

} // namespace phantom::device
