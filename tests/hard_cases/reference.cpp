// SPDX-License-Identifier: GPL-2.0-or-later
#include "reference.hpp"

#include <algorithm>
#include <cmath>

namespace phantom::reference {

namespace {

using Real = __float128;

struct V {
    Real x = 0, y = 0, z = 0;
};

V of(const Vec3& a)
{
    return {a[0], a[1], a[2]};
}
Vec3 to_double(const V& a)
{
    return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)};
}
V operator+(V a, V b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
V operator-(V a, V b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
V operator*(Real s, V a)
{
    return {s * a.x, s * a.y, s * a.z};
}
Real dot(V a, V b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
V cross(V a, V b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Real root(Real a)
{
    if (!(a > 0))
        return 0;
    Real x = std::sqrt(static_cast<double>(a));
    if (!(x > 0))
        return 0;
    for (int i = 0; i < 3; ++i)
        x = (x + a / x) / 2;
    return x;
}

Real length(V a)
{
    return root(dot(a, a));
}
V unit(V a)
{
    const Real l = length(a);
    return l > 0 ? (1 / l) * a : a;
}
Real magnitude(Real a)
{
    return a < 0 ? -a : a;
}

V corner(const Triangle& t, int i)
{
    return of(t.corner[static_cast<std::size_t>(i % 3)]);
}
V normal(const Triangle& t, int i)
{
    return of(t.normal[static_cast<std::size_t>(i % 3)]);
}
/// How often h divides A(h): 0 for a face; 1 for a fan of which two corners are the same point, 2 where all
/// three are.
int fan_order(const Triangle& t)
{
    if (!t.fan)
        return 0;
    const bool same01 = t.corner[0] == t.corner[1], same12 = t.corner[1] == t.corner[2];
    const bool same20 = t.corner[2] == t.corner[0];
    return same01 && same12 ? 2 : same01 || same12 || same20 ? 1 : 0;
}
V area_vector(const Triangle& t)
{
    return cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
}

void tighten(Result& result, Real distance)
{
    result.margin = std::min(result.margin, static_cast<double>(magnitude(distance)));
}

/// Step 2 of Algorithm 1 for one edge: normal and signed distance from the wall.
struct Wall {
    V normal;
    Real distance;
};

Wall wall_at(const Triangle& t, int i, V tip)
{
    const V from = corner(t, i), edge = corner(t, i + 1) - from;
    Real s = dot(edge, tip - from) / dot(edge, edge);
    s = s < 0 ? Real(0) : s > 1 ? Real(1) : s;
    const V n = unit((1 - s) * normal(t, i) + s * normal(t, i + 1));
    return {n, dot(unit(cross(n, edge)), tip - (from + s * edge))};
}

/// Step 3: n0/d0 + n1/d1 + n2/d2 without the divisions, and its limit where distances vanish.
V blended_normal(const std::array<Wall, 3>& wall)
{
    const Real d0 = wall[0].distance, d1 = wall[1].distance, d2 = wall[2].distance;
    V n = d1 * d2 * wall[0].normal + d0 * d2 * wall[1].normal + d0 * d1 * wall[2].normal;
    if (!(length(n) > 0)) {
        n = V{};
        for (const Wall& w : wall)
            if (w.distance == 0)
                n = n + w.normal;
    }
    return unit(n);
}

struct Contact {
    std::size_t face;
    V foot, force; // D, s
    bool dropped = false;
};

/// Where the open segment from `from` to `to` meets the triangle: the parameter, or -1.
Real segment_meets(const Triangle& t, V from, V to)
{
    const V area = area_vector(t), way = to - from;
    const Real down = dot(area, way);
    if (down == 0)
        return -1;
    const Real s = dot(area, corner(t, 0) - from) / down;
    const V at = from + s * way;
    for (int i = 0; i < 3; ++i)
        if (dot(cross(corner(t, i + 1) - corner(t, i), at - corner(t, i)), area) < 0)
            return -1;
    return s;
}

/// Do the two triangles share the edge or vertex on which `foot` (in the plane of a) lies?
bool shares_feature(const Triangle& a, const Triangle& b, V foot)
{
    const auto has = [&b](std::uint32_t v) {
        return b.vertex[0] == v || b.vertex[1] == v || b.vertex[2] == v;
    };
    const Real near = 1e-5; // mm: "lies on"
    for (int i = 0; i < 3; ++i) {
        const std::uint32_t v = a.vertex[static_cast<std::size_t>(i)];
        const std::uint32_t w = a.vertex[static_cast<std::size_t>((i + 1) % 3)];
        if (length(foot - corner(a, i)) < near && has(v))
            return true;
        const V edge = corner(a, i + 1) - corner(a, i);
        if (length(cross(unit(edge), foot - corner(a, i))) < near && has(v) && has(w))
            return true;
    }
    return false;
}

void find_contacts(const std::vector<Triangle>& triangles, const std::vector<std::size_t>& faces, V tip,
                   std::vector<Contact>& out, Result& result)
{
    for (const std::size_t f : faces) {
        const Triangle& t = triangles[f];
        const V area = area_vector(t);
        if (!(length(area) > 0))
            continue;
        const V g = unit(area);
        const Real d = dot(g, tip - corner(t, 0)), radius = t.radius;
        if (d > 2 * radius || d < -radius)
            continue;
        const std::array<Wall, 3> wall{wall_at(t, 0, tip), wall_at(t, 1, tip), wall_at(t, 2, tip)};
        const Real least = std::min({wall[0].distance, wall[1].distance, wall[2].distance});
        if (least < -1e-3)
            continue; // far outside: no margin to speak of
        tighten(result, d);
        tighten(result, d - radius);
        if (!(d > 0 && d < radius))
            continue;
        tighten(result, least);
        if (least < 0)
            continue;
        const V n = blended_normal(wall);
        const Real c = dot(g, n);
        tighten(result, c);
        if (!(c > 0))
            continue;
        tighten(result, d / c - radius);
        if (d / c < radius)
            out.push_back({f, tip - (d / c) * n, t.stiffness * (radius - d / c) * n});
    }
}

void remove_overlap(const std::vector<Triangle>& triangles, V tip, std::vector<Contact>& contacts,
                    Result& result)
{
    for (Contact& a : contacts) {
        for (const Contact& b : contacts) {
            if (&a == &b || triangles[b.face].fan ||
                shares_feature(triangles[a.face], triangles[b.face], a.foot))
                continue;
            const Real s = segment_meets(triangles[b.face], tip, a.foot);
            if (s > 1e-6 && s < 1 - 1e-6)
                a.dropped = true;
            if (s > 0) {
                tighten(result, s - 1e-6);
                tighten(result, s - (1 - 1e-6));
            }
        }
    }
}

V combined(V sum, Real most, Combine rule)
{
    const Real l = length(sum);
    if (l < 1e-9 * most || l == 0)
        return {};
    if (rule == Combine::bounded && l <= most)
        return sum;
    return (most / l) * sum;
}

/// All real roots of c0 + c1 h + c2 h^2 + c3 h^3 in (0, limit), by bisection between the critical points.
std::vector<Real> cubic_roots(const std::array<Real, 4>& c, Real limit)
{
    const auto at = [&c](Real h) { return ((c[3] * h + c[2]) * h + c[1]) * h + c[0]; };
    std::vector<Real> ends{0, limit}, roots;
    const Real discriminant = c[2] * c[2] - 3 * c[1] * c[3];
    if (discriminant > 0) {
        const Real q = c[2] < 0 ? -c[2] + root(discriminant) : -c[2] - root(discriminant);
        for (const Real h : {c[3] == 0 ? Real(-1) : q / (3 * c[3]), q == 0 ? Real(-1) : c[1] / q})
            if (h > 0 && h < limit)
                ends.push_back(h);
    }
    std::sort(ends.begin(), ends.end());
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        Real low = ends[i], high = ends[i + 1];
        const bool negative = at(low) < 0;
        if (negative == (at(high) < 0))
            continue;
        for (int step = 0; step < 120; ++step) {
            const Real middle = (low + high) / 2;
            ((at(middle) < 0) == negative ? low : high) = middle;
        }
        roots.push_back((low + high) / 2);
    }
    return roots;
}

struct ShellSum {
    V sum;
    Real bound = 0; // the largest k R involved
};

/// The shell's point of a root, if it is in the shell.
struct ShellPoint {
    bool in_shell = false, folded = false;
    V normal; // N
};

ShellPoint shell_point(const Triangle& t, V tip, Real h, Result& result)
{
    std::array<V, 3> offset;
    for (int i = 0; i < 3; ++i)
        offset[static_cast<std::size_t>(i)] = corner(t, i) + h * normal(t, i);
    const V area = cross(offset[1] - offset[0], offset[2] - offset[0]);
    const Real size2 = dot(area, area);
    if (size2 == 0)
        return {};
    std::array<Real, 3> b;
    V n;
    Real least = 1e9;
    for (int i = 0; i < 3; ++i) {
        const V from = offset[static_cast<std::size_t>((i + 1) % 3)];
        const V edge = offset[static_cast<std::size_t>((i + 2) % 3)] - from;
        b[static_cast<std::size_t>(i)] = dot(cross(edge, tip - from), area) / size2;
        n = n + b[static_cast<std::size_t>(i)] * normal(t, i);
        const Real distance = b[static_cast<std::size_t>(i)] * root(size2) / length(edge);
        least = std::min(least, distance);
    }
    // A(h) = 0 solves the cubic as well; P is not in that triangle
    const V found = b[0] * offset[0] + b[1] * offset[1] + b[2] * offset[2];
    if (length(found - tip) > 1e-6)
        return {};
    if (h * length(n) < 2 * Real(t.radius))
        tighten(result, least);
    if (least < 0)
        return {};
    return {true, dot(area, n) < 0, n};
}

/// The h of which P may be in the triangle's shell.
std::vector<Real> shell_roots(const Triangle& t, V tip)
{
    const V e1 = corner(t, 1) - corner(t, 0), e2 = corner(t, 2) - corner(t, 0);
    const V f1 = normal(t, 1) - normal(t, 0), f2 = normal(t, 2) - normal(t, 0);
    const V q = tip - corner(t, 0), m0 = normal(t, 0);
    const V a0 = cross(e1, e2), a1 = cross(e1, f2) + cross(f1, e2), a2 = cross(f1, f2);
    const int order = fan_order(t);
    if (order == 0 && !(length(a0) > 0))
        return {};
    std::array<Real, 4> c{dot(q, a0), dot(q, a1) - dot(m0, a0), dot(q, a2) - dot(m0, a1), -dot(m0, a2)};
    // A fan: A0 = 0, over a vertex A1 = 0 as well. h = 0 solves the cubic and is no contact.
    for (int i = 0; i < order; ++i)
        c = {c[1], c[2], c[3], 0};
    return cubic_roots(c, 1e3);
}

/// What the force of a contact with that triangle is multiplied by: before the rims of its surface it fades.
Real fade(const std::vector<Triangle>& rims, const Triangle& t, V foot)
{
    Real least = 1;
    for (const Triangle& rim : rims) {
        if (rim.surface != t.surface)
            continue;
        const V from = corner(rim, 0), edge = corner(rim, 1) - from;
        Real s = dot(edge, foot - from) / dot(edge, edge);
        s = s < 0 ? Real(0) : s > 1 ? Real(1) : s;
        least = std::min(least, length(foot - (from + s * edge)) / Real(t.radius));
    }
    return least;
}

/// Adds one root of one patch: (b, h) solves P = sum b_i (x_i + h m_i).
void add_root(const Triangle& t, const std::vector<Triangle>& rims, V tip, Real h, ShellSum& shell,
              Result& result)
{
    const ShellPoint at = shell_point(t, tip, h, result);
    if (!at.in_shell)
        return;
    const Real height = h * length(at.normal), radius = t.radius;
    result.degree += at.folded ? -1 : 1;
    tighten(result, height);
    tighten(result, height - radius);
    if (!(height < radius))
        return;
    ++result.contacts;
    result.folded += at.folded ? 1 : 0;
    const Real whole = t.stiffness * (radius - height) * fade(rims, t, tip - h * at.normal);
    const Real signed_force = at.folded ? -whole : whole;
    shell.sum = shell.sum + signed_force * unit(at.normal);
    shell.bound = std::max(shell.bound, Real(t.stiffness) * radius);
}

/// `paper` over edges and corners: D is the fan's own point, n its direction to the tip.
void find_fan_contacts(const std::vector<Triangle>& triangles, const std::vector<std::size_t>& faces, V tip,
                       std::vector<Contact>& out, Result& result)
{
    for (const std::size_t f : faces) {
        const Triangle& t = triangles[f];
        if (fan_order(t) == 0)
            continue;
        for (const Real h : shell_roots(t, tip)) {
            const ShellPoint at = shell_point(t, tip, h, result);
            const Real height = h * length(at.normal);
            if (!at.in_shell || at.folded)
                continue;
            tighten(result, height - t.radius);
            if (height < t.radius)
                out.push_back({f, tip - h * at.normal, t.stiffness * (t.radius - height) * unit(at.normal)});
        }
    }
}

Result paper_shell(const std::vector<Triangle>& triangles, const std::vector<Triangle>& rims,
                   const std::vector<std::size_t>& faces, V tip, Combine rule)
{
    Result result;
    std::vector<Contact> contacts;
    find_contacts(triangles, faces, tip, contacts, result);
    find_fan_contacts(triangles, faces, tip, contacts, result);
    remove_overlap(triangles, tip, contacts, result);
    V sum;
    Real most = 0;
    for (const Contact& c : contacts) {
        if (c.dropped) {
            ++result.dropped;
            continue;
        }
        const V force = fade(rims, triangles[c.face], c.foot) * c.force;
        sum = sum + force;
        most = std::max(most, length(force));
        ++result.contacts;
    }
    result.force = to_double(combined(sum, most, rule));
    return result;
}

Result projected_shell(const std::vector<Triangle>& triangles, const std::vector<Triangle>& rims,
                       const std::vector<std::size_t>& faces, V tip)
{
    Result result;
    ShellSum shell;
    for (const std::size_t f : faces)
        for (const Real h : shell_roots(triangles[f], tip))
            add_root(triangles[f], rims, tip, h, shell, result);
    const Real l = length(shell.sum);
    result.force = to_double(l > shell.bound ? (shell.bound / l) * shell.sum : shell.sum);
    return result;
}

} // namespace

Reference::Reference(std::vector<Triangle> triangles, Options options)
    : triangles_(std::move(triangles)), options_(options)
{
    const auto rims =
        std::stable_partition(triangles_.begin(), triangles_.end(), [](const Triangle& t) { return !t.rim; });
    rims_.assign(rims, triangles_.end());
    triangles_.erase(rims, triangles_.end());
    for (const Triangle& t : triangles_) {
        double extent = 0;
        for (const Vec3& x : t.corner)
            extent = std::max(
                extent, std::hypot(x[0] - t.corner[0][0], x[1] - t.corner[0][1], x[2] - t.corner[0][2]));
        extents_.push_back(extent);
    }
}

/// Faces that may come within `reach` of the point. The rest is too far to matter; asking them all in
/// __float128 takes a second on a scan.
std::vector<std::size_t> Reference::near(const Vec3& at, double reach) const
{
    std::vector<std::size_t> faces;
    for (std::size_t f = 0; f < triangles_.size(); ++f) {
        const Vec3& x = triangles_[f].corner[0];
        const double far = std::hypot(at[0] - x[0], at[1] - x[1], at[2] - x[2]);
        if (options_.all_roots || far <= (reach + extents_[f]) * 1.001 + 1e-3)
            faces.push_back(f);
    }
    return faces;
}

Result Reference::shell(const Vec3& tip) const
{
    double radius = 0;
    for (const Triangle& t : triangles_)
        radius = std::max(radius, t.radius);
    const auto faces = near(tip, 2 * radius);
    Result result = options_.model == Model::paper
                        ? paper_shell(triangles_, rims_, faces, of(tip), options_.combine)
                        : projected_shell(triangles_, rims_, faces, of(tip));
    result.proxy = tip;
    return result;
}

void Reference::restart()
{
    inside_ = has_path_ = false;
}

/// Faces that the segment crosses in that way, by where.
std::vector<Reference::Crossing> Reference::crossings(const Vec3& from, const Vec3& to, bool outward) const
{
    std::vector<Crossing> found;
    const V a = of(from), b = of(to);
    for (const std::size_t f : near(from, static_cast<double>(length(b - a)))) {
        const Triangle& t = triangles_[f];
        if (t.fan)
            continue;
        const V area = area_vector(t);
        const Real begin = dot(area, a - corner(t, 0)), end = dot(area, b - corner(t, 0));
        if (outward ? !(begin <= 0 && end >= 0) : !(begin >= 0 && end < 0))
            continue;
        const Real along = segment_meets(t, a, b);
        if (along >= 0 && along <= 1)
            found.push_back({static_cast<double>(along), f});
    }
    std::sort(found.begin(), found.end(), [](const Crossing& x, const Crossing& y) {
        return x.along < y.along || (x.along == y.along && x.face < y.face);
    });
    return found;
}

/// Is there a surface over the tip, up to the plane of that face, along its normal?
bool Reference::covered(const Vec3& tip, std::size_t face) const
{
    const Triangle& t = triangles_[face];
    const V g = unit(area_vector(t)), p = of(tip);
    const Real depth = dot(g, corner(t, 0) - p);
    return depth > 0 && !crossings(tip, to_double(p + (depth * (1 + 1e-9)) * g), true).empty();
}

void Reference::enter(const Vec3& from, const Vec3& to, const Crossing& at)
{
    inside_ = true;
    proxy_ = to_double(of(from) + at.along * (of(to) - of(from)));
    face_ = at.face;
}

Vec3 Reference::held(const Vec3& tip, const Vec3& proxy, std::size_t face) const
{
    const Triangle& t = triangles_[face];
    const V v = of(proxy), area = area_vector(t);
    V n;
    if (options_.model == Model::paper) {
        std::array<Wall, 3> wall{wall_at(t, 0, v), wall_at(t, 1, v), wall_at(t, 2, v)};
        for (Wall& w : wall)
            w.distance = std::max(w.distance, Real(0));
        n = blended_normal(wall);
    } else {
        for (int i = 0; i < 3; ++i) {
            const V edge = corner(t, i + 2) - corner(t, i + 1);
            n = n + (dot(cross(edge, v - corner(t, i + 1)), area) / dot(area, area)) * normal(t, i);
        }
        n = unit(n);
    }
    return to_double(fade(rims_, t, v) * Real(t.stiffness) * (Real(t.radius) * n + (v - of(tip))));
}

Result Reference::tick(const Vec3& tip)
{
    const Vec3 from = has_path_ ? previous_ : tip;
    const bool moved = has_path_ && options_.penetration;
    previous_ = tip;
    has_path_ = true;
    if (moved && inside_) {
        const auto out = crossings(from, tip, true);
        if (!out.empty()) {
            inside_ = false;
            for (const Crossing& in : crossings(from, tip, false))
                if (!inside_ && in.along > out.front().along)
                    enter(from, tip, in);
        } else {
            const Vec3 target = to_double(of(proxy_) + (of(tip) - of(from)));
            const auto over = crossings(tip, target, true);
            if (!over.empty())
                enter(tip, target, over.back());
        }
    } else if (moved) {
        const auto in = crossings(from, tip, false);
        if (!in.empty()) {
            const auto out = crossings(from, tip, true);
            const bool through = !out.empty() && out.back().along > in.front().along;
            if (!through || covered(tip, in.front().face))
                enter(from, tip, in.front());
        }
    }
    if (!inside_)
        return shell(tip);
    Result result;
    result.force = held(tip, proxy_, face_);
    result.contacts = 1;
    result.inside = true;
    result.proxy = proxy_;
    return result;
}

} // namespace phantom::reference
