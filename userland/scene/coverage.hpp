// SPDX-License-Identifier: GPL-2.0-or-later
// How far round a point of the surface the nearest so many triangles are all there are: what a set of that
// budget covers. The finer the triangles, the less; and a tip must not leave it before the next set is there.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fdh/scene_tree.hpp"
#include "scene/scene.hpp"

namespace phantom::scene {

/// Speed of a hand in a hurry, mm/s: the fastest that touch is promised for.
inline constexpr double fastest_hand_mm_s = 500.0;

/// The time that a set has to last at least for such a hand: a feeder that manages 100 sets a second.
inline constexpr double slow_feed_s = 0.01;

/// No coverage is looked for beyond this, mm: a set that holds everything within it lasts long enough.
inline constexpr double coverage_max_mm = 1000.0;

struct Coverage {
    std::uint32_t budget = 0;
    std::size_t samples = 0;
    /// Of the samples; coverage_max_mm where the budget holds all that is near.
    double min_mm = coverage_max_mm, p1_mm = coverage_max_mm, median_mm = coverage_max_mm;
};

/// At points spread over the surfaces of all objects, as many to a mm^2 everywhere: always the same ones. The
/// tree is the scene's. The minimum is that of the samples, and not of all points.
Coverage measure_coverage(const Scene& scene, const fdh::SceneTree<14>& tree, std::uint32_t budget,
                          std::size_t samples = 4096);

/// At world points, mm: to colour a picture by.
std::vector<float> coverage_at(const fdh::SceneTree<14>& tree, std::span<const mesh::Vec3> points_mm,
                               std::uint32_t budget);
/// At an object's vertices.
std::vector<float> vertex_coverage(const Object& object, const fdh::SceneTree<14>& tree,
                                   std::uint32_t budget);

/// A tip in contact needs the ball of the contact radius now and until the next set, `delay_s` later. On a
/// round surface the proxy goes faster than the tip under it, and hands speed up: the way is taken larger
/// than it is by that factor.
inline constexpr double way_margin = 1.5;

/// Of a tip at that speed.
double reach_needed_mm(double contact_radius_mm, double speed_mm_s, double delay_s);
/// The speed that this reach lasts for; 0 when it does for none.
double speed_allowed_mm_s(double reach_mm, double contact_radius_mm, double delay_s);

} // namespace phantom::scene
