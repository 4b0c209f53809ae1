// SPDX-License-Identifier: GPL-2.0-or-later
#include "random_cases.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "creased.hpp"
#include "distance.hpp"
#include "shapes_of_interest.hpp"

namespace phantom::hard {

namespace {

/// Numbers that are the same with every standard library, which its distributions need not be.
class Chance {
  public:
    explicit Chance(std::uint64_t seed) : engine_(seed) {}
    double between(double low, double high)
    {
        return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
    }
    unsigned below(unsigned count) { return static_cast<unsigned>(engine_() % count); }
    Vec3 vector(double size) { return {between(-size, size), between(-size, size), between(-size, size)}; }
    Vec3 direction()
    {
        for (;;) {
            const Vec3 v = vector(1);
            if (length(v) > 0.1 && length(v) < 1)
                return unit(v);
        }
    }
    std::mt19937_64& engine() { return engine_; }

  private:
    std::mt19937_64 engine_;
};

/// Triangles of any shape and place.
Triangles random_soup(Chance& chance, double radius)
{
    Triangles out;
    const unsigned count = 1 + chance.below(40);
    for (std::uint32_t f = 0; f < count; ++f) {
        reference::Triangle t;
        const Vec3 at = chance.vector(4);
        const double size = std::pow(10, chance.between(-4, 0.5));
        for (Vec3& x : t.corner)
            x = on_grid(add(at, chance.vector(size)));
        for (Vec3& n : t.normal)
            n = on_unit_grid(chance.direction());
        t.vertex = {3 * f, 3 * f + 1, 3 * f + 2};
        t.radius = radius;
        out.push_back(t);
    }
    return out;
}

/// Closed and star-shaped, its vertex normals pushed about by up to `push`; some faces are needles.
Shape random_star(Chance& chance, double push)
{
    std::array<Vec3, 3> wave;
    for (Vec3& w : wave)
        w = chance.vector(6);
    const double size = chance.between(3, 12), bump = chance.between(0, 0.08) * size;
    Shape s = star(1 + chance.below(2), [&](const Vec3& d) {
        double r = size;
        for (const Vec3& w : wave)
            r += bump * std::sin(dot(w, d) + w[0]);
        return r;
    });
    for (Vec3& v : s.vertices)
        v = on_grid(add(v, chance.vector(0.03 * size)));
    smooth_normals(s);
    for (Vec3& n : s.normals)
        n = on_unit_grid(unit(add(n, chance.vector(push))));
    return s;
}

/// z = -slope |x| with a slope to either side; convex or concave.
Shape random_dihedral(Chance& chance)
{
    const auto slope = [&chance] { return std::tan(chance.between(-85, 85) / 180 * std::numbers::pi); };
    const double left = slope(), right = slope();
    return field(6, 3, [&](double x, double) { return x < 0 ? left * x : right * x; });
}

/// Faces less than 16 nm high have no plane.
unsigned without_plane(const Triangles& mesh)
{
    unsigned count = 0;
    for (const auto& t : mesh) {
        double longest = 0;
        for (std::size_t i = 0; i < 3; ++i)
            longest = std::max(longest, length(subtract(t.corner[(i + 1) % 3], t.corner[i])));
        const double area =
            length(cross(subtract(t.corner[1], t.corner[0]), subtract(t.corner[2], t.corner[0])));
        count += !t.fan && !t.rim && area < 16e-6 * longest;
    }
    return count;
}

struct Pose {
    std::array<Vec3, 3> axes;
    Vec3 at;
    [[nodiscard]] Vec3 turned(const Vec3& v) const
    {
        return {dot(axes[0], v), dot(axes[1], v), dot(axes[2], v)};
    }
};

Pose random_pose(Chance& chance)
{
    Pose pose;
    pose.axes[0] = chance.direction();
    pose.axes[1] = unit(cross(pose.axes[0], chance.direction()));
    pose.axes[2] = cross(pose.axes[0], pose.axes[1]);
    pose.at = chance.vector(std::pow(10, chance.between(-2, 2.9)));
    return pose;
}

Triangles placed(Triangles triangles, const Pose& pose)
{
    for (auto& t : triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            t.corner[i] = on_grid(add(pose.turned(t.corner[i]), pose.at));
            t.normal[i] = on_unit_grid(pose.turned(t.normal[i]));
        }
    }
    return triangles;
}

/// A point over or under a random face, up to its corners and beyond.
Vec3 near_some_face(Chance& chance, const Triangles& mesh, double low, double high)
{
    const auto rims = std::find_if(mesh.begin(), mesh.end(), [](const auto& t) { return t.rim; });
    const auto& t = mesh[chance.below(static_cast<unsigned>(rims - mesh.begin()))];
    double a = chance.between(-0.2, 1.2), b = chance.between(-0.2, 1.2);
    if (chance.below(4) == 0) // exactly on an edge's or a corner's line
        a = chance.below(2);
    const Vec3 foot = add(t.corner[0], add(scale(a, subtract(t.corner[1], t.corner[0])),
                                           scale(b, subtract(t.corner[2], t.corner[0]))));
    return on_grid(add(foot, scale(chance.between(low, high), t.normal[chance.below(3)])));
}

} // namespace

Case random_case(std::uint64_t seed)
{
    Chance chance(seed);
    Case c;
    c.kind = Kind::random;
    c.radius = std::pow(10, chance.between(-1, 0.7));
    c.projected_step = measured; // how steep is not known; that nothing jumps is
    c.jump = folded_jump;
    Triangles mesh;
    const unsigned sort = chance.below(5);
    switch (sort) {
    case 0:
        c.name = "soup";
        mesh = random_soup(chance, c.radius);
        break;
    case 1:
        c.name = "star, smooth";
        mesh = random_star(chance, 0).triangles(1, c.radius);
        break;
    case 2:
        c.name = "star, normals pushed";
        mesh = random_star(chance, 0.5).triangles(1, c.radius);
        break;
    case 3:
        c.name = "star, creased";
        mesh = creased(random_star(chance, 0), chance.between(5, 60), 1, c.radius);
        break;
    default:
        c.name = "dihedral, creased";
        mesh = creased(random_dihedral(chance), 3, 1, c.radius);
    }
    const bool star_shaped = sort >= 1 && sort <= 3;
    mesh = placed(mesh, random_pose(chance));
    c.name = fmt::format("seed {}: {}", seed, c.name);
    c.rigid = sort != 0;
    c.continuous = star_shaped;
    c.penetrates = chance.below(2) == 0;
    const double low = c.penetrates ? -0.5 * c.radius : 0.05 * c.radius;
    for (int i = 0; i < 3; ++i) {
        Path path;
        path.step_mm = 0.02;
        for (int k = 0; k < 3; ++k) {
            Vec3 p = near_some_face(chance, mesh, low, c.radius);
            for (int tries = 0; k == 0 && star_shaped && !nearest(mesh, p).in_front && tries < 50; ++tries)
                p = near_some_face(chance, mesh, 0.3 * c.radius, c.radius); // begins outside
            // no farther than 2 mm at a time: the rest would be air
            path.places.push_back(k == 0
                                      ? p
                                      : add(path.places.back(),
                                            scale(std::min(1.0, 2 / length(subtract(p, path.places.back()))),
                                                  subtract(p, path.places.back()))));
        }
        c.paths.push_back(std::move(path));
    }
    c.refused = without_plane(mesh);
    c.sets = {std::move(mesh)};
    return c;
}

} // namespace phantom::hard
