// SPDX-License-Identifier: GPL-2.0-or-later
#include "corpus.hpp"

#include <algorithm>
#include <iterator>

namespace phantom::hard {

const char* title(Kind kind)
{
    switch (kind) {
    case Kind::slivers:
        return "slivers, points";
    case Kind::on_feature:
        return "tip exactly on";
    case Kind::edges:
        return "edges and tips";
    case Kind::folds:
        return "shell folds";
    case Kind::narrow:
        return "narrow places";
    case Kind::place:
        return "far and small";
    case Kind::doubles:
        return "faulty meshes";
    case Kind::speed:
        return "speed";
    case Kind::exchange:
        return "set exchange";
    case Kind::limits:
        return "integer limits";
    case Kind::random:
        return "random";
    }
    return "";
}

const std::vector<Case>& corpus()
{
    static const std::vector<Case> all = [] {
        std::vector<Case> cases;
        for (auto part : {degenerate_cases(), feature_cases(), concave_cases(), motion_cases()})
            std::move(part.begin(), part.end(), std::back_inserter(cases));
        std::stable_sort(cases.begin(), cases.end(),
                         [](const Case& a, const Case& b) { return a.kind < b.kind; });
        return cases;
    }();
    return all;
}

Case make_case(Kind kind, std::string name, Triangles triangles, double radius, std::vector<Path> paths)
{
    Case c;
    c.name = std::move(name);
    c.kind = kind;
    c.sets = {std::move(triangles)};
    c.paths = std::move(paths);
    c.radius = radius;
    return c;
}

Triangles moved(Triangles triangles, const Vec3& by)
{
    for (auto& t : triangles)
        for (Vec3& x : t.corner)
            x = on_grid(add(x, by));
    return triangles;
}

Triangles flipped(Triangles triangles)
{
    for (auto& t : triangles) {
        std::swap(t.corner[1], t.corner[2]);
        std::swap(t.normal[1], t.normal[2]);
        std::swap(t.vertex[1], t.vertex[2]);
        for (Vec3& n : t.normal)
            n = scale(-1, n);
    }
    return triangles;
}

Triangles joined(Triangles all, Triangles more)
{
    std::uint32_t first = 0;
    for (const auto& t : all)
        first = std::max({first, t.vertex[0] + 1, t.vertex[1] + 1, t.vertex[2] + 1});
    for (auto& t : more)
        for (std::uint32_t& v : t.vertex)
            v += first;
    all.insert(all.end(), more.begin(), more.end());
    // fans after the faces, rims last
    std::stable_sort(all.begin(), all.end(),
                     [](const auto& a, const auto& b) { return a.fan + 2 * a.rim < b.fan + 2 * b.rim; });
    return all;
}

Triangles faceted(Triangles triangles)
{
    for (auto& t : triangles)
        t.normal.fill(on_unit_grid(
            unit(cross(subtract(t.corner[1], t.corner[0]), subtract(t.corner[2], t.corner[0])))));
    return triangles;
}

} // namespace phantom::hard
