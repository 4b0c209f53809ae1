// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/section_file.hpp"

#include <xxhash.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <string_view>

#include <fmt/format.h>

#include "base/output_file.hpp"
#include "fdh/parallel.hpp"

namespace phantom::scene {

namespace {

/// Changed whenever this file's layout is; what the sections mean is part of the key.
constexpr std::uint32_t layout_version = 1;
constexpr std::array<char, 8> magic = {'P', 'H', 'F', 'D', 'H', 'C', '\r', '\n'};
/// Written as a number: read on a machine of the other byte order it is another one.
constexpr std::uint32_t byte_order = 0x01020304;

struct Header {
    std::array<char, 8> magic;
    std::uint32_t layout, byte_order;
    CacheKey key;
    std::uint64_t file_bytes;
    std::uint64_t sections;
    std::uint64_t checksum; ///< of this header with checksum 0, and of the table
    std::uint64_t zero;
};
static_assert(sizeof(Header) == SectionReader::alignment);

struct Entry {
    std::uint64_t id;
    std::uint64_t offset, bytes;
    std::uint64_t checksum;
};

/// Bytes that get a checksum of their own, so that all cores can work on one section; a section's is that of
/// its pieces' checksums.
constexpr std::size_t piece_bytes = 4U << 20;

/// Of each section.
std::vector<std::uint64_t> checksums(const std::vector<std::span<const std::byte>>& sections)
{
    std::vector<std::vector<std::uint64_t>> sums(sections.size());
    struct Piece {
        std::span<const std::byte> bytes;
        std::uint64_t* sum;
    };
    std::vector<Piece> pieces;
    for (std::size_t s = 0; s < sections.size(); ++s) {
        sums[s].resize((sections[s].size() + piece_bytes - 1) / piece_bytes);
        for (std::size_t i = 0; i < sums[s].size(); ++i) {
            const std::size_t begin = i * piece_bytes;
            pieces.push_back(
                {sections[s].subspan(begin, std::min(piece_bytes, sections[s].size() - begin)), &sums[s][i]});
        }
    }
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
        for (std::size_t i = next++; i < pieces.size(); i = next++)
            *pieces[i].sum = XXH3_64bits(pieces[i].bytes.data(), pieces[i].bytes.size());
    };
    const std::size_t threads = std::min<std::size_t>(fdh::thread_count(0), pieces.size());
    fdh::on_threads(static_cast<unsigned>(threads), work);
    std::vector<std::uint64_t> result;
    result.reserve(sums.size());
    for (const std::vector<std::uint64_t>& sum : sums)
        result.push_back(XXH3_64bits(sum.data(), sum.size() * sizeof(sum[0])));
    return result;
}

std::uint64_t table_checksum(Header header, std::span<const Entry> entries)
{
    header.checksum = 0;
    return XXH3_64bits(&header, sizeof header) ^ XXH3_64bits(entries.data(), entries.size_bytes());
}

std::uint64_t aligned(std::uint64_t offset)
{
    return (offset + SectionReader::alignment - 1) / SectionReader::alignment * SectionReader::alignment;
}

template <typename T>
std::string_view characters(std::span<const T> elements)
{
    return {reinterpret_cast<const char*>(elements.data()), elements.size_bytes()};
}

bool zero(std::span<const std::byte> bytes)
{
    return std::all_of(bytes.begin(), bytes.end(), [](std::byte b) { return b == std::byte{0}; });
}

/// The table, if header and table are whole.
Result<std::span<const Entry>> table_of(std::span<const std::byte> bytes, const std::string& name)
{
    Header header{};
    if (bytes.size() < sizeof header)
        return Error{name, "is cut short"};
    std::memcpy(&header, bytes.data(), sizeof header);
    if (header.magic != magic)
        return Error{name, "is no cache file of phantom_rt"};
    if (header.layout != layout_version || header.byte_order != byte_order)
        return Error{name, "is a cache file of another version or machine"};
    if (header.file_bytes != bytes.size())
        return Error{name, fmt::format("is cut short: {} bytes of {}", bytes.size(), header.file_bytes)};
    if (header.sections > (bytes.size() - sizeof header) / sizeof(Entry))
        return Error{name, "has changed since it was written"};
    const std::span entries(reinterpret_cast<const Entry*>(bytes.data() + sizeof header), header.sections);
    if (table_checksum(header, entries) != header.checksum)
        return Error{name, "has changed since it was written"};
    return entries;
}

} // namespace

std::string CacheKey::text() const
{
    return fmt::format("{:016x}{:016x}", words[0], words[1]);
}

Status SectionWriter::write(const std::filesystem::path& file, const CacheKey& key) const
{
    std::vector<std::span<const std::byte>> contents;
    for (const Section& section : sections_)
        contents.push_back(section.bytes);
    const std::vector<std::uint64_t> sums = checksums(contents);
    std::vector<Entry> entries;
    std::uint64_t offset = aligned(sizeof(Header) + sections_.size() * sizeof(Entry));
    for (std::size_t i = 0; i < sections_.size(); ++i) {
        entries.push_back({sections_[i].id, offset, contents[i].size(), sums[i]});
        offset = aligned(offset + contents[i].size());
    }
    Header header{magic, layout_version, byte_order, key, offset, entries.size(), 0, 0};
    header.checksum = table_checksum(header, entries);

    Result<OutputFile> out = OutputFile::open(file);
    if (!out)
        return out.error();
    std::uint64_t written = 0;
    const auto append = [&](std::string_view text) -> Status {
        written += text.size();
        return out->append(text);
    };
    const auto pad = [&]() -> Status { return append(std::string(aligned(written) - written, '\0')); };
    Status status = append(characters(std::span<const Header>(&header, 1)));
    if (status)
        status = append(characters(std::span<const Entry>(entries)));
    for (std::size_t i = 0; status && i < sections_.size(); ++i) {
        status = pad();
        if (status)
            status = append(characters(sections_[i].bytes));
    }
    if (status)
        status = pad();
    return status ? out->commit() : status;
}

Result<SectionReader> SectionReader::open(const std::filesystem::path& file,
                                          const std::optional<CacheKey>& key, Check check)
{
    Result<std::shared_ptr<const MappedFile>> mapped = MappedFile::open(file);
    if (!mapped)
        return mapped.error();
    const std::span<const std::byte> bytes = (*mapped)->bytes();
    const std::string name = file.string();
    const Result<std::span<const Entry>> table = table_of(bytes, name);
    if (!table)
        return table.error();
    SectionReader reader;
    std::memcpy(&reader.key_, bytes.data() + offsetof(Header, key), sizeof reader.key_);
    if (key && reader.key_ != *key)
        return Error{name, "is of another mesh or of other options"};
    const Error changed{name, "has changed since it was written"};
    std::vector<std::span<const std::byte>> contents;
    std::uint64_t end = sizeof(Header) + table->size_bytes();
    for (const Entry& entry : *table) {
        if (entry.offset != aligned(end) || entry.offset > bytes.size() ||
            entry.bytes > bytes.size() - entry.offset || !zero(bytes.subspan(end, entry.offset - end)))
            return changed;
        contents.push_back(bytes.subspan(entry.offset, entry.bytes));
        end = entry.offset + entry.bytes;
    }
    if (bytes.size() != aligned(end) || !zero(bytes.subspan(end)))
        return changed;
    const std::vector<std::uint64_t> sums =
        check == Check::content ? checksums(contents) : std::vector<std::uint64_t>();
    for (std::size_t i = 0; i < sums.size(); ++i)
        if (sums[i] != (*table)[i].checksum)
            return changed;
    reader.file_ = std::move(*mapped);
    return reader;
}

std::optional<std::span<const std::byte>> SectionReader::find_bytes(std::uint32_t id) const
{
    const std::span<const std::byte> bytes = file_->bytes();
    const Result<std::span<const Entry>> table = table_of(bytes, {});
    for (const Entry& entry : *table)
        if (entry.id == id)
            return bytes.subspan(entry.offset, entry.bytes);
    return std::nullopt;
}

} // namespace phantom::scene
