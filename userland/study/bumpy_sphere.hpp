// SPDX-License-Identifier: GPL-2.0-or-later
// The mesh and the path that proxies are compared on: a sphere with bumps, of any fineness, and a tip that
// rubs along a spiral under its surface and lifts off now and then. Frequency-subdivided icosahedron (20 f^2
// triangles), r = 50 + sin(12x) sin(12y) sin(12z) mm for x y z on the unit sphere.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "base/result.hpp"
#include "feeder/path.hpp"
#include "mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace phantom::study {

inline constexpr double bumpy_radius_mm = 50.0;

/// The frequency 32 gives 20,480 triangles, 100 200,000, 316 1,997,120. Smooth normals. 1 <= frequency.
Result<mesh::Mesh> bumpy_sphere(unsigned frequency);

struct SpiralOptions {
    double depth_mm = 3.0; ///< nominal, under r = 50 mm: the tip passes under the valleys of the bumps
    double speed_mm_s = 100.0;
    double swing = 0.0;   ///< the speed goes up and down by that part of it,
    double swing_s = 0.4; ///< once in this time
    double seconds = 20.0;
    double rate_hz = 1000.0;
    double turns = 20.0; ///< from pole to pole; there and back again
    double lift_s = 5.0; ///< lifted 3 mm off the surface for the ends of every such time
    double lifting_s = 0.5;
};
feeder::Path spiral_path(const SpiralOptions& options);

/// The point of a mesh nearest to another, by looking at every triangle near it: no hierarchy, no memory of
/// the last answer.
class BruteForce {
  public:
    explicit BruteForce(const mesh::Mesh& mesh);
    ~BruteForce();
    BruteForce(const BruteForce&) = delete;
    BruteForce& operator=(const BruteForce&) = delete;

    struct Point {
        std::array<double, 3> at{};
        double distance_mm = 0;
        bool inside = false; ///< the point asked for lies under the face that the nearest point is on
        std::array<double, 3> normal{}; ///< of the surface there, interpolated, unit
    };
    /// Within some 15 mm of the surface.
    [[nodiscard]] Point nearest(const std::array<double, 3>& from) const;

  private:
    struct Cells;
    std::unique_ptr<Cells> cells_;
};

} // namespace phantom::study
