// SPDX-License-Identifier: GPL-2.0-or-later
// Grooves, shells that fold over, and places too narrow for R.
#include <fmt/format.h>

#include <numbers>

#include "corpus.hpp"
#include "creased.hpp"
#include "shapes_of_interest.hpp"

namespace phantom::hard {

namespace {

Case within(Kind kind, std::string name, Triangles triangles, double radius, std::vector<Path> paths)
{
    Case c = make_case(kind, std::move(name), std::move(triangles), radius, std::move(paths));
    c.projected_step = folded_step;
    return c;
}

/// z = slope |x|
std::vector<Case> grooves()
{
    std::vector<Case> out;
    for (const double degrees : {5.0, 20.0, 45.0, 90.0, 135.0, 175.0}) {
        const double slope = 1 / std::tan(degrees / 2 * std::numbers::pi / 180);
        const Shape groove = field(6, 3, [&](double x, double) { return slope * std::abs(x); });
        const std::vector<Path> outside{{{{0, 0.31, 0.2}, {std::min(1.0, 0.9 * 0.2 / slope), -0.22, 0.2}}},
                                        {{{0, 0.31, 0.9}, {std::min(1.0, 0.9 * 0.9 / slope), -0.22, 0.9}}},
                                        {{{0, 0.1, 0.01}, {0.001, 0.12, 1.7}}}};
        const std::vector<Path> under{
            {{{0.001, 0.3, 0.5}, {0, 0.3, -0.5}, {-0.3, 0.3, -0.5}, {0.3, 0.31, -0.5}, {0, 0.2, -0.1}}}};
        for (const bool sharp : {false, true}) {
            const auto mesh = sharp ? creased(groove, 3, 1, 1.5) : groove.triangles(1, 1.5);
            const char* how = sharp ? "creased" : "smooth";
            out.push_back(within(Kind::folds, fmt::format("groove of {:.0f} deg, {}", degrees, how), mesh,
                                 1.5, outside));
            out.back().near_mm =
                sharp ? 1 : 0; // smooth normals lie far from the walls', and so does a contact
            out.push_back(within(Kind::folds, fmt::format("groove of {:.0f} deg, {}, under it", degrees, how),
                                 mesh, 1.5, under));
            out.back().projected_step = measured;
            out.back().penetrates = true;
        }
    }
    return out;
}

std::vector<Case> folds()
{
    std::vector<Case> out;
    const auto dented = [](const Vec3& d) { return 10 - 4 * std::exp(-15 * (1 - d[2])); };
    out.push_back(within(Kind::folds, "dent, R beyond its curvature", star(2, dented).triangles(1, 12), 12,
                         {{{{-2, 0.4, 9}, {2, -0.3, 9}}},
                          {{{0.1, 0.23, 6.7}, {0.13, 0.2, 14}}},
                          {{{1, 0.5, 7.5}, {2.5, 0.5, 14}}}}));
    out.back().closed = true;
    out.back().near_mm = 5;
    out.push_back(within(Kind::folds, "dent, on its axis of symmetry", star(2, dented).triangles(1, 12), 12,
                         {{{{0, 0, 6.05}, {0, 0, 14}}}}));
    out.push_back(within(Kind::folds, "finer dent, on its axis of symmetry", star(3, dented).triangles(1, 12),
                         12, {{{{0, 0, 6.05}, {0, 0, 14}}}}));
    out.back().near_mm = 5;
    out.back().projected_step = focus_step;
    out.back().jump = focus_jump;
    out.back().outcome =
        "3.43 mm over its bottom the shells of a ring shrink to a point, and the force of the "
        "model jumps there, whatever the arithmetic";
    out.push_back(
        within(Kind::folds, "bowl, R beyond its curvature",
               field(8, 2, [](double x, double y) { return 0.5 * (x * x + y * y); }).triangles(1, 1.5), 1.5,
               {{{{-0.7, 0.1, 1}, {0, 0, 1}, {0.7, -0.1, 1}}}, {{{0.01, 0.02, 0.03}, {0.012, 0.03, 1.6}}}}));
    out.back().near_mm = 0.9;
    out.push_back(
        within(Kind::folds, "bumps, R beyond their curvature",
               star(2, [](const Vec3& d) { return 10 + 0.6 * std::sin(9 * d[0]) * std::sin(9 * d[1]); })
                   .triangles(1, 3),
               3, {{{{2, 3, 10.5}, {-1, 4, 10.5}}}, {{{3.5, 3.5, 8.8}, {4.5, 4.5, 11}}}}));
    out.back().closed = true;
    out.back().near_mm = 1.5;
    return out;
}

Shape inward(Shape shape)
{
    for (auto& face : shape.faces)
        std::swap(face[1], face[2]);
    smooth_normals(shape);
    return shape;
}

/// A tube along x, seen from inside, 2 mm long to either side.
Shape tube(double radius, unsigned sides)
{
    Shape s;
    for (unsigned j = 0; j < 2; ++j) {
        for (unsigned i = 0; i < sides; ++i) {
            const double a = 2 * std::numbers::pi * i / sides;
            s.vertices.push_back(on_grid({j == 0 ? -4.0 : 4.0, radius * std::cos(a), radius * std::sin(a)}));
            s.normals.push_back(on_unit_grid({0, -std::cos(a), -std::sin(a)}));
        }
    }
    for (unsigned i = 0; i < sides; ++i) {
        const unsigned next = (i + 1) % sides;
        s.faces.push_back({i, sides + i, sides + next});
        s.faces.push_back({i, sides + next, next});
    }
    return s;
}

std::vector<Case> narrow_places()
{
    std::vector<Case> out;
    const auto floor = field(2, 5, [](double, double) { return 0.0; }).triangles(1, 2);
    const auto slot = joined(floor, moved(flipped(floor), {0, 0, 1}));
    out.push_back(
        within(Kind::narrow, "slot of 1 mm, R = 2 mm", slot, 2,
               {{{{1.1, 0.7, 0.01}, {1.1, 0.7, 0.5}, {1.1, 0.7, 0.99}}}, {{{-1, 0.2, 0.5}, {1, 0.1, 0.5}}}}));
    out.back().projected_step = out.back().paper_step = smooth_step;
    out.back().near_mm = 0.5;
    const auto wedge =
        joined(floor, moved(flipped(field(2, 5, [](double x, double) { return 0.1 * x; }).triangles(1, 2)),
                            {0, 0, 0.8}));
    out.push_back(within(Kind::narrow, "slot that opens, R = 2 mm", wedge, 2,
                         {{{{-1, 0.2, 0.3}, {2, 0.1, 0.4}}}, {{{1, 0.2, 0.01}, {1, 0.2, 0.85}}}}));
    out.back().projected_step = smooth_step;
    const auto slanted =
        field(2, 5, [](double x, double y) { return 0.3 * x - 0.2 * y - 1; }).triangles(1, 2);
    out.push_back(within(Kind::narrow, "a slanted sheet under another", joined(floor, slanted), 2,
                         {{{{-1, 0.2, 0.3}, {1.2, -0.7, 0.5}}}, {{{0.3, 0.2, 0.01}, {0.3, 0.25, 2.1}}}}));
    out.back().projected_step = smooth_step;
    out.back().near_mm = 1.9;
    out.back().outcome =
        "`paper` drops the lower one's contact but near edges of the upper; `projected` adds it";
    const std::vector<Path> across{{{{-0.5, -0.4, -0.3}, {0, 0, 0}, {0.5, 0.4, 0.3}}},
                                   {{{-0.5, 0.1, 0.05}, {0.5, -0.02, 0.03}}}};
    out.push_back(within(Kind::narrow, "closed box smaller than R, smooth",
                         inward(box({0.6, 0.5, 0.4})).triangles(1, 2), 2, across));
    out.back().jump = folded_jump;
    out.push_back(within(Kind::narrow, "closed box smaller than R, walls alone",
                         faceted(inward(box({0.6, 0.5, 0.4})).triangles(1, 2)), 2, across));
    out.back().projected_step = measured; // walls without fans: each shell ends at its edges
    out.back().near_mm = 0.3;
    out.push_back(
        within(Kind::narrow, "hollow ball smaller than R", flipped(sphere(2, 1.5).triangles(1, 2)), 2,
               {{{{-1.3, 0.1, 0.2}, {0, 0, 0}, {1.2, -0.3, 0.1}}}, {{{0.2, 0, 1.3}, {0.1, 0.2, -1.3}}}}));
    out.back().outcome = "at its centre all shells shrink to a point, and the forces of both sides cancel";
    out.push_back(
        within(Kind::narrow, "tube narrower than R", tube(0.8, 12).triangles(1, 2), 2,
               {{{{0, -0.7, 0.1}, {0.1, 0, 0}, {0.2, 0.7, 0.2}}}, {{{-1, 0.2, 0.3}, {1, -0.3, 0.2}}}}));
    out.back().projected_step = measured;
    out.back().outcome = "on its axis all shells shrink to a line, and the force turns over";
    const auto ball = sphere(2, 3).triangles(1, 2);
    out.push_back(
        within(Kind::narrow, "between two balls 1 mm apart", joined(ball, moved(ball, {7, 0, 0})), 2,
               {{{{3.05, 0.1, 0.1}, {3.5, 0, 0}, {3.95, 0.1, -0.1}}}, {{{3.5, 0, -2}, {3.4, 0.1, 2}}}}));
    out.back().near_mm = 1.4;
    out.back().surfaces = 2;
    out.back().closed = true;
    out.back().projected_step = smooth_step;
    return out;
}

} // namespace

std::vector<Case> concave_cases()
{
    std::vector<Case> out;
    for (auto part : {grooves(), folds(), narrow_places()})
        std::move(part.begin(), part.end(), std::back_inserter(out));
    return out;
}

} // namespace phantom::hard
