// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/scene_tree.hpp"

#include <stdexcept>
#include <string>

#include "fdh/collector.hpp"
#include "fdh/pose.hpp"
#include "fdh/split.hpp"
#include "fdh/tree_impl.hpp"

namespace phantom::fdh {

template <int K>
struct SceneTree<K>::Impl {
    struct Object {
        TriangleTree<K> tree;
        Pose pose;
    };
    std::vector<Object> objects;
    Grid grid;                  ///< of level one: world coordinates to steps
    std::vector<Node<K>> nodes; ///< leaf references are object numbers; empty objects are not in it
    const SearchKernels<K>* kernels = &search_kernels<K>(Isa::best);

    static void check(const Pose& pose, std::size_t object)
    {
        if (!finite(pose))
            throw std::invalid_argument("fdh: object " + std::to_string(object) + ": its pose is not finite");
    }

    void update();
    [[nodiscard]] Hull<K> in_steps(const Slabs<K>& slabs) const;

    /// Visits the objects whose hulls are within the collector's limit, near ones first.
    template <class Collector>
    void collect(const Point& p, Collector& collector) const;
};

/// Outward to float, relative to the level's origin.
template <int K>
Hull<K> SceneTree<K>::Impl::in_steps(const Slabs<K>& slabs) const
{
    constexpr auto directions = hull_directions<K>();
    Hull<K> hull;
    for (int k = 0; k < K / 2; k++) {
        double shift = 0, magnitude = std::max(std::abs(slabs[k][0]), std::abs(slabs[k][1]));
        for (int axis = 0; axis < 3; axis++) {
            shift += directions[k][axis] * grid.origin[axis];
            magnitude += std::abs(grid.origin[axis]);
        }
        const double slack = 0x1p-50 * magnitude;
        hull.low[k] = round_down((slabs[k][0] - shift - slack) / grid.step);
        hull.high[k] = round_up((slabs[k][1] - shift + slack) / grid.step);
    }
    return hull;
}

template <int K>
void SceneTree<K>::Impl::update()
{
    nodes.clear();
    std::vector<Slabs<K>> hulls(objects.size());
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Point low = {infinity, infinity, infinity}, high = {-infinity, -infinity, -infinity};
    std::vector<PrimitiveBox> boxes;
    for (std::uint32_t i = 0; i < objects.size(); i++) {
        if (objects[i].tree.triangles() == 0)
            continue;
        hulls[i] = posed_hull<K>(objects[i].tree.hull(), objects[i].pose);
        boxes.emplace_back().index = i;
        for (int axis = 0; axis < 3; axis++) {
            low[axis] = std::min(low[axis], hulls[i][axis][0]);
            high[axis] = std::max(high[axis], hulls[i][axis][1]);
        }
    }
    if (boxes.empty())
        return;
    grid = Grid::over(low, high);
    std::vector<Hull<K>> stepped(objects.size());
    for (PrimitiveBox& box : boxes) {
        stepped[box.index] = in_steps(hulls[box.index]);
        std::copy_n(stepped[box.index].low, 3, box.low);
        std::copy_n(stepped[box.index].high, 3, box.high);
    }
    const Shape shape = split(boxes, 1, 1);
    nodes.assign(shape.nodes.size(), empty_node<K>());
    for (std::size_t n = shape.nodes.size(); n-- > 0;)
        for (int i = 0; i < shape.nodes[n].count; i++) {
            const auto& child = shape.nodes[n].children[i];
            const std::uint32_t object = boxes[child.begin].index;
            if (child.reference & leaf_flag)
                set_child(nodes[n], i, stepped[object], object | leaf_flag);
            else
                set_child(nodes[n], i, hull_of(nodes[child.reference]), child.reference);
        }
}

template <int K>
template <class Collector>
void SceneTree<K>::Impl::collect(const Point& p, Collector& collector) const
{
    if (nodes.empty())
        return;
    struct Waiting {
        float bound2;
        std::uint32_t child;
    };
    const auto point = project<K>(grid.to_steps(p));
    auto hull_limit = [&] {
        const double steps = collector.limit() / grid.step;
        return search_limit(steps * steps);
    };
    float limit = hull_limit();
    Waiting stack[stack_size];
    int top = 0;
    stack[top++] = {0, 0};
    while (top > 0) {
        const Waiting next = stack[--top];
        if (!(next.bound2 < limit))
            continue;
        if (next.child & leaf_flag) {
            const std::uint32_t object = next.child & ~leaf_flag;
            objects[object].tree.impl_->collect(to_local(objects[object].pose, p), object, collector);
            limit = hull_limit();
            continue;
        }
        float bound2[lanes];
        kernels->bounds(nodes[next.child], point, bound2);
        const int base = top;
        for (int lane = 0; lane < lanes; lane++) {
            if (!(bound2[lane] < limit))
                continue;
            int place = top++;
            for (; place > base && stack[place - 1].bound2 < bound2[lane]; place--)
                stack[place] = stack[place - 1];
            stack[place] = {bound2[lane], nodes[next.child].child[lane]};
        }
    }
}

template <int K>
SceneTree<K>::SceneTree() : impl_(std::make_unique<Impl>())
{
}
template <int K>
SceneTree<K>::SceneTree(SceneTree&&) noexcept = default;
template <int K>
SceneTree<K>& SceneTree<K>::operator=(SceneTree&&) noexcept = default;
template <int K>
SceneTree<K>::~SceneTree() = default;

template <int K>
std::uint32_t SceneTree<K>::add(TriangleTree<K> tree, const Pose& pose)
{
    Impl::check(pose, impl_->objects.size());
    impl_->objects.push_back({std::move(tree), pose});
    return static_cast<std::uint32_t>(impl_->objects.size() - 1);
}

template <int K>
void SceneTree<K>::set_pose(std::uint32_t object, const Pose& pose)
{
    Impl::check(pose, object);
    impl_->objects.at(object).pose = pose;
}

template <int K>
void SceneTree<K>::update()
{
    impl_->update();
}

template <int K>
std::size_t SceneTree<K>::objects() const
{
    return impl_->objects.size();
}

template <int K>
const TriangleTree<K>& SceneTree<K>::tree(std::uint32_t object) const
{
    return impl_->objects.at(object).tree;
}

template <int K>
const Pose& SceneTree<K>::pose(std::uint32_t object) const
{
    return impl_->objects.at(object).pose;
}

template <int K>
std::size_t SceneTree<K>::triangles() const
{
    std::size_t sum = 0;
    for (const auto& object : impl_->objects)
        sum += object.tree.triangles();
    return sum;
}

template <int K>
std::size_t SceneTree<K>::bytes() const
{
    std::size_t sum = sizeof(Impl) + impl_->objects.capacity() * sizeof(typename Impl::Object) +
                      impl_->nodes.capacity() * sizeof(Node<K>);
    for (const auto& object : impl_->objects)
        sum += object.tree.bytes();
    return sum;
}

template <int K>
void SceneTree<K>::nearest(const Point& p, std::size_t count, double max_radius, Nearest& out) const
{
    if (!valid_query(p, max_radius)) {
        out.clear();
        return;
    }
    NearestCollector collector(out, count, max_radius);
    impl_->collect(p, collector);
    collector.finish();
}

template <int K>
void SceneTree<K>::within(const Point& p, double radius, std::vector<Hit>& out) const
{
    out.clear();
    if (!valid_query(p, radius))
        return;
    WithinCollector collector(out, radius);
    impl_->collect(p, collector);
    collector.finish();
}

template class SceneTree<6>;
template class SceneTree<14>;
template class SceneTree<18>;
template class SceneTree<26>;

} // namespace phantom::fdh
