// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/shapes/nurbs_surface.hpp"

#include <algorithm>
#include <cmath>

#include "mesh/vector.hpp"

namespace phantom::scene {

namespace {

using mesh::Vec3;
using Direction = NurbsPatch::Direction;

/// x w, y w, z w, w.
using Homogeneous = std::array<double, 4>;

Homogeneous plus(const Homogeneous& a, double s, const Homogeneous& b)
{
    return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2], a[3] + s * b[3]};
}

constexpr std::size_t orders_max = nurbs_degree_max + 1;

/// The functions that do not vanish on the span, and their slopes: of control points span - degree ... span.
struct Basis {
    std::array<double, orders_max> value{}, slope{};
};

/// Algorithm A2.2, the slopes from the functions of one degree less (equation 2.7).
Basis basis_at(const Direction& d, std::uint32_t span, double t)
{
    Basis basis;
    basis.value[0] = 1;
    for (std::uint32_t degree = 1; degree <= d.degree; ++degree) {
        std::array<double, orders_max> value{}, slope{};
        for (std::uint32_t r = 0; r < degree; ++r) {
            // The lower function r lives on knots[first] ... knots[first + degree].
            const std::uint32_t first = span + 1 + r - degree;
            const double low = d.knots[first], width = d.knots[first + degree] - low;
            const double rising = (t - low) / width * basis.value[r];
            value[r] += basis.value[r] - rising;
            value[r + 1] += rising;
            slope[r] -= degree / width * basis.value[r];
            slope[r + 1] += degree / width * basis.value[r];
        }
        basis = {value, slope};
    }
    return basis;
}

Homogeneous control(const NurbsPatch& patch, std::size_t i, std::size_t j)
{
    const std::size_t at = i * patch.v.count + j;
    const Vec3& p = patch.points[at];
    const double w = patch.weights[at];
    return {w * p[0], w * p[1], w * p[2], w};
}

Vec3 spatial(const Homogeneous& h)
{
    return {h[0], h[1], h[2]};
}

/// Bezier points of a piece of the patch, a column for every u index.
using Net = std::vector<std::vector<Homogeneous>>;

/// Of the piece between the parameters low and high of a span, by the polar form: point k is the value at
/// `high` k times and at `low` else (Ramshaw 1989, "Blossoms are polar forms"). `control` are the span's own
/// points.
std::vector<Homogeneous> bezier_points(const Direction& d, std::uint32_t span,
                                       const std::vector<Homogeneous>& control, double low, double high)
{
    const std::uint32_t degree = d.degree;
    std::vector<Homogeneous> out;
    for (std::uint32_t k = 0; k <= degree; ++k) {
        std::vector<Homogeneous> points = control;
        for (std::uint32_t r = 1; r <= degree; ++r) {
            const double t = r <= degree - k ? low : high;
            for (std::uint32_t i = degree; i >= r; --i) {
                const std::uint32_t knot = span - degree + i;
                const double left = d.knots[knot], width = d.knots[knot + degree + 1 - r] - left;
                const double part = (t - left) / width;
                points[i] = plus(plus({}, 1 - part, points[i - 1]), part, points[i]);
            }
        }
        out.push_back(points[degree]);
    }
    return out;
}

Net transposed(const Net& net)
{
    Net out(net.front().size());
    for (const auto& column : net) {
        for (std::size_t j = 0; j < column.size(); ++j)
            out[j].push_back(column[j]);
    }
    return out;
}

double parameter(const Direction& d, std::uint32_t span, double part)
{
    return (1 - part) * d.knots[span] + part * d.knots[span + 1];
}

Net bezier_net(const NurbsPatch& patch, std::uint32_t span_u, const Window& u, std::uint32_t span_v,
               const Window& v)
{
    Net rows; // of v indices, along u
    for (std::uint32_t j = 0; j <= patch.v.degree; ++j) {
        std::vector<Homogeneous> row;
        for (std::uint32_t i = 0; i <= patch.u.degree; ++i)
            row.push_back(control(patch, span_u - patch.u.degree + i, span_v - patch.v.degree + j));
        rows.push_back(bezier_points(patch.u, span_u, row, parameter(patch.u, span_u, u.low),
                                     parameter(patch.u, span_u, u.high)));
    }
    Net net = transposed(rows);
    for (auto& column : net)
        column = bezier_points(patch.v, span_v, column, parameter(patch.v, span_v, v.low),
                               parameter(patch.v, span_v, v.high));
    return net;
}

/// Differences of neighbours along u: those of the derivative but for a factor.
Net differences(const Net& net)
{
    Net out;
    for (std::size_t i = 0; i + 1 < net.size(); ++i) {
        out.emplace_back();
        for (std::size_t j = 0; j < net[i].size(); ++j)
            out.back().push_back(plus(net[i + 1][j], -1, net[i][j]));
    }
    return out;
}

/// The largest lengths of a net's positions and weights.
struct Size {
    double position = 0, weight = 0;
};

Size size_of(const Net& net)
{
    Size size;
    for (const auto& column : net) {
        for (const Homogeneous& h : column) {
            size.position = std::max(size.position, mesh::length(spatial(h)));
            size.weight = std::max(size.weight, std::abs(h[3]));
        }
    }
    return size;
}

/// A net moved so that the mean of its points is the origin; how far they are from it, and their least
/// weight.
struct LocalNet {
    Net net;
    double reach = 0, least_weight = INFINITY;
};

LocalNet centred(Net net)
{
    LocalNet local{std::move(net), 0, INFINITY};
    Vec3 middle{0, 0, 0};
    const double share = 1.0 / static_cast<double>(local.net.size() * local.net.front().size());
    for (const auto& column : local.net)
        for (const Homogeneous& h : column)
            middle = mesh::add(middle, mesh::scaled(spatial(h), share / h[3]));
    for (auto& column : local.net) {
        for (Homogeneous& h : column) {
            h = {h[0] - middle[0] * h[3], h[1] - middle[1] * h[3], h[2] - middle[2] * h[3], h[3]};
            local.reach = std::max(local.reach, mesh::length(spatial(h)) / h[3]);
            local.least_weight = std::min(local.least_weight, h[3]);
        }
    }
    return local;
}

} // namespace

SurfacePoint surface_point(const NurbsPatch& patch, std::uint32_t span_u, double u, std::uint32_t span_v,
                           double v)
{
    const Basis bu = basis_at(patch.u, span_u, u), bv = basis_at(patch.v, span_v, v);
    Homogeneous x{}, xu{}, xv{}, xuv{};
    for (std::size_t a = 0; a <= patch.u.degree; ++a) {
        for (std::size_t b = 0; b <= patch.v.degree; ++b) {
            const Homogeneous h = control(patch, span_u - patch.u.degree + a, span_v - patch.v.degree + b);
            x = plus(x, bu.value[a] * bv.value[b], h);
            xu = plus(xu, bu.slope[a] * bv.value[b], h);
            xv = plus(xv, bu.value[a] * bv.slope[b], h);
            xuv = plus(xuv, bu.slope[a] * bv.slope[b], h);
        }
    }
    // The quotient rule (equation 4.20).
    const double w = 1 / x[3];
    SurfacePoint point;
    point.position = mesh::scaled(spatial(x), w);
    point.u = mesh::scaled(mesh::subtract(spatial(xu), mesh::scaled(point.position, xu[3])), w);
    point.v = mesh::scaled(mesh::subtract(spatial(xv), mesh::scaled(point.position, xv[3])), w);
    Vec3 mixed = mesh::subtract(spatial(xuv), mesh::scaled(point.position, xuv[3]));
    mixed = mesh::subtract(mixed, mesh::scaled(point.v, xu[3]));
    mixed = mesh::subtract(mixed, mesh::scaled(point.u, xv[3]));
    point.uv = mesh::scaled(mixed, w);
    return point;
}

Bend bend_of(const NurbsPatch& patch, std::uint32_t span_u, const Window& u, std::uint32_t span_v,
             const Window& v)
{
    const LocalNet local = centred(bezier_net(patch, span_u, u, span_v, v));
    // Per span, not per window.
    const double by_u = patch.u.degree / (u.high - u.low), by_v = patch.v.degree / (v.high - v.low);
    const double by_uu = by_u * (patch.u.degree - 1) / (u.high - u.low);
    const double by_vv = by_v * (patch.v.degree - 1) / (v.high - v.low);
    const auto weighed = [&local](const Net& net, double factor) {
        const Size size = size_of(net);
        return (size.position + local.reach * size.weight) / local.least_weight * factor;
    };
    const Net along_u = differences(local.net), along_v = differences(transposed(local.net));
    return {weighed(differences(along_u), by_uu), weighed(differences(transposed(along_u)), by_u * by_v),
            weighed(differences(along_v), by_vv)};
}

Ends ends_of(const NurbsPatch& patch)
{
    const std::size_t nu = patch.u.count, nv = patch.v.count;
    const auto same = [&](std::size_t a, std::size_t b) {
        return control(patch, a / nv, a % nv) == control(patch, b / nv, b % nv);
    };
    // Only an edge that the patch reaches can be a seam or a pole: its end knot repeated degree + 1 times.
    const auto clamped = [](const Direction& d, bool high) {
        return high ? d.knots[d.count] == d.knots.back() : d.knots[0] == d.knots[d.degree];
    };
    Ends ends;
    ends.closed_u = clamped(patch.u, false) && clamped(patch.u, true);
    for (std::size_t j = 0; j < nv; ++j)
        ends.closed_u = ends.closed_u && same(j, (nu - 1) * nv + j);
    ends.closed_v = clamped(patch.v, false) && clamped(patch.v, true);
    for (std::size_t i = 0; i < nu; ++i)
        ends.closed_v = ends.closed_v && same(i * nv, i * nv + nv - 1);
    for (std::size_t end = 0; end < 2; ++end) {
        const std::size_t i = end * (nu - 1), j = end * (nv - 1);
        ends.pole_u[end] = clamped(patch.u, end == 1);
        for (std::size_t k = 1; k < nv; ++k)
            ends.pole_u[end] = ends.pole_u[end] && patch.points[i * nv] == patch.points[i * nv + k];
        ends.pole_v[end] = clamped(patch.v, end == 1);
        for (std::size_t k = 1; k < nu; ++k)
            ends.pole_v[end] = ends.pole_v[end] && patch.points[j] == patch.points[k * nv + j];
    }
    return ends;
}

} // namespace phantom::scene
