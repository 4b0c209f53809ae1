// SPDX-License-Identifier: GPL-2.0-or-later
// Triangles that scans and programs really write: slivers, points, doubles, opposites, rims, intersections.
#include <fmt/format.h>

#include <random>

#include "corpus.hpp"
#include "creased.hpp"
#include "shapes_of_interest.hpp"

namespace phantom::hard {

namespace {

constexpr Vec3 up{0, 0, 1};

/// A flat square of 10 mm with a sliver across its middle, `height` at its highest. Normals all +z.
Shape split_plate(bool cap, double height)
{
    Shape s;
    s.vertices = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}, {-5, 0, 0}, {5, 0, 0}};
    s.vertices.push_back(on_grid(cap ? Vec3{0, height, 0} : Vec3{5, height, 0}));
    s.faces = {{0, 1, 5}, {0, 5, 4}, {4, 5, 6}}; // the sliver is the third
    if (cap)
        s.faces.insert(s.faces.end(), {{4, 6, 3}, {6, 2, 3}, {6, 5, 2}});
    else
        s.faces.insert(s.faces.end(), {{4, 6, 2}, {4, 2, 3}});
    s.normals.assign(s.vertices.size(), up);
    return s;
}

/// A sliver of less than 16 nm has no plane and is refused.
constexpr double refused_below_mm = 16e-6;

Case sliver(bool cap, double aspect)
{
    const double height = 10 / aspect;
    Case c;
    c.name =
        fmt::format("{} sliver of aspect 1e{:.0f} in a plate", cap ? "cap" : "needle", std::log10(aspect));
    c.kind = Kind::slivers;
    c.sets = {split_plate(cap, height).triangles(1, 1)};
    const double y = height / 4;
    c.paths = {{{{2, -0.3, 0.3}, {2, 0, 0.3}, {2, y, 0.3}, {2, height, 0.3}, {2, 0.3, 0.3}}},
               {{{1, 0.1, 1.2}, {1, y, 0.1}, {1, -0.1, -0.4}, {1.5, -0.2, -0.4}, {1.5, y, 0.2}}}};
    c.paper_step = smooth_step;
    c.near_mm = 0.95;
    c.penetrates = true;
    c.rigid = false;
    c.refused = height < refused_below_mm ? 1 : 0;
    return c;
}

/// Along the sliver and straight down into it, or where it was.
Case into_sliver(double aspect)
{
    Case c = sliver(false, aspect);
    const double y = 5 / aspect;
    c.name += ", along and into it";
    c.paths = {{{{-2, y, 0.4}, {2, y, 0.35}}}, {{{1, y, 1.2}, {1, y, 0}, {1, y, -0.4}}, 0.02, End::inside}};
    if (c.refused)
        c.outcome = "less than 16 nm high, it has no shell, but no tip gets through it";
    return c;
}

/// Nothing but the sliver: its shell is a sliver too, and ends all round.
Case lone_sliver(bool cap, double aspect)
{
    Case c;
    c.name = fmt::format("{} sliver of aspect 1e{:.0f} alone", cap ? "cap" : "needle", std::log10(aspect));
    c.kind = Kind::slivers;
    auto all = split_plate(cap, 10 / aspect).triangles(1, 1);
    c.sets = {{all[2]}};
    c.paths = {{{{-5.5, 0, 0.2}, {5.5, 10 / aspect, 0.2}}}, {{{2, -0.1, 0.1}, {2, 0.1, 0.1}, {2, 0, -0.2}}}};
    c.projected_step = measured;
    c.penetrates = true;
    c.rigid = false;
    c.refused = 10 / aspect < refused_below_mm ? 1 : 0;
    return c;
}

reference::Triangle triangle(const Vec3& a, const Vec3& b, const Vec3& c)
{
    reference::Triangle t;
    t.corner = {on_grid(a), on_grid(b), on_grid(c)};
    t.normal.fill(up);
    t.vertex = {900, 901, 902};
    t.radius = 2;
    return t;
}

const std::vector<Path>& over_a_sphere()
{
    static const std::vector<Path> paths{
        {{{-3, 1, 11}, {3, -0.5, 11}}},
        {{{1, 0.5, 12.5}, {1, 0.5, 9}, {2, 1, 8.8}, {1.9, -0.3, 11.4}}},
        {{{0, 0, 12.5}, {0, 0, 10}, {0, 0, 9.5}, {0, 0, 10}, {2.3, 2.1, 10.2}}},
    };
    return paths;
}

Case points_and_lines()
{
    Case c;
    c.name = "points, lines and a face 1 nm high";
    c.kind = Kind::slivers;
    c.sets = {sphere(2, 10).triangles(1, 2)};
    c.sets[0].push_back(triangle({0, 0, 10}, {0, 0, 10}, {0, 0, 10}));
    c.sets[0].push_back(triangle({0, 0, 10}, {1, 0, 10}, {1, 0, 10}));
    c.sets[0].push_back(triangle({-1, -1, 10}, {0, 0, 10}, {3, 3, 10}));
    c.sets[0].push_back(triangle({0, 0, 10}, {9, 0, 10}, {5, 1e-6, 10}));
    c.paths = over_a_sphere();
    c.radius = 2;
    c.near_mm = 1.5;
    c.penetrates = true;
    c.refused = 4;
    return c;
}

Case on_a_sphere(std::string name, Triangles triangles, std::string outcome)
{
    Case c;
    c.name = std::move(name);
    c.kind = Kind::doubles;
    c.sets = {std::move(triangles)};
    c.paths = over_a_sphere();
    c.radius = 2;
    c.projected_step = measured;
    c.penetrates = true;
    c.outcome = std::move(outcome);
    return c;
}

std::vector<Case> doubled()
{
    const Triangles good = sphere(2, 10).triangles(1, 2);
    Triangles twice = good, some_flipped = good;
    twice.insert(twice.end(), good.begin(), good.end());
    for (std::size_t f = 0; f < good.size(); f += 5)
        some_flipped[f] = flipped({good[f]})[0];
    Triangles both = good;
    const Triangles backs = flipped(good);
    both.insert(both.end(), backs.begin(), backs.end());

    std::vector<Case> out;
    out.push_back(on_a_sphere("every face twice", twice,
                              "`paper` as if once; `projected` twice the force, kR at most"));
    out.back().convex = true;
    out.back().once = false;
    out.push_back(on_a_sphere("faces back to back", both, "from outside as the front faces alone"));
    out.push_back(on_a_sphere("every fifth face flipped", with_rims(some_flipped),
                              "a hole where the face is flipped; the force fades before it"));
    return out;
}

/// Half-planes that meet in the y axis, each with its own normal.
Triangles sheets(const std::vector<double>& angles_deg)
{
    Triangles out;
    for (std::size_t i = 0; i < angles_deg.size(); ++i) {
        const double a = angles_deg[i] / 180 * std::numbers::pi;
        const Vec3 rim{5 * std::cos(a), 0, 5 * std::sin(a)};
        Shape s;
        s.vertices = {{0, -5, 0}, {0, 5, 0}, on_grid(add(rim, {0, 5, 0})), on_grid(add(rim, {0, -5, 0}))};
        s.faces = {{0, 2, 1}, {0, 3, 2}};
        smooth_normals(s);
        auto sheet = s.triangles(1, 1);
        for (auto& t : sheet)
            for (auto& v : t.vertex)
                v = v < 2 ? v : v + 10 * static_cast<std::uint32_t>(i); // the axis is one edge of all
        out.insert(out.end(), sheet.begin(), sheet.end());
    }
    return out;
}

Case faulty(std::string name, Triangles triangles, double radius, std::vector<Path> paths,
            std::string outcome)
{
    Case c;
    c.name = std::move(name);
    c.kind = Kind::doubles;
    c.sets = {std::move(triangles)};
    c.paths = std::move(paths);
    c.radius = radius;
    c.projected_step = measured;
    c.penetrates = true;
    c.outcome = std::move(outcome);
    return c;
}

/// A plate whose upper half ends in the middle of the lower half's edge.
Triangles t_junction()
{
    Shape s;
    s.vertices = {{-5, -5, 0}, {5, -5, 0}, {5, 0, 0}, {-5, 0, 0}, {0, 0, 0}, {5, 5, 0}, {-5, 5, 0}};
    s.faces = {{0, 1, 2}, {0, 2, 3}, {3, 4, 6}, {4, 5, 6}, {4, 2, 5}};
    s.normals.assign(s.vertices.size(), up);
    return s.triangles(1, 1);
}

} // namespace

std::vector<Case> degenerate_cases()
{
    std::vector<Case> out;
    for (const bool cap : {false, true})
        for (const double aspect : {1e3, 1e4, 1e5, 1e6, 1e7})
            out.push_back(sliver(cap, aspect));
    for (const double aspect : {1e5, 1e6})
        out.push_back(into_sliver(aspect));
    for (const bool cap : {false, true})
        out.push_back(lone_sliver(cap, 1e5));
    out.push_back(points_and_lines());

    for (Case& c : doubled())
        out.push_back(std::move(c));
    out.push_back(
        faulty("three sheets on one edge", with_rims(sheets({0, 120, 250})), 1,
               {{{{-1, 0.3, 0.4}, {1, 0.3, 0.4}}}, {{{0, 0.1, 0.8}, {0, 0.1, -0.5}, {1, 0, 0.5}}}},
               "each sheet from its own side, all run the same way along the edge: each fades before it"));
    out.back().projected_step = smooth_step;
    out.push_back(faulty("a T-junction", with_rims(t_junction()), 1,
                         {{{{-1, 0.3, 0.4}, {1, -0.3, 0.4}}}, {{{0, 0, 0.8}, {0, 0, 0}, {0, 0, -0.3}}}},
                         "no edge goes on from the other's points: the force fades before the seam"));
    out.back().paper_step = out.back().projected_step = smooth_step;
    out.push_back(faulty("over the rim of an open sheet", with_rims(sheets({0})), 1,
                         {{{{3, 0.2, 0.3}, {6, 0.1, 0.3}}}, {{{4.8, 0.2, 0.3}, {4.8, 0, -0.3}, {5.5, 0, 0}}}},
                         "fades over the last R before the rim; `two_sided` closes the sheet"));
    out.back().paper_step = out.back().projected_step = out.back().inside_step = smooth_step;
    const auto block = faceted(box({3, 3, 1}).triangles(1, 1));
    out.push_back(faulty("blocks that cross", joined(block, moved(block, {2, 2, 1})), 1,
                         {{{{-2, 0, 1.4}, {3, 1, 1.4}, {3, 2, 2.5}}},
                          {{{-2, 0, 1.5}, {-2, 0, 0.5}, {1, 0.5, 0.5}, {2, 2, 1.8}}}},
                         "outside, contacts of both are added; inside, either holds the proxy"));
    std::mt19937 random(6);
    std::normal_distribution<double> any;
    auto anyhow = soup(random, 120, 1.5);
    for (auto& t : anyhow)
        for (Vec3& n : t.normal)
            n = on_unit_grid(unit({any(random), any(random), any(random)}));
    out.push_back(faulty("soup with normals that point anywhere", anyhow, 1.5,
                         {{{{-4, -3, -3}, {4, 3, 3}}}, {{{4, -2, 0}, {-4, 2, 1}, {3, 4, -2}, {-3, -4, 2}}}},
                         "bounded, no more"));
    out.back().rigid = false;
    return out;
}

} // namespace phantom::hard
