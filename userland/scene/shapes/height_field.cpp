// SPDX-License-Identifier: GPL-2.0-or-later
// Between four samples lies a cell of the bicubic surface of Catmull and Rom. The grid of triangles goes
// through all samples, and through n^2 parts of every cell where the chord error asks for it: over steps of
// 1/n the triangles are within (|z_uu| + 2 |z_uv| + |z_vv|) / 8 n^2 of the surface (Filip, Magedson and
// Markot 1986), measured upright, and the second derivatives are within those of the cell's Bezier points.
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <fmt/format.h>

#include "mesh/vector.hpp"
#include "scene/shapes/grey_image.hpp"
#include "scene/shapes/soup_builder.hpp"

namespace phantom::scene {

namespace {

using Four = std::array<double, 4>;

/// Weights of the samples -1, 0, 1, 2 at t between 0 and 1.
Four weights(double t)
{
    return {0.5 * t * (-1 + t * (2 - t)), 1 + 0.5 * t * t * (-5 + 3 * t), 0.5 * t * (1 + t * (4 - 3 * t)),
            0.5 * t * t * (t - 1)};
}

Four slopes(double t)
{
    return {-0.5 + t * (2 - 1.5 * t), t * (-5 + 4.5 * t), 0.5 + t * (4 - 4.5 * t), t * (-1 + 1.5 * t)};
}

/// The Bezier points of the curve through the two samples in the middle.
Four bezier(const Four& s)
{
    return {s[1], s[1] + (s[2] - s[0]) / 6, s[2] - (s[3] - s[1]) / 6, s[2]};
}

/// The surface over cells of side 1, u along the image's rows, v downward.
class Relief {
  public:
    Relief(const GreyImage& image, double height_mm) : image_(image), height_mm_(height_mm) {}

    /// A sample; beyond the edges the surface goes on straight.
    [[nodiscard]] double sample(std::int64_t u, std::int64_t v) const
    {
        const std::int64_t last_u = image_.width - 1, last_v = image_.height - 1;
        if (u < 0)
            return 2 * sample(0, v) - sample(1, v);
        if (u > last_u)
            return 2 * sample(last_u, v) - sample(last_u - 1, v);
        if (v < 0)
            return 2 * sample(u, 0) - sample(u, 1);
        if (v > last_v)
            return 2 * sample(u, last_v) - sample(u, last_v - 1);
        return height_mm_ * image_.at(static_cast<std::uint32_t>(u), static_cast<std::uint32_t>(v));
    }

    /// Height and its slopes at (u + s, v + t), s and t in 0 ... 1.
    struct Point {
        double z, zu, zv;
    };
    [[nodiscard]] Point at(std::int64_t u, double s, std::int64_t v, double t) const
    {
        const Four wu = weights(s), wv = weights(t), du = slopes(s), dv = slopes(t);
        Point point{0, 0, 0};
        for (std::int64_t j = 0; j < 4; ++j) {
            for (std::int64_t i = 0; i < 4; ++i) {
                const double z = sample(u + i - 1, v + j - 1);
                const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
                point.z += wu[a] * wv[b] * z;
                point.zu += du[a] * wv[b] * z;
                point.zv += wu[a] * dv[b] * z;
            }
        }
        return point;
    }

    /// A bound of |z_uu| + 2 |z_uv| + |z_vv| over one cell.
    [[nodiscard]] double bend(std::int64_t u, std::int64_t v) const
    {
        std::array<Four, 4> rows{}, b{};
        for (std::int64_t j = 0; j < 4; ++j)
            rows[static_cast<std::size_t>(j)] = bezier({sample(u - 1, v + j - 1), sample(u, v + j - 1),
                                                        sample(u + 1, v + j - 1), sample(u + 2, v + j - 1)});
        for (std::size_t i = 0; i < 4; ++i)
            b[i] = bezier({rows[0][i], rows[1][i], rows[2][i], rows[3][i]}); // b[u][v]
        double uu = 0, uv = 0, vv = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t k = 0; k < 2; ++k) {
                uu = std::max(uu, std::abs(b[k + 2][i] - 2 * b[k + 1][i] + b[k][i]));
                vv = std::max(vv, std::abs(b[i][k + 2] - 2 * b[i][k + 1] + b[i][k]));
            }
        }
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t k = 0; k < 3; ++k)
                uv = std::max(uv, std::abs(b[i + 1][k + 1] - b[i + 1][k] - b[i][k + 1] + b[i][k]));
        }
        return 6 * uu + 2 * 9 * uv + 6 * vv;
    }

    [[nodiscard]] double bend() const
    {
        double most = 0;
        for (std::int64_t v = 0; v + 1 < image_.height; ++v) {
            for (std::int64_t u = 0; u + 1 < image_.width; ++u)
                most = std::max(most, bend(u, v));
        }
        return most;
    }

  private:
    const GreyImage& image_;
    double height_mm_;
};

/// The triangles: the relief, and below it walls and a bottom.
class Field {
  public:
    Field(const HeightField& field, const GreyImage& image, std::uint32_t parts)
        : field_(field),
          relief_(image, field.height_mm),
          parts_(parts),
          columns_((image.width - 1) * parts),
          rows_((image.height - 1) * parts),
          cells_{image.width - 1, image.height - 1}
    {
    }

    Result<mesh::Soup> make()
    {
        make_relief();
        if (!field_.closed)
            return builder_.take();
        if (lowest_ < -0.25 * field_.base_mm)
            return Error{"base_mm", fmt::format("is {:g}, but between its samples the surface swings down to "
                                                "{:.3g} mm, expected {:.3g} or more",
                                                field_.base_mm, lowest_, -4 * lowest_)};
        make_base();
        return builder_.take();
    }

  private:
    [[nodiscard]] double x_at(double part) const { return (part - 0.5) * field_.size_mm[0]; }
    [[nodiscard]] double y_at(double part) const { return (0.5 - part) * field_.size_mm[1]; }

    /// Of the relief: vertex and normal have the same number.
    [[nodiscard]] Corner corner(std::uint32_t column, std::uint32_t row) const
    {
        const std::uint32_t number = row * (columns_ + 1) + column;
        return {number, number};
    }

    void make_relief()
    {
        for (std::uint32_t row = 0; row <= rows_; ++row) {
            const std::uint32_t v = std::min(row / parts_, cells_[1] - 1);
            for (std::uint32_t column = 0; column <= columns_; ++column) {
                const std::uint32_t u = std::min(column / parts_, cells_[0] - 1);
                const Relief::Point point = relief_.at(u, static_cast<double>(column - u * parts_) / parts_,
                                                       v, static_cast<double>(row - v * parts_) / parts_);
                lowest_ = std::min(lowest_, point.z);
                builder_.vertex({x_at(static_cast<double>(column) / columns_),
                                 y_at(static_cast<double>(row) / rows_), point.z});
                // Slopes per mm; v runs against y.
                builder_.normal(mesh::normalized({-point.zu * cells_[0] / field_.size_mm[0],
                                                  point.zv * cells_[1] / field_.size_mm[1], 1}));
            }
        }
        for (std::uint32_t row = 0; row < rows_; ++row) {
            for (std::uint32_t column = 0; column < columns_; ++column)
                builder_.quad(corner(column, row), corner(column, row + 1), corner(column + 1, row + 1),
                              corner(column + 1, row));
        }
    }

    /// The bottom in squares of a sixteenth of its longer side, and walls between their edge and the
    /// relief's.
    void make_base()
    {
        constexpr double squares = 16;
        const double side = std::max(field_.size_mm[0], field_.size_mm[1]) / squares;
        std::array<std::uint32_t, 2> count{};
        for (std::size_t axis = 0; axis < 2; ++axis)
            count[axis] = static_cast<std::uint32_t>(std::max(1.0, std::round(field_.size_mm[axis] / side)));
        std::vector<std::uint32_t> numbers; // row by row
        for (std::uint32_t row = 0; row <= count[1]; ++row) {
            for (std::uint32_t column = 0; column <= count[0]; ++column)
                numbers.push_back(
                    builder_.vertex({x_at(static_cast<double>(column) / count[0]),
                                     y_at(static_cast<double>(row) / count[1]), -field_.base_mm}));
        }
        const std::uint32_t down = builder_.normal({0, 0, -1});
        const auto base = [&](std::uint32_t column, std::uint32_t row, std::uint32_t normal) {
            return Corner{numbers[row * (count[0] + 1) + column], normal};
        };
        for (std::uint32_t row = 0; row < count[1]; ++row) {
            for (std::uint32_t column = 0; column < count[0]; ++column)
                builder_.quad(base(column, row, down), base(column + 1, row, down),
                              base(column + 1, row + 1, down), base(column, row + 1, down));
        }
        make_walls(count,
                   [&](std::uint32_t column, std::uint32_t row) { return base(column, row, down).vertex; });
    }

    /// From the relief straight down to half way, with an edge under every corner of it, and from there to
    /// the bottom's fewer corners: so no triangle can overlap another, however rugged the relief is.
    template <typename Base>
    void make_walls(const std::array<std::uint32_t, 2>& count, Base&& base)
    {
        // Seen from outside a wall runs to the right, with the lower chain to the right of the upper one.
        struct Wall {
            mesh::Vec3 normal;
            std::size_t axis;  ///< that it runs along
            bool far, forward; ///< at the end of the other axis; in ascending order
        };
        const std::array<std::uint32_t, 2> fine{columns_, rows_};
        for (const Wall& wall : {Wall{{0, -1, 0}, 0, true, true}, Wall{{0, 1, 0}, 0, false, false},
                                 Wall{{-1, 0, 0}, 1, false, true}, Wall{{1, 0, 0}, 1, true, false}}) {
            const std::uint32_t normal = builder_.normal(wall.normal);
            const auto chain = [&](const std::array<std::uint32_t, 2>& size, auto&& vertex_at) {
                std::vector<ChainCorner> corners;
                for (std::uint32_t i = 0; i <= size[wall.axis]; ++i) {
                    std::array<std::uint32_t, 2> at{};
                    at[wall.axis] = wall.forward ? i : size[wall.axis] - i;
                    at[1 - wall.axis] = wall.far ? size[1 - wall.axis] : 0;
                    corners.push_back(
                        {{vertex_at(at[0], at[1]), normal}, static_cast<double>(i) / size[wall.axis]});
                }
                return corners;
            };
            const auto relief =
                chain(fine, [this](std::uint32_t c, std::uint32_t r) { return corner(c, r).vertex; });
            const auto half =
                chain(fine, [this](std::uint32_t c, std::uint32_t r) { return half_way(c, r); });
            for (std::size_t i = 0; i + 1 < half.size(); ++i)
                builder_.quad(half[i].corner, half[i + 1].corner, relief[i + 1].corner, relief[i].corner);
            stitch(builder_, chain(count, base), half);
        }
    }

    /// The vertex half way between z = 0 and the bottom, below one of the relief's edge.
    std::uint32_t half_way(std::uint32_t column, std::uint32_t row)
    {
        const auto [found, fresh] = half_way_.try_emplace(corner(column, row).vertex, 0);
        if (fresh) {
            const mesh::Vec3 above = builder_.position(found->first);
            found->second = builder_.vertex({above[0], above[1], -0.5 * field_.base_mm});
        }
        return found->second;
    }

    const HeightField& field_;
    Relief relief_;
    std::uint32_t parts_;          ///< of a cell
    std::uint32_t columns_, rows_; ///< of quads
    std::array<std::uint32_t, 2> cells_;
    SoupBuilder builder_;
    std::unordered_map<std::uint32_t, std::uint32_t> half_way_; ///< of a vertex of the relief
    double lowest_ = INFINITY;
};

} // namespace

Result<mesh::Soup> height_field_soup(const HeightField& field, std::optional<double> chord_mm)
{
    const auto image = read_grey_image(field.image);
    if (!image)
        return Error{"image", image.error().text()};
    const double cells = 2.0 * (image->width - 1.0) * (image->height - 1.0);
    if (cells > static_cast<double>(shape_triangles_max))
        return Error{"image", fmt::format("{} has {} x {} samples, {:.0f} triangles, expected at most {}",
                                          field.image.string(), image->width, image->height, cells,
                                          shape_triangles_max)};
    double parts = 1;
    if (chord_mm) {
        parts = std::max(1.0, std::ceil(std::sqrt(Relief(*image, field.height_mm).bend() / (8 * *chord_mm))));
        if (Status status = check_count(cells * parts * parts, *chord_mm); !status)
            return status.error();
    }
    return Field(field, *image, static_cast<std::uint32_t>(parts)).make();
}

} // namespace phantom::scene
