// SPDX-License-Identifier: GPL-2.0-or-later
// Tips exactly on vertices, edges, planes, walls; ridges, cones, corners, saddles.
#include <fmt/format.h>

#include <numbers>

#include "corpus.hpp"
#include "creased.hpp"
#include "shapes_of_interest.hpp"

namespace phantom::hard {

namespace {

constexpr double crease_deg = 3; // every edge but those within a plane

Vec3 middle(const reference::Triangle& t)
{
    return scale(1.0 / 3, add(t.corner[0], add(t.corner[1], t.corner[2])));
}

/// A coarse sphere with radial normals: every wall is known exactly.
Case on_sphere(std::string name, std::vector<Path> paths)
{
    Case c;
    c.name = std::move(name);
    c.kind = Kind::on_feature;
    c.sets = {sphere(1, 10).triangles(1, 3)};
    c.paths = std::move(paths);
    c.radius = 3;
    c.near_mm = 2;
    c.closed = c.convex = true;
    return c;
}

std::vector<Case> on_features()
{
    const Triangles ball = sphere(1, 10).triangles(1, 3);
    const auto& t = ball[0];
    const Vec3 edge = scale(0.5, add(t.corner[0], t.corner[1])), face = middle(t);
    std::vector<Case> out;
    out.push_back(
        on_sphere("tip on the line of a vertex normal",
                  {{{{0, 0, 13}, {0, 0, 10.5}, {0, 0, 10}}}, {{{-1, -0.7, 11}, {0, 0, 11}, {1, 0.4, 11}}}}));
    out.push_back(on_sphere("tip on a shell wall",
                            {{{{0, 0, 11.5}, {3, 0, 10.5}, {7.5, 0, 7.5}}}, {{{0, 0, 10.2}, {4, 0, 10}}}}));
    out.push_back(on_sphere("tip on vertex, edge and face",
                            {{{t.corner[0], edge, face, t.corner[2], face}, 0},
                             {{scale(1.05, t.corner[0]), t.corner[0], scale(1.05, edge), edge}},
                             {{scale(1.05, face), face, scale(1.02, face)}}}));
    out.back().paper_step = measured;
    const Vec3 beyond = add(face, scale(2, subtract(t.corner[0], face)));
    const Vec3 before = add(face, scale(-2.5, subtract(t.corner[0], face)));
    out.push_back(on_sphere("tip in the plane of a face", {{{before, face, t.corner[0], beyond}}}));
    out.push_back(on_sphere("tip at the shell's end", {{{{0, 0, 13.1}, {0, 0, 13}, {0, 0, 12.9}}},
                                                       {{{-1, 0, 13}, {0, 0, 13}, {1, 0, 13}}}}));

    Case c;
    c.name = "tip on the planes and edges of a box";
    c.kind = Kind::on_feature;
    c.sets = {creased(box({5, 4, 3}), crease_deg, 1, 2)};
    c.paths = {{{{3, 1, 3.5}, {3, 1, 3}, {4.5, 1, 3}, {5, 1, 3}}, 0},
               {{{5.5, 1, 3}, {6, 2, 3}, {6, 4, 3}, {5.5, 4.5, 3}}},  // on a wall of an edge's fan
               {{{6.5, 5.5, 4.5}, {5.5, 4.5, 3.5}, {5.2, 4.2, 3.2}}}, // over a corner
               {{{5.5, -3, 3.5}, {5.5, 4, 3.5}, {5.5, 4.5, 3.5}}},    // along an edge, over a corner's wall
               {{{5, 1, 3}, {5, 4, 3}, {5, 4, 3}, {5, 1, 3}}, 0}};
    c.radius = 2;
    c.near_mm = 1.9;
    c.closed = c.convex = true;
    out.push_back(std::move(c));
    return out;
}

Case over(std::string name, Triangles triangles, double radius, std::vector<Path> paths)
{
    return make_case(Kind::edges, std::move(name), std::move(triangles), radius, std::move(paths));
}

/// z = -slope |x|
std::vector<Case> ridges()
{
    std::vector<Case> out;
    for (const double degrees : {5.0, 20.0, 45.0, 90.0, 135.0, 175.0}) {
        const double slope = 1 / std::tan(degrees / 2 * std::numbers::pi / 180);
        const Shape ridge = field(6, 3, [&](double x, double) { return -slope * std::abs(x); });
        const std::vector<Path> paths{{{{-1, 0.31, 0.2}, {0, 0.05, 0.2}, {1, -0.22, 0.2}}},
                                      {{{-1, 0.31, 0.9}, {1, -0.22, 0.9}}},
                                      {{{0, 0.1, 0.05}, {0.001, 0.12, 1.6}}}};
        out.push_back(
            over(fmt::format("ridge of {:.0f} deg, smooth", degrees), ridge.triangles(1, 1.5), 1.5, paths));
        out.back().projected_step = sharp_step;
        out.push_back(over(fmt::format("ridge of {:.0f} deg, creased", degrees),
                           creased(ridge, crease_deg, 1, 1.5), 1.5, paths));
        out.back().near_mm = 1.4;
    }
    return out;
}

std::vector<Case> tips()
{
    std::vector<Case> out;
    for (const double height : {0.5, 3.0, 20.0}) {
        const std::vector<Path> paths{
            {{{-0.5, 0, height + 0.4}, {0, 0.05, height + 0.4}, {0.5, 0.1, height + 0.4}}},
            {{{0, 0, height + 0.02}, {0, 0, height + 1.6}}},
            {{{-0.5, 0, height - 0.05}, {-0.5, 0.3, height + 0.1}}}};
        const Shape cone = fan(7, 4, height);
        out.push_back(over(fmt::format("cone 8 mm wide, {:g} mm high, smooth", height),
                           cone.triangles(1, 1.5), 1.5, paths));
        out.push_back(over(fmt::format("cone 8 mm wide, {:g} mm high, creased", height),
                           creased(cone, crease_deg, 1, 1.5), 1.5, paths));
        out.back().near_mm = 0.9;
    }
    const std::vector<Path> paths{{{{-0.5, 0.1, 5.2}, {0, 0, 5.2}, {0.5, -0.1, 5.2}}},
                                  {{{0, 0, 5.02}, {0, 0, 6.1}}},
                                  {{{-0.5, 0, 4}, {0, -0.4, 4}, {0.5, 0, 4}}}};
    const Shape needle = fan(5, 0.1, 5);
    out.push_back(over("needle tip, 0.2 mm wide, 5 mm high, smooth", needle.triangles(1, 1), 1, paths));
    out.back().projected_step = sharp_step;
    out.push_back(
        over("needle tip, 0.2 mm wide, 5 mm high, creased", creased(needle, crease_deg, 1, 1), 1, paths));
    return out;
}

/// A fan over an edge of 10 mm, the tip some um over its end. It came out of a random case.
Case low_over_an_edges_end()
{
    reference::Triangle t;
    t.fan = true;
    const Vec3 tip{9.442468, 5.700386, 0.666553}, end = add(tip, {-0.002358, 0.002094, -0.004057});
    t.corner = {on_grid(add(tip, {-2.649051, -7.942621, 6.077554})), on_grid(end), on_grid(end)};
    const Vec3 one{0.925931663, -0.019739658, 0.377174892};
    t.normal = {on_unit_grid(one), on_unit_grid(one), on_unit_grid({0.745993796, 0.229916644, 0.625005276})};
    t.vertex = {0, 1, 1};
    t.radius = 0.14565;
    Case c = over("fan over an edge of 10 mm, low over its end", {t}, 0.14565,
                  {{{add(tip, {0, 0, -0.002}), tip, add(tip, {0.002, 0, 0.005})}}});
    c.rigid = false;                            // it is as narrow as its height
    c.projected_step = c.paper_step = measured; // alone: it ends at its walls
    c.jump = 0.02;
    return c;
}

std::vector<Case> bodies()
{
    std::vector<Case> out;
    const std::vector<Path> round_a_corner{{{{4, 3, 3.5}, {5.5, 3.5, 3.3}, {5.6, 4.4, 2}}},
                                           {{{5.2, 4.2, 3.2}, {6.3, 5.3, 4.3}}},
                                           {{{5.3, 4.3, 3.3}, {5.5, 3.3, 3.5}, {3, 3, 3.3}}}};
    out.push_back(over("corner of a box, smooth", box({5, 4, 3}).triangles(1, 2), 2, round_a_corner));
    out.back().closed = true;
    out.push_back(
        over("corner of a box, creased", creased(box({5, 4, 3}), crease_deg, 1, 2), 2, round_a_corner));
    out.back().near_mm = 1.9;
    out.back().closed = out.back().convex = true;
    out.push_back(over("box entered through face, edge and corner", creased(box({5, 4, 3}), crease_deg, 1, 2),
                       2,
                       {{{{3, 1, 5}, {3, 1, 2.5}, {2.5, 1.2, 2.2}, {3, 0.9, 3.2}}},
                        {{{5.5, 1, 3.5}, {4.7, 1, 2.7}, {5.5, 1.1, 3.4}}},
                        {{{5.5, 4.5, 3.5}, {4.7, 3.7, 2.7}, {5.4, 4.4, 3.3}}}}));
    out.back().projected_step = measured; // on leaving through another face than the one it is held on
    out.back().near_mm = 1.9;
    out.back().closed = out.back().penetrates = true;
    Shape sheet;
    sheet.vertices = {{-5, -4, 0}, {5, -4, 0}, {5, 4, 0}, {-5, 4, 0}};
    sheet.faces = {{0, 1, 2}, {0, 2, 3}};
    out.push_back(over("rim of a two-sided sheet", creased(sheet, 30, 1, 1, true), 1,
                       {{{{3, 0.2, 0.3}, {5, 0.2, 0.3}, {5.5, 0.1, 0}, {4.5, 0.3, -0.3}}},
                        {{{5, 4, 0.5}, {5.3, 4.3, 0}, {5, 4, -0.5}}}}));
    out.back().near_mm = 0.95;
    out.push_back(over("saddle", field(8, 4, saddle).triangles(1, 2), 2,
                       {{{{-1.5, -1, 0.5}, {0, 0, 0.5}, {1.5, 1.2, 0.7}}}, {{{0, 0, 0.01}, {0, 0, 2.1}}}}));
    out.back().near_mm = 1.5;
    out.push_back(over("bumpy ball", star(2, bumpy).triangles(1, 1.5), 1.5,
                       {{{{3, 5, 9.5}, {-1, 4, 10.3}}}, {{{8, 6, 6}, {5, 3, 5}, {4, 4, 5}, {7, 6, 7}}}}));
    out.back().near_mm = 1;
    out.back().closed = out.back().penetrates = true;
    out.push_back(low_over_an_edges_end());
    return out;
}

} // namespace

std::vector<Case> feature_cases()
{
    std::vector<Case> out;
    for (auto part : {on_features(), ridges(), tips(), bodies()})
        std::move(part.begin(), part.end(), std::back_inserter(out));
    return out;
}

} // namespace phantom::hard
