// SPDX-License-Identifier: GPL-2.0-or-later
// A grid over every knot span of the patch. Its parts are as many as the chord error asks for:
//
// In homogeneous coordinates S = X / w. The triangle's point over the same weights of its corners is
// L = X_l / w_l, with X_l and w_l linear, so S - L = ((X - X_l) - L (w - w_l)) / w, and by the bound of
// Filip, Magedson and Markot (1986) |S - L| <= (e(X) + r e(w)) / w_min, with r >= |L| and e(Y) = (du^2 |Y_uu|
// + 2 du dv |Y_uv| + dv^2 |Y_vv|) / 8. The second derivatives are B-splines again: they lie within the hull
// of their control points. X is taken from the middle of the span's own control points.
#include <algorithm>
#include <cmath>

#include "mesh/vector.hpp"
#include "scene/shapes/nurbs_surface.hpp"
#include "scene/shapes/soup_builder.hpp"

namespace phantom::scene {

namespace {

using mesh::Vec3;

/// Unit normals nearer than this are one: what rounding leaves of a formula's own.
constexpr double same_normal = 1e-9;

/// Parts of every span in one direction.
struct Steps {
    std::vector<std::uint32_t> spans;  ///< knot spans that are not empty
    std::vector<std::uint32_t> parts;  ///< of each
    std::vector<std::uint32_t> line_0; ///< grid line at which each begins
    [[nodiscard]] std::uint32_t lines() const { return line_0.back() + parts.back() + 1; }
    [[nodiscard]] double total() const { return line_0.back() + parts.back(); }
};

Steps steps_of(const NurbsPatch::Direction& d)
{
    Steps steps;
    for (std::uint32_t k = d.degree; k < d.count; ++k) {
        if (d.knots[k] < d.knots[k + 1])
            steps.spans.push_back(k);
    }
    steps.parts.assign(steps.spans.size(), 1);
    return steps;
}

struct Parts {
    double u = 1, v = 1;
};

/// Parts of a span that are enough over these windows.
Parts parts_for(const Bend& bend, double chord_mm)
{
    // 2 / (nu nv) <= 1 / nu^2 + 1 / nv^2
    const double along_u = bend.uu + bend.uv, along_v = bend.vv + bend.uv;
    const double share = along_u > 0 && along_v > 0 ? 0.5 * chord_mm : chord_mm;
    return {std::max(1.0, std::ceil(std::sqrt(along_u / (8 * share)))),
            std::max(1.0, std::ceil(std::sqrt(along_v / (8 * share))))};
}

/// Windows of 2 / count of a span, every one half over the next: a triangle over no more than 1 / count of
/// the span lies within one of them. The whole span for count 1.
std::vector<Window> windows(int count)
{
    std::vector<Window> all;
    for (int i = 0; i + 1 < count; ++i)
        all.push_back({static_cast<double>(i) / count, static_cast<double>(i + 2) / count});
    return count == 1 ? std::vector<Window>{Window{}} : all;
}

/// Windows pay where there are many more parts than windows.
Parts parts_of_span(const NurbsPatch& patch, std::uint32_t u, std::uint32_t v, double chord_mm)
{
    Parts best = parts_for(bend_of(patch, u, {}, v, {}), chord_mm);
    for (const int count : {4, 16}) {
        const int count_u = best.u >= 2 * count ? count : 1, count_v = best.v >= 2 * count ? count : 1;
        if (count_u == 1 && count_v == 1)
            break;
        Parts parts{static_cast<double>(count_u), static_cast<double>(count_v)};
        for (const Window& window_u : windows(count_u)) {
            for (const Window& window_v : windows(count_v)) {
                const Parts here = parts_for(bend_of(patch, u, window_u, v, window_v), chord_mm);
                parts = {std::max(parts.u, here.u), std::max(parts.v, here.v)};
            }
        }
        if (parts.u * parts.v < best.u * best.v)
            best = parts;
    }
    return best;
}

/// Makes the parts of every span enough for the chord error; false when they are beyond counting.
bool choose_parts(const NurbsPatch& patch, double chord_mm, Steps& u, Steps& v)
{
    for (std::size_t i = 0; i < u.spans.size(); ++i) {
        for (std::size_t j = 0; j < v.spans.size(); ++j) {
            const Parts parts = parts_of_span(patch, u.spans[i], v.spans[j], chord_mm);
            if (!(parts.u < 1e6 && parts.v < 1e6))
                return false;
            u.parts[i] = std::max(u.parts[i], static_cast<std::uint32_t>(parts.u));
            v.parts[j] = std::max(v.parts[j], static_cast<std::uint32_t>(parts.v));
        }
    }
    for (Steps* steps : {&u, &v}) {
        std::uint32_t line = 0;
        for (const std::uint32_t parts : steps->parts) {
            steps->line_0.push_back(line);
            line += parts;
        }
    }
    return true;
}

class Grid {
  public:
    Grid(const NurbsPatch& patch, const Steps& u, const Steps& v)
        : patch_(patch),
          u_(u),
          v_(v),
          ends_(ends_of(patch)),
          vertices_(static_cast<std::size_t>(u.lines()) * v.lines(), mesh::no_neighbour)
    {
    }

    mesh::Soup make()
    {
        for (std::size_t i = 0; i < u_.spans.size(); ++i) {
            for (std::size_t j = 0; j < v_.spans.size(); ++j) {
                for (std::uint32_t a = 0; a < u_.parts[i]; ++a) {
                    for (std::uint32_t b = 0; b < v_.parts[j]; ++b)
                        cell(i, a, j, b);
                }
            }
        }
        return builder_.take();
    }

  private:
    /// A corner of a cell: in span i (of Steps), `a` of its parts from its start.
    struct Place {
        std::size_t i;
        std::uint32_t a;
        std::size_t j;
        std::uint32_t b;
    };

    static double parameter(const NurbsPatch::Direction& d, const Steps& steps, std::size_t i, double a)
    {
        const double low = d.knots[steps.spans[i]], high = d.knots[steps.spans[i] + 1];
        return a == steps.parts[i] ? high : low + (high - low) * (a / steps.parts[i]);
    }

    [[nodiscard]] SurfacePoint evaluate(const Place& p, double a, double b) const
    {
        return surface_point(patch_, u_.spans[p.i], parameter(patch_.u, u_, p.i, a), v_.spans[p.j],
                             parameter(patch_.v, v_, p.j, b));
    }

    /// The grid line, that at the seam and all of a pole counted once.
    [[nodiscard]] std::size_t number(const Place& p) const
    {
        std::uint32_t line_u = u_.line_0[p.i] + p.a, line_v = v_.line_0[p.j] + p.b;
        if (ends_.closed_u && line_u + 1 == u_.lines())
            line_u = 0;
        if (ends_.closed_v && line_v + 1 == v_.lines())
            line_v = 0;
        if (pole_v(line_v))
            line_u = 0;
        if (pole_u(line_u))
            line_v = 0;
        return static_cast<std::size_t>(line_u) * v_.lines() + line_v;
    }
    [[nodiscard]] bool pole_v(std::uint32_t line) const
    {
        return (ends_.pole_v[0] && line == 0) || (ends_.pole_v[1] && line + 1 == v_.lines());
    }
    [[nodiscard]] bool pole_u(std::uint32_t line) const
    {
        return (ends_.pole_u[0] && line == 0) || (ends_.pole_u[1] && line + 1 == u_.lines());
    }

    /// The corner of a cell whose middle is at (middle_a, middle_b).
    Corner corner(const Place& p, double middle_a, double middle_b)
    {
        std::uint32_t& vertex = vertices_[number(p)];
        if (vertex == mesh::no_neighbour) {
            vertex = builder_.vertex(evaluate(p, p.a, p.b).position);
            normals_of_.emplace_back();
        }
        const bool at_pole_v = pole_v(v_.line_0[p.j] + p.b), at_pole_u = pole_u(u_.line_0[p.i] + p.a);
        // At a pole the normal is that of the cell's middle meridian, should there be many.
        const SurfacePoint point = evaluate(p, at_pole_v ? middle_a : p.a, at_pole_u ? middle_b : p.b);
        const Vec3 normal = normal_of(point, p, at_pole_u, at_pole_v);
        for (const std::uint32_t known : normals_of_[vertex]) {
            if (mesh::distance(normals_[known], normal) < same_normal)
                return {vertex, known};
        }
        normals_.push_back(normal);
        normals_of_[vertex].push_back(builder_.normal(normal));
        return {vertex, normals_of_[vertex].back()};
    }

    /// At a pole S_u (or S_v) vanishes; near it is S_uv times the distance from it.
    static Vec3 normal_of(const SurfacePoint& s, const Place& p, bool at_pole_u, bool at_pole_v)
    {
        if (at_pole_v)
            return mesh::normalized(mesh::cross(mesh::scaled(s.uv, p.b == 0 ? 1 : -1), s.v));
        if (at_pole_u)
            return mesh::normalized(mesh::cross(s.u, mesh::scaled(s.uv, p.a == 0 ? 1 : -1)));
        return mesh::normalized(mesh::cross(s.u, s.v));
    }

    void cell(std::size_t i, std::uint32_t a, std::size_t j, std::uint32_t b)
    {
        const double middle_a = a + 0.5, middle_b = b + 0.5;
        const std::array<Corner, 4> c{
            corner({i, a, j, b}, middle_a, middle_b), corner({i, a + 1, j, b}, middle_a, middle_b),
            corner({i, a + 1, j, b + 1}, middle_a, middle_b), corner({i, a, j, b + 1}, middle_a, middle_b)};
        for (const std::array<std::size_t, 3>& t : {std::array<std::size_t, 3>{0, 1, 2}, {0, 2, 3}}) {
            const Corner &p = c[t[0]], &q = c[t[1]], &r = c[t[2]];
            if (p.vertex != q.vertex && q.vertex != r.vertex && r.vertex != p.vertex)
                builder_.face(p, q, r);
        }
    }

    const NurbsPatch& patch_;
    const Steps &u_, &v_;
    Ends ends_;
    std::vector<std::uint32_t> vertices_;                ///< by grid lines
    std::vector<std::vector<std::uint32_t>> normals_of_; ///< per vertex
    std::vector<Vec3> normals_;
    SoupBuilder builder_;
};

/// Six times the volume that the faces enclose; positive with the outside outward.
double six_volumes(const mesh::Soup& soup)
{
    double sum = 0;
    const Vec3& origin = soup.vertices.front();
    for (const mesh::Triple& face : soup.faces)
        sum += mesh::dot(mesh::subtract(soup.vertices[face[0]], origin),
                         mesh::cross(mesh::subtract(soup.vertices[face[1]], origin),
                                     mesh::subtract(soup.vertices[face[2]], origin)));
    return sum;
}

void turn_over(mesh::Soup& soup)
{
    for (mesh::Triple& face : soup.faces)
        std::swap(face[1], face[2]);
    for (mesh::Triple& face : soup.face_normals)
        std::swap(face[1], face[2]);
    for (Vec3& normal : soup.normals)
        normal = mesh::scaled(normal, -1);
}

} // namespace

Result<mesh::Soup> nurbs_soup(const NurbsPatch& patch, double chord_mm)
{
    if (!(mesh::bounds_of(patch.points).extent() > 0))
        return Error{"points_mm", "lie all in one place: the patch has no area"};
    Steps u = steps_of(patch.u), v = steps_of(patch.v);
    const bool counted = choose_parts(patch, chord_mm, u, v);
    if (Status status = check_count(counted ? 2 * u.total() * v.total() : 1e12, chord_mm); !status)
        return status.error();
    mesh::Soup soup = Grid(patch, u, v).make();
    if (ends_of(patch).encloses() && six_volumes(soup) < 0)
        turn_over(soup);
    return soup;
}

} // namespace phantom::scene
