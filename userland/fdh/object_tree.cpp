// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/object_tree.hpp"

namespace phantom::fdh {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Coordinates are cut off here [steps], so that squares stay finite in float. Gaps become smaller by it,
/// which a lower bound may be.
constexpr double farthest = 0x1p61;

/// The grid lies round the objects as they were at the last rebuild. This far from its origin [steps] float
/// is coarser than four steps.
constexpr float grid_outgrown = 4 * static_cast<float>(Grid::half_extent_steps);

template <int K>
bool is_empty(const Slabs<K>& hull)
{
    return !(hull[0][0] <= hull[0][1]);
}

template <class Hull>
double centre(const Hull& hull, int axis)
{
    return 0.5 * (double(hull.low[axis]) + hull.high[axis]);
}

constexpr int bins = 16;

/// The box of the items whose centroids fall into one part of an axis.
struct Bin {
    double low[3] = {infinity, infinity, infinity}, high[3] = {-infinity, -infinity, -infinity};
    std::size_t count = 0;

    template <class Hull>
    void add(const Hull& hull)
    {
        for (int axis = 0; axis < 3; axis++) {
            low[axis] = std::min(low[axis], double(hull.low[axis]));
            high[axis] = std::max(high[axis], double(hull.high[axis]));
        }
        count++;
    }
    void add(const Bin& bin)
    {
        for (int axis = 0; axis < 3; axis++) {
            low[axis] = std::min(low[axis], bin.low[axis]);
            high[axis] = std::max(high[axis], bin.high[axis]);
        }
        count += bin.count;
    }
    [[nodiscard]] double cost() const
    {
        const double x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
        return count > 0 ? static_cast<double>(count) * (x * y + y * z + z * x) : 0;
    }
};

/// Which bin a centroid falls into.
struct BinScale {
    int axis = 0;
    double low = 0, bins_per_step = 0;

    template <class Hull>
    [[nodiscard]] int bin_of(const Hull& hull) const
    {
        return std::min(static_cast<int>((centre(hull, axis) - low) * bins_per_step), bins - 1);
    }
};

/// Bins before `bin` go first.
struct Cut {
    double cost = infinity; ///< infinite: there is no cut with something on either side
    int bin = 0;
    BinScale scale{};
};

Cut best_cut(const Bin (&binned)[bins], const BinScale& scale)
{
    Bin after[bins]; // everything from this bin on
    after[bins - 1] = binned[bins - 1];
    for (int b = bins - 1; b-- > 1;) {
        after[b] = after[b + 1];
        after[b].add(binned[b]);
    }
    Cut best;
    Bin first;
    for (int b = 1; b < bins; b++) {
        first.add(binned[b - 1]);
        const double cost = first.cost() + after[b].cost();
        if (first.count > 0 && after[b].count > 0 && cost < best.cost)
            best = {cost, b, scale};
    }
    return best;
}

} // namespace

template <int K>
typename ObjectTree<K>::Hull ObjectTree<K>::in_steps(const Slabs<K>& slabs) const
{
    Hull hull;
    for (int k = 0; k < K / 2; k++) {
        const auto [low, high] = slabs[k];
        const double slack = 0x1p-50 * (origin_magnitude_ + std::max(std::abs(low), std::abs(high)));
        hull.low[k] =
            round_down(std::clamp((low - origin_[k] - slack) * grid_.steps_per_unit, -farthest, farthest));
        hull.high[k] =
            round_up(std::clamp((high - origin_[k] + slack) * grid_.steps_per_unit, -farthest, farthest));
    }
    return hull;
}

/// What `bounds` is held against; room for the rounding of a dozen float operations.
template <int K>
float ObjectTree<K>::limit_in_steps2(double limit) const
{
    const double steps = limit * grid_.steps_per_unit;
    const double padded = steps * steps * (1 + 0x1p-19);
    return padded < 0.5 * std::numeric_limits<float>::max() ? next_up(round_up(padded)) : infinity;
}

template <int K>
void ObjectTree<K>::bounds(const Node& node, const Hull& query, float (&bound2)[width])
{
    typedef float V __attribute__((vector_size(16))); // every x86-64 and every arm64 has these
    constexpr int step = sizeof(V) / sizeof(float);
    auto load = [](const float* p) {
        V v;
        __builtin_memcpy(&v, p, sizeof v);
        return v;
    };
    for (int lane = 0; lane < width; lane += step) {
        const V bound = squared_distance_bound<K, float>([&](int k) {
            const V below = load(node.low[k] + lane) - query.high[k];
            const V above = query.low[k] - load(node.high[k] + lane);
            const V gap = below > above ? below : above;
            return gap > 0 ? gap * gap : V{};
        });
        __builtin_memcpy(bound2 + lane, &bound, sizeof bound);
    }
}

template <int K>
void ObjectTree<K>::set_lane(Node& node, int lane, const Hull& hull)
{
    for (int k = 0; k < K / 2; k++) {
        node.low[k][lane] = hull.low[k];
        node.high[k][lane] = hull.high[k];
    }
}

template <int K>
typename ObjectTree<K>::Hull ObjectTree<K>::union_of(const Node& node)
{
    Hull hull;
    for (int k = 0; k < K / 2; k++) {
        hull.low[k] = *std::min_element(node.low[k], node.low[k] + width);
        hull.high[k] = *std::max_element(node.high[k], node.high[k] + width);
    }
    return hull;
}

template <int K>
double ObjectTree<K>::half_area(const Hull& hull)
{
    const double x = double(hull.high[0]) - hull.low[0], y = double(hull.high[1]) - hull.low[1],
                 z = double(hull.high[2]) - hull.low[2];
    return x * y + y * z + z * x;
}

template <int K>
double ObjectTree<K>::cost() const
{
    double nodes = 0, objects = 0;
    for (const double area : node_areas_)
        nodes += area;
    for (const double area : object_areas_)
        objects += area;
    return objects > 0 ? nodes / objects : 0;
}

template <int K>
std::size_t ObjectTree<K>::bytes() const
{
    return nodes_.capacity() * sizeof(Node) + places_.capacity() * sizeof(Place) +
           (node_areas_.capacity() + object_areas_.capacity()) * sizeof(double) + changed_.capacity() +
           items_.capacity() * sizeof(Item);
}

template <int K>
bool ObjectTree<K>::update(std::span<const Slabs<K>> hulls, std::span<const std::uint32_t> moved)
{
    if (hulls.size() == places_.size() && refit(hulls, moved)) {
        const double now = cost();
        least_cost_ = std::min(least_cost_, now);
        if (now <= tolerated_growth * least_cost_)
            return false;
    }
    rebuild(hulls);
    least_cost_ = cost();
    return true;
}

template <int K>
bool ObjectTree<K>::refit(std::span<const Slabs<K>> hulls, std::span<const std::uint32_t> moved)
{
    for (const std::uint32_t object : moved) {
        const Place place = places_[object];
        if ((place.node == none) != is_empty<K>(hulls[object]))
            return false;
        if (place.node == none)
            continue;
        const Hull hull = in_steps(hulls[object]);
        set_lane(nodes_[place.node], place.lane, hull);
        object_areas_[object] = half_area(hull);
        changed_[place.node] = 1;
    }
    // Parents stand before their children: from the back, each is complete when its own turn comes.
    for (std::size_t n = nodes_.size(); n-- > 0;) {
        if (!changed_[n])
            continue;
        changed_[n] = 0;
        const Hull hull = union_of(nodes_[n]);
        node_areas_[n] = half_area(hull);
        if (n > 0) {
            set_lane(nodes_[nodes_[n].parent], nodes_[n].lane, hull);
            changed_[nodes_[n].parent] = 1;
            continue;
        }
        for (int axis = 0; axis < 3; axis++)
            if (hull.low[axis] < -grid_outgrown || hull.high[axis] > grid_outgrown)
                return false;
    }
    return true;
}

template <int K>
void ObjectTree<K>::rebuild(std::span<const Slabs<K>> hulls)
{
    nodes_.clear();
    node_areas_.clear();
    changed_.clear();
    items_.clear();
    places_.assign(hulls.size(), {});
    object_areas_.assign(hulls.size(), 0.0);
    Slabs<K> whole = empty_slabs<K>();
    for (const Slabs<K>& hull : hulls)
        if (!is_empty<K>(hull))
            grow<K>(whole, hull);
    if (is_empty<K>(whole))
        return;
    grid_ = Grid::over({whole[0][0], whole[1][0], whole[2][0]}, {whole[0][1], whole[1][1], whole[2][1]});
    const Point& o = grid_.origin;
    origin_magnitude_ = std::abs(o[0]) + std::abs(o[1]) + std::abs(o[2]);
    constexpr auto directions = hull_directions<K>();
    for (int k = 0; k < K / 2; k++)
        origin_[k] = directions[k][0] * o[0] + directions[k][1] * o[1] + directions[k][2] * o[2];
    for (std::uint32_t object = 0; object < hulls.size(); object++)
        if (!is_empty<K>(hulls[object])) {
            items_.push_back({in_steps(hulls[object]), object});
            object_areas_[object] = half_area(items_.back().hull);
        }
    build(items_, 0, none, 0);
    // The hulls of inner nodes, from the back.
    changed_.assign(nodes_.size(), 1);
    node_areas_.assign(nodes_.size(), 0.0);
    refit(hulls, {});
    std::fill(changed_.begin(), changed_.end(), 0);
}

/// Makes up to `width` groups of the items, the largest box split first, and nodes of those.
template <int K>
std::uint32_t ObjectTree<K>::build(Group items, int depth, std::uint32_t parent, int parent_lane)
{
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    Node& fresh = nodes_.emplace_back();
    fresh.parent = parent;
    fresh.lane = parent_lane;
    Hull empty;
    std::fill(std::begin(empty.low), std::end(empty.low), infinity);
    std::fill(std::begin(empty.high), std::end(empty.high), -infinity);
    for (int lane = 0; lane < width; lane++) {
        set_lane(fresh, lane, empty);
        fresh.child[lane] = 0;
    }

    auto area_of = [&](Group group) {
        Hull hull = empty;
        for (const Item& item : group)
            for (int axis = 0; axis < 3; axis++) {
                hull.low[axis] = std::min(hull.low[axis], item.hull.low[axis]);
                hull.high[axis] = std::max(hull.high[axis], item.hull.high[axis]);
            }
        return half_area(hull);
    };
    struct {
        Group items;
        double area;
    } groups[width];
    groups[0] = {items, area_of(items)};
    int count = 1;
    while (count < width) {
        int largest = -1;
        for (int i = 0; i < count; i++)
            if (groups[i].items.size() > 1 && (largest < 0 || groups[i].area > groups[largest].area))
                largest = i;
        if (largest < 0)
            break;
        const Group whole = groups[largest].items;
        const std::size_t first = split(whole, depth >= balanced_depth);
        groups[largest] = {whole.first(first), area_of(whole.first(first))};
        groups[count++] = {whole.subspan(first), area_of(whole.subspan(first))};
    }
    for (int lane = 0; lane < count; lane++) {
        const Group group = groups[lane].items;
        std::uint32_t child;
        if (group.size() == 1) {
            child = group[0].object | object_flag;
            places_[group[0].object] = {index, lane};
            set_lane(nodes_[index], lane, group[0].hull);
        } else {
            child = build(group, depth + 1, index, lane);
        }
        nodes_[index].child[lane] = child;
    }
    return index;
}

/// Reorders the items and returns how many go first, at least one and not all: the split with the least
/// half area times count over all three axes with binned centroids (Wald 2007), or the halves by count along
/// the axis of the widest centroids.
template <int K>
std::size_t ObjectTree<K>::split(Group items, bool by_count)
{
    double low[3], high[3]; // of the centroids
    int widest = 0;
    for (int axis = 0; axis < 3; axis++) {
        low[axis] = high[axis] = centre(items[0].hull, axis);
        for (const Item& item : items) {
            low[axis] = std::min(low[axis], centre(item.hull, axis));
            high[axis] = std::max(high[axis], centre(item.hull, axis));
        }
        if (high[axis] - low[axis] > high[widest] - low[widest])
            widest = axis;
    }
    Cut best;
    for (int axis = 0; axis < 3 && !by_count; axis++) {
        if (!(high[axis] > low[axis]))
            continue;
        const BinScale scale{axis, low[axis], bins / (high[axis] - low[axis])};
        Bin binned[bins];
        for (const Item& item : items)
            binned[scale.bin_of(item.hull)].add(item.hull);
        const Cut cut = best_cut(binned, scale);
        if (cut.cost < best.cost)
            best = cut;
    }
    if (best.cost < infinity) {
        const auto middle = std::partition(items.begin(), items.end(), [&](const Item& item) {
            return best.scale.bin_of(item.hull) < best.bin;
        });
        return static_cast<std::size_t>(middle - items.begin());
    }
    const std::size_t half = items.size() / 2;
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                     [&](const Item& a, const Item& b) {
                         const double x = centre(a.hull, widest), y = centre(b.hull, widest);
                         return x != y ? x < y : a.object < b.object;
                     });
    return half;
}

template class ObjectTree<6>;
template class ObjectTree<14>;
template class ObjectTree<18>;
template class ObjectTree<26>;

} // namespace phantom::fdh
