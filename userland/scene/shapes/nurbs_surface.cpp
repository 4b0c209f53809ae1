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

/// Control points of one span, a column for every u index.
using Net = std::vector<std::vector<Homogeneous>>;

/// Of the derivative along u of a net of the given degree whose first point is control point `first`
/// (equation 3.4).
Net derived_u(const Net& net, const Direction& d, std::uint32_t degree, std::uint32_t first)
{
    Net out;
    for (std::size_t i = 0; i + 1 < net.size(); ++i) {
        // Each derivative before has taken a knot from either end.
        const std::size_t at = first + i + (d.degree - degree) + 1;
        const double factor = degree / (d.knots[at + degree] - d.knots[at]);
        std::vector<Homogeneous> column;
        for (std::size_t j = 0; j < net[i].size(); ++j) {
            Homogeneous value{};
            value = plus(value, factor, net[i + 1][j]);
            column.push_back(plus(value, -factor, net[i][j]));
        }
        out.push_back(std::move(column));
    }
    return out;
}

Net transposed(const Net& net)
{
    Net out(net.empty() ? 0 : net.front().size());
    for (const auto& column : net) {
        for (std::size_t j = 0; j < column.size(); ++j)
            out[j].push_back(column[j]);
    }
    return out;
}

/// The largest length in the net, as (position, weight).
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

/// The control points that the span depends on, from their middle; their greatest distance from it and their
/// least weight.
struct LocalNet {
    Net net;
    double reach = 0, least_weight = INFINITY;
};

LocalNet local_net(const NurbsPatch& patch, std::uint32_t first_u, std::uint32_t first_v)
{
    const auto each = [&](auto&& visit) {
        for (std::size_t i = first_u; i <= first_u + patch.u.degree; ++i) {
            for (std::size_t j = first_v; j <= first_v + patch.v.degree; ++j)
                visit(i, j);
        }
    };
    Vec3 middle{0, 0, 0};
    const double share = 1.0 / ((patch.u.degree + 1) * (patch.v.degree + 1));
    each([&](std::size_t i, std::size_t j) {
        middle = mesh::add(middle, mesh::scaled(patch.points[i * patch.v.count + j], share));
    });
    LocalNet local;
    local.net.resize(patch.u.degree + 1);
    each([&](std::size_t i, std::size_t j) {
        const std::size_t at = i * patch.v.count + j;
        const double w = patch.weights[at];
        const Vec3 from_middle = mesh::subtract(patch.points[at], middle);
        local.reach = std::max(local.reach, mesh::length(from_middle));
        local.least_weight = std::min(local.least_weight, w);
        local.net[i - first_u].push_back({w * from_middle[0], w * from_middle[1], w * from_middle[2], w});
    });
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

Bend bend_of(const NurbsPatch& patch, std::uint32_t span_u, std::uint32_t span_v)
{
    const std::uint32_t first_u = span_u - patch.u.degree, first_v = span_v - patch.v.degree;
    const LocalNet local = local_net(patch, first_u, first_v);
    const auto weighed = [&local](const Size& size, double area) {
        return (size.position + local.reach * size.weight) / local.least_weight * area;
    };
    const Net net_u = derived_u(local.net, patch.u, patch.u.degree, first_u);
    const Net net_v = derived_u(transposed(local.net), patch.v, patch.v.degree, first_v);
    const Net net_uv = derived_u(transposed(net_u), patch.v, patch.v.degree, first_v);
    const double u = patch.u.knots[span_u + 1] - patch.u.knots[span_u];
    const double v = patch.v.knots[span_v + 1] - patch.v.knots[span_v];
    Bend bend{0, weighed(size_of(net_uv), u * v), 0};
    if (patch.u.degree > 1)
        bend.uu = weighed(size_of(derived_u(net_u, patch.u, patch.u.degree - 1, first_u)), u * u);
    if (patch.v.degree > 1)
        bend.vv = weighed(size_of(derived_u(net_v, patch.v, patch.v.degree - 1, first_v)), v * v);
    return bend;
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
