// SPDX-License-Identifier: GPL-2.0-or-later
// What a triangle tree consists of; shared with the scene tree, which searches several.
#pragma once

#include <cmath>
#include <utility>

#include "fdh/build.hpp"
#include "fdh/collector.hpp"
#include "fdh/search.hpp"
#include "fdh/tree.hpp"

namespace phantom::fdh {

template <int K>
struct TriangleTree<K>::Impl {
    TreeData<K> data;
    Isa isa;
    const SearchKernels<K>* kernels;

    Impl(TreeData<K> data_, Isa asked)
        : data(std::move(data_)),
          isa(resolve_isa(asked)),
          kernels(&search_kernels<K>(isa)),
          view(data.view()),
          prefetch(data.nodes.size_bytes() + data.leaves.size_bytes() > cached_bytes)
    {
    }

    /// Below this, a tree in use stays in a core's own cache, and asking for its memory early costs more than
    /// it gains.
    static constexpr std::size_t cached_bytes = 1 << 20;

    /// Adds what is near p [mesh coordinates] to what a collector has.
    template <class Collector>
    void collect(const Point& p, std::uint32_t object, Collector& collector) const
    {
        if (data.nodes.empty())
            return;
        const Point steps = data.grid.to_steps(p);
        const ErrorBound error = error_from(steps);
        if (near(steps))
            collector.search(view, *kernels, search_point<K>(steps, data.longest_edge, prefetch),
                             data.grid.step, object, error);
        else
            collector.search_precisely(view, steps, data.grid.step, object, error);
    }

    [[nodiscard]] static bool near(const Point& steps)
    {
        return std::abs(steps[0]) <= farthest_point && std::abs(steps[1]) <= farthest_point &&
               std::abs(steps[2]) <= farthest_point;
    }
    [[nodiscard]] ErrorBound error_from(const Point& steps) const
    {
        const double base = data.grid.distance_error(steps);
        if (near(steps))
            return {base + float_error * data.longest_edge * data.grid.step, float_error};
        return {base, Grid::arithmetic};
    }

    TreeView<K> view;
    bool prefetch;
};

} // namespace phantom::fdh
