// SPDX-License-Identifier: GPL-2.0-or-later
// What a scene tree consists of; shared with the coherent queries, which search its objects in their own way.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "fdh/collector.hpp"
#include "fdh/object_tree.hpp"
#include "fdh/scene_tree.hpp"
#include "fdh/tree_impl.hpp"

namespace phantom::fdh {

template <int K>
struct SceneTree<K>::Impl {
    struct Object {
        TriangleTree<K> tree;
        Pose pose;
        Slabs<K> local{};         ///< the tree's hull
        bool hull_is_old = false; ///< waits for update()
    };
    std::vector<Object> objects;
    std::vector<Slabs<K>> hulls; ///< of each object, posed
    std::vector<std::uint32_t> moved;
    ObjectTree<K> level;

    static void check(const Pose& pose, std::size_t object)
    {
        if (!finite(pose))
            throw std::invalid_argument("fdh: object " + std::to_string(object) + ": its pose is not finite");
    }

    void mark(std::uint32_t object);
    bool update();

    /// Calls search(object, p in its frame) for the objects whose hulls are within the collector's limit,
    /// near ones first.
    template <class Collector, class Search>
    void visit(const Point& p, const Collector& collector, const Search& search) const
    {
        auto in_its_frame = [&](std::uint32_t object) { search(object, to_local(objects[object].pose, p)); };
        if (objects.size() == 1) // its own root tells as much
            in_its_frame(0);
        else
            level.visit(
                slabs_of<K>(p), [&] { return collector.limit(); }, in_its_frame);
    }

    template <class Collector>
    void collect(const Point& p, Collector& collector) const
    {
        visit(p, collector, [&](std::uint32_t object, const Point& local) {
            objects[object].tree.impl_->collect(local, object, collector);
        });
    }

    /// Lower bound of the distance between two objects.
    [[nodiscard]] double separation(std::uint32_t first, std::uint32_t second) const;
    /// Adds the pairs of an object with others, of which only those behind it if `each_once`.
    void add_pairs(std::uint32_t object, double distance, bool each_once, std::vector<ObjectPair>& out) const;
};

} // namespace phantom::fdh
