// SPDX-License-Identifier: GPL-2.0-or-later
// What a triangle tree consists of; shared with the scene tree, which searches several.
#pragma once

#include <utility>

#include "fdh/build.hpp"
#include "fdh/search.hpp"
#include "fdh/tree.hpp"

namespace phantom::fdh {

template <int K>
struct TriangleTree<K>::Impl {
    TreeData<K> data;
    Isa isa;
    const SearchKernels<K>* kernels;

    Impl(TreeData<K> data_, Isa asked)
        : data(std::move(data_)), isa(resolve_isa(asked)), kernels(&search_kernels<K>(isa))
    {
    }

    /// Adds what is near p [mesh coordinates] to a collector's hits.
    template <class Collector>
    void collect(const Point& p, std::uint32_t object, Collector& collector) const
    {
        if (data.nodes.empty())
            return;
        const Point steps = data.grid.to_steps(p);
        const SearchQuery<K> query{{steps[0], steps[1], steps[2]}, project<K>(steps), data.grid.step, object};
        Sink& sink = collector.open(data.grid.distance_error(steps));
        kernels->search(data.nodes.data(), data.leaves.data(), query, sink);
    }
};

} // namespace phantom::fdh
