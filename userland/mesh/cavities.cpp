// SPDX-License-Identifier: GPL-2.0-or-later
// Which closed components lie inside which: boxes first, then rays. A ray starts at a point of the inner
// component and goes up the z axis; it is inside when it crosses the outer one an odd number of times.
#include <algorithm>
#include <cmath>

#include "mesh/box_tree.hpp"
#include "mesh/components.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

/// Rays per inner component. All have to agree: where they do not, the two cut one another.
constexpr std::uint32_t probes_each = 3;

struct Probe {
    Vec3 from;
    std::uint32_t component;
    std::uint32_t crossings = 0;
};

/// Faces by component: those of c are order[first[c]] ... order[first[c + 1] - 1].
struct FaceLists {
    std::vector<std::uint32_t> first, order;
};

FaceLists lists_of(const Components& components)
{
    FaceLists lists;
    lists.first.assign(components.count() + 1, 0);
    for (const std::uint32_t c : components.of_face)
        ++lists.first[c + 1];
    for (std::size_t c = 0; c < components.count(); ++c)
        lists.first[c + 1] += lists.first[c];
    std::vector<std::uint32_t> next(lists.first.begin(), lists.first.end() - 1);
    lists.order.resize(components.of_face.size());
    for (std::uint32_t f = 0; f < components.of_face.size(); ++f)
        lists.order[next[components.of_face[f]]++] = f;
    return lists;
}

/// Does the edge pass the point, seen along z, on its side of higher x? The same bits from either of the
/// edge's faces, so a ray through an edge or a vertex meets exactly one of the faces there.
bool passes(const Vec3& a, const Vec3& b, const Vec3& point)
{
    if ((a[1] > point[1]) == (b[1] > point[1]))
        return false;
    const Vec3 &low = a < b ? a : b, &high = a < b ? b : a;
    return point[0] < low[0] + (point[1] - low[1]) / (high[1] - low[1]) * (high[0] - low[0]);
}

/// Does the ray from the point up z cross the face?
bool crosses(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point)
{
    if ((passes(a, b, point) != passes(b, c, point)) == passes(c, a, point))
        return false;
    if (point[2] < std::min({a[2], b[2], c[2]}))
        return true;
    if (point[2] >= std::max({a[2], b[2], c[2]}))
        return false;
    const Vec3 normal = cross(subtract(b, a), subtract(c, a));
    const double above = dot(normal, subtract(point, a)); // of the plane, along the normal
    return normal[2] > 0 ? above < 0 : above > 0;
}

/// Probes in columns along z, so that a face meets few of them.
class Columns {
  public:
    explicit Columns(std::vector<Probe>& probes) : probes_(probes)
    {
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const auto [low, high] =
                std::minmax_element(probes.begin(), probes.end(), [axis](const Probe& a, const Probe& b) {
                    return a.from[axis] < b.from[axis];
                });
            low_[axis] = low->from[axis];
            width_[axis] = high->from[axis] - low->from[axis];
        }
        side_ = std::clamp<std::size_t>(
            static_cast<std::size_t>(std::sqrt(static_cast<double>(probes.size()))), 1, 1024);
        first_.assign(side_ * side_ + 1, 0);
        for (const Probe& probe : probes)
            ++first_[cell(0, probe.from[0]) * side_ + cell(1, probe.from[1]) + 1];
        for (std::size_t i = 0; i < side_ * side_; ++i)
            first_[i + 1] += first_[i];
        std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
        order_.resize(probes.size());
        for (std::uint32_t p = 0; p < probes.size(); ++p)
            order_[next[cell(0, probes[p].from[0]) * side_ + cell(1, probes[p].from[1])]++] = p;
    }

    void count_crossings(const Vec3& a, const Vec3& b, const Vec3& c)
    {
        for (std::size_t axis = 0; axis < 2; ++axis) {
            if (std::max({a[axis], b[axis], c[axis]}) < low_[axis] ||
                std::min({a[axis], b[axis], c[axis]}) > low_[axis] + width_[axis])
                return;
        }
        const std::size_t left = cell(0, std::min({a[0], b[0], c[0]}));
        const std::size_t right = cell(0, std::max({a[0], b[0], c[0]}));
        const std::size_t front = cell(1, std::min({a[1], b[1], c[1]}));
        const std::size_t back = cell(1, std::max({a[1], b[1], c[1]}));
        for (std::size_t x = left; x <= right; ++x) {
            // the cells of one x stand together
            for (std::uint32_t i = first_[x * side_ + front]; i < first_[x * side_ + back + 1]; ++i) {
                Probe& probe = probes_[order_[i]];
                probe.crossings += crosses(a, b, c, probe.from);
            }
        }
    }

  private:
    /// Rises with the coordinate: what lies between two points lies in cells between theirs.
    [[nodiscard]] std::size_t cell(std::size_t axis, double coordinate) const
    {
        if (!(width_[axis] > 0))
            return 0;
        const double part = std::clamp((coordinate - low_[axis]) / width_[axis], 0.0, 1.0);
        return std::min(side_ - 1, static_cast<std::size_t>(part * static_cast<double>(side_)));
    }

    std::vector<Probe>& probes_;
    std::array<double, 2> low_{}, width_{};
    std::size_t side_ = 1;
    std::vector<std::uint32_t> first_, order_; ///< probes by cell
};

bool strictly_inside(const Bounds& inner, const Bounds& outer)
{
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!(inner.low[axis] > outer.low[axis] && inner.high[axis] < outer.high[axis]))
            return false;
    }
    return true;
}

std::vector<Bounds> boxes_of(const Soup& soup, const Components& components)
{
    std::vector<Bounds> boxes(components.count());
    std::vector<bool> begun(components.count(), false);
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        const std::uint32_t c = components.of_face[f];
        for (const std::uint32_t v : soup.faces[f]) {
            const Vec3& point = soup.vertices[v];
            if (!begun[c])
                boxes[c] = {point, point};
            begun[c] = true;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                boxes[c].low[axis] = std::min(boxes[c].low[axis], point[axis]);
                boxes[c].high[axis] = std::max(boxes[c].high[axis], point[axis]);
            }
        }
    }
    return boxes;
}

/// Points on the faces of a component, spread over their order.
void add_probes(const Soup& soup, const FaceLists& lists, std::uint32_t component, std::vector<Probe>& probes)
{
    const std::uint32_t first = lists.first[component], count = lists.first[component + 1] - first;
    for (std::uint32_t i = 0; i < probes_each; ++i) {
        const auto step = static_cast<std::uint64_t>(count - 1) * i / (probes_each - 1);
        const Triple& face = soup.faces[lists.order[first + static_cast<std::uint32_t>(step)]];
        const Vec3 sum = add(add(soup.vertices[face[0]], soup.vertices[face[1]]), soup.vertices[face[2]]);
        probes.push_back({scaled(sum, 1.0 / 3), component});
    }
}

} // namespace

std::vector<bool> cavities_of(const Soup& soup, const Components& components, const std::vector<bool>& closed)
{
    std::vector<bool> cavity(components.count(), false);
    if (std::count(closed.begin(), closed.end(), true) < 2)
        return cavity;
    const std::vector<Bounds> boxes = boxes_of(soup, components);
    const BoxTree tree(boxes);
    struct Pair {
        std::uint32_t outer, inner;
        bool operator<(const Pair& b) const { return outer != b.outer ? outer < b.outer : inner < b.inner; }
    };
    std::vector<Pair> pairs;
    for (std::uint32_t inner = 0; inner < boxes.size(); ++inner) {
        if (!closed[inner])
            continue;
        tree.visit_meeting({boxes[inner].low, boxes[inner].low}, [&](std::uint32_t outer) {
            if (closed[outer] && strictly_inside(boxes[inner], boxes[outer]))
                pairs.push_back({outer, inner});
        });
    }
    if (pairs.empty())
        return cavity;
    std::sort(pairs.begin(), pairs.end());
    const FaceLists lists = lists_of(components);
    std::vector<Probe> probes;
    for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
        const std::uint32_t outer = pairs[begin].outer;
        probes.clear();
        for (end = begin; end < pairs.size() && pairs[end].outer == outer; ++end)
            add_probes(soup, lists, pairs[end].inner, probes);
        Columns columns(probes);
        for (std::uint32_t i = lists.first[outer]; i < lists.first[outer + 1]; ++i) {
            const Triple& face = soup.faces[lists.order[i]];
            columns.count_crossings(soup.vertices[face[0]], soup.vertices[face[1]], soup.vertices[face[2]]);
        }
        for (std::size_t p = 0; p < probes.size(); p += probes_each) {
            const auto inside = [](const Probe& probe) { return probe.crossings % 2 == 1; };
            const auto first = probes.begin() + static_cast<std::ptrdiff_t>(p);
            if (std::all_of(first, first + probes_each, inside))
                cavity[probes[p].component] = !cavity[probes[p].component];
        }
    }
    return cavity;
}

} // namespace phantom::mesh
