// SPDX-License-Identifier: GPL-2.0-or-later
// Far and small meshes, fast and faulty tips, sets exchanged in mid-contact, the limits of the integer
// border.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "corpus.hpp"
#include "creased.hpp"
#include "distance.hpp"
#include "shapes_of_interest.hpp"

namespace phantom::hard {

namespace {

/// A ball of 2 mm with bumps of 0.1 mm.
double finely_bumpy(const Vec3& d)
{
    return 1 + 0.1 * std::sin(5 * d[0]) * std::cos(5 * d[1]);
}

const std::vector<Path>& over_the_small_ball()
{
    static const std::vector<Path> paths{{{{-0.4, 0.1, 1.1}, {0, 0, 1.2}, {0.5, -0.1, 1.1}}},
                                         {{{0.2, 0.1, 1.4}, {0.2, 0.1, 0.8}, {0.3, 0, 1.3}}}};
    return paths;
}

/// Where a scene keeps it, `at` mm from the world's origin in double, and then in its set: from an origin
/// near it, in whole nm.
Triangles as_a_set_carries_it(Triangles triangles, double at)
{
    for (auto& t : triangles) {
        for (Vec3& x : t.corner) {
            for (double& axis : x) {
                const double world = axis + at;
                axis = world - at;
            }
            x = on_grid(x);
        }
    }
    return triangles;
}

Case resized(Case c, double factor)
{
    for (Triangles& set : c.sets) {
        for (auto& t : set) {
            t.radius *= factor;
            for (Vec3& x : t.corner)
                x = on_grid(scale(factor, x));
        }
    }
    for (Path& path : c.paths) {
        path.step_mm *= factor;
        for (Vec3& p : path.places)
            p = scale(factor, p);
    }
    c.radius *= factor;
    c.near_mm *= factor;
    return c;
}

std::vector<Case> places()
{
    const Triangles ball = star(2, finely_bumpy).triangles(1, 0.5);
    Case plain =
        make_case(Kind::place, "ball of 2 mm with bumps of 0.1 mm", ball, 0.5, over_the_small_ball());
    plain.projected_step = folded_step;
    plain.near_mm = 0.2;
    plain.closed = plain.penetrates = true;
    std::vector<Case> out{plain};
    out.push_back(plain);
    out.back().name = "the same 5,000 km from the world's origin";
    out.back().sets = {as_a_set_carries_it(ball, 5e9)};
    out.push_back(plain);
    out.back().name = "the same 1 m from its set's origin";
    out.back().sets = {moved(ball, {998, -998, 998})};
    for (Path& path : out.back().paths)
        for (Vec3& p : path.places)
            p = add(p, {998, -998, 998});
    out.push_back(resized(plain, 0.005));
    out.back().name = "the same 10 um across";
    out.back().rigid = false;  // its corners are 1,000 steps of the nm grid apart
    out.back().closed = false; // the places' distance from the surface is near the grid's
    out.push_back(make_case(Kind::place, "plate of 2 m, R = 100 mm",
                            field(4, 900, [](double, double) { return 0.0; }).triangles(1, 100), 100,
                            {{{{-3, 1, 50}, {2, -1, 50}}}, {{{1, 1, 1}, {1, 1, -1}, {1.5, 1, 1}}}}));
    out.back().near_mm = 90;
    out.back().penetrates = true;
    return out;
}

/// From a to b, `step_mm` a tick.
Path ticks(const Vec3& a, const Vec3& b, double step_mm, End end)
{
    Path path{{}, 0, end};
    const double way = length(subtract(b, a));
    for (double s = 0; s < way; s += step_mm)
        path.places.push_back(add(a, scale(s / way, subtract(b, a))));
    path.places.push_back(b);
    return path;
}

/// Fast ones: 1 kHz, the slowest rate.
Case fast(std::string name, Triangles triangles, std::vector<Path> paths)
{
    Case c = make_case(Kind::speed, std::move(name), std::move(triangles), 1, std::move(paths));
    c.projected_step = measured; // steps are as long as the ways
    c.penetrates = true;
    return c;
}

std::vector<Case> speeds()
{
    const Triangles plate = creased(box({5, 5, 0.1}), 30, 1, 1), ball = star(2, bumpy).triangles(1, 1);
    std::vector<Case> out;
    for (const double mm : {0.1, 1.0, 3.0, 10.0}) { // of a tick at 1 kHz: the speed in m/s
        out.push_back(fast(fmt::format("plate of 0.2 mm at {:g} m/s", mm), plate,
                           {ticks({1, 1.5, 1.9}, {1.2, 1.4, -4}, mm, End::inside),
                            ticks({-2, 0.3, 0.6}, {-1.9, 0.2, -0.55}, mm, End::inside),
                            ticks({0, 0, 5}, {0, 0, -0.05}, mm, End::inside)}));
        out.push_back(fast(fmt::format("bumpy ball at {:g} m/s", mm), ball,
                           {ticks({3, 5, 14}, {1, 2, 3}, mm, End::inside),
                            ticks({-14, 2, 1}, {0, 1, 2}, mm, End::inside),
                            ticks({0, 0, 14}, {0, 0, 2}, mm, End::inside)}));
        out.back().closed = true;
    }
    const Triangles rib = creased(box({0.1, 5, 5}), 30, 1, 1);
    out.push_back(
        fast("a tick longer than a rib of 0.2 mm", rib,
             {{{{-0.6, 1, 1}, {0.5, 1, 1}}, 0, End::inside}, {{{-2, 1, 0}, {2.5, 0.5, 0}}, 0, End::inside}}));
    out.push_back(fast("a tick that clips an edge", creased(box({5, 4, 3}), 30, 1, 1),
                       {{{{4.9, 1, 3.3}, {5.3, 1, 2.9}, {5.4, 1, 3.2}}, 0, End::outside}}));
    out.push_back(fast("teleport through a ball", ball,
                       {{{{0, 0.5, 12}, {0.1, 0.3, -14}, {0, 0.5, 12}}, 0, End::any}}));
    out.back().outcome = "held or not, as after a plate; the servo latches OVERSPEED";
    out.push_back(fast(
        "glitch of one tick", ball,
        {{{{0, 0.5, 10.9}, {0, 0.5, 10.8}, {900, 0, -900}, {0, 0.5, 10.8}, {0, 0.5, 10.9}}, 0, End::outside},
         {{{0, 0.5, 10.9}, {0, 0.5, 9}, {0, 0.5, 9}, {-30, 5, 2000}, {0, 0.5, 9}}, 0, End::any}}));
    out.back().outcome = "bounded; the servo latches OVERSPEED";
    return out;
}

/// The faces within `reach` of the path's places, by another order.
Triangles part_of(const Triangles& mesh, const std::vector<Vec3>& places, double reach)
{
    Triangles out;
    for (const auto& t : mesh) {
        const bool near = std::any_of(places.begin(), places.end(),
                                      [&](const Vec3& p) { return nearest({t}, p).distance < reach; });
        if (near)
            out.insert(out.begin(), t);
    }
    return out;
}

std::vector<Case> exchanges()
{
    Triangles ball = star(2, bumpy).triangles(1, 1.5);
    for (std::uint32_t f = 0; f < ball.size(); ++f)
        ball[f].face = f;
    const Path along{{{1, 2, 10.2}, {0, 2.5, 9.9}, {-1, 2, 10}}},
        down{{{1, 2, 10.5}, {0.5, 2, 8.5}, {-1, 2, 8.2}, {-0.5, 1, 11.5}}};
    const Triangles near = part_of(ball, along.places, 4), nearer = part_of(ball, down.places, 3);
    std::vector<Case> out;
    out.push_back(make_case(Kind::exchange, "another subset every tick", ball, 1.5, {along}));
    out.back().sets.insert(out.back().sets.end(), {near, part_of(near, along.places, 3)});
    out.back().near_mm = 1;
    out.push_back(make_case(Kind::exchange, "another subset every tick, inside", ball, 1.5, {down}));
    out.back().sets.push_back(nearer);
    out.back().projected_step = measured; // as it is on leaving without an exchange
    out.back().closed = out.back().penetrates = true;
    out.push_back(make_case(Kind::exchange, "an empty set every other tick", ball, 1.5, {along, down}));
    out.back().sets.push_back({});
    out.back().projected_step = measured;
    out.back().penetrates = true;
    out.back().outcome = "no force from the empty set; the servo fades to it";
    Triangles few = nearer;
    few.resize(8);
    out.push_back(make_case(Kind::exchange, "a set over budget every other tick", ball, 1.5, {along, down}));
    out.back().sets.push_back(few);
    out.back().projected_step = measured;
    out.back().penetrates = true;
    out.back().outcome = "the servo fades where coverage ends";
    return out;
}

std::vector<Case> limits()
{
    std::vector<Case> out;
    Triangles stiff = field(1, 10, [](double, double) { return 0.0; }).triangles(4e6, 2);
    out.push_back(make_case(Kind::limits, "k = 4e6 N/mm", stiff, 2,
                            {{{{1, 2, 2.1}, {1, 2, 1}, {0, 2, -1}, {0, 2, 1}}}}));
    out.back().stiffness = 4e6;
    out.back().projected_step = measured;
    out.back().penetrates = out.back().saturates = true;
    out.push_back(
        make_case(Kind::limits, "corners at +-1 m, R = 1 m", box({1000, 1000, 1000}).triangles(1, 1000), 1000,
                  {{{{999, 10, 1140}, {1001, -5, 1100}}, 1}, {{{990, 990, 1010}, {1010, 1010, 990}}, 1}}));
    out.back().projected_step = measured;
    out.back().rigid = false;
    constexpr double end =
        1147.483646; // farther away, a distance to -1 m has more than 32 bits: nothing is covered
    const Triangles far = joined(moved(sphere(1, 10).triangles(1, 2), {-990, -990, -990}),
                                 moved(sphere(1, 10).triangles(1, 2), {990, 990, 990}));
    out.push_back(make_case(
        Kind::limits, "distances of 32 bits", far, 2,
        {{{{end, end, end}, {end, -end, -end}, {-end, -end, -end}, {-end, -end, end}, {-end, end, end}}, 0},
         {{{end, end, end}, {979, 990, 990}, {978.6, 990, 990}, {-end, end, -end}}, 0}}));
    out.back().projected_step = measured;
    out.back().penetrates = true;
    out.back().rigid = false;
    return out;
}

} // namespace

std::vector<Case> motion_cases()
{
    std::vector<Case> out;
    for (auto part : {places(), speeds(), exchanges(), limits()})
        std::move(part.begin(), part.end(), std::back_inserter(out));
    return out;
}

} // namespace phantom::hard
