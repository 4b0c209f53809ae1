// SPDX-License-Identifier: GPL-2.0-or-later
// What the shapes share while they are triangulated. Private to the shapes.
#pragma once

#include <cstdint>
#include <span>

#include "scene/shapes/shape.hpp"

namespace phantom::scene {

/// A vertex and one of the normals that it has.
struct Corner {
    std::uint32_t vertex, normal;
};

/// Corners and faces of a shape, each vertex made once: what is welded is welded by its number.
class SoupBuilder {
  public:
    std::uint32_t vertex(const mesh::Vec3& position)
    {
        soup_.vertices.push_back(position);
        return static_cast<std::uint32_t>(soup_.vertices.size() - 1);
    }
    std::uint32_t normal(const mesh::Vec3& unit)
    {
        soup_.normals.push_back(unit);
        return static_cast<std::uint32_t>(soup_.normals.size() - 1);
    }
    void face(const Corner& a, const Corner& b, const Corner& c)
    {
        soup_.faces.push_back({a.vertex, b.vertex, c.vertex});
        soup_.face_normals.push_back({a.normal, b.normal, c.normal});
    }
    /// Counter-clockwise, cut from a to c.
    void quad(const Corner& a, const Corner& b, const Corner& c, const Corner& d)
    {
        face(a, b, c);
        face(a, c, d);
    }
    [[nodiscard]] const mesh::Vec3& position(std::uint32_t vertex) const { return soup_.vertices[vertex]; }
    mesh::Soup take() { return std::move(soup_); }

  private:
    mesh::Soup soup_;
};

/// A corner of a chain of corners, and how far along the chain it stands.
struct ChainCorner {
    Corner corner;
    double at; ///< ascending
};

/// The strip between two chains that run side by side, `right` to the right of `left` seen from outside.
void stitch(SoupBuilder& builder, std::span<const ChainCorner> right, std::span<const ChainCorner> left);

/// The flat lid of a ring of corners that stand at equal angles round the z axis, counter-clockwise seen
/// from above: rings of half as many corners inward, so that triangles stay well shaped and no corner has
/// hundreds of them. Its outside is +z, or -z with `down`.
void cap(SoupBuilder& builder, std::span<const std::uint32_t> ring, double radius_mm, double z_mm, bool down);

/// Straight pieces of a circle whose chords stay within the error; at least `least`.
double circle_segments(double radius_mm, double chord_mm, double least);

/// The error of too many triangles, when there are.
Status check_count(double triangles, double chord_mm);

Result<mesh::Soup> sphere_soup(const Sphere& sphere, double chord_mm);
Result<mesh::Soup> ellipsoid_soup(const Ellipsoid& ellipsoid, double chord_mm);
Result<mesh::Soup> torus_soup(const Torus& torus, double chord_mm);
mesh::Soup box_soup(const Box& box);
Result<mesh::Soup> cone_soup(const Cone& cone, double chord_mm);
Result<mesh::Soup> superquadric_soup(const Superquadric& superquadric, double chord_mm);
Result<mesh::Soup> height_field_soup(const HeightField& field, std::optional<double> chord_mm);
Result<mesh::Soup> nurbs_soup(const NurbsPatch& patch, double chord_mm);

} // namespace phantom::scene
