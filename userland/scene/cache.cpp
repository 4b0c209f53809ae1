// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/cache.hpp"

#include <sys/stat.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include <fmt/format.h>

#include "scene/preparation_id.hpp"

namespace phantom::scene {

namespace {

namespace fs = std::filesystem;

constexpr const char* extension = ".prepared";

/// Of an object: numbers of its sections. Those of a surface start at its level times level_stride.
enum Section : std::uint32_t {
    version,
    source,
    findings,
    warnings,
    numbers,
    vertices,
    faces,
    normals,
    face_normals,
    neighbours,
    fans,
    first_fans,
    rim_edges,
    rim_surface,
    rim_nodes,
    tree_nodes,
    tree_leaves,
    face_groups,
    group_names,
    level_stride = 64
};

/// What a surface has beside its arrays.
struct Numbers {
    double error_mm;
    std::uint64_t rim_loops;
    std::array<double, 3> tree_origin;
    double tree_step, tree_longest_edge, tree_spread;
    std::uint64_t tree_triangles;
};

std::span<const char> characters(std::string_view text)
{
    return {text.data(), text.size()};
}

std::string text_of(const SectionReader& file, std::uint32_t id)
{
    const auto found = file.find<char>(id);
    return found ? std::string(found->begin(), found->end()) : std::string();
}

/// Device, inode, size and times: what changes when somebody writes to or replaces a file.
Result<std::string> identity_of(const fs::path& file)
{
    struct stat s {};
    if (::stat(file.c_str(), &s) != 0)
        return Error{file.string(), "cannot be opened: " + std::string(std::strerror(errno))};
    // Whoever opens a pipe waits for its writer; read() refuses it.
    if (!S_ISREG(s.st_mode))
        return Error{file.string(), "is no regular file"};
    return fmt::format("{}:{}:{}:{}.{}:{}.{}", s.st_dev, s.st_ino, s.st_size, s.st_mtim.tv_sec,
                       s.st_mtim.tv_nsec, s.st_ctim.tv_sec, s.st_ctim.tv_nsec);
}

/// Everything but the content; doubles by their bits.
std::string options_text(const CacheRequest& request)
{
    return fmt::format("{} {} reach {:a}", request.mesh.extension().string(), mesh::words_of(request.prepare),
                       request.reach_mm);
}

class Loader {
  public:
    Loader(const SectionReader& file, std::uint32_t level) : file_(file), base_(level * level_stride) {}

    /// False when a section is missing or the arrays do not belong together.
    bool load(Surface& out)
    {
        const auto found = file_.find<Numbers>(base_ + numbers);
        if (!found || found->size() != 1)
            return false;
        const Numbers& one = found->front();
        take(vertices, out.mesh.vertices);
        take(faces, out.mesh.faces);
        take(normals, out.mesh.normals);
        take(face_normals, out.mesh.face_normals);
        take(neighbours, out.mesh.neighbours);
        take(face_groups, out.mesh.face_groups);
        take(fans, out.fans.fans);
        take(first_fans, out.fans.first);
        take(rim_edges, out.rims.edges);
        take(rim_surface, out.rims.surface);
        take(rim_nodes, out.rims.nodes);
        out.rims.loops = one.rim_loops;
        out.error_mm = one.error_mm;
        const auto nodes = file_.find<std::byte>(base_ + tree_nodes);
        const auto leaves = file_.find<std::byte>(base_ + tree_leaves);
        if (!complete_ || !nodes || !leaves)
            return false;
        out.tree = fdh::TriangleTree<14>::open({one.tree_origin, one.tree_step, one.tree_longest_edge,
                                                one.tree_spread, one.tree_triangles, *nodes, *leaves},
                                               file_.keeper());
        const std::size_t count = out.mesh.faces.size();
        return take_names(out.mesh, count) && out.tree && out.tree->triangles() == count &&
               out.mesh.face_normals.size() == count && out.mesh.neighbours.size() == count &&
               (out.fans.first.empty() || out.fans.first.size() == count + 1) &&
               (out.rims.surface.empty() || out.rims.surface.size() == count);
    }

  private:
    /// False when a face has a group that is not there.
    bool take_names(mesh::Mesh& out, std::size_t faces) const
    {
        const std::string names = text_of(file_, base_ + group_names);
        for (std::size_t at = 0; at < names.size();) {
            const std::size_t end = names.find('\n', at);
            out.group_names.push_back(names.substr(at, end - at));
            at = end + 1;
        }
        return out.face_groups.empty() ||
               (out.face_groups.size() == faces &&
                *std::max_element(out.face_groups.begin(), out.face_groups.end()) < out.group_names.size());
    }

    template <typename T>
    void take(Section section, SharedArray<T>& out)
    {
        const auto found = file_.find<T>(base_ + section);
        complete_ = complete_ && found;
        if (found)
            out = SharedArray<T>(*found, file_.keeper());
    }

    const SectionReader& file_;
    std::uint32_t base_;
    bool complete_ = true;
};

/// What is written of a surface and lies nowhere in it.
struct Beside {
    Numbers numbers;
    std::string groups; ///< names, a line each: they have no line ends
};

Beside beside(const Surface& surface)
{
    const fdh::TreeImage tree = surface.tree->image();
    Beside out{{surface.error_mm, surface.rims.loops, tree.origin, tree.step, tree.longest_edge, tree.spread,
                tree.triangles},
               {}};
    for (const std::string& name : surface.mesh.group_names)
        out.groups += name + '\n';
    return out;
}

void add_surface(const Surface& surface, const Beside& one, std::uint32_t level, SectionWriter& out)
{
    const std::uint32_t base = level * level_stride;
    out.add(base + numbers, std::span(&one.numbers, 1));
    out.add<mesh::Vec3>(base + vertices, surface.mesh.vertices);
    out.add<mesh::Triple>(base + faces, surface.mesh.faces);
    out.add<mesh::Vec3>(base + normals, surface.mesh.normals);
    out.add<mesh::Triple>(base + face_normals, surface.mesh.face_normals);
    out.add<mesh::Triple>(base + neighbours, surface.mesh.neighbours);
    out.add<std::uint8_t>(base + face_groups, surface.mesh.face_groups);
    out.add(base + group_names, characters(one.groups));
    out.add<mesh::Fan>(base + fans, surface.fans.fans);
    out.add<std::uint32_t>(base + first_fans, surface.fans.first);
    out.add<mesh::Rim>(base + rim_edges, surface.rims.edges);
    out.add<std::uint32_t>(base + rim_surface, surface.rims.surface);
    out.add<mesh::RimNode>(base + rim_nodes, surface.rims.nodes);
    const fdh::TreeImage tree = surface.tree->image();
    out.add(base + tree_nodes, tree.nodes);
    out.add(base + tree_leaves, tree.leaves);
}

CacheKey key_of(const std::string& words)
{
    const XXH128_hash_t hash = XXH3_128bits(words.data(), words.size());
    return {{hash.high64, hash.low64}};
}

fs::path file_of(const fs::path& directory, const CacheKey& key)
{
    return directory / (key.text() + extension);
}

/// What was used last is removed last. It may be somebody else's file: then it keeps its time.
void mark_used(const fs::path& file)
{
    std::error_code ignored;
    fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
}

Status write(const fs::path& directory, const CacheKey& key, const SectionWriter& out)
{
    std::error_code code;
    fs::create_directories(directory, code);
    if (code)
        return Error{directory.string(), "cannot be made: " + code.message()};
    fs::permissions(directory, fs::perms::owner_all, code);
    if (Status status = out.write(file_of(directory, key), key); !status)
        return status;
    trim_cache(directory, cache_bytes_max);
    return success();
}

/// What a writer left that did not come to its end: a file that is not written to any more.
bool is_left_over(const fs::path& file)
{
    std::error_code code;
    const auto age = fs::file_time_type::clock::now() - fs::last_write_time(file, code);
    return file.filename().string().find(std::string(extension) + ".tmp-") != std::string::npos && !code &&
           age > std::chrono::hours(1);
}

CacheEntry describe(const fs::path& file, bool whole)
{
    CacheEntry entry;
    std::error_code ignored;
    entry.file = file;
    entry.bytes = fs::file_size(file, ignored);
    entry.used = fs::last_write_time(file, ignored);
    if (is_left_over(file)) {
        entry.fault = "was never finished";
        return entry;
    }
    const auto opened = SectionReader::open(file, std::nullopt, whole ? Check::content : Check::table);
    if (!opened) {
        entry.fault = opened.error().what;
        return entry;
    }
    entry.source = text_of(*opened, source);
    if (const auto one = opened->find<Numbers>(numbers); one && one->size() == 1)
        entry.triangles = one->front().tree_triangles;
    if (text_of(*opened, version) != preparation_id)
        entry.fault = "is of another version of the program";
    else if (opened->key().text() + extension != file.filename())
        entry.fault = "has another file's name";
    return entry;
}

} // namespace

std::optional<fs::path> cache_directory()
{
    const auto absolute = [](const char* name) -> std::optional<fs::path> {
        const char* value = std::getenv(name); // NOLINT(concurrency-mt-unsafe): nobody sets it
        if (value == nullptr || !fs::path(value).is_absolute())
            return std::nullopt;
        return fs::path(value);
    };
    if (const auto cache = absolute("XDG_CACHE_HOME"))
        return *cache / "phantom_rt";
    if (const auto home = absolute("HOME"))
        return *home / ".cache" / "phantom_rt";
    return std::nullopt;
}

bool is_cacheable(const fs::path& mesh)
{
    return !mesh.empty() && mesh.extension() != ".gltf" && mesh.extension() != ".GLTF";
}

Result<CacheTicket> ticket_for(const CacheRequest& request)
{
    const Result<std::string> identity = identity_of(request.mesh);
    if (!identity)
        return identity.error();
    const auto file = MappedFile::open(request.mesh);
    if (!file)
        return file.error();
    const std::span<const std::byte> bytes = (*file)->bytes();
    const XXH128_hash_t content = XXH3_128bits(bytes.data(), bytes.size());
    const std::string all = fmt::format("{} {:016x}{:016x} {}", preparation_id, content.high64, content.low64,
                                        options_text(request));
    return CacheTicket{key_of(all), *identity};
}

Result<bool> open_cached(const fs::path& directory, const CacheTicket& ticket, Object& object)
{
    const fs::path file = file_of(directory, ticket.key);
    std::error_code code;
    if (!fs::exists(file, code))
        return false;
    const auto opened = SectionReader::open(file, ticket.key);
    if (!opened)
        return opened.error();
    const auto found = opened->find<mesh::Findings>(findings);
    const Error misfit{file.string(), "has changed since it was written"};
    if (!found || found->size() != 1)
        return misfit;
    Object filled = object;
    if (!Loader(*opened, 0).load(filled))
        return misfit;
    static_cast<mesh::Findings&>(filled.report) = found->front();
    const std::string lines = text_of(*opened, warnings);
    for (std::size_t at = 0; at < lines.size();) {
        const std::size_t end = lines.find('\n', at);
        filled.report.warnings.push_back(lines.substr(at, end - at));
        at = end + 1;
    }
    object = std::move(filled);
    mark_used(file);
    return true;
}

Result<bool> keep(const fs::path& directory, const CacheTicket& ticket, const CacheRequest& request,
                  const Object& object)
{
    const Result<std::string> identity = identity_of(request.mesh);
    if (!identity || *identity != ticket.identity)
        return false;
    std::string lines;
    for (const std::string& warning : object.report.warnings)
        lines += warning + '\n';
    std::error_code code;
    const std::string from = fs::absolute(request.mesh, code).string();
    const mesh::Findings& counts = object.report;
    const Beside one = beside(object);
    SectionWriter out;
    out.add(version, characters(preparation_id));
    out.add(source, characters(from));
    out.add(findings, std::span(&counts, 1));
    out.add(warnings, characters(lines));
    add_surface(object, one, 0, out);
    if (const Status status = write(directory, ticket.key, out); !status)
        return status.error();
    return true;
}

CacheKey derived_key(const CacheKey& object, const std::string& words)
{
    return key_of(object.text() + ' ' + words);
}

std::optional<std::vector<Surface>> open_chain(const fs::path& directory, const CacheKey& key)
{
    const fs::path file = file_of(directory, key);
    const auto opened = SectionReader::open(file, key);
    if (!opened)
        return std::nullopt;
    std::vector<Surface> chain;
    while (opened->find<Numbers>(static_cast<std::uint32_t>(chain.size()) * level_stride + numbers)) {
        Surface surface;
        if (!Loader(*opened, static_cast<std::uint32_t>(chain.size())).load(surface))
            return std::nullopt;
        chain.push_back(std::move(surface));
    }
    mark_used(file);
    return chain;
}

Status keep_chain(const fs::path& directory, const CacheKey& key, const std::string& source_text,
                  const std::vector<Surface>& chain)
{
    SectionWriter out;
    out.add(version, characters(preparation_id));
    out.add(source, characters(source_text));
    std::vector<Beside> all;
    all.reserve(chain.size());
    for (const Surface& surface : chain)
        all.push_back(beside(surface));
    for (std::size_t level = 0; level < chain.size(); ++level)
        add_surface(chain[level], all[level], static_cast<std::uint32_t>(level), out);
    return write(directory, key, out);
}

std::vector<CacheEntry> list_cache(const fs::path& directory, bool whole)
{
    std::vector<CacheEntry> entries;
    std::error_code code;
    for (const fs::directory_entry& item : fs::directory_iterator(directory, code))
        if (item.path().extension() == extension || is_left_over(item.path()))
            entries.push_back(describe(item.path(), whole));
    std::sort(entries.begin(), entries.end(), [](const CacheEntry& a, const CacheEntry& b) {
        return a.used != b.used ? a.used < b.used : a.file < b.file;
    });
    return entries;
}

std::vector<CacheEntry> trim_cache(const fs::path& directory, std::uint64_t bytes_max)
{
    const std::vector<CacheEntry> entries = list_cache(directory, false);
    std::uint64_t left = 0;
    for (const CacheEntry& entry : entries)
        left += entry.bytes;
    std::vector<CacheEntry> removed;
    for (const CacheEntry& entry : entries) {
        std::error_code code;
        if (left <= bytes_max)
            break;
        if (!fs::remove(entry.file, code))
            continue;
        left -= entry.bytes;
        removed.push_back(entry);
    }
    return removed;
}

std::vector<CacheEntry> prune_cache(const fs::path& directory, std::uint64_t bytes_max)
{
    std::vector<CacheEntry> removed;
    for (const CacheEntry& entry : list_cache(directory, true)) {
        std::error_code code;
        if (!entry.fault.empty() && fs::remove(entry.file, code))
            removed.push_back(entry);
    }
    const std::vector<CacheEntry> trimmed = trim_cache(directory, bytes_max);
    removed.insert(removed.end(), trimmed.begin(), trimmed.end());
    return removed;
}

} // namespace phantom::scene
