// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/edge_collapse.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "fdh/parallel.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

/// A face may turn by that much at most: cos 75 degrees.
constexpr double turn_cosine = 0.25881904510252074;

/// Twice the root of three times a face's area over the sum of its squared sides: 1 for an equilateral one.
constexpr double quality_min = 0.05;

/// A vertex with more faces stays out of it: what is looked at round it grows with their square.
constexpr std::size_t degree_max = 64;

/// An edge's length counts as error to that part of it (squared): in a plane the short ones go first.
constexpr double length_part = 1e-6;

/// A pass that removes less than that part of the faces is the last.
constexpr double pass_min = 0.01;

double quality(const Vec3& a, const Vec3& b, const Vec3& c, double double_area)
{
    const Vec3 e0 = subtract(b, a), e1 = subtract(c, b), e2 = subtract(a, c);
    const double sides = dot(e0, e0) + dot(e1, e1) + dot(e2, e2);
    return sides > 0 ? std::sqrt(12.0) * double_area / sides : 0.0;
}

std::vector<std::uint32_t> counting(std::size_t count)
{
    std::vector<std::uint32_t> out(count);
    std::iota(out.begin(), out.end(), 0U);
    return out;
}

/// Numbers what is used in order of first use; returns what was used, and replaces the numbers.
std::vector<std::uint32_t> renumber(std::vector<Triple>& triples, std::size_t count)
{
    std::vector<std::uint32_t> number(count, no_neighbour), used;
    for (Triple& triple : triples) {
        for (std::uint32_t& v : triple) {
            if (number[v] == no_neighbour) {
                number[v] = static_cast<std::uint32_t>(used.size());
                used.push_back(v);
            }
            v = number[v];
        }
    }
    return used;
}

template <typename Value>
void keep(std::vector<Value>& values, const std::vector<std::uint32_t>& used)
{
    std::vector<Value> kept;
    kept.reserve(used.size());
    for (const std::uint32_t i : used)
        kept.push_back(values[i]);
    values = std::move(kept);
}

} // namespace

void Quadric::add_plane(const Vec3& point, const Vec3& n, double w)
{
    const double d = -dot(n, point);
    const double products[6] = {n[0] * n[0], n[0] * n[1], n[0] * n[2], n[1] * n[1], n[1] * n[2], n[2] * n[2]};
    for (std::size_t i = 0; i < 6; ++i)
        a[i] += w * products[i];
    for (std::size_t i = 0; i < 3; ++i)
        b[i] += w * d * n[i];
    c += w * d * d;
    weight += w;
}

void Quadric::add_line(const Vec3& point, const Vec3& u, double w)
{
    // |q|^2 - (u q)^2 for q = x - point: of identity minus u u^T
    const double m[6] = {1 - u[0] * u[0], -u[0] * u[1], -u[0] * u[2],
                         1 - u[1] * u[1], -u[1] * u[2], 1 - u[2] * u[2]};
    const Vec3 mp = subtract(point, scaled(u, dot(u, point)));
    for (std::size_t i = 0; i < 6; ++i)
        a[i] += w * m[i];
    for (std::size_t i = 0; i < 3; ++i)
        b[i] -= w * mp[i];
    c += w * dot(mp, point);
    weight += w;
}

void Quadric::add(const Quadric& other)
{
    for (std::size_t i = 0; i < 6; ++i)
        a[i] += other.a[i];
    for (std::size_t i = 0; i < 3; ++i)
        b[i] += other.b[i];
    c += other.c;
    weight += other.weight;
}

double Quadric::mean_at(const Vec3& x) const
{
    if (!(weight > 0))
        return 0;
    const double square = a[0] * x[0] * x[0] + a[3] * x[1] * x[1] + a[5] * x[2] * x[2] +
                          2.0 * (a[1] * x[0] * x[1] + a[2] * x[0] * x[2] + a[4] * x[1] * x[2]);
    return std::max(0.0, (square + 2.0 * dot(b, x) + c) / weight);
}

const EdgeCollapse::Spoke* EdgeCollapse::Ring::to(std::uint32_t vertex) const
{
    for (const Spoke& spoke : spokes)
        if (spoke.vertex == vertex)
            return &spoke;
    return nullptr;
}

EdgeCollapse::EdgeCollapse(Wedges wedges, unsigned threads)
    : wedges_(std::move(wedges)), threads_(fdh::thread_count(threads))
{
    const Bounds bounds = bounds_of(wedges_.vertices);
    centre_ = scaled(add(bounds.low, bounds.high), 0.5);
    planes_.resize(wedges_.vertices.size());
    lines_.resize(wedges_.vertices.size());
    for (const Triple& face : wedges_.faces) {
        const Vec3 a = place(face[0]);
        const Vec3 across = cross(subtract(place(face[1]), a), subtract(place(face[2]), a));
        for (const std::uint32_t v : face)
            planes_[v].add_plane(a, normalized(across), 0.5 * length(across));
    }
    begin_pass();
    Ring ring;
    for (std::uint32_t v = 0; v < wedges_.vertices.size(); ++v) {
        look_round(v, ring);
        for (const Spoke& spoke : ring.spokes) {
            const Vec3 along = subtract(place(spoke.vertex), place(v));
            if (!spoke.plain())
                lines_[v].add_line(place(v), normalized(along), length(along));
        }
    }
}

Vec3 EdgeCollapse::place(std::uint32_t vertex) const
{
    return subtract(wedges_.vertices[vertex], centre_);
}

void EdgeCollapse::begin_pass()
{
    const std::size_t vertices = wedges_.vertices.size();
    vertex_now_ = counting(vertices);
    wedge_now_ = counting(wedges_.vertex_of.size());
    taken_.assign(vertices, false);
    first_.assign(vertices + 1, 0);
    for (const Triple& face : wedges_.faces)
        for (const std::uint32_t v : face)
            ++first_[v + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    faces_of_.resize(3 * wedges_.faces.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t f = 0; f < wedges_.faces.size(); ++f)
        for (const std::uint32_t v : wedges_.faces[f])
            faces_of_[next[v]++] = f;
}

std::span<const std::uint32_t> EdgeCollapse::faces_of(std::uint32_t vertex) const
{
    return {faces_of_.data() + first_[vertex], first_[vertex + 1] - first_[vertex]};
}

/// The face turned so that the vertex comes first; corners all no_neighbour when it has vanished.
EdgeCollapse::Corner EdgeCollapse::corner_now(std::uint32_t face, std::uint32_t vertex) const
{
    Triple at = wedges_.faces[face], wedge = wedges_.corners[face];
    for (std::size_t i = 0; i < 3; ++i) {
        at[i] = vertex_now_[at[i]];
        wedge[i] = wedge_now_[wedge[i]];
    }
    if (at[0] == at[1] || at[1] == at[2] || at[2] == at[0])
        return {{no_neighbour, no_neighbour, no_neighbour}, {}, 0};
    const std::size_t i = at[0] == vertex ? 0 : at[1] == vertex ? 1 : 2, j = (i + 1) % 3, k = (i + 2) % 3;
    const std::uint8_t group = wedges_.face_groups.empty() ? std::uint8_t{0} : wedges_.face_groups[face];
    return {{at[i], at[j], at[k]}, {wedge[i], wedge[j], wedge[k]}, group};
}

void EdgeCollapse::look_round(std::uint32_t vertex, Ring& ring) const
{
    ring.spokes.clear();
    ring.faces = 0;
    const auto spoke_to = [&ring](std::uint32_t other) -> Spoke& {
        for (Spoke& spoke : ring.spokes)
            if (spoke.vertex == other)
                return spoke;
        ring.spokes.emplace_back();
        ring.spokes.back().vertex = other;
        return ring.spokes.back();
    };
    if (faces_of(vertex).size() > degree_max)
        return;
    for (const std::uint32_t face : faces_of(vertex)) {
        const Corner corner = corner_now(face, vertex);
        if (corner.vertex[0] == no_neighbour)
            continue;
        ++ring.faces;
        Spoke& out = spoke_to(corner.vertex[1]);
        ++out.outs;
        out.after_out = corner.vertex[2];
        out.out = {corner.wedge[0], corner.wedge[1]};
        out.out_group = corner.group;
        Spoke& in = spoke_to(corner.vertex[2]);
        ++in.ins;
        in.before_in = corner.vertex[1];
        in.in = {corner.wedge[0], corner.wedge[2]};
        in.in_group = corner.group;
    }
}

bool EdgeCollapse::single_fan(const Ring& ring)
{
    const Spoke* begin = &ring.spokes.front();
    for (const Spoke& spoke : ring.spokes)
        if (spoke.ins == 0)
            begin = &spoke;
    std::size_t walked = 0;
    for (const Spoke* at = begin; at && at->outs > 0;) {
        if (++walked > ring.faces)
            return false;
        at = ring.to(at->after_out);
        if (at == begin)
            break;
    }
    return walked == ring.faces;
}

std::optional<int> EdgeCollapse::features(const Ring& ring)
{
    int borders = 0, creases = 0;
    for (const Spoke& spoke : ring.spokes) {
        if (spoke.outs > 1 || spoke.ins > 1)
            return std::nullopt;
        borders += spoke.outs + spoke.ins == 1;
        creases += spoke.outs + spoke.ins == 2 && !spoke.plain();
    }
    const int all = borders + creases;
    const bool through = all == 0 || (all == 2 && borders != 1);
    if (ring.spokes.empty() || !through || !single_fan(ring))
        return std::nullopt;
    return all;
}

double EdgeCollapse::cost(std::uint32_t from, std::uint32_t to, bool feature) const
{
    const Vec3 at = place(to), way = subtract(at, place(from));
    const double planes = planes_[from].mean_at(at);
    return (feature ? std::max(planes, lines_[from].mean_at(at)) : planes) + length_part * dot(way, way);
}

/// The link condition, and that each wedge of the vertex has one to become.
bool EdgeCollapse::keeps_topology(std::uint32_t to, int features, const Workspace& work) const
{
    const Spoke& edge = *work.from.to(to);
    if (features == 2 && edge.plain())
        return false;
    std::uint32_t common = 0;
    for (const Spoke& spoke : work.from.spokes) {
        const Spoke* other = work.to.to(spoke.vertex);
        common += other != nullptr;
        // The rest of the border or crease must not run into the same face, nor join another there.
        if (other && spoke.vertex != to && !spoke.plain())
            return false;
    }
    if (common != edge.outs + edge.ins)
        return false;
    if (work.from.faces == 3 && common == 2) { // one face is left: not back to back with another
        const Spoke* side = work.to.to(edge.after_out);
        if (side->after_out == edge.before_in && side->outs == 1)
            return false;
        if (side->before_in == edge.before_in && side->ins == 1)
            return false;
    }
    return work.from.spokes.size() + work.to.spokes.size() < degree_max / 2;
}

bool EdgeCollapse::keeps_shape(std::uint32_t from, std::uint32_t to) const
{
    double worst_before = 1, worst_after = 1;
    for (const std::uint32_t face : faces_of(from)) {
        const Corner corner = corner_now(face, from);
        if (corner.vertex[0] == no_neighbour || corner.vertex[1] == to || corner.vertex[2] == to)
            continue;
        const Vec3 a = place(from), b = place(corner.vertex[1]), c = place(corner.vertex[2]),
                   a_next = place(to);
        const Vec3 before = cross(subtract(b, a), subtract(c, a));
        const Vec3 after = cross(subtract(b, a_next), subtract(c, a_next));
        const double size_before = length(before), size_after = length(after);
        if (!(dot(before, after) >= turn_cosine * size_before * size_after))
            return false;
        worst_before = std::min(worst_before, quality(a, b, c, size_before));
        worst_after = std::min(worst_after, quality(a_next, b, c, size_after));
    }
    return worst_after >= std::min(quality_min, worst_before);
}

std::optional<EdgeCollapse::Candidate> EdgeCollapse::best(std::uint32_t vertex, double cost_max,
                                                          Workspace& work) const
{
    look_round(vertex, work.from);
    const std::optional<int> kind = features(work.from);
    if (!kind)
        return std::nullopt;
    work.choices.clear();
    for (const Spoke& spoke : work.from.spokes) {
        if (*kind == 2 && spoke.plain())
            continue;
        const double price = cost(vertex, spoke.vertex, *kind == 2);
        if (price <= cost_max)
            work.choices.push_back({price, vertex, spoke.vertex});
    }
    std::sort(work.choices.begin(), work.choices.end(), [](const Candidate& a, const Candidate& b) {
        return a.cost != b.cost ? a.cost < b.cost : a.to < b.to;
    });
    for (const Candidate& choice : work.choices) {
        look_round(choice.to, work.to);
        if (!work.to.spokes.empty() && keeps_topology(choice.to, *kind, work) &&
            keeps_shape(vertex, choice.to))
            return choice;
    }
    return std::nullopt;
}

std::vector<EdgeCollapse::Candidate> EdgeCollapse::candidates(double cost_max) const
{
    const std::size_t vertices = wedges_.vertices.size();
    std::vector<Candidate> all(vertices, {0, no_neighbour, no_neighbour});
    fdh::parallel_for(0, vertices, threads_, [&](std::size_t begin, std::size_t end) {
        Workspace work;
        for (std::size_t v = begin; v < end; ++v)
            if (const auto found = best(static_cast<std::uint32_t>(v), cost_max, work))
                all[v] = *found;
    });
    std::erase_if(all, [](const Candidate& candidate) { return candidate.from == no_neighbour; });
    return all;
}

std::optional<double> EdgeCollapse::median_error_mm() const
{
    std::vector<Candidate> all = candidates(std::numeric_limits<double>::infinity());
    const std::size_t middle = (wedges_.vertices.size() - 1) / 2;
    if (all.empty())
        return std::nullopt;
    const auto at = all.begin() + static_cast<std::ptrdiff_t>(std::min(middle, all.size() - 1));
    std::nth_element(all.begin(), at, all.end(),
                     [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
    return std::sqrt(at->cost);
}

std::size_t EdgeCollapse::apply(const Candidate& collapse, Workspace& work)
{
    const auto [price, from, to] = collapse;
    if (taken_[from] || taken_[to])
        return 0;
    look_round(from, work.from);
    look_round(to, work.to);
    const std::optional<int> kind = features(work.from);
    if (!kind || !work.from.to(to) || work.to.spokes.empty() || !keeps_topology(to, *kind, work) ||
        !keeps_shape(from, to))
        return 0;
    const Spoke& edge = *work.from.to(to);
    if (edge.outs)
        wedge_now_[edge.out[0]] = edge.out[1];
    if (edge.ins)
        wedge_now_[edge.in[0]] = edge.in[1];
    vertex_now_[from] = to;
    taken_[from] = taken_[to] = true;
    planes_[to].add(planes_[from]);
    lines_[to].add(lines_[from]);
    return edge.outs + edge.ins;
}

void EdgeCollapse::run(double error_mm, std::size_t faces)
{
    std::size_t now = wedges_.faces.size();
    Workspace work;
    for (bool worth = true; worth && now > faces;) {
        std::vector<Candidate> all = candidates(error_mm * error_mm);
        std::sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
            return a.cost != b.cost ? a.cost < b.cost : a.from < b.from;
        });
        const std::size_t before = now;
        for (const Candidate& collapse : all) {
            if (now <= faces)
                break;
            now -= apply(collapse, work);
        }
        worth = static_cast<double>(before - now) > pass_min * static_cast<double>(before);
        end_pass();
        begin_pass();
    }
}

void EdgeCollapse::end_pass()
{
    std::size_t kept = 0;
    for (std::uint32_t f = 0; f < wedges_.faces.size(); ++f) {
        const Corner corner = corner_now(f, vertex_now_[wedges_.faces[f][0]]);
        if (corner.vertex[0] == no_neighbour)
            continue;
        if (!wedges_.face_groups.empty())
            wedges_.face_groups[kept] = corner.group;
        wedges_.faces[kept] = corner.vertex;
        wedges_.corners[kept++] = corner.wedge;
    }
    wedges_.faces.resize(kept);
    wedges_.corners.resize(kept);
    if (!wedges_.face_groups.empty())
        wedges_.face_groups.resize(kept);
    const std::vector<std::uint32_t> vertices = renumber(wedges_.faces, wedges_.vertices.size());
    const std::vector<std::uint32_t> wedges = renumber(wedges_.corners, wedges_.vertex_of.size());
    std::vector<std::uint32_t> number(wedges_.vertices.size(), no_neighbour);
    for (std::uint32_t v = 0; v < vertices.size(); ++v)
        number[vertices[v]] = v;
    keep(wedges_.vertices, vertices);
    keep(planes_, vertices);
    keep(lines_, vertices);
    keep(wedges_.vertex_of, wedges);
    for (std::uint32_t& v : wedges_.vertex_of)
        v = number[v];
}

} // namespace phantom::mesh
