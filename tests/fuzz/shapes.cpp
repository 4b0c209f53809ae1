// SPDX-License-Identifier: GPL-2.0-or-later
#include "shapes.hpp"

#include <cmath>
#include <limits>

#include "feel.hpp"

namespace phantom::fuzz {

namespace {

/// How a face's corners get their normals.
enum class Rule : std::uint32_t { Plane, Radial, Bent, Any };
constexpr std::uint32_t rules = 4;

Point plus(const Point& a, const Point& b)
{
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

Point scaled(const Direction& direction, double by)
{
    return {std::llround(direction[0] * by), std::llround(direction[1] * by),
            std::llround(direction[2] * by)};
}

/// Two bytes: any direction, on an octahedron that is unfolded into a square.
Direction any_direction(Bytes& in)
{
    const double u = static_cast<std::int8_t>(in.byte()) / 127.0;
    const double v = static_cast<std::int8_t>(in.byte()) / 127.0;
    const double z = 1 - std::abs(u) - std::abs(v);
    if (z >= 0)
        return normalized({u, v, z});
    return normalized({std::copysign(1 - std::abs(v), u), std::copysign(1 - std::abs(u), v), z});
}

Direction corner_normal(Bytes& in, Rule rule, const Direction& plane, const Point& corner)
{
    switch (rule) {
    case Rule::Plane:
        return plane;
    case Rule::Radial:
        return normalized({double(corner[0]), double(corner[1]), double(corner[2])}, plane);
    case Rule::Bent: {
        const Direction bend = any_direction(in);
        return normalized({plane[0] + 0.5 * bend[0], plane[1] + 0.5 * bend[1], plane[2] + 0.5 * bend[2]});
    }
    case Rule::Any:
        return any_direction(in);
    }
    return plane;
}

void add_triangle(Bytes& in, SetBuilder& to, Rule rule, const std::array<Point, 3>& corner)
{
    const Direction plane = plane_normal(corner);
    std::array<Direction, 3> normal{};
    for (std::size_t i = 0; i < 3; ++i)
        normal[i] = corner_normal(in, rule, plane, corner[i]);
    to.triangle(corner, normal);
}

void add_free_triangle(Bytes& in, const Ruler& ruler, SetBuilder& to)
{
    const Rule rule{in.choose(rules)};
    std::array<Point, 3> corner{};
    for (Point& x : corner)
        x = ruler.point(in);
    add_triangle(in, to, rule, corner);
}

/// A needle or a cap of any height, down to none.
void add_sliver(Bytes& in, const Ruler& ruler, SetBuilder& to)
{
    const Point at = ruler.point(in);
    const std::int64_t half = ruler.length(in) / 2, height = in.raw<std::int16_t>();
    const std::int64_t foot = half * static_cast<std::int8_t>(in.byte()) / 127;
    add_triangle(in, to, Rule::Plane,
                 {plus(at, {-half, 0, 0}), plus(at, {half, 0, 0}), plus(at, {foot, height, 0})});
}

/// A height field: plate, groove, bumps.
void add_grid(Bytes& in, const Ruler& ruler, SetBuilder& to)
{
    const Rule rule{in.choose(rules)};
    const std::size_t side = 1 + in.choose(6);
    const Point at = ruler.point(in);
    const std::int64_t step = ruler.length(in), relief = ruler.length(in);
    std::array<Point, 49> corner{};
    for (std::size_t i = 0; i <= side; ++i)
        for (std::size_t j = 0; j <= side; ++j)
            corner[i * 7 + j] = plus(at, {step * std::int64_t(i), step * std::int64_t(j),
                                          relief ? relief * static_cast<std::int8_t>(in.byte()) / 64 : 0});
    for (std::size_t i = 0; i < side; ++i) {
        for (std::size_t j = 0; j < side; ++j) {
            const Point &a = corner[i * 7 + j], &b = corner[i * 7 + 7 + j];
            const Point &c = corner[i * 7 + 8 + j], &d = corner[i * 7 + j + 1];
            add_triangle(in, to, rule, {a, b, c});
            add_triangle(in, to, rule, {a, c, d});
        }
    }
}

/// An octant's faces, split until they are small; each by its corners' directions.
void add_ball_face(SetBuilder& to, const Point& at, double radius, bool hollow,
                   const std::array<Direction, 3>& corner, std::uint32_t splits, std::uint32_t& left)
{
    if (splits) {
        std::array<Direction, 3> middle{};
        for (std::size_t i = 0; i < 3; ++i) {
            const Direction &a = corner[i], &b = corner[(i + 1) % 3];
            middle[i] = normalized({a[0] + b[0], a[1] + b[1], a[2] + b[2]});
        }
        for (std::size_t i = 0; i < 3; ++i)
            add_ball_face(to, at, radius, hollow, {corner[i], middle[i], middle[(i + 2) % 3]}, splits - 1,
                          left);
        add_ball_face(to, at, radius, hollow, middle, splits - 1, left);
        return;
    }
    if (!left)
        return;
    --left;
    std::array<Point, 3> x{};
    std::array<Direction, 3> m{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t from = hollow ? 2 - i : i;
        x[i] = plus(at, scaled(corner[from], radius));
        for (std::size_t axis = 0; axis < 3; ++axis)
            m[i][axis] = hollow ? -corner[from][axis] : corner[from][axis];
    }
    to.triangle(x, m);
}

/// A sphere or a piece of one, from outside or from inside.
void add_ball(Bytes& in, const Ruler& ruler, SetBuilder& to)
{
    const std::uint32_t kind = in.byte();
    const Point at = ruler.point(in);
    const double radius = std::abs(double(ruler.length(in)));
    std::uint32_t left = 1 + in.byte();
    for (int octant = 0; octant < 8; ++octant) {
        const double x = octant & 1 ? -1 : 1, y = octant & 2 ? -1 : 1, z = octant & 4 ? -1 : 1;
        std::array<Direction, 3> corner{Direction{x, 0, 0}, Direction{0, y, 0}, Direction{0, 0, z}};
        if (x * y * z < 0)
            std::swap(corner[1], corner[2]);
        add_ball_face(to, at, radius, kind & 4, corner, kind & 3, left);
    }
}

Direction axis_direction(std::size_t axis, bool negative)
{
    Direction out{};
    out[axis] = negative ? -1 : 1;
    return out;
}

/// The two triangles of each side.
void add_box_sides(SetBuilder& to, const std::array<Point, 8>& x, bool turned)
{
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t u = std::size_t(1) << (axis + 1) % 3, v = std::size_t(1) << (axis + 2) % 3;
        for (const bool negative : {false, true}) {
            const std::size_t base = negative ? 0 : std::size_t(1) << axis;
            std::array<std::size_t, 4> ring{base, base + u, base + u + v, base + v};
            if (negative != turned)
                std::swap(ring[1], ring[3]);
            const Direction m = axis_direction(axis, negative != turned);
            to.triangle({x[ring[0]], x[ring[1]], x[ring[2]]}, {m, m, m});
            to.triangle({x[ring[0]], x[ring[2]], x[ring[3]]}, {m, m, m});
        }
    }
}

/// The fans over its edges and corners.
void add_box_fans(SetBuilder& to, const std::array<Point, 8>& x)
{
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t along = std::size_t(1) << axis;
        const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (std::size_t corner = 0; corner < 8; ++corner) {
            if (corner & along)
                continue;
            const Point &a = x[corner], &b = x[corner | along];
            const Direction mu = axis_direction(u, !(corner >> u & 1)),
                            mv = axis_direction(v, !(corner >> v & 1));
            to.fan({a, a, b}, {mu, mv, mv});
            to.fan({a, b, b}, {mu, mv, mu});
        }
    }
    for (std::size_t corner = 0; corner < 8; ++corner)
        to.fan({x[corner], x[corner], x[corner]},
               {axis_direction(0, !(corner & 1)), axis_direction(1, !(corner & 2)),
                axis_direction(2, !(corner & 4))});
}

/// Flat sides that keep their normals, joined by fans; or a room, seen from inside, which needs none.
void add_box(Bytes& in, const Ruler& ruler, SetBuilder& to)
{
    const bool room = in.byte() & 1;
    const Point at = ruler.point(in), size = ruler.point(in);
    std::array<Point, 8> x{};
    for (std::size_t corner = 0; corner < 8; ++corner)
        for (std::size_t axis = 0; axis < 3; ++axis)
            x[corner][axis] = at[axis] + (corner >> axis & 1 ? std::abs(size[axis]) : 0);
    add_box_sides(to, x, room);
    if (!room)
        add_box_fans(to, x);
}

void add_edge_fan(Bytes& in, const Ruler& ruler, SetBuilder& to)
{
    const Point a = ruler.point(in), b = ruler.point(in);
    to.fan({a, a, b}, {any_direction(in), any_direction(in), any_direction(in)});
}

void add_corner_fan(Bytes& in, const Ruler& ruler, SetBuilder& to)
{
    const Point a = ruler.point(in);
    to.fan({a, a, a}, {any_direction(in), any_direction(in), any_direction(in)});
}

/// Eight codes an octave from `first` on; the highest is the end of the range.
std::uint32_t logarithmic(std::uint8_t code, double first)
{
    const double value = first * std::exp2(code / 8.0);
    constexpr double top = std::numeric_limits<std::uint32_t>::max();
    return code == 255 || value >= top ? std::uint32_t(top) : std::uint32_t(value);
}

} // namespace

std::int64_t Ruler::length(Bytes& in) const
{
    const auto steps = in.raw<std::int16_t>();
    switch (steps) {
    case std::numeric_limits<std::int16_t>::max():
        return PHANTOM_COORDINATE_MAX_NM;
    case std::numeric_limits<std::int16_t>::min():
        return -PHANTOM_COORDINATE_MAX_NM;
    default:
        return steps * unit_nm / 1000;
    }
}

Point Ruler::point(Bytes& in) const
{
    const std::int64_t x = length(in), y = length(in), z = length(in);
    return {x, y, z};
}

Range add_shape(Bytes& in, const Ruler& ruler, SetBuilder& to)
{
    using Maker = void (*)(Bytes&, const Ruler&, SetBuilder&);
    constexpr Maker makers[shape_kinds] = {add_free_triangle, add_sliver,   add_grid,      add_ball,
                                           add_box,           add_edge_fan, add_corner_fan};
    const std::size_t begin = to.face_count();
    const std::uint8_t kind = in.byte();
    if (kind == shape_rims)
        to.end_surface();
    else
        makers[kind % shape_kinds](in, ruler, to);
    return {begin, to.face_count()};
}

phantom_material read_material(Bytes& in, std::uint8_t& feel)
{
    phantom_material material{};
    material.stiffness_mn_mm = logarithmic(in.byte(), 1) - 1;
    material.radius_nm = logarithmic(in.byte(), 1);
    const std::uint8_t damping = in.byte();
    material.damping_mns_m = damping ? logarithmic(damping, 1) : 0;
    feel = damping ? 0 : in.byte();
    material.effects = damping || feel & 1 ? PHANTOM_EFFECT_DAMPING : 0;
    material.effects |= surface_effects(feel, material.radius_nm);
    return material;
}

} // namespace phantom::fuzz
