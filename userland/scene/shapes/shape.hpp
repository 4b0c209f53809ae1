// SPDX-License-Identifier: GPL-2.0-or-later
// Shapes that a scene file may name instead of a mesh, and their triangles. Lengths in mm.
//
// "We triangulate all complex models including analytic surfaces" (Kabelac 2001). The triangles lie within
// the chord error of the formula and the formula within it of the triangles; corners lie on the formula and
// keep its own unit normals, two and more of them where it has a crease. So the contact model `projected`
// feels a shape as smooth as its formula, however coarse the triangles are.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <variant>
#include <vector>

#include "base/result.hpp"
#include "mesh/mesh.hpp"

namespace phantom::scene {

/// Round the origin.
struct Sphere {
    double radius_mm;
};

/// Round the origin, axes along x, y and z.
struct Ellipsoid {
    mesh::Vec3 size_mm; ///< whole lengths
};

/// Round the z axis.
struct Torus {
    double radius_mm;      ///< of the circle that the tube's middle runs on
    double tube_radius_mm; ///< below radius_mm
};

struct Box {
    mesh::Vec3 size_mm;
};

/// Round the z axis, from -height/2 to height/2. A cylinder where the radii are equal, a cone where the upper
/// one is 0, a frustum elsewhere. Rims are creases; a cone's tip has a normal for every triangle.
struct Cone {
    double radius_mm;     ///< at the lower end
    double top_radius_mm; ///< 0 or more
    double height_mm;
};

/// ((|x/a|^(2/e2) + |y/b|^(2/e2))^(e2/e1) + |z/c|^(2/e1)) = 1, a, b, c half the size (Barr 1981,
/// "Superquadrics and Angle-Preserving Transformations"). Convex for exponents up to 2.
struct Superquadric {
    mesh::Vec3 size_mm;
    double north_south; ///< e1: 1 is round, towards 0 a prism, towards 2 a double cone
    double east_west;   ///< e2: the same for the outline seen from above
};

/// A grey image as heights: its samples lie on a grid over size_mm, centred in x and y, the image's upper
/// edge at +y. Between them the bicubic surface of Catmull and Rom (1974), which runs through every sample
/// with continuous slopes.
struct HeightField {
    std::filesystem::path image; ///< PNG of 8 or 16 bits, or PGM
    std::array<double, 2> size_mm;
    double height_mm; ///< of white; black lies at z = 0
    double base_mm;   ///< closed: the flat bottom lies so far below z = 0
    bool closed;      ///< with side walls and a bottom; else a sheet
};

/// A tensor product B-spline patch with weights (Piegl and Tiller 1997, "The NURBS Book"). Its outside is the
/// side of dS/du x dS/dv, unless it closes on itself. Edges that run into one point are poles, edges that
/// meet are a seam.
struct NurbsPatch {
    struct Direction {
        std::uint32_t degree;      ///< 1 ... nurbs_degree_max
        std::uint32_t count;       ///< control points, above the degree
        std::vector<double> knots; ///< count + degree + 1, ascending; an inner one at most `degree` times
    };
    Direction u, v;
    std::vector<mesh::Vec3> points; ///< of u index i and v index j: points[i * v.count + j]
    std::vector<double> weights;    ///< as the points, above 0
};
inline constexpr std::uint32_t nurbs_degree_max = 9;

using Shape = std::variant<Sphere, Ellipsoid, Torus, Box, Cone, Superquadric, HeightField, NurbsPatch>;

/// Of one shape: what preparation takes some 30 s for.
inline constexpr std::uint64_t shape_triangles_max = 10'000'000;

/// The triangles of a shape, welded, counter-clockwise seen from outside, with normals at every corner.
/// Without chord_mm: 0.12% of the sphere's radius, of the longest half axis of an ellipsoid or superquadric,
/// of the outer radius of a torus, of the larger radius of a cone, of half the longest side of the box round
/// a patch's control points; a height field then has its samples for corners. Errors: `where` is the key of
/// the scene file that is at fault (chord_mm, image).
Result<mesh::Soup> triangulate(const Shape& shape, std::optional<double> chord_mm);

} // namespace phantom::scene
