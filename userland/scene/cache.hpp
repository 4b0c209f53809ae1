// SPDX-License-Identifier: GPL-2.0-or-later
// The cache of prepared objects: what reading, preparing and building hulls gave, one file for each mesh and
// its options, in $XDG_CACHE_HOME/phantom_rt. Opened by mapping; checked before it is used. A file that is
// cut short, changed, foreign or old is never used, and replaced.
//
// A file's name is its key: a hash of the mesh file's bytes, of all options that the result depends on, and
// of the program's own preparation code. So nothing has to be noticed as outdated: what is outdated has
// another name, and `fdhctl cache prune` removes it.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "mesh/prepare.hpp"
#include "scene/scene.hpp"
#include "scene/section_file.hpp"

namespace phantom::scene {

/// $XDG_CACHE_HOME/phantom_rt, else $HOME/.cache/phantom_rt; nothing when neither is set to an absolute path.
std::optional<std::filesystem::path> cache_directory();

/// After a file was added, those used longest ago are removed until no more than this is left.
inline constexpr std::uint64_t cache_bytes_max = 8ULL << 30;

/// What a kept object depends on.
struct CacheRequest {
    std::filesystem::path mesh;
    mesh::PrepareOptions prepare;
    double reach_mm = 0; ///< of the rims, see mesh::make_rims
};

/// Whether all of the mesh is in its file. (A .gltf names others.)
bool is_cacheable(const std::filesystem::path& mesh);

/// Two hashes of the file's bytes would be as much work as the whole load: the identity of the file shows
/// that it was not exchanged between hashing and reading.
struct CacheTicket {
    CacheKey key;
    std::string identity;
};

/// Error: the mesh file cannot be opened.
Result<CacheTicket> ticket_for(const CacheRequest& request);

/// Fills the object's surfaces and its report. False if there is no such file. Error: there is one that
/// cannot be used, and why; the object is as it was.
Result<bool> open_cached(const std::filesystem::path& directory, const CacheTicket& ticket, Object& object);

/// Keeps the object. Its hulls must have been built. Error: cannot be written. False, and nothing is written,
/// if the mesh file changed since the ticket was made.
Result<bool> keep(const std::filesystem::path& directory, const CacheTicket& ticket,
                  const CacheRequest& request, const Object& object);

/// The key of what was made of a kept object, in the way that the words say.
CacheKey derived_key(const CacheKey& object, const std::string& words);

/// A chain of levels of detail, or nothing if it is not kept or its file cannot be used.
std::optional<std::vector<Surface>> open_chain(const std::filesystem::path& directory, const CacheKey& key);

/// Keeps a chain; the hulls of all must have been built. `source` is shown by list_cache().
Status keep_chain(const std::filesystem::path& directory, const CacheKey& key, const std::string& source,
                  const std::vector<Surface>& chain);

/// A file of the cache, for people.
struct CacheEntry {
    std::filesystem::path file;
    std::uint64_t bytes = 0;
    std::filesystem::file_time_type used; ///< when it was last written or opened
    std::string source;                   ///< the mesh file it was made from; empty if it does not say
    std::uint64_t triangles = 0;
    std::string fault; ///< why it will never be used again; empty: sound, as far as was looked
};

/// Every file of the cache, the least recently used first. whole: every byte is checked, not only header and
/// version.
std::vector<CacheEntry> list_cache(const std::filesystem::path& directory, bool whole);

/// Removes the least recently used until no more than that is left. Gives what was removed.
std::vector<CacheEntry> trim_cache(const std::filesystem::path& directory, std::uint64_t bytes_max);

/// Removes what has a fault, then trims.
std::vector<CacheEntry> prune_cache(const std::filesystem::path& directory, std::uint64_t bytes_max);

} // namespace phantom::scene
