// SPDX-License-Identifier: GPL-2.0-or-later
// What every shape is held to, given its formula from outside: distances both ways, closedness, normals.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scene/shapes/shape.hpp"

namespace phantom::scene::test {

/// A formula as an oracle sees it.
struct Formula {
    /// Distance of a point from the surface, or a bound of it from above.
    std::function<double(const mesh::Vec3&)> distance;
    /// The surface's outward unit normal at one of its points; where it has several, the one that fits a face
    /// with this normal.
    std::function<mesh::Vec3(const mesh::Vec3&, const mesh::Vec3& face_normal)> normal;
    /// Points of the surface at parameters in [0, 1]^2.
    std::function<mesh::Vec3(double, double)> point;
};

/// The triangles of a shape; a failure is the test's.
mesh::Soup soup_of(const Shape& shape, std::optional<double> chord_mm = std::nullopt);

/// No point of a face is farther from the surface than the chord error, and none of the surface from the
/// faces. Returns the largest distance seen.
double expect_within_chord(const mesh::Soup& soup, const Formula& formula, double chord_mm);

/// Corners lie on the surface; their normals are the formula's, to 1e-12, and preparation leaves both alone.
void expect_exact_corners(const mesh::Soup& soup, const Formula& formula, double size_mm);

/// Closed, outward, welded, no face without area: preparation finds nothing to do but for so many normals.
void expect_sound(const mesh::Soup& soup, bool closed = true, std::uint64_t normals_repaired = 0);

} // namespace phantom::scene::test
