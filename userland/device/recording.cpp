// SPDX-License-Identifier: GPL-2.0-or-later
#include "device/recording.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>

#include <fmt/format.h>

namespace phantom::device {

namespace {

using Bytes = std::span<const std::byte>;

struct Chunk {
    std::uint32_t kind = 0;
    Bytes payload;
};

/// One recording being read. Everything is copied out: `bytes` need not be aligned.
class Parser {
  public:
    Parser(Bytes bytes, std::size_t at, const std::string& where) : bytes_(bytes), at_(at), where_(where) {}

    /// Moves `at` behind it.
    Result<Recording> run(std::size_t& at)
    {
        if (Status status = header(); !status)
            return status.error();
        bool ended = false;
        while (!ended && out_.cut.empty()) {
            const std::size_t begin = at_;
            const std::optional<Chunk> chunk = next();
            if (!chunk)
                break;
            if (!have_origin_ && chunk->kind != RECORDING_ORIGIN)
                return Error{where_, "is damaged: a recording begins with its origin"};
            if (Status status = take(*chunk); !status) {
                if (!have_origin_ || chunk->kind == RECORDING_ORIGIN)
                    return status.error();
                out_.cut = fmt::format("damaged at byte {}: {}", begin, status.error().what);
            }
            ended = chunk->kind == RECORDING_END;
        }
        if (!have_origin_)
            return Error{where_, out_.cut.empty() ? "is cut short before its first chunk" : out_.cut};
        sort_into_runs();
        at = out_.cut.empty() ? at_ : bytes_.size();
        return std::move(out_);
    }

  private:
    [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

    template <typename T>
    T copy(Bytes from) const
    {
        T value{};
        std::memcpy(&value, from.data(), sizeof value);
        return value;
    }

    template <typename T>
    static void append(Bytes from, std::size_t count, std::vector<T>& to)
    {
        const std::size_t before = to.size();
        to.resize(before + count);
        if (count > 0)
            std::memcpy(to.data() + before, from.data(), count * sizeof(T));
    }

    Status header()
    {
        if (left() < sizeof(recording_header))
            return Error{where_, "is no recording: too short",
                         "fdhctl load SCENE --record FILE.rec makes one"};
        const auto header = copy<recording_header>(bytes_.subspan(at_));
        if (std::memcmp(header.magic, RECORDING_MAGIC, sizeof header.magic) != 0)
            return Error{where_,
                         at_ == 0 ? "is no recording: it does not begin with " RECORDING_MAGIC
                                  : fmt::format("has no recording at byte {}", at_),
                         "fdhctl load SCENE --record FILE.rec makes one"};
        if (header.version != RECORDING_VERSION)
            return Error{where_, fmt::format("is a recording of version {}, this program reads version {}",
                                             header.version, RECORDING_VERSION)};
        if (header.reserved != 0)
            return Error{where_, "is damaged: its header is not a recording's"};
        at_ += sizeof header;
        return success();
    }

    /// Nothing at the end of what is good; then `cut` says why.
    std::optional<Chunk> next()
    {
        if (left() < sizeof(recording_chunk)) {
            out_.cut = left() == 0 ? "it was not ended" : fmt::format("it is cut short at byte {}", at_);
            return std::nullopt;
        }
        const auto head = copy<recording_chunk>(bytes_.subspan(at_));
        if (head.size > RECORDING_CHUNK_MAX || head.size % 8 != 0 || head.reserved != 0) {
            out_.cut = fmt::format("damaged at byte {}: no chunk", at_);
            return std::nullopt;
        }
        if (head.size > left() - sizeof head) {
            out_.cut = fmt::format("it is cut short at byte {}", at_);
            return std::nullopt;
        }
        const Bytes payload = bytes_.subspan(at_ + sizeof head, head.size);
        std::uint32_t sum = recording_checksum(0, &head, offsetof(recording_chunk, checksum));
        sum = recording_checksum(sum, payload.data(), payload.size());
        if (sum != head.checksum) {
            out_.cut = fmt::format("damaged at byte {}: wrong checksum", at_);
            return std::nullopt;
        }
        at_ += sizeof head + head.size;
        return Chunk{head.kind, payload};
    }

    Status take(const Chunk& chunk)
    {
        switch (chunk.kind) {
        case RECORDING_ORIGIN:
            return take_origin(chunk.payload);
        case RECORDING_START:
            return take_one(chunk.payload, starts_);
        case RECORDING_SET:
            return take_set(chunk.payload);
        case RECORDING_TICKS:
            if (chunk.payload.size() % sizeof(phantom_tick) != 0)
                return Error{"", "a part of a tick"};
            append(chunk.payload, chunk.payload.size() / sizeof(phantom_tick), ticks_);
            return success();
        case RECORDING_MARK:
            return take_one(chunk.payload, marks_);
        default:
            return success();
        }
    }

    template <typename T>
    Status take_one(Bytes payload, std::vector<T>& to)
    {
        if (payload.size() != sizeof(T))
            return Error{"", fmt::format("a chunk of {} bytes, expected {}", payload.size(), sizeof(T))};
        append(payload, 1, to);
        return success();
    }

    Status take_origin(Bytes payload)
    {
        if (payload.size() != sizeof(recording_origin))
            return Error{where_, fmt::format("is damaged: an origin of {} bytes, expected {}", payload.size(),
                                             sizeof(recording_origin))};
        out_.origin = copy<recording_origin>(payload);
        out_.origin.device[sizeof out_.origin.device - 1] = 0;
        out_.origin.scene[sizeof out_.origin.scene - 1] = 0;
        const phantom_info& info = out_.origin.info;
        if (info.abi_version != PHANTOM_ABI_VERSION || info.tick_size != sizeof(phantom_tick))
            return Error{where_,
                         fmt::format("was recorded from version {} of the module's interface with ticks of "
                                     "{} bytes; this program knows version {} with {}",
                                     info.abi_version, info.tick_size, PHANTOM_ABI_VERSION,
                                     sizeof(phantom_tick))};
        have_origin_ = true;
        return success();
    }

    Status take_set(Bytes payload)
    {
        if (payload.size() < sizeof(phantom_set))
            return Error{"", "a part of a set"};
        PatchSet set;
        set.header = copy<phantom_set>(payload);
        payload = payload.subspan(sizeof(phantom_set));
        const std::uint64_t wanted = std::uint64_t{set.header.patch_count} * sizeof(phantom_patch) +
                                     std::uint64_t{set.header.material_count} * sizeof(phantom_material) +
                                     set.header.effect_bytes +
                                     std::uint64_t{set.header.object_count} * sizeof(phantom_object);
        if (wanted != payload.size() || set.header.effect_bytes % sizeof(std::uint64_t) != 0)
            return Error{
                "", fmt::format("a set of {} bytes behind its header, expected {}", payload.size(), wanted)};
        append(payload, set.header.patch_count, set.patches);
        payload = payload.subspan(set.patches.size() * sizeof(phantom_patch));
        append(payload, set.header.material_count, set.materials);
        payload = payload.subspan(set.materials.size() * sizeof(phantom_material));
        append(payload, set.header.effect_bytes / sizeof(std::uint64_t), set.effect_tables);
        payload = payload.subspan(set.header.effect_bytes);
        append(payload, set.header.object_count, set.objects);
        out_.sets[set.header.id] = std::move(set);
        return success();
    }

    /// A run's ticks are those from its START on; without STARTs a run begins where tick numbers begin again.
    void sort_into_runs()
    {
        std::size_t next_start = 0;
        for (const phantom_tick& tick : ticks_) {
            bool begins = out_.runs.empty();
            const recording_start* start = nullptr;
            while (next_start < starts_.size() && starts_[next_start].start_ns < tick.time_ns) {
                start = &starts_[next_start++];
                begins = true;
            }
            if (!begins && tick.tick <= out_.runs.back().ticks.back().tick)
                begins = true;
            if (begins) {
                RecordedRun& run = out_.runs.emplace_back();
                run.started = start != nullptr;
                run.start = start ? start->start : phantom_start{};
                run.start_ns = start ? start->start_ns : 0;
            }
            out_.runs.back().ticks.push_back(tick);
        }
        std::uint64_t last_ns = 0;
        for (RecordedRun& run : out_.runs) {
            give_marks(run, last_ns);
            last_ns = run.ticks.back().time_ns;
        }
    }

    /// The marks of a run are those whose start lies between the last tick of the run before and its own
    /// first.
    void give_marks(RecordedRun& run, std::uint64_t last_ns)
    {
        const phantom_tick& first = run.ticks.front();
        for (const recording_mark& mark : marks_)
            if (mark.start_ns >= std::max(run.start_ns, last_ns) && mark.start_ns <= first.time_ns)
                run.marks.push_back(mark);
        // The thread begins its run a little after START; the first tick comes one period later.
        if (!run.marks.empty())
            run.start_ns = run.marks.back().start_ns;
        else if (first.tick == 1 && first.rate_hz != 0)
            run.start_ns =
                std::max<std::uint64_t>(run.start_ns, due_ns(first) - 1000000000ULL / first.rate_hz);
    }

    Bytes bytes_;
    std::size_t at_;
    const std::string& where_;
    bool have_origin_ = false;
    Recording out_;
    std::vector<recording_start> starts_;
    std::vector<recording_mark> marks_;
    std::vector<phantom_tick> ticks_;
};

Result<std::vector<std::byte>> bytes_of(const std::filesystem::path& file)
{
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"), std::fclose);
    if (!stream)
        return Error{file.string(), std::string("cannot be read: ") + std::strerror(errno)};
    std::vector<std::byte> bytes;
    constexpr std::size_t step = 1U << 20;
    for (std::size_t got = step; got == step;) {
        const std::size_t before = bytes.size();
        bytes.resize(before + step);
        got = std::fread(bytes.data() + before, 1, step, stream.get());
        bytes.resize(before + got);
    }
    if (std::ferror(stream.get()))
        return Error{file.string(), std::string("cannot be read: ") + std::strerror(errno)};
    return bytes;
}

} // namespace

RecordedRun::Losses RecordedRun::losses() const
{
    Losses out{ticks.size(), 0};
    if (ticks.empty())
        return out;
    if (started && ticks.front().tick != 1)
        return {0, ticks.front().tick - 1};
    bool based = ticks.front().tick == 1;
    std::uint64_t unseen = 0; // ran before the first record: the recorder came later
    std::size_t good = 0;     // records up to the last mark without loss
    for (const recording_mark& mark : marks) {
        // What lies behind the last record may be missing from a recording that was cut.
        if (mark.tick < ticks.front().tick || mark.tick > ticks.back().tick || mark.missed >= mark.tick)
            continue;
        const auto behind = std::upper_bound(
            ticks.begin(), ticks.end(), mark.tick,
            [](std::uint64_t number, const phantom_tick& tick) { return number < tick.tick; });
        const auto have = static_cast<std::uint64_t>(behind - ticks.begin());
        const std::uint64_t ran = mark.tick - mark.missed;
        if (!based)
            unseen = ran > have ? ran - have : 0;
        based = true;
        const bool first_loss = out.lost == 0;
        out.lost = std::max(out.lost, ran > have + unseen ? ran - have - unseen : 0);
        if (!first_loss)
            continue;
        if (out.lost == 0) {
            good = have;
            continue;
        }
        // The widest gap since then is where they are missing.
        std::uint64_t widest = 0;
        for (std::size_t i = std::max<std::size_t>(good, 1); i < ticks.size() && i <= have; ++i)
            if (const std::uint64_t gap = ticks[i].tick - ticks[i - 1].tick; gap > widest) {
                widest = gap;
                out.before = i;
            }
    }
    return out;
}

std::size_t Recording::ticks() const
{
    std::size_t count = 0;
    for (const RecordedRun& run : runs)
        count += run.ticks.size();
    return count;
}

bool is_recording_name(const std::filesystem::path& file)
{
    return file.extension() == ".rec";
}

Result<std::vector<Recording>> parse_recordings(Bytes bytes, const std::string& where)
{
    std::vector<Recording> all;
    std::size_t at = 0;
    do {
        Result<Recording> recording = Parser(bytes, at, where).run(at);
        if (!recording && !all.empty()) {
            // What lies behind a good recording does not make that one bad.
            all.back().cut = recording.error().what;
            break;
        }
        if (!recording)
            return recording.error();
        all.push_back(std::move(*recording));
    } while (at < bytes.size());
    return all;
}

Result<std::vector<Recording>> read_recordings(const std::filesystem::path& file)
{
    const Result<std::vector<std::byte>> bytes = bytes_of(file);
    if (!bytes)
        return bytes.error();
    return parse_recordings(*bytes, file.string());
}

phantom_model model_of(const phantom_tick& tick)
{
    phantom_model model{};
    model.model = tick.model & 15U;
    model.newton_steps = tick.model >> 4 & 15U;
    model.combine = tick.model >> 8 & 15U;
    model.proxy = tick.model >> 12 & 15U;
    model.arith = tick.model >> 16 & 15U;
    return model;
}

std::uint64_t due_ns(const phantom_tick& tick)
{
    return tick.time_ns - tick.latency_ns;
}

} // namespace phantom::device
