// SPDX-License-Identifier: GPL-2.0-or-later
// The hard cases as data: a mesh, ways of the tip, and what must hold on them. One runner (suite.hpp) goes
// through all of them, for the test and for the table.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "meshes.hpp"

namespace phantom::hard {

using Triangles = std::vector<reference::Triangle>;

/// Kinds of trouble, in the order of the table.
enum class Kind {
    slivers,
    on_feature,
    edges,
    folds,
    narrow,
    place,
    doubles,
    speed,
    exchange,
    limits,
    random
};
const char* title(Kind kind);

/// Where a path must end with proxy=constrained. (With proxy=paper a tip leaves a plate by its back.)
enum class End { any, outside, inside };

/// From place to place, straight. Every place is a sample itself: the tip is exactly there.
struct Path {
    std::vector<Vec3> places;
    double step_mm = 0.02; ///< between samples; 0: the places alone, as a fast or faulty tip has them
    End end = End::any;
};

/// Largest step of the force on 1 um, in kR (on R/1000 where R < 1 mm).
///
/// Over one sheet |dF| <= k (1 + (R - h)/rho) |dP|, rho the distance from where the normals there come
/// together: 1e-3/R for a plane, 1/h of it over an edge. Where a shell folds the root comes in with the
/// square root of the way: sqrt(2 um / mm) of R is 4%.
constexpr double smooth_step = 0.01;
constexpr double sharp_step = 0.03; ///< normals that turn by 90 degrees within 0.1 mm
constexpr double folded_step = 0.10;
/// Largest part of a step that is left on 3 nm, kR: sqrt(3 nm / 1 mm) is 0.2%, a soft wall on which shells
/// differ a little. In float32, where an edge has folded over, the two roots that cancel there differ by
/// rounding.
constexpr double smooth_jump = 0.01;
constexpr double folded_jump = 0.10;
/// Where the offset edges of a ring shrink to a point Z, at h = z, what is next to it is P - Z = (z - h)
/// v(b): the roots' b and normals depend on the direction of P - Z alone, so the force has another limit in
/// each direction. No arithmetic can mend that. Along the axis of the fine dent the limits from below and
/// from above differ by that (Focus of reference_test); the window, 0.2 um wide, spreads it, and leaves so
/// much on 3 nm.
constexpr double focus_step = 0.70;
constexpr double focus_jump = 0.02;
constexpr double measured = std::numeric_limits<double>::infinity(); ///< nothing is promised: see the table

struct Case {
    std::string name;
    Kind kind = Kind::slivers;
    /// The mesh. With more than one, they take turns with every tick, as sets do that are exchanged.
    std::vector<Triangles> sets;
    std::vector<Path> paths;
    double stiffness = 1, radius = 1; ///< the largest k and R among the triangles

    /// Largest step on 1 um: of `paper` (bounded) and of `projected`, outside; of either where the tip is or
    /// was inside.
    double paper_step = measured;
    double projected_step = smooth_step;
    double inside_step = measured;
    /// What of a step may be left on 3 nm, kR; asked where the step is promised.
    double jump = smooth_jump;
    bool continuous = false; ///< asked of `projected` though its step is not: how steep it is is not known
    /// Nearer than this to the front of a face there is contact, mm. 0: not asked.
    double near_mm = 0;
    bool closed = false;     ///< the tip is inside when it is behind the nearest face
    int surfaces = 1;        ///< closed ones: outside, valid - folded is their number
    bool convex = false;     ///< a tip has one nearest point: a force above k (R - distance) is a double
    bool once = true;        ///< and there is none
    bool penetrates = false; ///< the path goes inside: run with either proxy
    unsigned refused = 0;    ///< faces that cannot be computed
    bool saturates = false;  ///< forces beyond the border's integers
    bool rigid = true;       ///< may be turned: its detail is far above the nm grid that corners lie on
    std::string outcome{};   ///< what a user must know, where that is not plain
    std::string
        fault{}; ///< known and not yet mended: asked for numbers that do not wrap, the table has the rest
};

/// All of them, in the order of their kinds.
const std::vector<Case>& corpus();

// The parts of the corpus.
std::vector<Case> degenerate_cases(); ///< slivers and points; doubles, flips, rims, intersections
std::vector<Case> feature_cases();    ///< tips exactly on things; ridges, cones, corners, saddles
std::vector<Case> concave_cases();    ///< grooves, folds, narrow places
std::vector<Case> motion_cases();     ///< far and small meshes, speed, sets exchanged, integer limits

// What the parts share.
/// One mesh, R of all its triangles; promised as the defaults above say.
Case make_case(Kind kind, std::string name, Triangles triangles, double radius, std::vector<Path> paths);
Triangles moved(Triangles triangles, const Vec3& by);
/// Seen from the other side.
Triangles flipped(Triangles triangles);
/// As another object: with vertices of its own.
Triangles joined(Triangles all, Triangles more);
/// Every corner with its face's own normal, and no fans.
Triangles faceted(Triangles triangles);

} // namespace phantom::hard
