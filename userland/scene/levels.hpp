// SPDX-License-Identifier: GPL-2.0-or-later
// A scene at falling detail. 64 triangles of a fine scan cover half a millimetre; a hand in a hurry crosses
// that in one. Levels are what it can be fed with: coarser, so that a set reaches farther.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "fdh/scene_tree.hpp"
#include "scene/coverage.hpp"
#include "scene/scene.hpp"

namespace phantom::scene {

/// The scene with coarser meshes: materials, poses and names as they are; numbers of faces and vertices are
/// the level's own. What is the same as in a finer level is shared with it.
struct Level {
    Scene scene;
    fdh::SceneTree<14> tree;
    double error_mm = 0; ///< largest distance of an object from its own mesh, see mesh/simplify_chain.hpp
    Coverage coverage;
};

struct Levels {
    Coverage finest;            ///< of the scene itself, level 0
    std::vector<Level> coarser; ///< level 1, 2 ...: fine to coarse
    double build_ms = 0;        ///< what it took to find out and to build

    [[nodiscard]] std::size_t size() const { return 1 + coarser.size(); }
    [[nodiscard]] const Coverage& coverage(std::size_t level) const;
    [[nodiscard]] double error_mm(std::size_t level) const;
};

/// Whether there shall be levels: "auto" where an object needs them, "off" never, a number: that level alone
/// (or the coarsest).
struct LevelWish {
    bool on = true;
    std::optional<std::uint32_t> fixed{};
};
/// Nothing when it is none of these.
std::optional<LevelWish> level_wish(const std::string& word);

struct LevelOptions {
    std::uint32_t budget = 64; ///< triangles of a set
    /// Sets of the coarsest level shall last for a tip of that speed, for so long.
    double speed_mm_s = fastest_hand_mm_s, delay_s = slow_feed_s;
    double edge_max_mm = std::numeric_limits<double>::infinity(); ///< no level with a longer edge
    unsigned threads = 0;                                         ///< 0: all cores
    std::optional<std::filesystem::path>
        cache{};                       ///< where the chains of kept objects are kept, see cache.hpp
    std::function<bool()> cancelled{}; ///< the levels then end where they are
};

/// A chain of simplifications for every object that needs one: whose budget of triangles covers too little at
/// more than one place in a hundred. Level n is every object at the n-th of its chain, or at its last. Where
/// no object needs one there are none, and nothing but the coverage was computed. The tree is the scene's.
/// Costs about as much time and memory as reading, preparing and building the hulls of what needs levels.
Levels build_levels(const Scene& scene, const fdh::SceneTree<14>& tree, const LevelOptions& options = {});

} // namespace phantom::scene
