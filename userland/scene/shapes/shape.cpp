// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/shapes/shape.hpp"

#include <algorithm>

#include "mesh/vector.hpp"
#include "scene/shapes/soup_builder.hpp"

namespace phantom::scene {

namespace {

/// Part of a shape's size that it may be off without being asked.
constexpr double chord_part = 0.0012;

/// What the default chord error is a part of.
double size_of(const Shape& shape)
{
    const auto half_longest = [](const mesh::Vec3& size) {
        return 0.5 * std::max({size[0], size[1], size[2]});
    };
    if (const auto* sphere = std::get_if<Sphere>(&shape))
        return sphere->radius_mm;
    if (const auto* ellipsoid = std::get_if<Ellipsoid>(&shape))
        return half_longest(ellipsoid->size_mm);
    if (const auto* torus = std::get_if<Torus>(&shape))
        return torus->radius_mm + torus->tube_radius_mm;
    if (const auto* cone = std::get_if<Cone>(&shape))
        return std::max(cone->radius_mm, cone->top_radius_mm);
    if (const auto* superquadric = std::get_if<Superquadric>(&shape))
        return half_longest(superquadric->size_mm);
    if (const auto* patch = std::get_if<NurbsPatch>(&shape))
        return 0.5 * mesh::bounds_of(patch->points).extent();
    return 1;
}

Result<mesh::Soup> soup_of(const Shape& shape, double chord_mm)
{
    if (const auto* sphere = std::get_if<Sphere>(&shape))
        return sphere_soup(*sphere, chord_mm);
    if (const auto* ellipsoid = std::get_if<Ellipsoid>(&shape))
        return ellipsoid_soup(*ellipsoid, chord_mm);
    if (const auto* torus = std::get_if<Torus>(&shape))
        return torus_soup(*torus, chord_mm);
    if (const auto* cone = std::get_if<Cone>(&shape))
        return cone_soup(*cone, chord_mm);
    if (const auto* superquadric = std::get_if<Superquadric>(&shape))
        return superquadric_soup(*superquadric, chord_mm);
    if (const auto* patch = std::get_if<NurbsPatch>(&shape))
        return nurbs_soup(*patch, chord_mm);
    return box_soup(std::get<Box>(shape));
}

/// Preparation keeps a normal that lies on the outer side of its face.
bool normals_fit(const mesh::Soup& soup)
{
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        const auto& [a, b, c] = soup.faces[f];
        const mesh::Vec3 normal = mesh::cross(mesh::subtract(soup.vertices[b], soup.vertices[a]),
                                              mesh::subtract(soup.vertices[c], soup.vertices[a]));
        for (const std::uint32_t corner : soup.face_normals[f]) {
            if (!(mesh::dot(soup.normals[corner], normal) > 0))
                return false;
        }
    }
    return true;
}

} // namespace

Result<mesh::Soup> triangulate(const Shape& shape, std::optional<double> chord_mm)
{
    if (const auto* field = std::get_if<HeightField>(&shape))
        return height_field_soup(*field, chord_mm);
    double chord = chord_mm.value_or(chord_part * size_of(shape));
    auto soup = soup_of(shape, chord);
    // Where a shape is strongly bent, faces within a coarse chord error may lie askew to its normals. A
    // formula with a cusp stays so however fine they are: there preparation has the last word.
    constexpr int finer_max = 6;
    for (int finer = 0; soup && finer < finer_max && !normals_fit(*soup); ++finer) {
        chord /= 4;
        auto next = soup_of(shape, chord);
        if (!next)
            break;
        soup = std::move(next);
    }
    return soup;
}

} // namespace phantom::scene
