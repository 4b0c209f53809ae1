// SPDX-License-Identifier: GPL-2.0-or-later
// Shapes with creases: box, and cylinder, frustum and cone.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/vector.hpp"
#include "scene/shapes/soup_builder.hpp"

namespace phantom::scene {

namespace {

using mesh::Vec3;

/// Triangles longer than this many times their width would make poor hulls.
constexpr double aspect_max = 32;

double rows_for(const Cone& cone, double segments)
{
    const double width = 2 * std::numbers::pi * std::max(cone.radius_mm, cone.top_radius_mm) / segments;
    const double generator = std::hypot(cone.height_mm, cone.radius_mm - cone.top_radius_mm);
    return std::max(1.0, std::ceil(generator / (aspect_max * width)));
}

/// The side of a cone: corners on generators, every strip between two generators flat.
class Side {
  public:
    Side(const Cone& cone, std::uint32_t segments, std::uint32_t rows)
        : cone_(cone), segments_(segments), rows_(rows)
    {
        rings_.resize(rows_ + 1);
        for (std::uint32_t i = 0; i < segments_; ++i)
            normals_.push_back(builder.normal(normal_at(i)));
        for (std::uint32_t row = 0; row <= rows_; ++row) {
            if (row == rows_ && pointed())
                rings_[row].assign(1, builder.vertex({0, 0, 0.5 * cone_.height_mm}));
            else
                make_ring(row);
        }
    }

    [[nodiscard]] bool pointed() const { return cone_.top_radius_mm == 0; }
    [[nodiscard]] std::span<const std::uint32_t> lower_ring() const { return rings_.front(); }
    [[nodiscard]] std::span<const std::uint32_t> upper_ring() const { return rings_.back(); }

    void make_faces()
    {
        for (std::uint32_t row = 0; row < rows_; ++row) {
            for (std::uint32_t i = 0; i < segments_; ++i) {
                if (row + 1 < rows_ || !pointed()) {
                    builder.quad(corner(row, i), corner(row, i + 1), corner(row + 1, i + 1),
                                 corner(row + 1, i));
                    continue;
                }
                // The formula has no normal at its tip: each triangle takes that of its middle generator.
                const std::uint32_t middle = builder.normal(normal_at(i + 0.5));
                builder.face(corner(row, i), corner(row, i + 1), {rings_[rows_][0], middle});
            }
        }
    }

    SoupBuilder builder;

  private:
    [[nodiscard]] double angle(double i) const { return 2 * std::numbers::pi * i / segments_; }
    [[nodiscard]] Vec3 normal_at(double i) const
    {
        return mesh::normalized({cone_.height_mm * std::cos(angle(i)), cone_.height_mm * std::sin(angle(i)),
                                 cone_.radius_mm - cone_.top_radius_mm});
    }
    void make_ring(std::uint32_t row)
    {
        const double part = static_cast<double>(row) / rows_;
        const double radius = (1 - part) * cone_.radius_mm + part * cone_.top_radius_mm;
        for (std::uint32_t i = 0; i < segments_; ++i)
            rings_[row].push_back(builder.vertex(
                {radius * std::cos(angle(i)), radius * std::sin(angle(i)), (part - 0.5) * cone_.height_mm}));
    }
    [[nodiscard]] Corner corner(std::uint32_t row, std::uint32_t i) const
    {
        return {rings_[row][i % segments_], normals_[i % segments_]};
    }

    Cone cone_;
    std::uint32_t segments_, rows_;
    std::vector<std::uint32_t> normals_;
    std::vector<std::vector<std::uint32_t>> rings_;
};

} // namespace

mesh::Soup box_soup(const Box& box)
{
    mesh::Soup soup;
    for (int corner = 0; corner < 8; ++corner)
        soup.vertices.push_back({(corner & 1 ? 0.5 : -0.5) * box.size_mm[0],
                                 (corner & 2 ? 0.5 : -0.5) * box.size_mm[1],
                                 (corner & 4 ? 0.5 : -0.5) * box.size_mm[2]});
    soup.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                  {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    soup.normals = {{0, 0, -1}, {0, 0, 1}, {0, -1, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}};
    for (std::uint32_t face = 0; face < 12; ++face)
        soup.face_normals.push_back({face / 2, face / 2, face / 2});
    return soup;
}

// Two parallel sides make each strip flat, so the error is the sagitta of the wider end.
Result<mesh::Soup> cone_soup(const Cone& cone, double chord_mm)
{
    const double segments = circle_segments(std::max(cone.radius_mm, cone.top_radius_mm), chord_mm, 8);
    const double rows = rows_for(cone, segments);
    // About three triangles a corner of each cap.
    if (Status status = check_count(2 * rows * segments + 6 * segments, chord_mm); !status)
        return status.error();
    Side side(cone, static_cast<std::uint32_t>(segments), static_cast<std::uint32_t>(rows));
    side.make_faces();
    cap(side.builder, side.lower_ring(), cone.radius_mm, -0.5 * cone.height_mm, true);
    if (!side.pointed())
        cap(side.builder, side.upper_ring(), cone.top_radius_mm, 0.5 * cone.height_mm, false);
    return side.builder.take();
}

} // namespace phantom::scene
