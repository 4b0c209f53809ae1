// SPDX-License-Identifier: GPL-2.0-or-later
// The meshes that several tests go through, and random points near their surfaces.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "meshes.hpp"

namespace phantom::hard {

struct Named {
    std::string name;
    std::vector<reference::Triangle> triangles;
    double radius; ///< R, mm
    /// float32 over some mm of patch and shell, k <= 1 N/mm; a hand feels some mN.
    double tolerance_n = 1e-5;
};

/// Triangles thrown at random with normals within 40 degrees of their own: nothing fits anything.
inline std::vector<reference::Triangle> soup(std::mt19937& random, unsigned count, double radius)
{
    std::uniform_real_distribution<double> place(-5, 5), side(-1.5, 1.5);
    std::vector<reference::Triangle> out;
    while (out.size() < count) {
        reference::Triangle t;
        const Vec3 at{place(random), place(random), place(random)};
        for (Vec3& x : t.corner)
            x = on_grid(add(at, {side(random), side(random), side(random)}));
        const Vec3 area = cross(subtract(t.corner[1], t.corner[0]), subtract(t.corner[2], t.corner[0]));
        if (length(area) < 0.3)
            continue;
        for (Vec3& n : t.normal)
            n = on_unit_grid(unit(add(unit(area), scale(0.4, {side(random), side(random), side(random)}))));
        for (std::uint32_t i = 0; i < 3; ++i)
            t.vertex[i] = static_cast<std::uint32_t>(3 * out.size() + i);
        t.radius = radius;
        out.push_back(t);
    }
    return out;
}

inline double saddle(double x, double y)
{
    return (x * x - y * y) / 12;
}

inline double bumpy(const Vec3& d)
{
    return 10 + 0.8 * std::sin(5 * d[0]) * std::cos(4 * d[1]) + 0.5 * std::sin(6 * d[2]);
}

inline std::vector<Named> shapes_of_interest()
{
    std::mt19937 random(7);
    std::vector<Named> out;
    out.push_back({"sphere", sphere(3, 10).triangles(1, 2), 2});
    out.push_back({"box", box({5, 4, 3}).triangles(1, 2), 2});
    out.push_back({"saddle", field(10, 5, saddle).triangles(0.5, 2), 2});
    out.push_back({"bumpy", star(3, bumpy).triangles(1, 1.5), 1.5});
    // every patch folds somewhere, and near a fold a root moves by more than what moved it
    out.push_back({"soup", soup(random, 60, 1.5), 1.5, 1e-4});
    return out;
}

/// A point over a random triangle, from `low` to `high` along its normal, a little beside it at times.
inline Vec3 point_near(const std::vector<reference::Triangle>& triangles, std::mt19937& random, double low,
                       double high)
{
    std::uniform_int_distribution<std::size_t> pick(0, triangles.size() - 1);
    std::uniform_real_distribution<double> part(-0.1, 1.1), height(low, high);
    const reference::Triangle& t = triangles[pick(random)];
    const double a = part(random), b = part(random) * (1 - a), h = height(random);
    Vec3 p = add(scale(1 - a - b, t.corner[0]), add(scale(a, t.corner[1]), scale(b, t.corner[2])));
    const Vec3 n =
        unit(add(scale(1 - a - b, t.normal[0]), add(scale(a, t.normal[1]), scale(b, t.normal[2]))));
    return on_grid(add(p, scale(h, n)));
}

} // namespace phantom::hard
