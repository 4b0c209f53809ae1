// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/edge_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/components.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

constexpr double pi = std::numbers::pi;

/// Bends nearer to one another than this are equal, radians: then the pair with less inside wins.
constexpr double same_bend = 1e-6;

/// Angles nearer to one another than this are equal, radians: faces back to back.
constexpr double same_angle = 1e-7;

/// With more faces at an edge than this only closed parts are paired: the flattest are sought among all
/// pairs.
constexpr std::size_t leaves_max = 64;

} // namespace

EdgePairs::EdgePairs(const std::vector<Vec3>& vertices, const std::vector<Triple>& faces,
                     const EdgeIndex& edges)
    : vertices_(vertices), faces_(faces)
{
    Components components = components_of(faces, edges);
    closed_ = closed_components(faces, edges, components);
    component_ = std::move(components.of_face);
}

std::vector<EdgePairs::Leaf> EdgePairs::leaves_round(std::span<const HalfEdge> halves) const
{
    const std::uint32_t a = from_vertex(faces_, halves[0]), b = to_vertex(faces_, halves[0]);
    const Vec3 &low = vertices_[std::min(a, b)], &high = vertices_[std::max(a, b)];
    const Vec3 axis = normalized(subtract(high, low));
    const Vec3 aside = std::abs(axis[0]) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 u = normalized(cross(axis, aside)), v = cross(axis, u);
    std::vector<Leaf> leaves;
    for (const HalfEdge half : halves) {
        const Vec3 out = subtract(vertices_[faces_[half / 3][(half % 3 + 2) % 3]], low);
        leaves.push_back({std::atan2(dot(out, v), dot(out, u)), from_vertex(faces_, half) == std::min(a, b),
                          half, component_[half / 3]});
    }
    std::sort(leaves.begin(), leaves.end(), [](const Leaf& one, const Leaf& other) {
        if (one.angle != other.angle)
            return one.angle < other.angle;
        return one.up != other.up ? one.up < other.up : one.half < other.half;
    });
    return leaves;
}

/// Orders faces back to back so that up and down alternate all the way round; false, and nothing changed,
/// when they cannot.
bool EdgePairs::take_turns(std::vector<Leaf>& leaves)
{
    const std::size_t count = leaves.size();
    if (count % 2 != 0)
        return false;
    // from a gap on, so that faces back to back stand together
    std::size_t start = 0;
    for (std::size_t i = 1; i < count && start == 0; ++i) {
        if (leaves[i].angle - leaves[i - 1].angle > same_angle)
            start = i;
    }
    // with two faces back to back at the start either may work: rather no outside between them than no inside
    for (const bool first : {true, false}) {
        std::vector<Leaf> turns, left(leaves);
        std::rotate(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(start), left.end());
        while (!left.empty()) {
            const bool up = (turns.size() % 2 == 0) == first;
            const auto next =
                std::find_if(left.begin(), left.end(), [&](const Leaf& l) { return l.up == up; });
            if (next == left.end() ||
                std::abs(std::remainder(next->angle - left.front().angle, 2 * pi)) > same_angle)
                break;
            turns.push_back(*next);
            left.erase(next);
        }
        if (left.empty()) {
            leaves = std::move(turns);
            return true;
        }
    }
    return false;
}

/// By the right hand an inside begins at a face that runs down and ends at one that runs up: brackets, on a
/// circle. They are balanced when read from where the fewest are open.
void EdgePairs::pair_inside(const std::vector<Leaf>& leaves, Pairs& out)
{
    int open = 0, least = 0;
    std::size_t start = 0;
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        open += leaves[i].up ? -1 : 1;
        if (open < least) {
            least = open;
            start = i + 1;
        }
    }
    std::vector<HalfEdge> begun;
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        const Leaf& leaf = leaves[(start + i) % leaves.size()];
        if (!leaf.up) {
            begun.push_back(leaf.half);
        } else if (!begun.empty()) {
            out.emplace_back(begun.back(), leaf.half);
            begun.pop_back();
        }
    }
}

void EdgePairs::pair_flattest(const std::vector<Leaf>& leaves, Pairs& out)
{
    struct Choice {
        double bend;   ///< 0 flat ... pi folded back
        double inside; ///< angle of the inside between them
        HalfEdge down, up;
        bool operator<(const Choice& b) const
        {
            if (bend != b.bend)
                return bend < b.bend;
            if (inside != b.inside)
                return inside < b.inside;
            return std::pair(down, up) < std::pair(b.down, b.up);
        }
    };
    if (leaves.size() > leaves_max)
        return;
    const auto in_steps = [](double angle) { return std::round(angle / same_bend); };
    std::vector<Choice> choices;
    for (const Leaf& down : leaves) {
        for (const Leaf& up : leaves) {
            if (down.up || !up.up)
                continue;
            const double turn = up.angle - down.angle, inside = turn < 0 ? turn + 2 * pi : turn;
            choices.push_back({in_steps(std::abs(inside - pi)), in_steps(inside), down.half, up.half});
        }
    }
    std::sort(choices.begin(), choices.end());
    std::vector<HalfEdge> taken;
    const auto is_free = [&taken](HalfEdge half) {
        return std::find(taken.begin(), taken.end(), half) == taken.end();
    };
    for (const Choice& choice : choices) {
        if (!is_free(choice.down) || !is_free(choice.up))
            continue;
        out.emplace_back(choice.down, choice.up);
        taken.insert(taken.end(), {choice.down, choice.up});
    }
}

void EdgePairs::pair(std::span<const HalfEdge> halves, Pairs& out) const
{
    std::vector<Leaf> leaves = leaves_round(halves), open, closed;
    if (leaves.size() <= leaves_max && take_turns(leaves)) {
        pair_inside(leaves, out);
        return;
    }
    for (const Leaf& leaf : leaves)
        (closed_[leaf.component] ? closed : open).push_back(leaf);
    std::stable_sort(closed.begin(), closed.end(),
                     [](const Leaf& a, const Leaf& b) { return a.component < b.component; });
    for (std::size_t begin = 0, end = 0; begin < closed.size(); begin = end) {
        while (end < closed.size() && closed[end].component == closed[begin].component)
            ++end;
        pair_inside({closed.begin() + static_cast<std::ptrdiff_t>(begin),
                     closed.begin() + static_cast<std::ptrdiff_t>(end)},
                    out);
    }
    pair_flattest(open, out);
}

} // namespace phantom::mesh
