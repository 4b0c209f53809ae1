// SPDX-License-Identifier: GPL-2.0-or-later
// The cache gives what was put in, or nothing: whatever happened to its files, the scene is the same.
#include "scene/cache.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <sstream>
#include <thread>

#include <fmt/format.h>

#include "folder.hpp"

namespace phantom::scene {
namespace {

namespace fs = std::filesystem;

/// A sheet with a fold (so it has a crease and its fans) and a boundary (so it has rims).
std::string folded_sheet(double height)
{
    constexpr int side = 6;
    std::string text = fmt::format("OFF\n{} {} 0\n", (side + 1) * (side + 1), 2 * side * side);
    for (int y = 0; y <= side; ++y)
        for (int x = 0; x <= side; ++x)
            text += fmt::format("{} {} {}\n", 10 * x, 10 * y, height * std::abs(x - 3));
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const int v = y * (side + 1) + x;
            text += fmt::format("3 {} {} {}\n3 {} {} {}\n", v, v + 1, v + side + 2, v, v + side + 2,
                                v + side + 1);
        }
    }
    return text;
}

class Cache : public ::testing::Test {
  protected:
    Cache() : mesh_(folder_.write("sheet.off", folded_sheet(20)))
    {
        options_.cache = folder_.path() / "cache";
    }

    Scene load(const LoadOptions& options)
    {
        Result<Scene> scene = scene::load(mesh_, options);
        EXPECT_TRUE(scene) << scene.error().text();
        return std::move(*scene);
    }
    Scene load() { return load(options_); }
    std::vector<CacheEntry> entries() { return list_cache(*options_.cache, true); }
    /// The one file that the cache has.
    fs::path file() { return entries().at(0).file; }

    test::Folder folder_;
    fs::path mesh_;
    LoadOptions options_;
};

void expect_same(const Object& a, const Object& b)
{
    EXPECT_TRUE(a.mesh.vertices == b.mesh.vertices);
    EXPECT_TRUE(a.mesh.faces == b.mesh.faces);
    EXPECT_TRUE(a.mesh.normals == b.mesh.normals);
    EXPECT_TRUE(a.mesh.face_normals == b.mesh.face_normals);
    EXPECT_TRUE(a.mesh.neighbours == b.mesh.neighbours);
    EXPECT_TRUE(a.fans.fans == b.fans.fans);
    EXPECT_TRUE(a.fans.first == b.fans.first);
    EXPECT_TRUE(a.rims.edges == b.rims.edges);
    EXPECT_TRUE(a.rims.surface == b.rims.surface);
    EXPECT_TRUE(a.rims.nodes == b.rims.nodes);
    EXPECT_EQ(a.rims.loops, b.rims.loops);
    EXPECT_EQ(a.error_mm, b.error_mm);
    EXPECT_EQ(a.report.faces_read, b.report.faces_read);
    EXPECT_EQ(a.report.crease_edges, b.report.crease_edges);
    EXPECT_EQ(a.report.edge_median_mm, b.report.edge_median_mm);
    EXPECT_EQ(a.report.warnings, b.report.warnings);
}

std::string bytes_of(const fs::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

void overwrite(const fs::path& file, const std::string& bytes)
{
    // As another program would: a new file under the old name.
    fs::remove(file);
    std::ofstream(file, std::ios::binary) << bytes;
}

TEST_F(Cache, SecondLoadGivesTheSameWithoutPreparing)
{
    const Scene fresh = load({}), first = load(), second = load();
    EXPECT_FALSE(first.objects[0].from_cache);
    ASSERT_TRUE(second.objects[0].from_cache);
    EXPECT_TRUE(second.notes.empty());
    ASSERT_FALSE(fresh.objects[0].fans.fans.empty());
    ASSERT_FALSE(fresh.objects[0].rims.edges.empty());
    ASSERT_FALSE(fresh.objects[0].report.warnings.empty());
    expect_same(fresh.objects[0], first.objects[0]);
    expect_same(fresh.objects[0], second.objects[0]);
}

TEST_F(Cache, HullsAnswerAsThoseBuilt)
{
    const auto built = build_tree<14>(load({}));
    load();
    const Scene kept = load();
    const auto opened = build_tree<14>(kept);
    fdh::Nearest a, b;
    for (int i = 0; i < 200; ++i) {
        const fdh::Point p = {std::fmod(17.3 * i, 60.0), std::fmod(7.7 * i, 60.0), std::fmod(3.1 * i, 40.0)};
        built.nearest(p, 9, 1e3, a);
        opened.nearest(p, 9, 1e3, b);
        ASSERT_EQ(a.hits.size(), b.hits.size());
        EXPECT_EQ(a.coverage, b.coverage);
        for (std::size_t h = 0; h < a.hits.size(); ++h) {
            EXPECT_EQ(a.hits[h].triangle, b.hits[h].triangle);
            EXPECT_EQ(a.hits[h].distance, b.hits[h].distance);
        }
    }
}

TEST_F(Cache, OutlivesTheFileThatIsRemoved)
{
    load();
    const Scene kept = load();
    fs::remove(file());
    expect_same(kept.objects[0], load({}).objects[0]);
}

TEST_F(Cache, EveryOptionHasAFileOfItsOwn)
{
    const std::vector<std::function<void(LoadOptions&)>> changes = {
        [](LoadOptions&) {},
        [](LoadOptions& o) { o.prepare.full = false; },
        [](LoadOptions& o) { o.prepare.scale = 2; },
        [](LoadOptions& o) { o.prepare.fit_mm = 50; },
        [](LoadOptions& o) { o.prepare.weld_mm = 0.5; },
        [](LoadOptions& o) { o.prepare.crease_deg = 170; },
        [](LoadOptions& o) { o.prepare.split_mm = 4; },
        [](LoadOptions& o) { o.radius_mm = 3; },
        [](LoadOptions& o) { o.unit = "m"; },
    };
    for (std::size_t i = 0; i < changes.size(); ++i) {
        LoadOptions changed = options_;
        changes[i](changed);
        const Scene scene = load(changed);
        EXPECT_FALSE(scene.objects[0].from_cache) << i;
        EXPECT_EQ(entries().size(), i + 1);
        LoadOptions without = changed;
        without.cache.reset();
        expect_same(load(without).objects[0], load(changed).objects[0]);
    }
}

TEST_F(Cache, ContentCountsNotNameOrTime)
{
    load();
    folder_.write("sheet.off", folded_sheet(21));
    const Scene changed = load();
    EXPECT_FALSE(changed.objects[0].from_cache);
    EXPECT_EQ(entries().size(), 2U);
    // another file with the first content
    mesh_ = folder_.write("other.off", folded_sheet(20));
    EXPECT_TRUE(load().objects[0].from_cache);
}

TEST_F(Cache, CutShortIsNoticedAndMended)
{
    load();
    const Scene fresh = load({});
    const std::string whole = bytes_of(file());
    for (std::size_t length : {0UL, 1UL, 63UL, 64UL, 65UL, 300UL, whole.size() / 2, whole.size() - 1}) {
        const fs::path name = file();
        overwrite(name, whole.substr(0, length));
        EXPECT_FALSE(entries().at(0).fault.empty());
        const Scene mended = load();
        EXPECT_FALSE(mended.objects[0].from_cache) << length;
        ASSERT_EQ(mended.notes.size(), 1U);
        EXPECT_NE(mended.notes[0].find("prepared again"), std::string::npos) << mended.notes[0];
        expect_same(fresh.objects[0], mended.objects[0]);
        EXPECT_TRUE(entries().at(0).fault.empty());
        EXPECT_TRUE(load().objects[0].from_cache);
    }
}

TEST_F(Cache, EveryChangedByteIsNoticed)
{
    load();
    const fs::path name = file();
    const std::string whole = bytes_of(name);
    // All of header and table, and a prime stride through the rest.
    const Result<CacheTicket> ticket = ticket_for({mesh_, {}, 1.0});
    ASSERT_TRUE(ticket);
    for (std::size_t at = 0; at < whole.size(); at += at < 700 ? 1 : 61) {
        std::string changed = whole;
        changed[at] = static_cast<char>(changed[at] ^ 0x10);
        overwrite(name, changed);
        const std::vector<CacheEntry> found = entries();
        ASSERT_EQ(found.size(), 1U);
        Object object;
        const Result<bool> opened = open_cached(*options_.cache, *ticket, object);
        EXPECT_FALSE(opened) << at;
        EXPECT_FALSE(found[0].fault.empty()) << at;
        EXPECT_TRUE(object.mesh.faces.empty());
    }
}

TEST_F(Cache, AnothersFileUnderTheNameIsNotTaken)
{
    load();
    const fs::path name = file();
    fs::remove(name);
    LoadOptions other = options_;
    other.prepare.crease_deg = 100;
    load(other);
    fs::rename(file(), name);
    EXPECT_EQ(entries().at(0).fault, "has another file's name");
    const Scene scene = load();
    EXPECT_FALSE(scene.objects[0].from_cache);
    ASSERT_EQ(scene.notes.size(), 1U);
    EXPECT_NE(scene.notes[0].find("of another mesh or of other options"), std::string::npos);
    EXPECT_TRUE(load().objects[0].from_cache);
}

TEST_F(Cache, OfAnotherVersionIsListedAndPruned)
{
    load();
    const fs::path sound = file();
    SectionWriter old;
    const std::string version = "of long ago";
    old.add(0, std::span(version.data(), version.size()));
    const CacheKey key{{1, 2}};
    ASSERT_TRUE(old.write(*options_.cache / (key.text() + ".prepared"), key));
    ASSERT_EQ(entries().size(), 2U);
    const auto removed = prune_cache(*options_.cache, cache_bytes_max);
    ASSERT_EQ(removed.size(), 1U);
    EXPECT_EQ(removed[0].fault, "is of another version of the program");
    EXPECT_EQ(file(), sound);
}

TEST_F(Cache, CannotBeWrittenIsSaidAndNothingElse)
{
    options_.cache = folder_.write("no_directory", "a file") / fs::path("cache");
    const Scene scene = load();
    ASSERT_EQ(scene.notes.size(), 1U);
    EXPECT_NE(scene.notes[0].find("cannot be made"), std::string::npos) << scene.notes[0];
    expect_same(scene.objects[0], load({}).objects[0]);
}

TEST_F(Cache, MeshThatChangedMeanwhileIsNotKept)
{
    const CacheRequest request{mesh_, {}, 1.0};
    const Result<CacheTicket> ticket = ticket_for(request);
    ASSERT_TRUE(ticket);
    Object object = load({}).objects[0];
    object.build_hulls();
    overwrite(mesh_, folded_sheet(30));
    const Result<bool> kept = keep(*options_.cache, *ticket, request, object);
    ASSERT_TRUE(kept);
    EXPECT_FALSE(*kept);
    EXPECT_TRUE(entries().empty());
}

TEST_F(Cache, APipeIsRefusedAtOnce)
{
    // Whoever opens it waits for a writer, who never comes.
    const fs::path pipe = folder_.path() / "pipe.off";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const Result<Scene> scene = scene::load(pipe, options_);
    ASSERT_FALSE(scene);
    EXPECT_NE(scene.error().text().find("not a regular file"), std::string::npos) << scene.error().text();
}

TEST_F(Cache, ManyAtOnceGiveTheSame)
{
    const Scene fresh = load({});
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) {
        threads.emplace_back([&] {
            for (int k = 0; k < 5; ++k)
                expect_same(fresh.objects[0], load().objects[0]);
        });
    }
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(entries().size(), 1U);
    EXPECT_EQ(std::distance(fs::directory_iterator(*options_.cache), {}), 1);
}

TEST_F(Cache, ChainsAreKeptBesideTheirObject)
{
    const Object object = load().objects[0];
    ASSERT_TRUE(object.cache_key);
    LoadOptions coarser;
    coarser.prepare.fit_mm = 30;
    std::vector<Surface> chain{load({}).objects[0], load(coarser).objects[0]};
    for (Surface& surface : chain)
        surface.build_hulls();
    chain[1].error_mm = 0.25;
    const CacheKey key = derived_key(*object.cache_key, "levels 64");
    EXPECT_NE(key, derived_key(*object.cache_key, "levels 32"));
    EXPECT_FALSE(open_chain(*options_.cache, key));
    ASSERT_TRUE(keep_chain(*options_.cache, key, "levels of sheet.off", chain));
    const auto opened = open_chain(*options_.cache, key);
    ASSERT_TRUE(opened);
    ASSERT_EQ(opened->size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_TRUE((*opened)[i].mesh.vertices == chain[i].mesh.vertices);
        EXPECT_TRUE((*opened)[i].fans.fans == chain[i].fans.fans);
        EXPECT_EQ((*opened)[i].error_mm, chain[i].error_mm);
    }
    EXPECT_EQ(entries().back().source, "levels of sheet.off");
    const fs::path file = *options_.cache / (key.text() + ".prepared");
    overwrite(file, bytes_of(file).substr(0, 2000));
    EXPECT_FALSE(open_chain(*options_.cache, key));
}

TEST_F(Cache, WhatWasUsedLongestAgoGoesFirst)
{
    std::vector<fs::path> files;
    for (const double crease : {10.0, 20.0, 30.0}) {
        options_.prepare.crease_deg = crease;
        load();
        files.push_back(entries().back().file);
        for (const fs::path& earlier : files)
            fs::last_write_time(earlier, fs::last_write_time(earlier) - std::chrono::hours(1));
    }
    options_.prepare.crease_deg = 10; // used again
    EXPECT_TRUE(load().objects[0].from_cache);
    const std::uint64_t one = entries()[0].bytes;
    const auto removed = trim_cache(*options_.cache, 2 * one + one / 2);
    ASSERT_EQ(removed.size(), 1U);
    EXPECT_EQ(removed[0].file, files[1]);
    EXPECT_EQ(trim_cache(*options_.cache, 0).size(), 2U);
}

TEST_F(Cache, UnfinishedFilesAreRemovedOnceTheyAreOld)
{
    load();
    const fs::path young = file().string() + ".tmp-1", old = file().string() + ".tmp-2";
    overwrite(young, "x");
    overwrite(old, "x");
    fs::last_write_time(old, fs::file_time_type::clock::now() - std::chrono::hours(2));
    const auto removed = prune_cache(*options_.cache, cache_bytes_max);
    ASSERT_EQ(removed.size(), 1U);
    EXPECT_EQ(removed[0].file, old);
    EXPECT_TRUE(fs::exists(young)); // somebody may be writing it
}

} // namespace
} // namespace phantom::scene
