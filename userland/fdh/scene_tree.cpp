// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/scene_tree.hpp"

#include <algorithm>
#include <utility>

#include "fdh/pair_search.hpp"
#include "fdh/region_search.hpp"
#include "fdh/scene_tree_impl.hpp"

namespace phantom::fdh {

template <int K>
void SceneTree<K>::Impl::mark(std::uint32_t object)
{
    if (!std::exchange(objects[object].hull_is_old, true))
        moved.push_back(object);
}

template <int K>
bool SceneTree<K>::Impl::update()
{
    hulls.resize(objects.size(), empty_slabs<K>());
    for (const std::uint32_t i : moved) {
        Object& object = objects[i];
        object.hull_is_old = false;
        hulls[i] = object.tree.triangles() > 0 ? posed_hull<K>(object.local, object.pose) : empty_slabs<K>();
    }
    const bool rebuilt = level.update(hulls, moved);
    moved.clear();
    return rebuilt;
}

template <int K>
double SceneTree<K>::Impl::separation(std::uint32_t first, std::uint32_t second) const
{
    const Object &a = objects[first], &b = objects[second];
    return std::max({distance_bound<K>(hulls[first], hulls[second]),
                     distance_bound_in_frame<K>(a.local, a.pose, b.local, b.pose),
                     distance_bound_in_frame<K>(b.local, b.pose, a.local, a.pose)});
}

template <int K>
void SceneTree<K>::Impl::add_pairs(std::uint32_t object, double distance, bool each_once,
                                   std::vector<ObjectPair>& out) const
{
    if (objects[object].tree.triangles() == 0)
        return;
    const std::size_t before = out.size();
    auto consider = [&](std::uint32_t other) {
        if (other == object || (each_once && other < object))
            return;
        const double at_least = separation(object, other);
        if (at_least <= distance)
            out.push_back({object, other, at_least});
    };
    level.visit(
        hulls[object], [&] { return distance; }, consider);
    std::sort(out.begin() + static_cast<std::ptrdiff_t>(before), out.end(),
              [](const ObjectPair& a, const ObjectPair& b) { return a.second < b.second; });
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
    const auto object = static_cast<std::uint32_t>(impl_->objects.size());
    const Slabs<K> local = tree.hull();
    impl_->objects.push_back({std::move(tree), pose, local});
    impl_->mark(object);
    return object;
}

template <int K>
void SceneTree<K>::set_pose(std::uint32_t object, const Pose& pose)
{
    Impl::check(pose, object);
    impl_->objects.at(object).pose = pose;
    impl_->mark(object);
}

template <int K>
void SceneTree<K>::set_tree(std::uint32_t object, TriangleTree<K> tree)
{
    typename Impl::Object& changed = impl_->objects.at(object);
    changed.local = tree.hull();
    changed.tree = std::move(tree);
    impl_->mark(object);
}

template <int K>
bool SceneTree<K>::update()
{
    return impl_->update();
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
                      impl_->hulls.capacity() * sizeof(Slabs<K>) +
                      impl_->moved.capacity() * sizeof(std::uint32_t) + impl_->level.bytes();
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
}

template <int K>
void SceneTree<K>::along(const Point& from, const Point& to, double radius, std::vector<Hit>& out) const
{
    out.clear();
    if (!valid_segment({from, to}, radius))
        return;
    Slabs<K> hull = slabs_of<K>(from);
    grow<K>(hull, slabs_of<K>(to));
    impl_->level.visit(
        hull, [&] { return radius; },
        [&](std::uint32_t i) {
            const typename Impl::Object& object = impl_->objects[i];
            const Segment local = {to_local(object.pose, from), to_local(object.pose, to)};
            const auto& data = object.tree.impl_->data;
            search_along<K>(object.tree.impl_->view, data.grid, local, radius, i, out);
        });
}

template <int K>
void SceneTree<K>::in_box(const Box& box, std::vector<Hit>& out) const
{
    out.clear();
    if (!valid_box(box))
        return;
    impl_->level.visit(
        slabs_of_box<K>(box), [] { return 0.0; },
        [&](std::uint32_t i) {
            const typename Impl::Object& object = impl_->objects[i];
            const auto& data = object.tree.impl_->data;
            search_box<K>(object.tree.impl_->view, data.grid, object.pose, box, i, out);
        });
}

template <int K>
void SceneTree<K>::pairs_near(std::uint32_t object, double distance, std::vector<ObjectPair>& out) const
{
    if (object >= impl_->objects.size())
        throw std::out_of_range("fdh: no object " + std::to_string(object));
    out.clear();
    if (distance >= 0)
        impl_->add_pairs(object, distance, false, out);
}

template <int K>
void SceneTree<K>::triangle_pairs(std::uint32_t first, std::uint32_t second, double distance,
                                  std::vector<TrianglePair>& out) const
{
    out.clear();
    auto posed = [&](std::uint32_t i) {
        const typename Impl::Object& object = impl_->objects.at(i);
        return PosedTree<K>{object.tree.impl_->view, object.tree.impl_->data.grid, object.pose};
    };
    const PosedTree<K> a = posed(first), b = posed(second);
    if (distance >= 0)
        search_pairs<K>(a, b, distance, out);
}

template <int K>
void SceneTree<K>::pairs(double distance, std::vector<ObjectPair>& out) const
{
    out.clear();
    if (!(distance >= 0))
        return;
    for (std::uint32_t object = 0; object < impl_->objects.size(); object++)
        impl_->add_pairs(object, distance, true, out);
}

template class SceneTree<6>;
template class SceneTree<14>;
template class SceneTree<18>;
template class SceneTree<26>;

} // namespace phantom::fdh
